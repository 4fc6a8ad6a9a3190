from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

version: str

class Design:
    def __init__(self, *args: Any, **kwargs: Any) -> None: ...
    def value(self, path: str) -> float | str | bool | None: ...
    def to_toml(self) -> str: ...

def read(file: str) -> Design: ...
def parse(text: str, name: str) -> Design: ...
def with_values(assignments: Sequence[str], base: Design | None) -> Design: ...
def parameters() -> list[tuple[str, str, str, str, str, str, tuple[str, ...], str]]: ...
def metrics() -> list[tuple[str, str, str, str]]: ...
def waveforms() -> list[tuple[str, str, str, str]]: ...
def statuses() -> list[str]: ...
def domain_name(bits: int) -> str: ...
def quantity(name: str, value: object, unit: str) -> float: ...
def run(
    design: Design,
    condition: str,
    method: str,
    tolerance: float,
    frequency: float | None,
    lift: float | None,
    allow_extrapolation: bool,
    points: int,
    endurance: bool,
) -> dict[str, Any]: ...
def gradient(
    design: Design,
    keys: Sequence[str],
    condition: str,
    tolerance: float,
    frequency: float | None,
    endurance: bool,
) -> dict[str, Any]: ...
def energy_balance(values: Any) -> tuple[float, float, float, float, float, float, float, float, float]: ...
def simulate(
    design: Design,
    condition: str,
    tolerance: float,
    max_time: float,
    crank_angle: float,
    crank_speed: float,
    current: float,
    record_interval: float,
) -> dict[str, Any]: ...
def solve_columns(
    study: str,
    base: Design,
    columns: Sequence[Any],
    count: int,
    condition: str,
    threads: int,
    progress: Callable[[int, int], object] | None,
) -> dict[str, Any]: ...
def sweep(
    study: str,
    vehicle: Design,
    output: str,
    threads: int,
    force: bool,
    progress: Callable[[int, int], object] | None,
) -> None: ...

class EquationsOfMotion:
    def __init__(self, design: Design, condition: str) -> None: ...
    def state_names(self) -> list[str]: ...
    def rates(self, time: float, state: Any, voltage: float | None) -> npt.NDArray[np.float64]: ...

def endurance(design: Design, allow_extrapolation: bool) -> dict[str, Any]: ...
def identify_motor(
    file: str, frequency: float | None, assume_steel_cylinder: bool, assume_typical_damping: bool, shaft: str
) -> dict[str, Any]: ...
def fit(file: str, overrides: Sequence[str], profiles: bool, compare_friction: bool) -> dict[str, Any]: ...
def tolerance(
    file: str,
    overrides: Sequence[str],
    allow_extrapolation: bool,
    threads: int,
    progress: Callable[[int, int], object] | None,
) -> dict[str, Any]: ...
def optimise(file: str, overrides: Sequence[str], allow_extrapolation: bool, threads: int) -> dict[str, Any]: ...
