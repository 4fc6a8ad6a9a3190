"""Steady flight of a vehicle, and small motions about it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arguments import callback, flag, number, threads_of
from ._flight import BodyState, body_of, ranges_of, settings_of
from ._linear import LinearModel
from ._operations import operation
from ._quantity import Quantity
from ._progress import shown
from ._studies import StudyResult, file_of, values_of, vehicle_and_study, vehicle_first
from ._vehicle import Vehicle, vehicle_of

if TYPE_CHECKING:
    import numpy.typing as npt

    from ._studies import Study


#: Inputs of linear models of flights beside the controls: the velocity of the air along the axes of the body in trim.
WIND_INPUTS = ("wind_u_m_per_s", "wind_v_m_per_s", "wind_w_m_per_s")


class Trim(StudyResult):
    """A steady flight: the keys of one of the `flights` of `wingbeat trim --json`.

    Examples
    --------
    >>> hover = wb.read("flight-friction2022").trim()
    >>> hover.status, hover.controls["voltage"].unit
    ('trimmed', 'V')
    """

    def __init__(self, found: dict[str, Any], vehicle: Vehicle) -> None:
        super().__init__(found)
        self._start = found
        #: The vehicle.
        self.vehicle = vehicle

    @property
    def controls(self) -> dict[str, Quantity]:
        """The setting of each control that the vehicle has, by name."""
        return settings_of(self._start["controls"], ranges_of(self.vehicle))

    @property
    def body(self) -> BodyState:
        """The body in that flight, at the origin."""
        return body_of(self._start["body"])

    @property
    def drives(self) -> npt.NDArray[np.float64]:
        """The drives at the beginning of their settled cycle, in the form for `FlightSimulation.start`; without a row
        if the vehicle does not flap."""
        return np.array(self._start["drives"])


class FlightStability(StudyResult):
    """Modes of a steady flight and its linear model: the keys of `wingbeat stability --json`.

    Examples
    --------
    >>> found = wb.read("flight-friction2022").flight_stability()
    >>> found.A.shape, found.trim.status
    ((8, 8), 'trimmed')
    """

    def __init__(self, found: dict[str, Any], vehicle: Vehicle) -> None:
        super().__init__(found)
        self._trim = Trim({**found, "values": found["values"]["trim"]}, vehicle)

    @property
    def trim(self) -> Trim:
        """The steady flight."""
        return self._trim

    @property
    def model(self) -> LinearModel:
        """The averaged linear model in continuous time, from controls and wind to all states.

        Raises
        ------
        ValueError
            If the vehicle is not in trim.
        """
        inputs = [*self["controls"], *WIND_INPUTS]
        n, m = len(self["states"]), len(inputs)
        both = np.hstack([self.B, self.W])
        matrices = {"A": self["A"], "B": both.tolist(), "C": np.eye(n).tolist(), "D": np.zeros((n, m)).tolist()}
        states = [{"name": name} for name in self["states"]]
        return LinearModel({**matrices, "states": states}, inputs, list(self["states"]), None)

    @property
    def A(self) -> npt.NDArray[np.float64]:
        """Of the averaged linear model: states by states."""
        return self._matrix("A")

    @property
    def B(self) -> npt.NDArray[np.float64]:
        """Of the averaged linear model: states by controls."""
        return self._matrix("B")

    @property
    def W(self) -> npt.NDArray[np.float64]:
        """Of the averaged linear model: states by the velocity of the air along the axes of the body [m/s]."""
        return self._matrix("W")

    def _matrix(self, name: str) -> npt.NDArray[np.float64]:
        if not self["A"]:
            raise ValueError(f"no linear model: {self['trim']['status_detail']}")
        return np.array(self[name], dtype=np.float64).reshape(len(self["states"]), -1)

    @property
    def averaged(self) -> npt.NDArray[np.complex128]:
        """The exponent of each of `modes` by the averaged model [1/s], NaN if there is none; of a pair that with
        positive imaginary part."""
        return self._eigenvalues("averaged")

    @property
    def floquet(self) -> npt.NDArray[np.complex128]:
        """The exponent of each of `modes` by Floquet theory [1/s]; NaN if there is none."""
        return self._eigenvalues("floquet")

    def _eigenvalues(self, kind: str) -> npt.NDArray[np.complex128]:
        parts = [[mode[f"{kind}_real_per_s"], mode[f"{kind}_imaginary_per_s"]] for mode in self["modes"]]
        pairs = np.array(parts, dtype=np.float64).reshape(-1, 2)
        return np.array(pairs[:, 0] + 1j * pairs[:, 1], dtype=np.complex128)

    def to_control(self) -> Any:
        """The averaged model as control.StateSpace of the package `control`, with names.

        Returns
        -------
        control.StateSpace
            From the deviations of the controls and the wind to those of all states, SI.

        Raises
        ------
        ImportError
            If `control` is not installed.
        ValueError
            If the vehicle is not in trim.

        Examples
        --------
        >>> found = wb.read("flight-friction2022").flight_stability()
        >>> found.to_control().state_labels  # doctest: +SKIP
        ['u_m_per_s', 'v_m_per_s', 'w_m_per_s', 'p_rad_per_s', 'q_rad_per_s', 'r_rad_per_s', 'roll_rad', 'pitch_rad']
        """
        return self.model.to_control()

    def to_scipy(self) -> Any:
        """The averaged model as scipy.signal.StateSpace.

        Returns
        -------
        scipy.signal.StateSpace
            From the deviations of the controls and the wind to those of all states, SI.

        Raises
        ------
        ImportError
            If SciPy is not installed.
        ValueError
            If the vehicle is not in trim.

        Examples
        --------
        >>> wb.read("flight-friction2022").flight_stability().to_scipy().A.shape
        (8, 8)
        """
        return self.model.to_scipy()


def _condition(speed: float | str, climb: float | str, turn_rate: float | str) -> tuple[float, float, float]:
    return number("speed", speed, "m/s"), number("climb", climb, "m/s"), number("turn_rate", turn_rate, "rad/s")


@operation
def trim(
    vehicle: Vehicle, *, speed: float | str = 0.0, climb: float | str = 0.0, turn_rate: float | str = 0.0
) -> Trim:
    """Controls and attitude of steady flight: `wingbeat trim`.

    Parameters
    ----------
    vehicle : Vehicle
        A vehicle with a body.
    speed : float or str, default 0.0
        Horizontal speed relative to the air [m/s].
    climb : float or str, default 0.0
        Upward speed [m/s].
    turn_rate : float or str, default 0.0
        Rate of the heading, to the right [rad/s].

    Returns
    -------
    Trim
        The flight; a vehicle that cannot be trimmed is a result with another status.

    Raises
    ------
    InputError
        For a vehicle without a body or with parts that flight does not model.

    Examples
    --------
    >>> hover = wb.trim(wb.read("flight-friction2022"))
    >>> hover.status, hover["power_electrical_w"] > 0
    ('trimmed', True)
    """
    return Trim(_core.trim(vehicle_of(vehicle)._design, *_condition(speed, climb, turn_rate)), vehicle)


@operation
def flight_stability(
    vehicle: Vehicle,
    *,
    speed: float | str = 0.0,
    climb: float | str = 0.0,
    turn_rate: float | str = 0.0,
    sensitivity: bool = False,
) -> FlightStability:
    """Modes of steady flight, averaged and by Floquet theory, and the linear model: `wingbeat stability`.

    Parameters
    ----------
    vehicle : Vehicle
        A vehicle with a body.
    speed : float or str, default 0.0
        Horizontal speed relative to the air [m/s].
    climb : float or str, default 0.0
        Upward speed [m/s].
    turn_rate : float or str, default 0.0
        Rate of the heading, to the right [rad/s].
    sensitivity : bool, default False
        Also compute the sensitivity of the least stable mode to every parameter, which takes most of the time.

    Returns
    -------
    FlightStability
        The modes; none if the vehicle is not in trim.

    Raises
    ------
    InputError
        For a vehicle without a body or with parts that flight does not model.

    Examples
    --------
    >>> found = wb.flight_stability(wb.read("flight-friction2022"))
    >>> found.states[:3], len(found.averaged) == len(found.modes)
    (['u_m_per_s', 'v_m_per_s', 'w_m_per_s'], True)
    """
    found = _core.flight_stability(
        vehicle_of(vehicle)._design, *_condition(speed, climb, turn_rate), flag("sensitivity", sensitivity)
    )
    return FlightStability(found, vehicle)


@operation
@vehicle_first("study")
def flight_tolerance(
    vehicle: Vehicle | Study,
    study: Mapping[str, Any] | None = None,
    *,
    speed: float | str = 0.0,
    values: Mapping[str, Any] | None = None,
    threads: int = 0,
    progress: bool | Callable[[int, int], object] | None = None,
) -> StudyResult:
    """Effect of uncertain parameters on a vehicle's steady flight and its modes: `wingbeat tolerance --flight`.

    Parameters
    ----------
    vehicle : Vehicle, path or dict
        As for `wingbeat.tolerance`; the vehicle has a body.
    study : dict
        With a Vehicle: the tables of a study file, without a vehicle.
    speed : float or str, default 0.0
        Horizontal speed relative to the air [m/s].
    values : dict, optional
        Values that replace those of the vehicle: SI numbers, or texts with a unit.
    threads : int, default 0
        Number of threads at most; 0: one for each core.
    progress : bool or function, optional
        True shows a bar (tqdm if it is installed), a function is called with vehicles done and vehicles.

    Returns
    -------
    StudyResult
        The keys of `wingbeat tolerance --flight --json`.

    Raises
    ------
    InputError
        For an invalid study, and for a vehicle without a body.
    TypeError
        For a Vehicle without a study, and for a Vehicle together with a study file, which names its vehicle.

    Examples
    --------
    >>> spread = {"key": "body.inertia_pitch", "distribution": "normal", "relative_deviation": 0.1}
    >>> study = {"samples": {"count": 16}, "parameter": [spread]}
    >>> found = wb.flight_tolerance(wb.read("flight-friction2022"), study)
    >>> found["flies"]["share"], found["unstable"]["count"]
    (1.0, 16)
    """
    base, tables = vehicle_and_study(vehicle, study)
    forward, overrides = number("speed", speed, "m/s"), values_of(values)
    with file_of(tables, base) as file, shown(callback(progress), 0) as tell:
        return StudyResult(_core.flight_tolerance(file, overrides, forward, threads_of(threads), tell))
