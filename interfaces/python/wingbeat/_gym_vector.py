"""Environments in arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ._arguments import refused, wrong_type
from ._gym_base import VectorBase, autoreset_mode, box, generator
from ._gym_task import OBSERVATION_LIMIT, Flights
from ._vehicle import Vehicle


def spaces_of(flights: Flights) -> tuple[Any, Any]:
    """Of observations and of actions, of one flight."""
    edge, limit = np.ones(len(flights.controls)), np.full(flights.observation_size, OBSERVATION_LIMIT)
    return box(-limit, limit), box(-edge, edge)


class FlightVectorEnv(VectorBase):  # type: ignore[misc]
    """Many vehicles that fly a task, in arrays: what `make_vec` returns.

    Examples
    --------
    >>> envs = wb.gym.make_vec("hover", "flight-friction2022", 3)
    >>> observations, infos = envs.reset(seed=1)
    >>> observations.shape, infos["distance"].shape
    ((3, 19), (3,))
    """

    def __init__(self, flights: Flights, autoreset: str) -> None:
        self._flights = flights
        self._same_step = autoreset == "SameStep"
        self.num_envs: int = flights.count
        self.single_observation_space, self.single_action_space = spaces_of(flights)
        seen, acted = self.single_observation_space, self.single_action_space
        self.observation_space = box(*(np.tile(edge, (self.num_envs, 1)) for edge in (seen.low, seen.high)))
        self.action_space = box(*(np.tile(edge, (self.num_envs, 1)) for edge in (acted.low, acted.high)))
        self.metadata = {"render_modes": [], "render_fps": 100, "autoreset_mode": autoreset_mode(autoreset)}
        self.render_mode = None
        self.closed = False
        #: The vehicle.
        self.vehicle: Vehicle = flights.vehicle
        #: Names of the controls, in the order of actions.
        self.controls: tuple[str, ...] = flights.controls
        self._random = [generator(None) for _ in range(self.num_envs)]
        self._ended = np.zeros(self.num_envs, dtype=bool)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray[Any, Any], dict[str, Any]]:
        """Starts an episode of each flight.

        Parameters
        ----------
        seed : int or list of int, optional
            A seed for each flight, or that of the first one; each further flight has a seed larger by 1.
        options : dict, optional
            As for FlightEnv.

        Returns
        -------
        observations : numpy.ndarray, shape (n, size)
            The observations of each environment.
        infos : dict
            As for FlightEnv, in arrays.

        Raises
        ------
        InputError
            For unknown options, and for a wrong number of seeds.

        Examples
        --------
        >>> envs = wb.gym.make_vec("hover", "flight-friction2022", 2)
        >>> alone, info = wb.gym.HoverEnv().reset(seed=8)
        >>> bool((envs.reset(seed=7)[0][1] == alone).all())
        True
        """
        if seed is not None:
            if isinstance(seed, (int, np.integer)):
                seeds: list[int | None] = [int(seed) + n for n in range(self.num_envs)]
            elif isinstance(seed, Sequence) and not isinstance(seed, str):
                seeds = list(seed)
            else:
                raise wrong_type("seed", "a whole number or a list of them", seed)
            if len(seeds) != self.num_envs:
                raise refused("seed", f"must be {self.num_envs} seeds, got {len(seeds)}")
            self._random = [old if one is None else generator(one) for one, old in zip(seeds, self._random)]
        self._flights.start(range(self.num_envs), self._random, options)
        self._ended[:] = False
        return self._flights.observe(), self._infos(np.zeros(self.num_envs, dtype=np.int64))

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Flies one control step of each flight.

        Parameters
        ----------
        actions : array_like, shape (n, controls)
            A number from -1 to 1 for each control of each flight.

        Returns
        -------
        observations : numpy.ndarray, shape (n, size)
            The observations of each environment.
        rewards : numpy.ndarray, shape (n,)
            Of this step, each at most 1.
        terminations : numpy.ndarray, shape (n,)
            Whether the flight has ended.
        truncations : numpy.ndarray, shape (n,)
            Whether the time of the episode is over.
        infos : dict
            As for FlightEnv, in arrays; with autoreset="SameStep" also "final_obs" and "final_info".

        Raises
        ------
        InputError
            For actions of another shape, or that are not finite.

        Examples
        --------
        >>> envs = wb.gym.make_vec("hover", "flight-friction2022", 2)
        >>> start = envs.reset(seed=1)
        >>> observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())
        >>> rewards.shape, bool(terminations.any())
        ((2,), False)
        """
        again, flights = self._ended.copy(), self._flights
        rewards, ends, over = flights.step(actions, self._random, ~again)
        if again.any():
            self._start_again(again)
        ended = (ends > 0) | over
        observations, infos = flights.observe(), self._infos(ends)
        if self._same_step and ended.any():
            self._start_again(ended)
            final = infos
            infos = self._infos(np.zeros_like(ends))
            kept = np.full(self.num_envs, None, dtype=object)
            for n in np.flatnonzero(ended):
                kept[n] = observations[n]
            infos |= {"final_obs": kept, "_final_obs": ended, "final_info": final, "_final_info": ended}
            observations = flights.observe()
        self._ended = np.zeros_like(ended) if self._same_step else ended
        return observations, rewards, ends > 0, over, infos

    def render(self) -> None:
        """Draws nothing.

        Examples
        --------
        >>> wb.gym.make_vec("hover", "flight-friction2022", 2).render()
        """

    def _start_again(self, which: Any) -> None:
        chosen = np.flatnonzero(which).tolist()
        self._flights.start(chosen, [self._random[n] for n in chosen], None)

    def _infos(self, ends: Any) -> dict[str, Any]:
        infos: dict[str, Any] = {}
        for name, values in self._flights.info(ends).items():
            infos[name], infos[f"_{name}"] = values, np.ones(self.num_envs, dtype=bool)
        return infos
