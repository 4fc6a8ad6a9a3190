"""Figures of fronts, fits and tolerances, for wingbeat.plot."""

from __future__ import annotations

import pathlib
import textwrap
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import refused, wrong_type
from ._figures import (
    COLOURS, CURVES, ORDERED, REFERENCE, axes_of, key, label_y, largest, metric_display, metric_row,
    named, panels_of, styled, words,
)
from ._optimise import Front
from ._studies import Found, StudyResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def front(
    found: Front, across: str | None = None, up: str | None = None, *, ax: Axes | None = None,
    width: float | str = "89 mm",
) -> Axes:
    """The designs of a front over two metrics, with its ends and its knee.

    Parameters
    ----------
    found : Front
        The result of `wingbeat.optimise` for several objectives.
    across, up : str, optional
        Metrics along the axes; default: the first two objectives.
    ax : matplotlib Axes, optional
        The Axes to draw into; default: those of a new figure.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Axes
        A point for each design.

    Raises
    ------
    InputError
        For an unknown metric.
    ValueError
        If no design was found.

    Examples
    --------
    >>> import wingbeat.plot
    >>> fronts = {
    ...     "search": {"population": 40, "generations": 5},
    ...     "objective": [
    ...         {"maximise": "lift_mean_n", "reference": 0},
    ...         {"minimise": "power_electrical_w", "reference": "4 W"},
    ...     ],
    ...     "parameter": [{"key": "supply.voltage", "lower": 2, "upper": 8}],
    ... }
    >>> found = wb.optimise(fronts, vehicle=wb.read("friction2022"))
    >>> wingbeat.plot.front(found).get_xlabel()
    'mean lift (mN)'
    """
    if not isinstance(found, Front):
        raise wrong_type("found", "a wingbeat.Front", found)
    if not found.all_vehicles:
        raise ValueError("there is no front: no design was found")
    objectives = [str(objective["metric"]) for objective in found["objectives"]]
    designs = found.designs
    columns, labels = [], []
    for metric in (across or objectives[0], up or objectives[1]):
        row = metric_row(metric)
        factor, unit = metric_display(row, designs[row.name].values)
        columns.append(factor * designs[row.name].values)
        labels.append(named(row.long_name, unit))
    inside = np.array([design["domain"] == "inside" for design in found["front"]])
    picks = found["picks"]
    ends = [n for name, n in picks.items() if name.startswith("end-")]
    with styled():
        ax = axes_of(ax, width, 2.4)
        for name, colour, some in (("front", "ink", inside), ("outside the model's domain", "outside_domain", ~inside)):
            if some.any():
                ax.plot(columns[0][some], columns[1][some], ".", color=COLOURS[colour], label=name)
        ax.plot(columns[0][ends], columns[1][ends], "^", markersize=5, color=ORDERED[2], label="ends")
        if "knee" in picks:
            knee = picks["knee"]
            ax.plot(columns[0][knee], columns[1][knee], "D", markersize=5, color=ORDERED[1], label="knee")
        ax.set_xlabel(labels[0])
        label_y(ax, labels[1], 1.8)
        key(ax)
    return ax


