"""A vehicle in flight, step by step: body, drives and wind."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import array, flag, mapping, number, refused, wrong_type
from ._operations import operation
from ._quantity import Quantity
from ._vehicle import Vehicle, vehicle_of

if TYPE_CHECKING:
    import numpy.typing as npt

#: Name and unit of every control, in the order of the compiled half.
CONTROLS: tuple[tuple[str, str], ...] = tuple(_core.flight_controls())
#: Names of the numbers of a drive, SI and rad.
DRIVE_STATES = (
    "angle", "speed", "current", "pitch_angle", "pitch_velocity", "twist_angle", "twist_velocity", "tip",
    "tip_velocity",
)  # fmt: skip
#: m/s2, the standard value.
GRAVITY = 9.80665


class BodyState(NamedTuple):
    """Position, attitude and motion of a body.

    Body axes: x forward, y to the right, z down, from the centre of mass. Earth axes: x north, y east, z down.

    Examples
    --------
    >>> body = wb.BodyState.at(position=[0, 0, -1], euler_angles=["5 deg", 0, 0])
    >>> f"{np.degrees(body.euler_angles[0]):.1f} deg"
    '5.0 deg'
    """

    velocity: npt.NDArray[np.float64]  #: of the centre of mass, in body axes [m/s]
    rates: npt.NDArray[np.float64]  #: roll, pitch and yaw rate p, q, r [rad/s]
    attitude: npt.NDArray[np.float64]  #: unit quaternion (w, x, y, z) from body to earth axes
    position: npt.NDArray[np.float64]  #: in earth axes [m]

    @classmethod
    def at(
        cls, *, position: Any = (0.0, 0.0, 0.0), velocity: Any = (0.0, 0.0, 0.0), rates: Any = (0.0, 0.0, 0.0),
        euler_angles: Any = (0.0, 0.0, 0.0),
    ) -> BodyState:  # fmt: skip
        """A body with its attitude given by Euler angles.

        Parameters
        ----------
        position : array_like, shape (3,), default (0.0, 0.0, 0.0)
            In earth axes [m].
        velocity : array_like, shape (3,), default (0.0, 0.0, 0.0)
            In body axes [m/s].
        rates : array_like, shape (3,), default (0.0, 0.0, 0.0)
            Roll, pitch and yaw rate [rad/s].
        euler_angles : array_like, shape (3,), default (0.0, 0.0, 0.0)
            Roll, pitch and yaw [rad], applied in the order yaw, pitch, roll.

        Returns
        -------
        BodyState
            The body.

        Raises
        ------
        InputError
            For values that are not three finite numbers.

        Examples
        --------
        >>> wb.BodyState.at(velocity=["1 m/s", 0, 0]).velocity.tolist()
        [1.0, 0.0, 0.0]
        """
        attitude = _core.attitude_of(_triple("euler_angles", euler_angles, "rad").tolist())
        return cls(
            _triple("velocity", velocity, "m/s"), _triple("rates", rates, "rad/s"), np.array(attitude),
            _triple("position", position, "m"),
        )  # fmt: skip

    @property
    def euler_angles(self) -> npt.NDArray[np.float64]:
        """Roll, pitch and yaw [rad]."""
        return np.array(_core.euler_angles(list(self.attitude)))

    @property
    def rotation(self) -> npt.NDArray[np.float64]:
        """The matrix that transforms vectors from body to earth axes."""
        turned: npt.NDArray[np.float64] = rotations(np.asarray(self.attitude)[None, :])[0]
        return turned


class FlightLoads(NamedTuple):
    """Loads of the air on wings, body and plates, about the centre of mass, in body axes.

    Examples
    --------
    >>> flight = wb.read("flight-friction2022").flight_simulation()
    >>> flight.loads.force.shape
    (3,)
    """

    force: npt.NDArray[np.float64]  #: [N]
    moment: npt.NDArray[np.float64]  #: [N m]


class FlightTotals(NamedTuple):
    """Integrals over a flight since its start.

    Examples
    --------
    >>> flight = wb.read("flight-friction2022").flight_simulation()
    >>> flight.step_to("20 ms")
    True
    >>> flight.totals.electrical > 0
    True
    """

    impulse: npt.NDArray[np.float64]  #: of the air's force in body axes [N s]
    angular_impulse: npt.NDArray[np.float64]  #: of its moment [N m s]
    electrical: float  #: energy at the motor terminals [J]
    motor: float  #: lost in windings, motor friction and gearboxes [J]
    friction: float  #: lost in the mechanism and in pitch hinges [J]
    wing_air: float  #: that the drives give to the air [J]
    body_air: float  #: that the air does on the body [J]
    residual: float  #: what the formulation of a crank fails to conserve [J]
    stops: float  #: lost in impacts on stops of the pitching [J]


@operation
class FlightSimulation:
    """A vehicle in flight, stepped in time: `vehicle.flight_simulation()`.

    Parameters
    ----------
    vehicle : Vehicle
        A vehicle with a body.
    tolerance : float, default 1e-07
        Largest relative error of an integration step, 1e-12 to 1e-2.
    gravity : float or str, default 9.80665
        Acceleration of free fall [m/s2].
    frozen : bool, default False
        The body keeps its velocity, rates and attitude, as in a wind tunnel.

    Raises
    ------
    InputError
        For a vehicle without a body or with parts that flight does not model, and for invalid options.

    Notes
    -----
    The flight begins upright at the origin with the drives at rest, under the vehicle's stated voltage; `start` begins
    elsewhere, for example in trim. Use a flight in one thread at a time; a wind function must not step it. `copy.copy`
    makes an independent flight, for example to return to a moment.

    Examples
    --------
    >>> vehicle = wb.read("flight-friction2022")
    >>> hover = vehicle.trim()
    >>> flight = wb.FlightSimulation(vehicle)
    >>> flight.start(hover.body, hover.drives)
    >>> flight.command(hover.controls)
    >>> flight.step_to("50 ms")
    True
    >>> bool(abs(flight.body.position[2]) < 0.01)
    True
    """

    #: The vehicle.
    vehicle: Vehicle
    #: The range of each control that the vehicle has, by name [unit of the control].
    ranges: dict[str, tuple[float, float]]

    def __init__(
        self, vehicle: Vehicle, *, tolerance: float = 1e-7, gravity: float | str = 9.80665, frozen: bool = False
    ) -> None:
        self.vehicle = vehicle_of(vehicle)
        self.ranges = ranges_of(self.vehicle)
        self._flight = _core.FlightSimulation(
            vehicle._design,
            number("tolerance", tolerance, "1"),
            number("gravity", gravity, "m/s2"),
            flag("frozen", frozen),
        )
        self._wind: Any = None

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self._flight.time()

    @property
    def body(self) -> BodyState:
        """Position, attitude and motion of the body."""
        return body_of(self._flight.body())

    @property
    def drives(self) -> npt.NDArray[np.float64]:
        """A row for each drive, first the right one: angle [rad], speed [rad/s], current [A], pitch angle [rad], pitch
        velocity [rad/s], twist angle, twist velocity, tip [m] and tip velocity [m/s]; 0 where it has none."""
        return self._flight.drives()

    @property
    def controls(self) -> dict[str, Quantity]:
        """The setting of each control that the vehicle has, by name."""
        return settings_of(self._flight.controls(), self.ranges)

    @property
    def wind(self) -> Any:
        """The wind given to `blow`; None: still air."""
        return self._wind

    @property
    def totals(self) -> FlightTotals:
        """Integrals since the start."""
        sums = self._flight.totals()
        electrical, motor, friction, wing_air, body_air, residual = sums[6:].tolist()
        return FlightTotals(
            sums[0:3], sums[3:6], electrical, motor, friction, wing_air, body_air, residual, self._flight.stops()
        )

    @property
    def loads(self) -> FlightLoads:
        """Loads of the air on the vehicle now."""
        numbers = self._flight.loads()
        return FlightLoads(numbers[:3], numbers[3:])

    @property
    def stored_energy(self) -> float:
        """Energy of drives and body, relative to the height of the origin [J]."""
        return self._flight.stored_energy()

    @property
    def cycle_time(self) -> float:
        """Approximate time of a wingbeat [s]."""
        return self._flight.cycle_time()

    def start(self, body: BodyState | None = None, drives: Any = None) -> None:
        """Starts at time 0 from a state, with totals of zero. Controls and wind are kept.

        Parameters
        ----------
        body : BodyState, optional
            The body; default: at rest, upright, at the origin.
        drives : array_like, shape (drives, 9), optional
            The drives, in the form of the attribute `drives`; default: at rest.

        Raises
        ------
        InputError
            For numbers that are not finite.
        TypeError
            For what is not a body.

        Examples
        --------
        >>> flight = wb.read("flight-friction2022").flight_simulation()
        >>> flight.start(wb.BodyState.at(velocity=["0.5 m/s", 0, 0]))
        >>> flight.time, flight.body.velocity.tolist()
        (0.0, [0.5, 0.0, 0.0])
        """
        rows = np.zeros((0, 9)) if drives is None else array("drives", drives)
        count = len(self._flight.drives())
        if drives is not None and rows.shape != (count, 9):
            raise refused("drives", f"expected an array of {count} by 9, got {rows.shape}")
        self._flight.start(numbers_of_body(BodyState.at() if body is None else body), rows)

    def place(self, body: BodyState) -> None:
        """Moves the body; drives and time are kept.

        Parameters
        ----------
        body : BodyState
            The body.

        Raises
        ------
        TypeError
            For what is not a body.

        Examples
        --------
        >>> flight = wb.read("flight-friction2022").flight_simulation()
        >>> flight.place(wb.BodyState.at(position=[0, 0, "-2 m"]))
        >>> flight.body.position.tolist()
        [0.0, 0.0, -2.0]
        """
        self._flight.place(numbers_of_body(body))

    def command(self, controls: Mapping[str, float | str]) -> None:
        """Sets controls from now on; controls that are not named are kept.

        Parameters
        ----------
        controls : dict
            Settings by the names of the attribute `ranges`: SI numbers, angles in radians, or texts with a unit. They
            may lie beyond the ranges.

        Raises
        ------
        InputError
            For a control that the vehicle does not have, and for a setting that is not finite.

        Examples
        --------
        >>> flight = wb.read("flight-friction2022").flight_simulation()
        >>> flight.command({"voltage": "6.5 V", "mean_stroke_angle": "2 deg"})
        >>> flight.controls["voltage"]
        6.5 V
        """
        settings = list(self._flight.controls())
        for name, value in mapping("controls", controls).items():
            if name not in self.ranges:
                raise refused(name, f"the vehicle has no such control; it has {', '.join(self.ranges)}")
            index, unit = _index_of[name]
            settings[index] = number(name, value, unit)
        self._flight.command(settings)

    def blow(self, wind: Any | Callable[[float, tuple[float, float, float]], Any] | None) -> None:
        """Sets the wind from now on.

        Parameters
        ----------
        wind : array_like or function or None
            Three numbers [m/s] in earth axes, or a function of time [s] and position [m], three numbers, that returns
            them; None: still air. A function is called at any time within a step and should be smooth there.

        Raises
        ------
        InputError
            For a wind that is not three finite numbers.

        Examples
        --------
        >>> flight = wb.read("flight-friction2022").flight_simulation()
        >>> flight.blow(["-1 m/s", 0, 0])
        >>> flight.blow(lambda time, position: (-np.sin(time), 0.0, 0.0))
        >>> flight.blow(None)
        """
        if wind is None:
            self._flight.blow(None)
        elif callable(wind):
            self._flight.blow(_asked(wind))
        else:
            wind = _triple("wind", wind, "m/s")
            self._flight.blow(wind.tolist())
        self._wind = wind

    def step_to(self, time: float | str) -> bool:
        """Steps to a time [s].

        Parameters
        ----------
        time : float or str
            Time to step to [s]; not in the past.

        Returns
        -------
        bool
            False if a mechanism has jammed; time then stops.

        Raises
        ------
        InputError
            For a time in the past.
        RuntimeError
            If the integration fails.

        Notes
        -----
        Other Python threads run during the call. After an exception in a wind function, or Ctrl-C, the flight has its
        state from before the call.

        Examples
        --------
        >>> flight = wb.read("flight-friction2022").flight_simulation()
        >>> flight.step_to("10 ms"), flight.time
        (True, 0.01)
        """
        return self._flight.step_to(number("time", time, "s"))

    def step(self, duration: float | str) -> bool:
        """Steps for a time [s], like `step_to`.

        Parameters
        ----------
        duration : float or str
            Time to step [s]; not negative.

        Returns
        -------
        bool
            False if a mechanism has jammed; time then stops.

        Raises
        ------
        InputError
            For a negative duration.

        Examples
        --------
        >>> flight = wb.read("flight-friction2022").flight_simulation()
        >>> flight.step("5 ms") and flight.step(0.005), flight.time
        (True, 0.01)
        """
        span = number("duration", duration, "s")
        if span < 0.0:
            raise refused("duration", f"must be >= 0 s, got {duration}")
        return self.step_to(self.time + span)

    def __copy__(self) -> FlightSimulation:
        made = FlightSimulation.__new__(FlightSimulation)
        made.__dict__.update(self.__dict__)
        made._flight = self._flight.copy()
        return made

    def __deepcopy__(self, memo: dict[int, Any]) -> FlightSimulation:
        return self.__copy__()

    def __repr__(self) -> str:
        x, y, z = self.body.position
        return f"<wingbeat.FlightSimulation of {self.vehicle.name!r} at {self.time:.6g} s: {x:.4g}, {y:.4g}, {z:.4g} m>"


_index_of = {name: (index, unit) for index, (name, unit) in enumerate(CONTROLS)}


def ranges_of(vehicle: Vehicle) -> dict[str, tuple[float, float]]:
    """The range of each control that a vehicle has."""
    found = _core.flight_vehicle(vehicle._design)["controls"]
    return {CONTROLS[index][0]: (low, high) for index, low, high in found}


def settings_of(settings: Any, names: Any) -> dict[str, Quantity]:
    """The settings of controls with these names, with their units."""
    return {name: Quantity(settings[_index_of[name][0]], _index_of[name][1]) for name in names}


def rotations(attitudes: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The matrices that take body axes to earth axes, of quaternions in rows."""
    w, x, y, z = (attitudes / np.linalg.norm(attitudes, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def body_of(numbers: npt.NDArray[np.float64]) -> BodyState:
    """A body from the numbers of the compiled half."""
    return BodyState(numbers[0:3], numbers[3:6], numbers[6:10], numbers[10:13])


def numbers_of_body(body: BodyState) -> npt.NDArray[np.float64]:
    """The numbers of a body as the compiled half takes them."""
    if not isinstance(body, BodyState):
        raise wrong_type("body", "a wingbeat.BodyState", body)
    return np.concatenate([np.asarray(part, dtype=np.float64).ravel() for part in body])


def _triple(name: str, values: Any, unit: str) -> npt.NDArray[np.float64]:
    found = array(name, values, unit)
    if found.shape != (3,) or not np.isfinite(found).all():
        raise refused(name, f"must be three finite numbers [{unit}], got {values!r}")
    return found


def _asked(wind: Callable[[float, tuple[float, float, float]], Any]) -> Callable[..., list[float]]:
    """A function of the wind, whose result is looked at."""

    def blows(time: float, position: list[float]) -> list[float]:
        x, y, z = position
        found = wind(time, (x, y, z))
        if isinstance(found, tuple) and len(found) == 3:
            if all(isinstance(x, float) and math.isfinite(x) for x in found):
                return list(found)
        return list(_triple("wind, what the function returns", found, "m/s").tolist())

    return blows
