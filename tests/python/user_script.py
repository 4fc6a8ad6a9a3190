"""A user's script, for mypy --strict: what the package promises about types. test_vehicle.py runs it, too."""

import sys

import numpy as np
import wingbeat as wb


def main(file: str) -> float:
    with open(file, encoding="utf-8") as opened:
        vehicle = wb.read(opened)
    inertia: float = 2.0 * vehicle.wing.count
    result = vehicle.replace({"supply.voltage": "3 V"}).solve(tolerance=1e-8)
    if result.lift_mean is None or result.frequency is None:
        raise SystemExit(result.evidence)
    unit: str = result.lift_mean.unit
    slope: float = wb.solve(vehicle).gradient("lift_mean", "transmission.crank_radius")
    slopes = result.gradient("lift_mean", ["transmission.crank_radius", "supply.voltage"])
    found = wb.solve({"supply.voltage": np.linspace(2, 4, 5)}, vehicle=vehicle)
    best = float(found.lift_mean[found.flapping].max())
    print(inertia, unit, slope, slopes.shape, best, vehicle.simulate().time_to_steady.unit)
    flight = vehicle.simulation(voltage=lambda time: 3.0 + time)
    kinds: list[str] = [event.kind for event in flight.step_to("20 ms")]
    speed: float = float(flight.state[1])
    flight.voltage = 3.0
    flight.restore(flight.save())
    print(kinds, speed, float(vehicle.motor_curves().stall_torque))
    data = vehicle.sweep({"supply.voltage": ["2 V", 3.0]}, progress=False)
    flapping: bool = bool((data.where(data.lift_mean > 0).status == "flapping").all())
    air = {"voltage_V": [2, 3, 4], "frequency_Hz": [16.0, 22.0, 27.5], "current_mean_mA": [110, 180, 253]}
    fitted = wb.fit(vehicle, air, parameters={"friction.radius": (0, "8 mm")}, deviation=0.01)
    same = vehicle.fit(air, parameters={"friction.radius": (0, "8 mm")}, deviation={"default": 0.01})
    left, right = wb.plot.single_column.unit, data.sel(supply_voltage=3.0).status.item()
    print(left, right)
    if fitted.vehicle is None or same.vehicle is None:
        raise SystemExit(str(fitted))
    print(flapping, fitted.vehicle.friction.radius == same.vehicle.friction.radius)
    return result.frequency + best


if __name__ == "__main__":
    main(sys.argv[1])
