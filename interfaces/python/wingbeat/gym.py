"""Environments for reinforcement learning by the interface of Gymnasium: hover, and tracking of a path.

    import wingbeat.gym
    env = wingbeat.gym.HoverEnv("flight-friction2022", gusts="0.2 m/s")
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
    many = wingbeat.gym.make_vec("track", "flight-x-wing", 64)    # 64 flights, stepped on all cores in one call

Gymnasium is optional. If it is installed, environments are `gymnasium.Env` with its spaces, and
`gymnasium.make("wingbeat.gym:wingbeat/Hover-v0")` and `wingbeat/Track-v0` make them.

Actions: a number from -1 to 1 for each control of the vehicle, in the order of `controls`. 0 is its setting in trim, -1
and 1 are the ends of its range, with linear interpolation.

Observations: 15 numbers and the last action, clipped to -10 and 10, all in body axes (x forward, y right, z down):
vector to the target / 1 m; velocity of the target relative to the body / 2 m/s; the directions down and north; rates /
(10 rad/s). They are instantaneous values, which include the motion of the body within a wingbeat.

Rewards of a step, at most 1, with the distance d to the target, the speed s against it, the tilt of the body, the size
w of the rates and the change c of each action:

    0.5 exp(-d / 0.25 m) + 0.2 exp(-s / (1 m/s)) + 0.2 max(0, cos(tilt)) + 0.1 exp(-w / (10 rad/s)) - 0.05 mean(c^2)

An episode terminates, with a reward of 0 for the last step, more than 1 m from the target, at a tilt of more than 80
deg, or if a mechanism jams. It is truncated after `duration`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ._arguments import refused
from ._gym_base import Box, EnvBase, gymnasium
from ._gym_task import Flights, options_of
from ._gym_vector import FlightVectorEnv, spaces_of
from ._vehicle import Vehicle

__all__ = ["Box", "FlightEnv", "FlightVectorEnv", "HoverEnv", "TrackEnv", "make", "make_vec"]


class FlightEnv(EnvBase):  # type: ignore[misc]
    """One vehicle that flies a task: what `make` returns.

    Examples
    --------
    >>> env = wb.gym.make("hover", disturbance=0)
    >>> observation, info = env.reset(seed=1)
    >>> env.controls[0], observation.shape, info["distance"]
    ('voltage', (19,), 0.0)
    """

    metadata: dict[str, Any] = {"render_modes": [], "render_fps": 100}

    def __init__(self, flights: Flights) -> None:
        self._flights = flights
        self.observation_space, self.action_space = spaces_of(flights)
        #: The vehicle.
        self.vehicle: Vehicle = flights.vehicle
        #: Names of the controls, in the order of actions.
        self.controls: tuple[str, ...] = flights.controls
        self.render_mode = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray[Any, Any], dict[str, Any]]:
        """Starts an episode near the target, the drives in the cycle of hover.

        Parameters
        ----------
        seed : int, optional
            Seed of the random numbers of this and later episodes; default: the sequence continues.
        options : dict, optional
            "disturbance" instead of that of the environment, or "body", a BodyState to start from.

        Returns
        -------
        observation : numpy.ndarray
            The observation, in the observation space.
        info : dict
            Time [s], position and target [m], distance [m], controls [SI], power [W], wind [m/s], and why it ended.

        Raises
        ------
        InputError
            For unknown options.

        Examples
        --------
        >>> env = wb.gym.HoverEnv()
        >>> first, second = (env.reset(seed=3)[0] for _ in range(2))
        >>> bool((first == second).all())
        True
        """
        super().reset(seed=seed)
        self._flights.start([0], [self.np_random], options)
        return self._flights.observe()[0], self._info(0)

    def step(self, action: Any) -> tuple[np.ndarray[Any, Any], float, bool, bool, dict[str, Any]]:
        """Flies one control step under an action.

        Parameters
        ----------
        action : array_like
            A number from -1 to 1 for each control; values beyond are clipped.

        Returns
        -------
        observation : numpy.ndarray
            The observation, in the observation space.
        reward : float
            Of this step, at most 1.
        terminated : bool
            The flight has ended: info["ended"] is "distance", "attitude", "jammed" or "failed".
        truncated : bool
            The time of the episode is over.
        info : dict
            As from `reset`.

        Raises
        ------
        InputError
            For an action of another shape, or that is not finite.

        Examples
        --------
        >>> env = wb.gym.HoverEnv()
        >>> start = env.reset(seed=1)
        >>> observation, reward, terminated, truncated, info = env.step(np.zeros(4))
        >>> terminated, info["time"]
        (False, 0.01)
        """
        given = np.asarray(action)
        rewards, ends, over = self._flights.step(given[None], [self.np_random], np.ones(1, dtype=bool))
        observation, info = self._flights.observe()[0], self._info(ends[0])
        return observation, float(rewards[0]), bool(ends[0] > 0), bool(over[0]), info

    def render(self) -> None:
        """Draws nothing.

        Examples
        --------
        >>> wb.gym.make("hover").render()
        """

    def _info(self, end: int) -> dict[str, Any]:
        return {
            name: values[0].item() if values.ndim == 1 and values.dtype != object else values[0]
            for name, values in self._flights.info([end]).items()
        }


class HoverEnv(FlightEnv):
    """Hover at the origin.

    Parameters
    ----------
    vehicle : Vehicle or str, default 'flight-friction2022'
        A vehicle with a body that hovers, or the name of one.
    rate : float or str, default 100.0
        Rate of control [Hz].
    duration : float or str, default 10.0
        Time after which an episode is truncated [s].
    disturbance : float, default 1.0
        Largest deviation of the start, uniformly distributed: for 1, 0.1 m, 0.3 m/s, 0.2 rad of roll and pitch, 0.5 rad
        of heading and 1 rad/s on each axis.
    wind : array_like, shape (3,), default (0.0, 0.0, 0.0)
        Steady wind in earth axes [m/s].
    gusts : float or str, default 0.0
        Standard deviation of gusts on each axis [m/s], with a correlation time of 0.5 s, constant over a step.
    tolerance : float, default 0.0001
        Largest relative error of an integration step, 1e-12 to 1e-2.
    render_mode : str, optional
        None: nothing is drawn.

    Raises
    ------
    InputError
        For a vehicle that does not hover, and for invalid options.

    Examples
    --------
    >>> env = wb.gym.HoverEnv("flight-x-wing", rate="200 Hz", gusts="0.1 m/s")
    >>> env.action_space.shape
    (4,)
    """

    def __init__(
        self, vehicle: Vehicle | str = "flight-friction2022", *, rate: float | str = 100.0,
        duration: float | str = 10.0, disturbance: float = 1.0, wind: Any = (0.0, 0.0, 0.0), gusts: float | str = 0.0,
        tolerance: float = 1e-4, render_mode: str | None = None,
    ) -> None:  # fmt: skip
        options = options_of(rate, duration, disturbance, wind, gusts, tolerance)
        super().__init__(_flights("hover", vehicle, 1, options, 1, render_mode))


class TrackEnv(FlightEnv):
    """Follow a target on a circle that rises and falls: radius 0.2 to 0.5 m, speed 0.2 to 0.5 m/s, drawn at each start.

    Parameters
    ----------
    vehicle : Vehicle or str, default 'flight-friction2022'
        A vehicle with a body that hovers, or the name of one.
    rate : float or str, default 100.0
        Rate of control [Hz].
    duration : float or str, default 10.0
        Time after which an episode is truncated [s].
    disturbance : float, default 1.0
        Largest deviation of the start, as for HoverEnv.
    wind : array_like, shape (3,), default (0.0, 0.0, 0.0)
        Steady wind in earth axes [m/s].
    gusts : float or str, default 0.0
        Standard deviation of gusts on each axis [m/s], with a correlation time of 0.5 s, constant over a step.
    tolerance : float, default 0.0001
        Largest relative error of an integration step, 1e-12 to 1e-2.
    render_mode : str, optional
        None: nothing is drawn.

    Raises
    ------
    InputError
        For a vehicle that does not hover, and for invalid options.

    Examples
    --------
    >>> env = wb.gym.TrackEnv(duration="5 s")
    >>> observation, info = env.reset(seed=1)
    >>> info["target"].tolist()
    [0.0, 0.0, 0.0]
    """

    def __init__(
        self, vehicle: Vehicle | str = "flight-friction2022", *, rate: float | str = 100.0,
        duration: float | str = 10.0, disturbance: float = 1.0, wind: Any = (0.0, 0.0, 0.0), gusts: float | str = 0.0,
        tolerance: float = 1e-4, render_mode: str | None = None,
    ) -> None:  # fmt: skip
        options = options_of(rate, duration, disturbance, wind, gusts, tolerance)
        super().__init__(_flights("track", vehicle, 1, options, 1, render_mode))


def _flights(task: str, vehicle: Vehicle | str, n: int, options: Any, threads: int, render_mode: Any) -> Flights:
    if render_mode is not None:
        raise refused("render_mode", f"must be None: nothing is drawn, got {render_mode!r}")
    return Flights(task, vehicle, n, options, threads)


def make(
    task: str, vehicle: Vehicle | str = "flight-friction2022", *, rate: float | str = 100.0,
    duration: float | str = 10.0, disturbance: float = 1.0, wind: Any = (0.0, 0.0, 0.0), gusts: float | str = 0.0,
    tolerance: float = 1e-4,
) -> FlightEnv:  # fmt: skip
    """Makes an environment without Gymnasium.

    Parameters
    ----------
    task : str
        "hover" or "track".
    vehicle : Vehicle or str, default 'flight-friction2022'
        A vehicle with a body that hovers, or the name of one.
    rate : float or str, default 100.0
        Rate of control [Hz].
    duration : float or str, default 10.0
        Time after which an episode is truncated [s].
    disturbance : float, default 1.0
        Largest deviation of the start, as for HoverEnv.
    wind : array_like, shape (3,), default (0.0, 0.0, 0.0)
        Steady wind in earth axes [m/s].
    gusts : float or str, default 0.0
        Standard deviation of gusts on each axis [m/s], with a correlation time of 0.5 s, constant over a step.
    tolerance : float, default 0.0001
        Largest relative error of an integration step, 1e-12 to 1e-2.

    Returns
    -------
    FlightEnv
        A HoverEnv or a TrackEnv.

    Raises
    ------
    InputError
        For a vehicle that does not hover, and for invalid options.

    Examples
    --------
    >>> type(wb.gym.make("track")).__name__
    'TrackEnv'
    """
    kinds: dict[str, Any] = {"hover": HoverEnv, "track": TrackEnv}
    if task not in kinds:
        raise refused("task", f'must be "hover" or "track", got {task!r}')
    made: FlightEnv = kinds[task](
        vehicle, rate=rate, duration=duration, disturbance=disturbance, wind=wind, gusts=gusts, tolerance=tolerance
    )
    return made


def make_vec(
    task: str, vehicle: Vehicle | str, n: int, *, threads: int = 0, rate: float | str = 100.0,
    duration: float | str = 10.0, disturbance: float = 1.0, wind: Any = (0.0, 0.0, 0.0), gusts: float | str = 0.0,
    tolerance: float = 1e-4, autoreset: str = "NextStep",
) -> FlightVectorEnv:  # fmt: skip
    """Makes many environments in arrays, stepped in one call on several threads.

    Parameters
    ----------
    task : str
        "hover" or "track".
    vehicle : Vehicle or str
        A vehicle with a body that hovers, or the name of one.
    n : int
        Number of flights.
    threads : int, default 0
        Largest number of threads; 0: one for each core.
    rate : float or str, default 100.0
        Rate of control [Hz].
    duration : float or str, default 10.0
        Time after which an episode is truncated [s].
    disturbance : float, default 1.0
        Largest deviation of the start, as for HoverEnv.
    wind : array_like, shape (3,), default (0.0, 0.0, 0.0)
        Steady wind in earth axes [m/s].
    gusts : float or str, default 0.0
        Standard deviation of gusts on each axis [m/s], with a correlation time of 0.5 s, constant over a step.
    tolerance : float, default 0.0001
        Largest relative error of an integration step, 1e-12 to 1e-2.
    autoreset : str, default 'NextStep'
        When a flight that has ended restarts: "NextStep", with the next action ignored and a reward of 0, or
        "SameStep", with the last observation in infos["final_obs"].

    Returns
    -------
    FlightVectorEnv
        By the interface of gymnasium.vector.VectorEnv.

    Raises
    ------
    InputError
        For a vehicle that does not hover, and for invalid options.

    Examples
    --------
    >>> envs = wb.gym.make_vec("track", "flight-friction2022", 4, threads=2)
    >>> envs.num_envs, envs.action_space.shape
    (4, (4, 4))
    """
    if autoreset not in ("NextStep", "SameStep"):
        raise refused("autoreset", f'must be "NextStep" or "SameStep", got {autoreset!r}')
    options = options_of(rate, duration, disturbance, wind, gusts, tolerance)
    return FlightVectorEnv(Flights(task, vehicle, n, options, threads), autoreset)


def _vector_of(task: str) -> Any:
    def made(num_envs: int = 1, vehicle: Vehicle | str = "flight-friction2022", **options: Any) -> FlightVectorEnv:
        return make_vec(task, vehicle, num_envs, **options)

    return made


if gymnasium is not None:
    for _task, _kind in (("hover", HoverEnv), ("track", TrackEnv)):
        gymnasium.register(
            id=f"wingbeat/{_task.capitalize()}-v0", entry_point=_kind, vector_entry_point=_vector_of(_task)
        )
