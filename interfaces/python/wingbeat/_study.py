"""Study files as text: what sweeps and columns of designs are made from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from . import _core
from ._errors import InputError
from ._tables import metric_called, metric_rows
from ._arguments import names, text
from ._vehicle import plain


def study_of(
    axes: Mapping[str, Any],
    *,
    title: str = "",
    tolerance: float = 1e-6,
    metrics: Iterable[str] | None = None,
    hold: Mapping[str, float],
    anywhere: bool,
) -> str:
    """The study file of a sweep over all combinations of values of keys."""
    lines = _study(title, tolerance, metrics, hold, anywhere)
    for key, values in axes.items():
        lines += ["", "[[axis]]", f"key = {_core.toml(key)}", f"values = {_core.toml(plain(values, key))}"]
    return "\n".join(lines) + "\n"


def study_of_columns(
    row: Mapping[str, float],
    *,
    tolerance: float,
    metrics: Iterable[str] | None,
    hold: Mapping[str, float],
    anywhere: bool,
) -> str:
    """The study file of a single design, with one axis of all keys that vary."""
    lines = _study("", tolerance, metrics, hold, anywhere)
    lines += ["", "[[axis]]", 'name = "design"', f"keys = {_core.toml(list(row))}"]
    values = list(row.values())
    lines.append(f"values = {_core.toml([[value] for value in values] if len(values) > 1 else values)}")
    return "\n".join(lines) + "\n"


def _study(
    title: str, tolerance: float, metrics: Iterable[str] | None, hold: Mapping[str, float], anywhere: bool
) -> list[str]:
    lines = ["[study]", 'vehicle = "vehicle"', f"tolerance = {_core.toml(tolerance)}"]
    if text("title", title):
        lines.append(f"title = {_core.toml(title)}")
    if metrics is not None:
        wanted = [metric_rows[metric_called(name)].key for name in names("metrics", metrics)]
        lines.append(f"metrics = {_core.toml(wanted)}")
    if anywhere:
        lines.append("allow_extrapolation = true")
    for key, value in hold.items():
        lines.append(f"hold = {{ {key} = {_core.toml(value)} }}")
    return lines


@contextmanager
def without_place(name: str) -> Iterator[None]:
    """Errors of a study that the user has not written, without its file, line and column."""
    try:
        yield
    except InputError as error:
        if error.file != name:
            raise
        made = _placeless(error, name)
        made.others = [_placeless(other, name) for other in error.others]
        raise made from None


def _placeless(error: InputError, name: str) -> InputError:
    text = str(error.args[0]).removeprefix(name)
    if error.line is not None:
        text = text.removeprefix(f":{error.line}:{error.column}")
    text = text.removeprefix(": ")
    for key in ("axis.key: ", "axis.keys: ", "study.hold.", "study."):
        text = text.removeprefix(key)
    made = InputError(text)
    made.key = error.key
    return made
