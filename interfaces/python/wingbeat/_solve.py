"""Steady flapping: of one vehicle, or of a design for each row of columns."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, overload

from . import _core
from ._arguments import HELD, Columns, flag, number, one_of, optional_number, text, wrong_type
from ._ensemble import Ensemble, is_columns, solve_columns
from ._operations import operation
from ._result import RunResult
from ._vehicle import Vehicle


@overload
def solve(
    design: Vehicle,
    /,
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
) -> RunResult: ...
@overload
def solve(
    design: Columns,
    /,
    *,
    vehicle: Vehicle | None = None,
    frequency: float | str | None = None,
    lift: float | str | None = None,
    lift_to_weight: float | None = None,
    power: float | str | None = None,
    condition: str = "air",
    tolerance: float = 1e-6,
    allow_extrapolation: bool = False,
    metrics: Iterable[str] | None = None,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> Ensemble: ...
@operation
def solve(
    design: Vehicle | Columns,
    /,
    *,
    vehicle: Vehicle | None = None,
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
    metrics: Iterable[str] | None = None,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> RunResult | Ensemble:
    """The steady flapping of a vehicle from rest with all metrics, or the status with the evidence.

    Parameters
    ----------
    design : Vehicle or dict
        A Vehicle; or a dict or DataFrame of columns with a design in each row: see `wingbeat.solve_columns`.
    vehicle : Vehicle, optional
        Of columns: the vehicle with all keys that are not columns.
    voltage : float or str, optional
        Of one vehicle: voltage of the supply [V], instead of the vehicle's.
    frequency : float or str, optional
        Flapping frequency [Hz], instead of a voltage: the voltage for it is found. For a direct drive this is the
        frequency of the supply.
    lift : float or str, optional
        Mean lift [N], instead of a voltage: the voltage (with pwm the duty) for it is found.
    lift_to_weight : float, optional
        Lift over weight [1], likewise; 1: hover.
    power : float or str, optional
        Mean electrical power [W], likewise.
    angle_of_attack : float or str, optional
        Of one vehicle: angle of attack at mid-stroke [rad]; the aerodynamics.pitch_coefficient for it is found.
    condition : str, default 'air'
        "air", "vacuum" or "wingless".
    method : str, default 'orbit'
        Of one vehicle: "orbit", or "transient" to simulate from rest.
    tolerance : float, default 1e-06
        Requested relative accuracy of every metric, 1e-12 to 1e-2.
    allow_extrapolation : bool, default False
        A search for a frequency, a lift or a power may leave the model's domain.
    endurance : bool, default False
        Of one vehicle on a battery: also compute how long it hovers and flaps, which takes a whole flight.
    metrics : list of str, optional
        Of columns: names of the metrics to compute; fewer take less time.
    threads : int, default 0
        Of columns: number of threads at most; 0: one for each core.
    progress : bool or function, optional
        Of columns: True shows a bar, a function is called with the designs done and their total.

    Returns
    -------
    RunResult or Ensemble
        A RunResult for a vehicle, whether it flaps or not; an Ensemble for columns.

    Raises
    ------
    InputError
        For options that cannot be used, and for more than one of voltage, frequency, lift, lift_to_weight and power.
    TypeError
        For an argument that is neither a vehicle nor columns, and for an option of the other kind.

    Examples
    --------
    >>> vehicle = wb.read("friction2022")
    >>> result = wb.solve(vehicle, frequency="22 Hz")
    >>> f"{result.frequency:.2f} Hz at {result.vehicle.supply.voltage:.3f} V"
    '22.00 Hz at 3.008 V'
    >>> vehicle.solve(voltage=0).status
    'stalled'
    >>> wb.solve({"supply.voltage": [3, 4]}, vehicle=vehicle).status
    array(['flapping', 'flapping'], dtype='<U9')
    """
    if isinstance(design, Vehicle):
        _refuse_options_of("columns", "a vehicle", vehicle=vehicle, metrics=metrics, threads=threads, progress=progress)
        return _solve(
            design, voltage, frequency, lift, lift_to_weight, power, angle_of_attack, condition, method, tolerance,
            allow_extrapolation, endurance,
        )
    if not is_columns(design):
        raise wrong_type("design", "a wingbeat.Vehicle, or a dict or DataFrame of columns", design)
    other = None if method == "orbit" else method
    _refuse_options_of(
        "a vehicle", "columns", voltage=voltage, angle_of_attack=angle_of_attack, method=other, endurance=endurance
    )
    return solve_columns(
        design,
        vehicle=vehicle,
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


def _refuse_options_of(owner: str, given: str, **options: Any) -> None:
    """Refuses options that are given but have no meaning here."""
    for name, value in options.items():
        if value is not None and value is not False and not (name == "threads" and value == 0):
            hint = "; give the column supply.voltage" if name == "voltage" else ""
            raise TypeError(f"{name}: is an option for {owner}, not for {given}{hint}")


def _solve(
    vehicle: Vehicle,
    voltage: float | str | None,
    frequency: float | str | None,
    lift: float | str | None,
    lift_to_weight: float | None,
    power: float | str | None,
    angle_of_attack: float | str | None,
    condition: str,
    method: str,
    tolerance: float,
    allow_extrapolation: bool,
    endurance: bool,
) -> RunResult:
    one_of(voltage=voltage, frequency=frequency, lift=lift, lift_to_weight=lift_to_weight, power=power)
    options: dict[str, Any] = {
        "condition": text("condition", condition),
        "method": text("method", method),
        "tolerance": number("tolerance", tolerance, "1"),
        "frequency": optional_number("frequency", frequency, HELD["frequency"]),
        "lift": optional_number("lift", lift, HELD["lift"]),
        "lift_to_weight": optional_number("lift_to_weight", lift_to_weight, HELD["lift_to_weight"]),
        "power": optional_number("power", power, HELD["power"]),
        "angle_of_attack": optional_number("angle_of_attack", angle_of_attack, "rad"),
        "allow_extrapolation": flag("allow_extrapolation", allow_extrapolation),
        "points": 0,
        "endurance": flag("endurance", endurance),
    }
    if voltage is not None:
        vehicle = vehicle.replace({"supply.voltage": voltage})
    found = _core.run(vehicle._design, **options)
    if any(options[name] is not None for name in (*HELD, "angle_of_attack")):
        vehicle = type(vehicle)._of(found["design"])
    return RunResult(found, vehicle, options)
