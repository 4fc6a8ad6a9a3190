"""What environments are made of: the classes of Gymnasium where it is installed, else what they need of it."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

try:
    gymnasium: Any = importlib.import_module("gymnasium")
except ImportError:
    gymnasium = None


class Box:
    """The range of observations or actions, instead of `gymnasium.spaces.Box` if Gymnasium is not installed.

    Parameters
    ----------
    low : array_like
        The lower limit of each number.
    high : array_like
        The upper limit of each number, of the same shape.
    dtype : type, default 'float32'
        Of the arrays.

    Examples
    --------
    >>> box = wb.gym.Box([-1, -1], [1, 1])
    >>> box.shape, box.contains(np.zeros(2, np.float32)), box.contains(np.full(2, 2, np.float32))
    ((2,), True, False)
    """

    def __init__(self, low: Any, high: Any, dtype: Any = "float32") -> None:
        self.dtype = np.dtype(dtype)
        self.low = np.asarray(low, self.dtype)
        self.high = np.asarray(high, self.dtype)
        self.shape = self.low.shape
        self._random: np.random.Generator | None = None

    def seed(self, seed: int | None = None) -> int:
        """Seeds the random numbers of `sample`.

        Parameters
        ----------
        seed : int, optional
            The seed; default: one from the system.

        Returns
        -------
        int
            The seed.

        Examples
        --------
        >>> wb.gym.Box([0], [1]).seed(5)
        5
        """
        chosen = int(np.random.SeedSequence().generate_state(1)[0]) if seed is None else seed
        self._random = generator(chosen)
        return chosen

    def sample(self) -> np.ndarray[Any, Any]:
        """Numbers drawn evenly from the box.

        Returns
        -------
        numpy.ndarray
            Of the shape and type of the box.

        Examples
        --------
        >>> box = wb.gym.Box([-1, -1], [1, 1])
        >>> box.sample() in box
        True
        """
        if self._random is None:
            self.seed()
        assert self._random is not None
        return self._random.uniform(self.low, self.high).astype(self.dtype)

    def contains(self, x: Any) -> bool:
        """Whether that is an array of this shape and type within the box.

        Parameters
        ----------
        x : numpy.ndarray
            The array to check.

        Returns
        -------
        bool
            True if the array lies in the box or on its edges.

        Examples
        --------
        >>> wb.gym.Box([0], [1]).contains(np.ones(1, np.float32))
        True
        """
        if not isinstance(x, np.ndarray) or x.shape != self.shape or not np.can_cast(x.dtype, self.dtype):
            return False
        return bool(np.all(x >= self.low) and np.all(x <= self.high))

    def __contains__(self, x: Any) -> bool:
        return self.contains(x)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Box):
            return NotImplemented
        same = np.array_equal(self.low, other.low) and np.array_equal(self.high, other.high)
        return bool(same and self.dtype == other.dtype)

    def __repr__(self) -> str:
        return f"Box({self.low.min():g}, {self.high.max():g}, {self.shape}, {self.dtype})"


def generator(seed: int | None) -> np.random.Generator:
    """Random numbers of a seed, those of Gymnasium."""
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))


def box(low: Any, high: Any) -> Any:
    """A box of Gymnasium's, where that is installed, of 32-bit numbers."""
    kind = Box if gymnasium is None else gymnasium.spaces.Box
    return kind(np.asarray(low, np.float32), np.asarray(high, np.float32), dtype=np.float32)


class _OwnEnv:
    """The part of gymnasium.Env that is used."""

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode: str | None = None
    spec: Any = None
    _np_random: np.random.Generator | None = None

    @property
    def np_random(self) -> np.random.Generator:
        """Random numbers of the environment, seeded by `reset`."""
        if self._np_random is None:
            self._np_random = generator(None)
        return self._np_random

    @property
    def unwrapped(self) -> Any:
        """The environment itself."""
        return self

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> Any:
        """Seeds the random numbers."""
        if seed is not None:
            self._np_random = generator(seed)

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *raised: Any) -> None:
        self.close()

    def close(self) -> None:
        """Nothing is open."""


class _OwnVectorEnv:
    """The part of gymnasium.vector.VectorEnv that is used."""

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode: str | None = None
    spec: Any = None
    closed: bool = False

    @property
    def unwrapped(self) -> Any:
        """The environment itself."""
        return self

    def close(self) -> None:
        """Nothing is open."""
        self.closed = True


EnvBase: Any = _OwnEnv if gymnasium is None else gymnasium.Env
VectorBase: Any = _OwnVectorEnv if gymnasium is None else importlib.import_module("gymnasium.vector").VectorEnv


def autoreset_mode(name: str) -> Any:
    """The mode of that name as Gymnasium has it: "NextStep" or "SameStep"."""
    modes = None if gymnasium is None else getattr(gymnasium.vector, "AutoresetMode", None)
    return name if modes is None else modes(name)