def residuals(found: Found, *, figure: Figure | None = None, width: float | str = "89 mm") -> Figure:
    """Fitted values against measurements, and residuals in standard deviations, in the order of the logs.

    Parameters
    ----------
    found : Found
        The result of `wingbeat.fit`.
    figure : matplotlib Figure, optional
        The Figure or SubFigure to draw into; default: a new one.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Figure
        Above, fitted over measured values, normalised by the largest of each quantity; below, the residuals.

    Raises
    ------
    ValueError
        If nothing was fitted.

    Examples
    --------
    >>> import wingbeat.plot
    >>> figure = wingbeat.plot.residuals(wb.fit("flapper", profiles=False))
    >>> [label.get_text() for label in figure.axes[1].get_xticklabels()]
    ['air', 'vacuum', 'wingless']
    """
    if not isinstance(found, Found) or "points" not in found:
        raise wrong_type("found", "the result of wingbeat.fit", found)
    points = [p for p in found["points"] if p["fitted"] is not None]
    if not points:
        raise ValueError("there are no residuals: no measurement was reached by the fit")
    quantities = list(dict.fromkeys(p["quantity"] for p in points))
    logs = [pathlib.PurePath(p["row"].rpartition(":")[0]).stem for p in points]
    markers = "osD^v<>P"
    with styled():
        figure, (above, below) = panels_of(figure, width, 2, 1.7, shared=False)
        above.axline((0, 0), slope=1, **REFERENCE)
        for n, quantity in enumerate(quantities):
            own = [k for k, p in enumerate(points) if p["quantity"] == quantity]
            measured, fitted, deviation = (np.array([points[k][name] for k in own], dtype=float)
                                           for name in ("measured", "fitted", "deviation"))
            most = largest(measured) or 1.0
            look: dict[str, Any] = {"marker": markers[n % len(markers)], "linestyle": "", "fillstyle": "none"}
            look["color"] = CURVES[n % 2]["color"]
            label = quantity.rpartition("_")[0].replace("_", " ") or quantity
            above.plot(measured / most, fitted / most, label=label, **look)
            below.plot(own, (measured - fitted) / deviation, **look)
        for value in (-3.0, 0.0, 3.0):
            below.axhline(value, **REFERENCE)
        starts = [0, *(k for k in range(1, len(logs)) if logs[k] != logs[k - 1]), len(logs)]
        for start in starts[1:-1]:
            below.axvline(start - 0.5, color="#e0e0e0", linewidth=0.5)
        below.set_xticks([0.5 * (a + b - 1) for a, b in zip(starts, starts[1:])], [logs[a] for a in starts[:-1]])
        below.tick_params(axis="x", length=0)
        if len(starts) > 5 or max(map(len, logs)) > 8:
            below.tick_params(axis="x", rotation=30)
        above.set_xlabel("measured, over the largest")
        label_y(above, "fitted, likewise", 1.2)
        label_y(below, "residual (standard deviations)", 1.2)
        key(above)
        figure.align_ylabels([above, below])
    return figure


#: What a tolerance study is first asked about.
_ASKED = ("frequency", "power_electrical", "lift_mean", "lift_to_weight", "stroke_amplitude", "efficiency_system")


def tolerance(
    found: StudyResult, metrics: Iterable[str] | None = None, *, ax: Axes | None = None,
    width: float | str = "89 mm",
) -> Axes:
    """Scatter of metrics about their medians: 95 % of the vehicles (bar) and all of them (line).

    Parameters
    ----------
    found : StudyResult
        The result of `wingbeat.tolerance`.
    metrics : list of str, optional
        Names of metrics; default: those of frequency, power, lift, stroke amplitude and efficiency that scatter.
    ax : matplotlib Axes, optional
        The Axes to draw into; default: those of a new figure.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Axes
        A row for each metric.

    Raises
    ------
    InputError
        For a metric that the study does not have, or whose median is 0.

    Examples
    --------
    >>> import wingbeat.plot
    >>> spread = {"key": "friction.radius", "distribution": "normal", "relative_deviation": 0.05}
    >>> study = {"samples": {"count": 128}, "parameter": [spread]}
    >>> found = wb.tolerance(study, vehicle=wb.read("friction2022"))
    >>> wingbeat.plot.tolerance(found, ["lift_mean"]).get_xlabel()
    'deviation from the median (%)'
    """
    outputs = _outputs(found)
    wanted = [metrics] if isinstance(metrics, str) else None if metrics is None else list(metrics)
    names, bars = [], []
    for metric in wanted if wanted is not None else _ASKED:
        row = metric_row(metric)
        spread = outputs.get(row.key)
        if wanted is None and spread is not None and spread["least"] == spread["most"]:
            continue
        if spread is not None and spread["median"]:
            names.append(row.long_name)
            bars.append(100.0 * (np.array([spread[name] for name in (
                "least", "percentile_2_5", "percentile_97_5", "most")]) / spread["median"] - 1.0))
        elif wanted is not None:
            missing = f"the study has no {row.name}" if spread is None else f"the median of {row.name} is 0"
            raise refused("metrics", missing)
    if not bars:
        raise refused("metrics", "expected at least one that the study has")
    table, rows = np.array(bars), np.arange(len(bars))
    with styled():
        ax = axes_of(ax, width, 0.7 + 0.22 * len(bars))
        ax.hlines(rows, table[:, 0], table[:, 3], color=COLOURS["ink"], linewidth=0.7, label="all that flap")
        ax.barh(rows, table[:, 2] - table[:, 1], left=table[:, 1], height=0.5, color="#cfcfcf", label="95 %")
        ax.axvline(0.0, label="median", **REFERENCE)
        _rows(ax, names)
        ax.set_xlabel("deviation from the median (%)")
        key(ax, room=0.5)
    return ax


