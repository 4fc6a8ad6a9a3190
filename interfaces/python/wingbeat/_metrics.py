"""Metrics as attributes, made from their table; _metrics.pyi has their types."""

from __future__ import annotations

from typing import Any

from ._quantity import Quantity
from ._tables import Metric, metric_rows


def number(metric: Metric, value: float) -> Quantity | None:
    """None where the metric is absent."""
    return None if value != value else Quantity(value, metric.unit, metric.long_name)


class WithMetrics:
    """Metrics as attributes: `lift_mean`, `frequency`, ... (`wingbeat.metrics`); None where there is none."""

    _metrics: Any

    @property
    def metrics(self) -> dict[str, Quantity | None]:
        """All metrics by name; None where the vehicle does not have one."""
        return {m.name: number(m, float(x)) for m, x in zip(metric_rows, self._metrics)}


def _property(index: int, metric: Metric) -> property:
    doc = f"{metric.long_name[0].upper()}{metric.long_name[1:]} [{metric.unit}]."
    return property(lambda self: number(metric, float(self._metrics[index])), doc=doc)


for _index, _metric in enumerate(metric_rows):
    setattr(WithMetrics, _metric.name, _property(_index, _metric))
