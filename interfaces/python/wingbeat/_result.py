"""One vehicle: what its steady flapping is like, and its start-up in time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np

from . import _core
from ._arguments import HELD, names, number, numbers_of, refused, text
from ._metrics import WithMetrics
from ._operations import operation
from ._quantity import Quantity
from ._tables import metric_called, metric_rows, waveforms
from ._vehicle import Vehicle, vehicle_of

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray

#: Instants of `RunResult.cycle`, both ends included, as `wingbeat run --waveforms` writes them.
CYCLE_POINTS = 361


class Event(NamedTuple):
    """An event in time.

    Examples
    --------
    >>> start = wb.read("friction2022").simulate()
    >>> start.events[0].kind
    'force-sign-change'
    """

    time: float  #: [s]
    crank_angle: float  #: not wrapped; of a direct drive the stroke angle [rad]
    kind: str  #: "revolution", "standstill", "breakaway", "jam", "force-sign-change", "supply-switch", "stop-impact"


class EnergyBalance(NamedTuple):
    """Mean powers of a cycle [W]: the electrical input and its shares.

    Examples
    --------
    >>> balance = wb.read("friction2022").solve(tolerance=1e-9).energy_balance
    >>> abs(balance.error) < 1e-6
    True
    """

    electrical: float  #: the input [W]
    copper: float  #: heat of the winding [W]
    viscous: float  #: viscous loss of the motor [W]
    motor_friction: float  #: loss by the motor's own friction [W]
    gear: float  #: loss of the gearbox [W]
    friction: float  #: loss by friction of the mechanism [W]
    hinge: float  #: loss in the hinges of the wings [W]
    aerodynamic: float  #: to the air [W]
    residual: float  #: what the transmission's formulation fails to conserve; 0 for virtual-work
    imbalance: float  #: the input minus all of these: the error of the solution
    electronics: float = 0.0  #: loss of the electronics, of a piezo with its dielectric's [W]

    @property
    def error(self) -> float:
        """The imbalance as a part of the input [1]."""
        return self.imbalance / self.electrical


class RunResult(WithMetrics):
    """The steady flapping of a vehicle from rest. A vehicle that does not flap is a result like any other.

    Metrics are attributes: `result.lift_mean`, None if absent (no flapping, no mass given).

    Examples
    --------
    >>> result = wb.read("friction2022").solve(voltage="3 V")
    >>> result.status, f"{1e3 * result.lift_mean:.2f} mN"
    ('flapping', '8.74 mN')
    >>> result.cycle.lift.sizes["time"]
    361
    """

    #: "flapping", "stalled", "locked", "jammed", "undecided", or "unreached": it flaps, but not as asked for.
    status: str
    #: One sentence: what shows the status.
    evidence: str
    #: False where no steady state was shown within the solver's limits.
    settled: bool
    #: "inside", or the limits of the model that the cycle exceeds; "" unless flapping.
    domain: str
    #: The same in a sentence with numbers; None where no limit is exceeded.
    domain_detail: str | None
    #: What else the program warns of, a sentence each.
    warnings: list[str]
    #: The vehicle as computed: with the voltage or duty that was found.
    vehicle: Vehicle

    def __init__(self, found: dict[str, Any], vehicle: Vehicle, options: dict[str, Any]) -> None:
        self.status = found["status"]
        self.evidence = found["evidence"]
        self.settled = found["settled"]
        self.domain = found["domain"] if self.status == "flapping" else ""
        self.domain_detail = found["domain_detail"]
        self.warnings = found["warnings"]
        self.vehicle = vehicle
        self._metrics = found["metrics"]
        self._options = options
        self._cycle: xarray.Dataset | None = None

    @property
    def energy_balance(self) -> EnergyBalance | None:
        """Where the electrical power goes; None if the vehicle does not flap."""
        if self.power_electrical is None:
            return None
        return EnergyBalance(**_core.energy_balance(self._metrics))

    @property
    def cycle(self) -> xarray.Dataset:
        """One flapping cycle, over time [s], with units and long names; computed at the first access.

        Raises
        ------
        ValueError
            If the vehicle does not flap.
        """
        if self._cycle is None:
            if self.status != "flapping":
                raise ValueError(f"there is no cycle: {self.evidence}")
            options: dict[str, Any] = {**self._options, **dict.fromkeys(HELD), "angle_of_attack": None}
            options |= {"points": CYCLE_POINTS, "endurance": False}
            self._cycle = _waveform(_core.run(self.vehicle._design, **options)["cycle"])
        return self._cycle

    @overload
    def gradient(self, metric: str, keys: str) -> float: ...
    @overload
    def gradient(self, metric: str, keys: list[str] | tuple[str, ...]) -> npt.NDArray[np.float64]: ...
    def gradient(self, metric: str, keys: str | list[str] | tuple[str, ...]) -> float | npt.NDArray[np.float64]:
        """Exact derivatives of a metric by numeric keys of the vehicle, SI per SI, in the order of `keys`.

        The voltage is held, or the frequency or lift that you solved for. NaN if the vehicle does not flap, and for
        metrics without derivatives (floquet_multiplier_max).

        Parameters
        ----------
        metric : str
            The name of a metric.
        keys : str or list of str
            A key, or a list of keys.

        Returns
        -------
        float or numpy.ndarray, shape (keys,)
            A number for a key, an array for a list of keys [unit of the metric per unit of the key].

        Raises
        ------
        InputError
            For an unknown key or metric, and for a key without a value in the vehicle.

        Examples
        --------
        >>> result = wb.read("friction2022").solve(tolerance=1e-9)
        >>> f"{result.gradient('frequency', 'supply.voltage'):.3f} Hz/V"
        '5.669 Hz/V'
        """
        index = metric_called(text("metric", metric))
        options = self._options
        found = _core.gradient(
            self.vehicle._design,
            [text("keys", keys)] if isinstance(keys, str) else names("keys", keys),
            condition=options["condition"],
            tolerance=options["tolerance"],
            held=next((name for name in HELD if options[name] is not None), ""),
            held_value=next((options[name] for name in HELD if options[name] is not None), 0.0),
            allow_extrapolation=options["allow_extrapolation"],
            endurance=metric_rows[index].name in ("hover", "endurance"),
        )
        slopes: npt.NDArray[np.float64] = found["gradients"][:, index].copy()
        return float(slopes[0]) if isinstance(keys, str) else slopes

    def __repr__(self) -> str:
        lines = [f"{self.status}: {self.evidence}"]
        if self.domain_detail:
            lines.append(f"outside the model's domain: {self.domain_detail}")
        lines += [f"warning: {warning}" for warning in self.warnings]
        for name, value in self.metrics.items():
            if value is not None:
                lines.append(f"  {name:<28}{value:>14.6g} {'' if value.unit == '1' else value.unit}".rstrip())
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        from html import escape

        rows = "".join(
            f"<tr><td style='text-align:left'>{escape(value.long_name)}</td><td><code>{name}</code></td>"
            f"<td>{value:.6g}</td><td>{'' if value.unit == '1' else escape(value.unit)}</td></tr>"
            for name, value in self.metrics.items()
            if value is not None
        )
        drawing = self.vehicle.drawing(self.stroke_amplitude or np.radians(60))
        shown = f"<div style='max-width: 28em'>{drawing}</div>" if drawing else ""
        notes = [f"outside the model's domain: {self.domain_detail}"] if self.domain_detail else []
        notes += [f"warning: {warning}" for warning in self.warnings]
        remarks = "".join(f"<p>{escape(remark)}</p>" for remark in notes)
        return f"<p><b>{escape(self.status)}</b>: {escape(self.evidence)}</p>{remarks}{shown}<table>{rows}</table>"


def _waveform(columns: Sequence[Any]) -> xarray.Dataset:
    import xarray

    named = {
        row.name: ("time", column, {"units": row.unit, "long_name": row.long_name})
        for row, column in zip(waveforms.values(), columns)
    }
    return xarray.Dataset(named).set_coords(["time", "crank_angle"])


class StartUp(WithMetrics):
    """A start-up in time. Metrics of the final cycle are attributes, None if absent.

    Examples
    --------
    >>> start = wb.read("friction2022").simulate()
    >>> start.status, start.samples.crank_speed.units
    ('flapping', 'rad/s')
    """

    status: str  #: "flapping", "stalled", "locked", "jammed" or "undecided"
    evidence: str  #: one sentence: what shows the status
    settled: bool  #: False where time, cycles or steps ran out first
    end_time: Quantity  #: time simulated [s]
    time_to_steady: Quantity  #: until every cycle's frequency is within 1 % of the last one's, or until rest [s]
    inrush_current: Quantity  #: highest current of the whole start-up [A]
    inrush_current_time: Quantity  #: when it flows [s]
    cycles: int  #: revolutions of the crank
    events: list[Event]  #: what happened on the way

    def __init__(self, found: dict[str, Any]) -> None:
        self.status = found["status"]
        self.evidence = found["evidence"]
        self.settled = found["settled"]
        self.cycles = found["cycles"]
        self.events = [Event(*event) for event in found["events"]]
        self.end_time = Quantity(found["end_time"], "s", "time simulated")
        self.time_to_steady = Quantity(found["time_to_steady"], "s", "time to steady flapping, or to rest")
        self.inrush_current = Quantity(found["inrush_current"], "A", "highest current of the start-up")
        self.inrush_current_time = Quantity(found["inrush_current_time"], "s", "time of the highest current")
        self._metrics = found["metrics"]
        self._samples = found["samples"]

    @property
    def samples(self) -> xarray.Dataset:
        """Crank angle [rad], crank speed [rad/s] and current [A] over time [s]."""
        import xarray

        made = {
            name: ("time", column, {"units": waveforms[name].unit, "long_name": waveforms[name].long_name})
            for name, column in zip(("time", "crank_angle", "crank_speed", "current"), self._samples)
        }
        made["time"][2]["long_name"] = "time since switching on"
        return xarray.Dataset(made).set_coords("time")

    def __repr__(self) -> str:
        return f"{self.status} after {self.time_to_steady!r}: {self.evidence}"


@operation
def simulate(
    vehicle: Vehicle,
    *,
    condition: str = "air",
    tolerance: float = 1e-6,
    max_time: float | str = 0.0,
    crank_angle: float | str = 0.0,
    crank_speed: float | str = 0.0,
    current: float | str = 0.0,
    record_interval: float | str = 0.0,
) -> StartUp:
    """The start-up of a vehicle in time, from rest unless another state is given.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    condition : str, default 'air'
        "air", "vacuum" or "wingless".
    tolerance : float, default 1e-06
        Requested relative accuracy of the metrics of steady flapping, 1e-11 to 1e-2.
    max_time : float or str, default 0.0
        Time limit of the simulation [s]; 0: chosen from the time scales of the vehicle.
    crank_angle : float or str, default 0.0
        Crank angle at the start [rad].
    crank_speed : float or str, default 0.0
        Crank speed at the start [rad/s].
    current : float or str, default 0.0
        Current at the start [A].
    record_interval : float or str, default 0.0
        Time between samples [s]; 0: every step of the integrator.

    Returns
    -------
    StartUp
        The start-up, whether it ends in flapping or not.

    Raises
    ------
    InputError
        For invalid options.

    Examples
    --------
    >>> start = wb.simulate(wb.read("friction2022"), record_interval="1 ms")
    >>> start.settled, start.inrush_current > 0.1
    (True, True)
    """
    for name, value in (("max_time", max_time), ("record_interval", record_interval)):
        if number(name, value, "s") < 0.0:
            raise refused(name, f"must be >= 0 s, got {value}")
    return StartUp(
        _core.simulate(
            vehicle_of(vehicle)._design,
            text("condition", condition),
            number("tolerance", tolerance, "1"),
            *numbers_of(
                max_time=(max_time, "s"),
                crank_angle=(crank_angle, "rad"),
                crank_speed=(crank_speed, "rad/s"),
                current=(current, "A"),
                record_interval=(record_interval, "s"),
            ),
        )
    )