def sensitivity(
    found: StudyResult, metric: str, *, ax: Axes | None = None, width: float | str = "89 mm"
) -> Axes:
    """Share of each uncertain parameter in the variance of a metric, with 95 % intervals, the largest first.

    Parameters
    ----------
    found : StudyResult
        The result of `wingbeat.tolerance`.
    metric : str
        The name of a metric.
    ax : matplotlib Axes, optional
        The Axes to draw into; default: those of a new figure.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Axes
        A row for each parameter.

    Raises
    ------
    InputError
        For a metric without shares of its variance.

    Examples
    --------
    >>> import wingbeat.plot
    >>> spread = {"key": "friction.radius", "distribution": "normal", "relative_deviation": 0.05}
    >>> study = {"samples": {"count": 128}, "parameter": [spread]}
    >>> found = wb.tolerance(study, vehicle=wb.read("friction2022"))
    >>> wingbeat.plot.sensitivity(found, "lift_mean").get_yticklabels()[0].get_text()
    'friction radius'
    """
    row = metric_row(metric)
    factors = _outputs(found).get(row.key, {}).get("factors")
    if not factors:
        raise refused("metric", f"the study has no shares of the variance of {row.name}")
    factors = sorted(factors, key=lambda one: -(one.get("total") or one.get("linear_share") or 0.0))
    kinds = (("first", "first order", "o", COLOURS["ink"], -0.22), ("total", "total", "s", COLOURS["grey"], 0.0),
             ("linear_share", "linear", "^", COLOURS["ink"], 0.22))
    with styled():
        ax = axes_of(ax, width, 0.7 + 0.26 * len(factors))
        for name, label, marker, colour, beside in kinds:
            have = [n for n, one in enumerate(factors) if one.get(name) is not None]
            if not have:
                continue
            at = np.array([factors[n][name] for n in have])
            error = None
            if f"{name}_95" in factors[have[0]]:
                error = np.abs(np.array([factors[n][f"{name}_95"] for n in have]).T - at)
            ax.errorbar(at, np.array(have) + beside, xerr=error, fmt=marker, color=colour, label=label, elinewidth=0.7,
                        fillstyle="none" if name == "linear_share" else "full")
        _rows(ax, [words(one["name"]) for one in factors])
        ax.set_ylim(len(factors) - 0.4, -0.6)
        ax.set_xlabel(f"share of the variance: {row.long_name}")
        key(ax, room=0.5)
    return ax


def _outputs(found: StudyResult) -> dict[str, Any]:
    if not isinstance(found, StudyResult) or "outputs" not in found:
        raise wrong_type("found", "the result of wingbeat.tolerance", found)
    outputs: dict[str, Any] = found["outputs"]
    return outputs


def _rows(ax: Any, names: list[str]) -> None:
    ax.set_yticks(range(len(names)), ["\n".join(textwrap.wrap(name, 28)) for name in names])
    ax.tick_params(axis="y", length=0)
    ax.spines["left"].set_visible(False)
    ax.set_ylim(len(names) - 0.5, -0.5)
