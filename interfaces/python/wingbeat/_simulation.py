"""A vehicle in time, step by step: for controllers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import array, number, numbers_of, refused, text, wrong_type
from ._operations import operation
from ._quantity import Quantity
from ._result import Event, _waveform
from ._tables import waveforms
from ._vehicle import Vehicle, vehicle_of

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray


class SimulationState(NamedTuple):
    """All states and the commanded voltage: the result of `Simulation.save`, for `restore`.

    You can compare, copy and pickle it; with a commanding function, if that can be pickled.

    Examples
    --------
    >>> flight = wb.read("friction2022").simulation()
    >>> events = flight.step("10 ms")
    >>> flight.save().time
    0.01
    """

    numbers: tuple[float, ...]  #: everything that moves, SI
    voltage: Any  #: as `Simulation.voltage`

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self.numbers[10]


@operation
class Simulation:
    """A vehicle in time, stepped from event to event: `vehicle.simulation()`.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle, at rest at time 0 unless another state is given.
    voltage : float, str, function or pair of arrays, optional
        The commanded voltage [V]: see the attribute `voltage`. Without it the supply drives the motor.
    condition : str, default 'air'
        "air", "vacuum" or "wingless".
    tolerance : float, default 1e-08
        Largest relative error of an integration step, 1e-12 to 1e-2.
    angle : float or str, default 0.0
        Crank angle at the start, or stroke angle of a direct drive [rad].
    speed : float or str, default 0.0
        Crank speed at the start, or flapping velocity of a direct drive [rad/s].
    current : float or str, default 0.0
        Current at the start [A].
    pitch_angle : float or str, default 0.0
        Pitch angle of wings on hinges at the start [rad].
    pitch_velocity : float or str, default 0.0
        Pitch velocity of wings on hinges at the start [rad/s].

    Raises
    ------
    InputError
        For invalid options.

    Notes
    -----
    Sticking, jamming, stops of hinges and the switching of a pwm supply are included. The motor is at ambient
    temperature. Use a simulation in one thread at a time; a commanding function must not step it. `copy.copy` makes an
    independent one; you can pickle it.

    Examples
    --------
    >>> flight = wb.Simulation(wb.read("friction2022"), voltage="3 V")
    >>> events = flight.step_to("0.2 s")
    >>> len(events) > 2, flight.stands
    (True, False)
    >>> flight.voltage = "2.5 V"
    >>> flight.step(1, until="revolution")[-1].kind
    'revolution'
    """

    #: Names of the numbers in `state`: "crank_angle" and "crank_speed" (of a direct drive "stroke_angle" and
    #: "flapping_velocity"); with an armature inductance "current"; of wings on hinges "pitch_angle", "pitch_velocity".
    states: tuple[str, ...]
    #: The vehicle.
    vehicle: Vehicle

    def __init__(
        self,
        vehicle: Vehicle,
        *,
        voltage: Any = None,
        condition: str = "air",
        tolerance: float = 1e-8,
        angle: float | str = 0.0,
        speed: float | str = 0.0,
        current: float | str = 0.0,
        pitch_angle: float | str = 0.0,
        pitch_velocity: float | str = 0.0,
    ) -> None:
        self.vehicle = vehicle_of(vehicle)
        state = numbers_of(
            angle=(angle, "rad"),
            speed=(speed, "rad/s"),
            current=(current, "A"),
            pitch_angle=(pitch_angle, "rad"),
            pitch_velocity=(pitch_velocity, "rad/s"),
        )
        self._start: tuple[Any, ...] = (text("condition", condition), number("tolerance", tolerance, "1"), *state)
        self._simulation = _core.Simulation(vehicle._design, *self._start)
        self.states = tuple(self._simulation.state_names())
        self._voltage: Any = None
        if voltage is not None:
            self.voltage = voltage

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self._simulation.time()

    @property
    def state(self) -> npt.NDArray[np.float64]:
        """A number for each of `states`, SI; the crank angle is not wrapped."""
        return self._simulation.state()

    @property
    def now(self) -> dict[str, Quantity | None]:
        """All present quantities, by the names of `RunResult.cycle`; None if absent."""
        return {
            row.name: None if value != value else Quantity(value, row.unit, row.long_name)
            for row, value in zip(waveforms.values(), self._simulation.acting())
        }

    @property
    def stands(self) -> bool:
        """Friction holds the crank, or the shaft of a direct drive."""
        return self._simulation.stands()

    @property
    def ended(self) -> bool:
        """The mechanism has jammed, and time stops."""
        return self._simulation.ended()

    @property
    def voltage(self) -> Any:
        """The voltage that replaces the supply [V], through the same resistance; None: the supply drives the motor.

        A number or a text with a unit holds until you set another voltage. A function of time [s] is called at any time
        within a step and should be smooth there. A pair of arrays, times [s] and voltages [V], is interpolated
        linearly, with constant values beyond its ends; two samples at one time are a jump.
        """
        return self._voltage

    @voltage.setter
    def voltage(self, voltage: float | str | Callable[[float], float] | tuple[Any, Any] | None) -> None:
        if isinstance(voltage, (tuple, list)) and len(voltage) == 2:
            times, volts = (array("voltage", samples, unit) for samples, unit in zip(voltage, ("s", "V")))
            if times.ndim != 1 or volts.ndim != 1:
                raise refused("voltage", "expected an array of times and one of voltages")
            self._simulation.command_samples(times.tolist(), volts.tolist())
            self._voltage = tuple(times.tolist()), tuple(volts.tolist())
        elif voltage is None:
            self._simulation.command(None)
            self._voltage = None
        elif callable(voltage):
            self._simulation.command(_asked(voltage))
            self._voltage = voltage
        else:
            held = number("voltage", voltage, "V")
            self._simulation.command(held)
            self._voltage = held

    def step_to(self, time: float | str, *, until: str | None = None) -> list[Event]:
        """Steps to a time [s] and returns the events on the way.

        Parameters
        ----------
        time : float or str
            Time to step to [s]; not in the past.
        until : str, optional
            Stop after the first event of this kind: "revolution" (the crank angle passes a multiple of 2 pi forwards),
            "force-sign-change" (of the rod), "standstill", "breakaway", "supply-switch", "stop-impact", "jam".

        Returns
        -------
        list of Event
            The events on the way.

        Raises
        ------
        InputError
            For a time in the past, and for an unknown kind of event.

        Notes
        -----
        The step ends early if the mechanism jams. Other Python threads run during the call. After an exception in a
        commanding function, or Ctrl-C, the simulation has its state from before the call.

        Examples
        --------
        >>> flight = wb.read("friction2022").simulation()
        >>> [event.kind for event in flight.step_to("0.2 s", until="revolution")][-1]
        'revolution'
        """
        end = number("time", time, "s")
        kind = None if until is None else text("until", until)
        return [Event(*event) for event in self._simulation.step_to(end, kind)]

    def step(self, duration: float | str, *, until: str | None = None) -> list[Event]:
        """Steps for a time [s] and returns the events on the way, like `step_to`.

        Parameters
        ----------
        duration : float or str
            Time to step [s]; not negative.
        until : str, optional
            Stop after the first event of this kind; `step_to` lists them.

        Returns
        -------
        list of Event
            The events on the way.

        Raises
        ------
        InputError
            For a negative duration, and for an unknown kind of event.

        Examples
        --------
        >>> flight = wb.read("friction2022").simulation()
        >>> events = flight.step("5 ms") + flight.step(0.005)
        >>> flight.time
        0.01
        """
        span = number("duration", duration, "s")
        if span < 0.0:
            raise refused("duration", f"must be >= 0 s, got {duration}")
        return self.step_to(self.time + span, until=until)

    def record(self, times: Any) -> xarray.Dataset:
        """Steps to each of these times and returns all quantities over time.

        Parameters
        ----------
        times : array_like, shape (n,)
            Times [s], SI numbers or texts with a unit; they must not decrease.

        Returns
        -------
        xarray.Dataset
            The variables of `RunResult.cycle` over `time`, with units and long names, NaN after a jam; over the
            dimension `event`: `event`, `event_time` [s] and `event_crank_angle` [rad].

        Raises
        ------
        InputError
            For times in the past, or decreasing times.

        Examples
        --------
        >>> record = wb.read("friction2022").simulation().record(np.linspace(0, 0.1, 11))
        >>> record.lift.sizes["time"], record.lift.attrs["units"]
        (11, 'N')
        """
        columns, events = self._simulation.record(array("times", times, "s").ravel().tolist())
        made = _waveform(columns)
        made["time"].attrs["long_name"] = "time since the start"
        time, angle, kind = zip(*events) if events else ((), (), ())
        return made.assign(
            event=("event", np.array(kind, dtype=str)),
            event_time=("event", np.array(time, dtype=float), {"units": "s", "long_name": "time of the event"}),
            event_crank_angle=("event", np.array(angle, dtype=float), {"units": "rad", "long_name": "crank angle then"}),
        )

    def save(self) -> SimulationState:
        """Its state. The same steps from it are bit-identical, in this and other simulations of the vehicle.

        Returns
        -------
        SimulationState
            The state for `restore`; you can pickle it.

        Examples
        --------
        >>> flight = wb.read("friction2022").simulation()
        >>> kept = flight.save()
        >>> events = flight.step("10 ms")
        >>> flight.restore(kept)
        >>> flight.time
        0.0
        """
        return SimulationState(self._simulation.save(), self._voltage)

    def restore(self, state: SimulationState) -> None:
        """Returns to a saved state.

        Parameters
        ----------
        state : SimulationState
            The result of `save`.

        Raises
        ------
        InputError
            For a state of another kind of vehicle.
        TypeError
            For an argument that is not a state.

        Examples
        --------
        >>> flight = wb.read("friction2022").simulation()
        >>> kept = flight.save()
        >>> events = flight.step("10 ms")
        >>> flight.restore(kept)
        >>> flight.time
        0.0
        """
        if not isinstance(state, SimulationState):
            raise wrong_type("state", "a wingbeat.SimulationState", state)
        self._simulation.restore(array("state", state.numbers).ravel().tolist())
        self.voltage = state.voltage

    def __copy__(self) -> Simulation:
        made = Simulation.__new__(Simulation)
        made.__dict__.update(self.__dict__)
        made._simulation = self._simulation.copy()
        return made

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulation:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return _restored, (self.vehicle, self._start, self.save())

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={value:.6g}" for name, value in zip(self.states, self.state))
        return f"<wingbeat.Simulation of {self.vehicle.name!r} at {self.time:.6g} s: {shown}>"


def _asked(voltage: Callable[[float], Any]) -> Callable[[float], float]:
    """A commanding function, whose result is looked at."""

    def command(time: float) -> float:
        volts = voltage(time)
        if isinstance(volts, float) and math.isfinite(volts):
            return volts
        return number("voltage, what the function returns", volts, "V")

    return command


def _restored(vehicle: Vehicle, start: tuple[Any, ...], state: SimulationState) -> Simulation:
    names = ("condition", "tolerance", "angle", "speed", "current", "pitch_angle", "pitch_velocity")
    made = Simulation(vehicle, **dict(zip(names, start)))
    made.restore(state)
    return made
