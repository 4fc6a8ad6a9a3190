"""What environments do: many flights of one vehicle at once, with starts, targets, wind, observations and rewards."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import mapping, number, refused, threads_of, whole, wrong_type
from ._flight import CONTROLS, GRAVITY, BodyState, _triple, numbers_of_body, ranges_of, rotations
from ._trim import Trim, trim
from ._vehicle import Vehicle, read, vehicle_of

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Sizes by which observations are divided.
DISTANCE_SCALE, SPEED_SCALE, RATE_SCALE = 1.0, 2.0, 10.0
#: Observations are cut off there.
OBSERVATION_LIMIT = 10.0
#: An episode ends that far from the target [m], and beyond that tilt of the body [rad].
FARTHEST, STEEPEST = 1.0, np.radians(80.0)
#: Largest deviations of a start for a disturbance of 1: position [m], velocity [m/s], roll and pitch, heading [rad],
#: rates [rad/s].
START_POSITION, START_SPEED, START_TILT, START_HEADING, START_RATE = 0.1, 0.3, 0.2, 0.5, 1.0
#: Correlation time of gusts [s].
GUST_TIME = 0.5
#: Why a flight ended, by the number that FlightBatch.step returns, and beyond.
ENDS = ("", "jammed", "failed", "distance", "attitude")


class Options(NamedTuple):
    """How environments fly."""

    rate: float  #: of control [Hz]
    duration: float  #: of an episode [s]
    disturbance: float  #: of starts
    wind: Array  #: [m/s]
    gusts: float  #: [m/s]
    tolerance: float  #: of steps


def options_of(
    rate: Any, duration: Any, disturbance: Any, wind: Any, gusts: Any, tolerance: Any
) -> Options:  # fmt: skip
    """The options of an environment, looked at."""
    made = Options(
        number("rate", rate, "Hz"),
        number("duration", duration, "s"),
        _not_negative("disturbance", disturbance, "1"),
        _triple("wind", wind, "m/s"),
        _not_negative("gusts", gusts, "m/s"),
        number("tolerance", tolerance, "1"),
    )
    for name, value in (("rate", made.rate), ("duration", made.duration)):
        if value <= 0.0:
            raise refused(name, f"must be > 0, got {value}")
    return made


def _not_negative(name: str, value: Any, unit: str) -> float:
    found = number(name, value, unit)
    if found < 0.0:
        raise refused(name, f"must be >= 0, got {value}")
    return found


@functools.lru_cache(maxsize=32)
def _hover(vehicle: Vehicle) -> Trim:
    found = trim(vehicle)
    if found.status != "trimmed":
        raise refused("vehicle", f"does not hover: {found['status_detail']}")
    return found


class Flights:
    """As many flights as there are environments, with what belongs to each in arrays."""

    def __init__(self, task: str, vehicle: Vehicle | str, count: int, options: Options, threads: int) -> None:
        if task not in ("hover", "track"):
            raise refused("task", f'must be "hover" or "track", got {task!r}')
        self.task, self.options = task, options
        self.vehicle = read(vehicle) if isinstance(vehicle, str) else vehicle_of(vehicle)
        self.count = whole("n", count, 1, 1_000_000)
        self.hover = _hover(self.vehicle)
        ranges = ranges_of(self.vehicle)
        #: Names of the controls, in the order of actions.
        self.controls = tuple(ranges)
        self._indices = [[name for name, _ in CONTROLS].index(name) for name in self.controls]
        self.trim_settings = np.array([float(self.hover.controls[name]) for name in self.controls])
        self.low, self.high = np.array(list(ranges.values())).T
        self.batch = _core.FlightBatch(self.vehicle._design, count, options.tolerance, GRAVITY, threads_of(threads))
        self.steps = np.zeros(count, dtype=np.int64)
        self.limit = max(1, round(options.duration * options.rate))
        self.actions = np.zeros((count, len(self.controls)))
        self.settings = np.tile(self.trim_settings, (count, 1))
        self.gusts = np.zeros((count, 3))
        self.paths = np.zeros((count, 4))  # radius [m], angular velocity [rad/s], heading [rad], height [m]
        self.energy = np.zeros(count)
        self.power = np.zeros(count)

    @property
    def observation_size(self) -> int:
        """How many numbers an observation has."""
        return 15 + len(self.controls)

    # ---- starts

    def start(self, which: Sequence[int], random: Sequence[np.random.Generator], options: Any) -> None:
        """Starts these flights anew, each with random numbers of its own."""
        given = mapping("options", options or {})
        for name in given:
            if name not in ("disturbance", "body"):
                raise refused(f"options: {name}", "is not an option; there are disturbance and body")
        disturbance = _not_negative("disturbance", given.get("disturbance", self.options.disturbance), "1")
        body = given.get("body")
        if body is not None and not isinstance(body, BodyState):
            raise wrong_type("options: body", "a wingbeat.BodyState", body)
        rows = []
        for n, draws in zip(which, random):
            start = self._drawn_start(draws, disturbance)
            rows.append(numbers_of_body(start if body is None else body))
            self.paths[n] = self._drawn_path(draws)
            self.gusts[n] = self.options.gusts * draws.standard_normal(3)
        self.batch.start(list(which), np.array(rows), self.hover.drives)
        chosen = list(which)
        self.steps[chosen], self.actions[chosen], self.energy[chosen], self.power[chosen] = 0, 0.0, 0.0, 0.0
        self.settings[chosen] = self.trim_settings

    def _drawn_start(self, draws: np.random.Generator, disturbance: float) -> BodyState:
        share = disturbance * draws.uniform(-1.0, 1.0, 12)
        angles = self.hover.body.euler_angles
        angles += share[6:9] * [START_TILT, START_TILT, START_HEADING]
        return BodyState.at(
            position=START_POSITION * share[0:3], velocity=START_SPEED * share[3:6], rates=START_RATE * share[9:12],
            euler_angles=angles,
        )  # fmt: skip

    def _drawn_path(self, draws: np.random.Generator) -> list[float]:
        radius, speed, heading, height = draws.uniform([0.2, 0.2, -np.pi, -0.2], [0.5, 0.5, np.pi, 0.2])
        turns = float(draws.integers(2)) * 2.0 - 1.0
        return [radius, turns * speed / radius, heading, height]

    # ---- targets

    def targets(self) -> tuple[Array, Array]:
        """Where each flight should be, and how fast, in earth axes."""
        if self.task == "hover":
            return np.zeros((self.count, 3)), np.zeros((self.count, 3))
        radius, rate, heading, height = self.paths.T
        t = self.steps / self.options.rate
        # Smoothly into motion, with a time constant of 1 s.
        angle, turning = rate * (t - 1.0 + np.exp(-t)), rate * (1.0 - np.exp(-t))
        ahead, aside = radius * np.sin(angle), radius * (1.0 - np.cos(angle))
        ahead_rate, aside_rate = radius * np.cos(angle) * turning, radius * np.sin(angle) * turning
        c, s = np.cos(heading), np.sin(heading)
        place = [c * ahead - s * aside, s * ahead + c * aside, -0.5 * height * (1.0 - np.cos(angle))]
        rise_rate = 0.5 * height * np.sin(angle) * turning
        speed = [c * ahead_rate - s * aside_rate, s * ahead_rate + c * aside_rate, -rise_rate]
        return np.stack(place, axis=1), np.stack(speed, axis=1)

    # ---- steps

    def step(self, actions: Any, random: Sequence[np.random.Generator], active: npt.NDArray[np.bool_]) -> Any:
        """Steps the active flights: reward, whether it ended and by what, whether its time is over."""
        given = np.asarray(actions, dtype=np.float64)
        if given.shape != self.actions.shape or not np.isfinite(given[active]).all():
            raise refused("action", f"must be finite numbers of shape {self.actions.shape}, got {given.shape}")
        before = self.actions.copy()
        self.actions[active] = np.clip(given[active], -1.0, 1.0)
        span = np.where(self.actions > 0.0, self.high - self.trim_settings, self.trim_settings - self.low)
        self.settings = self.trim_settings + self.actions * span
        self._blow(random, active)
        commanded = np.zeros((self.count, len(CONTROLS)))
        commanded[:, self._indices] = self.settings
        step = 1.0 / self.options.rate
        ended = self.batch.step(step, commanded, self.options.wind + self.gusts, active.tolist())
        self.steps[active] += 1
        energy = self.batch.totals()[:, 6]
        self.power = (energy - self.energy) / step
        self.energy = energy
        rewards, ends = self._assessed(ended.astype(np.int64), self.actions - before)
        return np.where(active, rewards, 0.0), np.where(active, ends, 0), active & (self.steps >= self.limit)

    def _blow(self, random: Sequence[np.random.Generator], active: npt.NDArray[np.bool_]) -> None:
        if self.options.gusts <= 0.0:
            return
        kept = np.exp(-1.0 / (self.options.rate * GUST_TIME))
        for n in np.flatnonzero(active):
            fresh = self.options.gusts * np.sqrt(1.0 - kept * kept) * random[n].standard_normal(3)
            self.gusts[n] = kept * self.gusts[n] + fresh

    def _assessed(self, ends: npt.NDArray[np.int64], changes: Array) -> tuple[Array, npt.NDArray[np.int64]]:
        """Rewards, and what ended a flight."""
        bodies = self.batch.bodies()
        turns = rotations(bodies[:, 6:10])
        places, speeds = self.targets()
        distance = np.linalg.norm(bodies[:, 10:13] - places, axis=1)
        slip = np.linalg.norm(np.einsum("nij,nj->ni", turns, bodies[:, 0:3]) - speeds, axis=1)
        upright = turns[:, 2, 2]
        ends = np.where((ends == 0) & (distance > FARTHEST), 3, ends)
        ends = np.where((ends == 0) & (upright < np.cos(STEEPEST)), 4, ends)
        rewards = 0.5 * np.exp(-distance / 0.25) + 0.2 * np.exp(-slip / 1.0) + 0.2 * np.maximum(0.0, upright)
        rewards += 0.1 * np.exp(-np.linalg.norm(bodies[:, 3:6], axis=1) / 10.0) - 0.05 * np.mean(changes**2, axis=1)
        return np.where(ends == 0, rewards, 0.0), ends

    # ---- what is seen

    def observe(self) -> npt.NDArray[np.float32]:
        """An observation for each flight, in rows."""
        bodies = self.batch.bodies()
        turns = rotations(bodies[:, 6:10])
        places, speeds = self.targets()
        seen = np.concatenate(
            [
                np.einsum("nji,nj->ni", turns, places - bodies[:, 10:13]) / DISTANCE_SCALE,
                (np.einsum("nji,nj->ni", turns, speeds) - bodies[:, 0:3]) / SPEED_SCALE,
                turns[:, 2, :],
                turns[:, 0, :],
                bodies[:, 3:6] / RATE_SCALE,
                self.actions,
            ],
            axis=1,
        )
        found: npt.NDArray[np.float32] = np.clip(seen, -OBSERVATION_LIMIT, OBSERVATION_LIMIT).astype(np.float32)
        return found

    def info(self, ends: Any) -> dict[str, Any]:
        """Further information, in arrays."""
        bodies = self.batch.bodies()
        places, _ = self.targets()
        return {
            "time": self.steps / self.options.rate,
            "position": bodies[:, 10:13],
            "target": places,
            "distance": np.linalg.norm(bodies[:, 10:13] - places, axis=1),
            "controls": self.settings.copy(),
            "power": self.power.copy(),
            "wind": self.options.wind + self.gusts,
            "ended": np.array(ENDS, dtype=object)[np.asarray(ends)],
        }

