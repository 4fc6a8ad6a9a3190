"""What a Vehicle does: the functions of the package as methods, with the vehicle as their first argument."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ._methods_flight import FlightMethods
from ._operations import method_of, operations

if TYPE_CHECKING:
    from xarray import Dataset

    from ._accessor import SweepData
    from ._arguments import Columns
    from ._ensemble import Ensemble
    from ._equations import EquationsOfMotion
    from ._linear import ControlModels
    from ._result import RunResult, StartUp
    from ._simulation import Simulation
    from ._studies import Flight, Found, StudyResult


class VehicleMethods(FlightMethods):
    """Methods that are functions of the package."""

    __slots__ = ()

    @method_of("solve")
    def solve(
        self,
        *,
        voltage: float | str | None = None,
        frequency: float | str | None = None,
        lift: float | str | None = None,
        lift_to_weight: float | None = None,
        power: float | str | None = None,
        angle_of_attack: float | str | None = None,
        condition: str = "air",
        method: str = "orbit",
        tolerance: float = 1e-6,
        allow_extrapolation: bool = False,
        endurance: bool = False,
    ) -> RunResult:
        """Its steady flapping with all metrics, or the status with the evidence: `wingbeat.solve` of one vehicle.

        Returns
        -------
        RunResult
            The result, whether it flaps or not.

        Examples
        --------
        >>> result = wb.read("friction2022").solve(lift="10 mN")
        >>> f"{result.voltage:.2f} V"
        '3.20 V'
        """
        return operations["solve"](  # type: ignore[no-any-return]
            self,
            voltage=voltage,
            frequency=frequency,
            lift=lift,
            lift_to_weight=lift_to_weight,
            power=power,
            angle_of_attack=angle_of_attack,
            condition=condition,
            method=method,
            tolerance=tolerance,
            allow_extrapolation=allow_extrapolation,
            endurance=endurance,
        )

    @method_of("simulate")
    def simulate(
        self,
        *,
        condition: str = "air",
        tolerance: float = 1e-6,
        max_time: float | str = 0.0,
        crank_angle: float | str = 0.0,
        crank_speed: float | str = 0.0,
        current: float | str = 0.0,
        record_interval: float | str = 0.0,
    ) -> StartUp:
        """Its start-up in time, from rest unless another state is given: `wingbeat.simulate`.

        Examples
        --------
        >>> start = wb.read("friction2022").simulate()
        >>> start.status, start.time_to_steady.unit
        ('flapping', 's')
        """
        return operations["simulate"](  # type: ignore[no-any-return]
            self,
            condition=condition,
            tolerance=tolerance,
            max_time=max_time,
            crank_angle=crank_angle,
            crank_speed=crank_speed,
            current=current,
            record_interval=record_interval,
        )

    @method_of("Simulation")
    def simulation(
        self,
        *,
        voltage: Any = None,
        condition: str = "air",
        tolerance: float = 1e-8,
        angle: float | str = 0.0,
        speed: float | str = 0.0,
        current: float | str = 0.0,
        pitch_angle: float | str = 0.0,
        pitch_velocity: float | str = 0.0,
    ) -> Simulation:
        """A simulation in time, stepped under commanded voltages: `wingbeat.Simulation`.

        Examples
        --------
        >>> flight = wb.read("friction2022").simulation(voltage="3 V")
        >>> events = flight.step_to("50 ms")
        >>> flight.time
        0.05
        """
        return operations["Simulation"](  # type: ignore[no-any-return]
            self,
            voltage=voltage,
            condition=condition,
            tolerance=tolerance,
            angle=angle,
            speed=speed,
            current=current,
            pitch_angle=pitch_angle,
            pitch_velocity=pitch_velocity,
        )

    @method_of("solve_columns")
    def solve_columns(
        self,
        columns: Columns,
        *,
        frequency: float | str | None = None,
        lift: float | str | None = None,
        lift_to_weight: float | None = None,
        power: float | str | None = None,
        allow_extrapolation: bool = False,
        condition: str = "air",
        tolerance: float = 1e-6,
        metrics: Iterable[str] | None = None,
        threads: int = 0,
        progress: bool | Callable[[int, int], object] | None = None,
    ) -> Ensemble:
        """Very many vehicles like it, on all cores: `wingbeat.solve_columns`.

        Examples
        --------
        >>> wb.read("friction2022").solve_columns({"supply.voltage": ["0 V", "3 V"]})
        <2 designs: 1 flapping, 1 stalled>
        """
        return operations["solve_columns"](  # type: ignore[no-any-return]
            columns,
            vehicle=self,
            frequency=frequency,
            lift=lift,
            lift_to_weight=lift_to_weight,
            power=power,
            allow_extrapolation=allow_extrapolation,
            condition=condition,
            tolerance=tolerance,
            metrics=metrics,
            threads=threads,
            progress=progress,
        )

    @method_of("sweep")
    def sweep(
        self,
        axes: Mapping[str, Any],
        *,
        output: str | os.PathLike[str] | None = None,
        frequency: float | str | None = None,
        lift: float | str | None = None,
        lift_to_weight: float | None = None,
        power: float | str | None = None,
        allow_extrapolation: bool = False,
        tolerance: float = 1e-6,
        metrics: Iterable[str] | None = None,
        title: str = "",
        threads: int = 0,
        force: bool = False,
        progress: bool | Callable[[int, int], object] | None = None,
    ) -> SweepData:
        """Its steady flapping for all combinations of values of keys, a dimension for each key: `wingbeat.sweep`.

        Examples
        --------
        >>> data = wb.read("friction2022").sweep({"supply.voltage": [2, 3, 4]})
        >>> data.lift_mean.sel(supply_voltage=3).round(5).item()
        0.00874
        """
        return operations["sweep"](  # type: ignore[no-any-return]
            self,
            axes,
            output=output,
            frequency=frequency,
            lift=lift,
            lift_to_weight=lift_to_weight,
            power=power,
            allow_extrapolation=allow_extrapolation,
            tolerance=tolerance,
            metrics=metrics,
            title=title,
            threads=threads,
            force=force,
            progress=progress,
        )

    @method_of("fit")
    def fit(
        self,
        data: Any,
        *,
        parameters: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None = None,
        deviation: float | str | Mapping[str, Any] | None = None,
        condition: str | None = None,
        springs: bool | None = None,
        loss: str | None = None,
        values: Mapping[str, Any] | None = None,
        profiles: bool = True,
        compare_friction: bool = False,
        threads: int = 0,
    ) -> Found:
        """Its parameters from bench measurements, with their uncertainty: `wingbeat.fit`.

        Examples
        --------
        >>> air = {"voltage_V": [2, 3, 4], "frequency_Hz": [16.0, 22.0, 27.5], "current_mean_mA": [110, 180, 253]}
        >>> vehicle = wb.read("friction2022")
        >>> found = vehicle.fit(air, parameters={"friction.radius": ("0 mm", "8 mm")}, deviation=0.01)
        >>> found["converged"], found.vehicle.friction.radius.unit
        (True, 'm')
        """
        return operations["fit"](  # type: ignore[no-any-return]
            self,
            data,
            parameters=parameters,
            deviation=deviation,
            condition=condition,
            springs=springs,
            loss=loss,
            values=values,
            profiles=profiles,
            compare_friction=compare_friction,
            threads=threads,
        )

    @method_of("tolerance")
    def tolerance(
        self,
        study: Mapping[str, Any],
        *,
        values: Mapping[str, Any] | None = None,
        allow_extrapolation: bool = False,
        threads: int = 0,
        progress: bool | Callable[[int, int], object] | None = None,
    ) -> StudyResult:
        """How uncertain parameters affect its metrics: `wingbeat.tolerance`.

        Examples
        --------
        >>> spread = {"key": "friction.radius", "distribution": "normal", "relative_deviation": 0.05}
        >>> found = wb.read("friction2022").tolerance({"samples": {"count": 64}, "parameter": [spread]})
        >>> found["outputs"]["lift_mean_n"]["median"].__round__(4)
        0.0087
        """
        return operations["tolerance"](  # type: ignore[no-any-return]
            self, study, values=values, allow_extrapolation=allow_extrapolation, threads=threads, progress=progress
        )

    @method_of("optimise")
    def optimise(
        self,
        study: Mapping[str, Any],
        *,
        values: Mapping[str, Any] | None = None,
        allow_extrapolation: bool = False,
        threads: int = 0,
        progress: bool | Callable[[int, int], object] | None = None,
    ) -> Found:
        """The best design within bounds and constraints, or a front: `wingbeat.optimise`.

        Examples
        --------
        >>> study = {
        ...     "objective": {"maximise": "lift_mean_n", "starts": 1, "screen": 32},
        ...     "parameter": [{"key": "supply.voltage", "lower": "2 V", "upper": "3 V"}],
        ... }
        >>> wb.read("friction2022").optimise(study).vehicle.supply.voltage
        3.0 V
        """
        return operations["optimise"](  # type: ignore[no-any-return]
            self, study, values=values, allow_extrapolation=allow_extrapolation, threads=threads, progress=progress
        )

    @method_of("endurance")
    def endurance(self, *, hover: bool = False, allow_extrapolation: bool = False) -> Flight:
        """How long it hovers and flaps on its battery: `wingbeat.endurance`.

        Examples
        --------
        >>> flight = wb.read("friction2022-battery").endurance()
        >>> f"{flight['endurance_s'] / 60:.1f} min"
        '8.2 min'
        """
        return operations["endurance"](  # type: ignore[no-any-return]
            self, hover=hover, allow_extrapolation=allow_extrapolation
        )

    @method_of("linearise")
    def linearise(
        self,
        *,
        condition: str = "air",
        frequency: float | str | None = None,
        lift: float | str | None = None,
        allow_extrapolation: bool = False,
        cycles: int = 0,
        hinge_offset: float | str = 0.0,
        maps: bool = True,
    ) -> ControlModels:
        """Linear models for control design: `wingbeat.linearise`.

        Examples
        --------
        >>> wb.read("friction2022").linearise(maps=False).discrete.states
        ['crank_speed', 'current']
        """
        return operations["linearise"](  # type: ignore[no-any-return]
            self,
            condition=condition,
            frequency=frequency,
            lift=lift,
            allow_extrapolation=allow_extrapolation,
            cycles=cycles,
            hinge_offset=hinge_offset,
            maps=maps,
        )

    @method_of("motor_curves")
    def motor_curves(self, *, voltage: float | str | None = None, speed: Any = None) -> Dataset:
        """Torque, current, powers and efficiency of its motors over speed: `wingbeat.motor_curves`.

        Examples
        --------
        >>> curves = wb.read("friction2022").motor_curves(speed=["0 rad/s", "600 rpm"])
        >>> curves.torque.attrs["units"], curves.speed.round(2).values
        ('N m', array([ 0.  , 62.83]))
        """
        return operations["motor_curves"](self, voltage=voltage, speed=speed)  # type: ignore[no-any-return]

    @method_of("coefficient_curves")
    def coefficient_curves(self, *, angle_of_attack: Any = None) -> Dataset:
        """Force coefficients of its wings over the angle of attack: `wingbeat.coefficient_curves`.

        Examples
        --------
        >>> curves = wb.read("friction2022").coefficient_curves(angle_of_attack=["30 deg", "60 deg"])
        >>> curves.drag.dims
        ('angle_of_attack',)
        """
        return operations["coefficient_curves"](self, angle_of_attack=angle_of_attack)  # type: ignore[no-any-return]

    @method_of("kinematics")
    def kinematics(self, *, crank_angle: Any = None) -> Dataset:
        """Stroke angle and its derivatives over the crank angle: `wingbeat.kinematics`.

        Examples
        --------
        >>> wb.read("friction2022").kinematics(crank_angle=["90 deg"]).stroke_angle.attrs["units"]
        'rad'
        """
        return operations["kinematics"](self, crank_angle=crank_angle)  # type: ignore[no-any-return]

    @method_of("EquationsOfMotion")
    def equations_of_motion(self, *, condition: str = "air") -> EquationsOfMotion:
        """The equations of motion, for integrators of your own: `wingbeat.EquationsOfMotion`.

        Examples
        --------
        >>> wb.read("friction2022").equations_of_motion(condition="vacuum").states
        ('crank_angle', 'crank_speed', 'current')
        """
        return operations["EquationsOfMotion"](self, condition=condition)  # type: ignore[no-any-return]


# Messages about arguments name the class that its users know.
for _name, _method in vars(VehicleMethods).items():
    if not _name.startswith("_"):
        _method.__qualname__ = f"Vehicle.{_name}"
