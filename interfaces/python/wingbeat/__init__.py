"""Electromechanical model of flapping-wing micro air vehicles.

    import wingbeat as wb
    vehicle = wb.read("friction2022")                   # shipped; or a file, or wb.Vehicle({...})
    result = vehicle.solve(voltage="3 V")               # result.status, result.lift_mean, result.cycle
    result.gradient("lift_mean", ["transmission.crank_radius"])
    vehicle.simulate().time_to_steady
    vehicle.simulation().step_to(0.1)                   # under commanded voltages, for controllers
    vehicle.trim(speed="1 m/s")                         # steady flight of a vehicle with a body; flight_stability()
    vehicle.flight_simulation().step_to(0.1)            # in flight, under controls and wind; wb.gym for learning
    vehicle.linearise().discrete.to_scipy()             # for control design
    vehicle.sweep({"supply.voltage": [2, 3, 4]})        # xarray
    wb.solve({"supply.voltage": [2, 3, 4]}, vehicle=vehicle).lift_mean
    vehicle.equations_of_motion().rates(time, state)    # for SciPy
    wb.fit(vehicle, data, parameters={"friction.radius": (0, "8 mm")}).vehicle
    wb.optimise("optimise-hover").vehicle               # likewise tolerance, endurance, identify_motor
    wb.plot.cycle(result)                               # figures, with matplotlib

Units: a quantity is a number in SI (an angle in radians) or a text with its unit: 0.005 or "5 mm". Results are in SI. A
vehicle that does not flap is a result, never an exception; invalid input raises InputError.
"""

import importlib
from typing import TYPE_CHECKING, Any

from ._core import version as __version__
from ._ensemble import Ensemble, solve_columns
from ._equations import EquationsOfMotion
from ._errors import InputError
from ._fit import fit
from ._flight import BodyState, FlightLoads, FlightSimulation, FlightTotals
from ._linear import ControlModels, LinearModel, linearise
from ._mjcf import export_mjcf
from ._optimise import Front, OwnOptimum, optimise
from ._parts import coefficient_curves, kinematics, motor_curves
from ._quantity import Quantity
from ._result import EnergyBalance, Event, RunResult, StartUp, simulate
from ._sections import Section
from ._simulation import Simulation, SimulationState
from ._solve import solve
from ._studies import Flight, Found, Identification, StudyResult, endurance, identify_motor, tolerance
from ._sweep import open_dataset, sweep
from ._tables import Metric, Parameter, metrics, parameters
from ._trim import FlightStability, Trim, flight_stability, flight_tolerance, trim
from ._vehicle import Vehicle, read, shipped

__all__ = [
    "BodyState",
    "ControlModels",
    "EnergyBalance",
    "Ensemble",
    "EquationsOfMotion",
    "Event",
    "Flight",
    "FlightLoads",
    "FlightSimulation",
    "FlightStability",
    "FlightTotals",
    "Found",
    "Front",
    "Identification",
    "InputError",
    "LinearModel",
    "Metric",
    "OwnOptimum",
    "Parameter",
    "Quantity",
    "RunResult",
    "Section",
    "Simulation",
    "SimulationState",
    "StartUp",
    "StudyResult",
    "Trim",
    "Vehicle",
    "__version__",
    "coefficient_curves",
    "endurance",
    "export_mjcf",
    "fit",
    "flight_stability",
    "flight_tolerance",
    "identify_motor",
    "kinematics",
    "linearise",
    "metrics",
    "motor_curves",
    "open_dataset",
    "optimise",
    "parameters",
    "read",
    "shipped",
    "simulate",
    "solve",
    "solve_columns",
    "sweep",
    "tolerance",
    "trim",
]

if TYPE_CHECKING:
    from . import gym as gym
    from . import plot as plot
    from ._accessor import SweepData as SweepData
else:

    def __getattr__(name: str) -> Any:
        """SweepData, which needs xarray, `wingbeat.plot`, which needs matplotlib, and `wingbeat.gym`, where they are
        first asked for."""
        if name == "SweepData":
            from ._accessor import SweepData

            return SweepData
        if name in ("gym", "plot"):
            return importlib.import_module(f".{name}", __name__)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
