"""The equations of motion, for integrators of the user's own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _core
from ._arguments import array, number, optional_number, text
from ._operations import operation
from ._vehicle import Vehicle, vehicle_of

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


@operation
class EquationsOfMotion:
    """The equations of motion of a vehicle in time: `scipy.integrate.solve_ivp(equations.rates, ...)`.

    The state is crank angle, not wrapped [rad], crank speed [rad/s] and, with an armature inductance, current [A]; for
    a direct drive stroke angle [rad], flapping velocity [rad/s] and current; for wings on hinges also pitch angle [rad]
    and pitch velocity [rad/s]. `states` has the names. The motor is at ambient temperature.

    Rates are continuous except at standstill, where friction changes its direction, and at jumps of the supply; they
    have kinks where the rod force, the stroke velocity, the pitch velocity or the torque of a lossy gearbox changes
    sign. Standstill and stops of hinges are not included: the rates are those of a crank that begins to turn forwards,
    and of wings that move beyond their stops. `wingbeat.Simulation` includes both.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    condition : str, default 'air'
        "air", "vacuum" or "wingless".

    Raises
    ------
    InputError
        For an unknown condition.

    Examples
    --------
    >>> equations = wb.read("friction2022").equations_of_motion()
    >>> equations.states
    ('crank_angle', 'crank_speed', 'current')
    """

    #: Names of the states.
    states: tuple[str, ...]

    def __init__(self, vehicle: Vehicle, *, condition: str = "air") -> None:
        self._made_of = (vehicle_of(vehicle), text("condition", condition))
        self._equations = _core.EquationsOfMotion(vehicle._design, condition)
        self.states = tuple(self._equations.state_names())

    def rates(self, time: float, state: Any, voltage: float | str | None = None) -> npt.NDArray[np.float64]:
        """Derivatives of the state [SI per s] at a time [s].

        Parameters
        ----------
        time : float
            Time since the start [s].
        state : array_like, shape (k,) or (k, n)
            A number for each of the k `states` [SI], or a column for each of n states.
        voltage : float or str, optional
            Voltage that replaces the supply [V], through the same resistance.

        Returns
        -------
        numpy.ndarray, shape of `state`
            Derivatives of the state by time [SI per s].

        Raises
        ------
        InputError
            For numbers that are not finite.

        Examples
        --------
        >>> equations = wb.read("friction2022").equations_of_motion()
        >>> equations.rates(0, [0, 100, 0])[0]
        100.0
        """
        return self._equations.rates(
            number("time", time, "s"), array("state", state), optional_number("voltage", voltage, "V")
        )

    def __repr__(self) -> str:
        vehicle, condition = self._made_of
        return f"<wingbeat.EquationsOfMotion of {vehicle.name!r} in {condition}: {', '.join(self.states)}>"

    def __reduce__(self) -> tuple[Any, tuple[Vehicle, str]]:
        return _restored, self._made_of


def _restored(vehicle: Vehicle, condition: str) -> EquationsOfMotion:
    return EquationsOfMotion(vehicle, condition=condition)
