from collections.abc import Callable, Sequence
from typing import Any

version: str

class Design:
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
