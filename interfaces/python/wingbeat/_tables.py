"""The tables that everything is named by: parameters of a vehicle, metrics of a cycle, columns of a waveform."""

from __future__ import annotations

from typing import NamedTuple

from . import _core
from ._errors import InputError


class Parameter(NamedTuple):
    """A key of the vehicle file.

    Examples
    --------
    >>> wb.parameters["motor.inertia"].unit
    'kg m2'
    """

    key: str  #: with its section: "motor.inertia"
    unit: str  #: SI unit, "1" for a plain number, "" where it is not a number
    range: str  #: of its values, in words
    default: str  #: in words; "required" where there is none
    meaning: str  #: with the symbol
    only_with: str  #: the choice it belongs to, "friction.type = viscous"; "" where it belongs everywhere
    alternatives: tuple[str, ...]  #: keys that may be given in its place
    example: str  #: a value as a vehicle file states it

    @property
    def always(self) -> bool:
        """True for a number that every vehicle has: stated, or the default."""
        has_default = self.default == "required" or self.default[:1].isdigit()
        return bool(self.unit) and has_default and not self.only_with and not self.alternatives

    @property
    def doc(self) -> str:
        """All of it as text."""
        unit = {"": "", "1": "Number. "}.get(self.unit, f"[{self.unit}] ")
        lines = [f"{self.meaning}.", f"{unit}Range: {self.range}. Default: {self.default}."]
        if self.only_with:
            lines.append(f"Only with {self.only_with.replace('|', ' or ')}.")
        if self.alternatives:
            lines.append(f"Instead of {' or '.join(self.alternatives)}.")
        return "\n".join(lines)


class Metric(NamedTuple):
    """A metric of a flapping cycle, or a column of its waveform.

    Examples
    --------
    >>> wb.metrics["lift_mean"].key, wb.metrics["lift_mean"].unit
    ('lift_mean_n', 'N')
    """

    key: str  #: in JSON and data sets: "lift_mean_n"
    name: str  #: here: "lift_mean"
    unit: str  #: UDUNITS
    long_name: str  #: what it is, in words


#: The keys of the vehicle file, each a `Parameter`, by key.
parameters: dict[str, Parameter] = {row[0]: Parameter(*row) for row in _core.parameters()}
#: The metrics of a flapping cycle, each a `Metric`, by the name that they have in Python.
metrics: dict[str, Metric] = {row[1]: Metric(*row) for row in _core.metrics()}
waveforms: dict[str, Metric] = {row[1]: Metric(*row) for row in _core.waveforms()}
statuses: tuple[str, ...] = tuple(_core.statuses())

metric_rows: tuple[Metric, ...] = tuple(metrics.values())
metric_index: dict[str, int] = {metric.name: n for n, metric in enumerate(metric_rows)}
metric_index.update({metric.key: n for n, metric in enumerate(metric_rows)})


def metric_called(name: str) -> int:
    """The index of a metric by its name here or in data sets."""
    if name in metric_index:
        return metric_index[name]
    import difflib

    near = difflib.get_close_matches(name, metrics, 1)
    error = InputError(f"metric: there is no {name!r}" + (f"; did you mean {near[0]}?" if near else ""))
    error.key = "metric"
    raise error
