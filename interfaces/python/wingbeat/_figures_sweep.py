"""Sweeps as curves and contours, for wingbeat.plot."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ._accessor import DataSet, status_of
from ._arguments import refused, wrong_type
from ._figures import (
    COLOURS, DASH_DOTTED, DASHED, DOTTED, ORDERED, SOLID, axes_of, display, key, label_y, largest,
    metric_display, metric_row, named, panels_of, pinned, scale_of, styled, words,
)

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

OUTSIDE_BAND, IDLE, BOUNDARY = "#d0d0d0", "#e4e4e4", "#b00000"
_DASHES = (SOLID, DASHED, DOTTED, DASH_DOTTED)


class Axis(NamedTuple):
    """A dimension of a sweep as a figure shows it."""

    dimension: str
    key: str
    numeric: bool
    values: npt.NDArray[Any]  #: in the unit shown, choices as texts
    unit: str

    @property
    def label(self) -> str:
        return named(words(self.key), self.unit)

    def value(self, at: int) -> str:
        """A value of it in a key: "voltage 3 V", "springs on"."""
        if self.numeric:
            return f"{words(self.key)} {self.values[at]:.4g} {self.unit}".rstrip()
        alone = self.key in ("condition", "transmission.formulation")
        return str(self.values[at]) if alone else f"{words(self.key)} {self.values[at]}"


def _axis(data: xarray.Dataset, dimension: str) -> Axis:
    if dimension not in data.coords:
        return Axis(dimension, dimension, True, np.arange(data.sizes[dimension], dtype=float), "")
    along = data[dimension]
    name = str(along.attrs.get("wingbeat_key", dimension))
    if along.dtype.kind not in "fiu":
        return Axis(dimension, name, False, along.values.astype(str), "")
    factor, unit = display(str(along.attrs.get("units", "1")), largest(along.values))
    return Axis(dimension, name, True, factor * along.values.astype(float), unit)


def axes_of_sweep(data: Any) -> tuple[list[Axis], list[Axis]]:
    """The dimensions along which metrics are drawn, and those with a curve for each value, as `wingbeat sweep --plot`
    tells them apart."""
    if not hasattr(data, "data_vars") or "status" not in data:
        raise wrong_type("data", "the data set of a sweep", data)
    every = [_axis(data, str(dimension)) for dimension in data["status"].dims]
    many = any(axis.numeric and len(axis.values) >= 10 for axis in every)
    along = [axis for axis in every if axis.numeric and (len(axis.values) >= 4 or not many)]
    return along, [axis for axis in every if axis not in along]


def metric_values(data: xarray.Dataset, metric: str) -> tuple[xarray.DataArray, str, str]:
    """A metric where the designs flap, in the unit shown, with its name and that unit."""
    row = metric_row(metric)
    if row.key not in data:
        raise refused("metric", f"the data set has no {row.name}")
    values = data[row.key].where(status_of(data) == "flapping")
    factor, unit = metric_display(row, values.values)
    return values * factor, row.long_name, unit


def _look(curves: list[Axis], at: tuple[int, ...]) -> dict[str, Any]:
    """Springs, surroundings and an ordered number decide the colour of a curve, the formulation its dash."""
    colour = dash = None
    rest = 0
    for axis, n in zip(curves, at):
        value = str(axis.values[n])
        if axis.key == "springs" and colour is None:
            colour = COLOURS["with_springs" if value == "on" else "without_springs"]
        elif axis.key == "condition" and colour is None:
            colour = COLOURS[{"air": "in_air", "vacuum": "in_vacuum"}.get(value, "without_wings")]
        elif axis.key == "transmission.formulation" and dash is None:
            dash = SOLID if value == "rod-force" else DASHED
        elif axis.numeric and colour is None:
            colour = ORDERED[n * len(ORDERED) // len(axis.values)]
        else:
            rest = rest * len(axis.values) + n
    dash = _DASHES[rest % len(_DASHES)] if dash is None else dash
    return {"color": colour or COLOURS["ink" if rest < len(_DASHES) else "grey"], "linestyle": dash}


def _outside(x: npt.NDArray[np.float64], y: npt.NDArray[np.float64], beyond: npt.NDArray[np.bool_], log: bool) -> Any:
    """The parts of a curve outside the domain, to halfway to the next design inside."""
    at: list[float] = []
    value: list[float] = []
    for n in np.flatnonzero(beyond & np.isfinite(y)):
        before, after = ([n - 1] if n > 0 else []), ([n + 1] if n + 1 < len(x) else [])
        for other, place in [(k, -1) for k in before] + [(n, 0)] + [(k, 1) for k in after]:
            if place == 0:
                at.append(x[n])
                value.append(y[n])
            elif np.isfinite(y[other]) and not beyond[other]:
                at.append(float(np.sqrt(x[n] * x[other])) if log else 0.5 * (x[n] + x[other]))
                value.append(0.5 * (y[n] + y[other]))
        if n + 1 == len(x) or not (beyond[n + 1] and np.isfinite(y[n + 1])):
            at.append(x[n])
            value.append(np.nan)
    return at, value


def draw_lines(ax: Any, data: xarray.Dataset, metric: str, height: float, with_key: bool = True) -> None:
    """A metric over one axis of numbers, a curve for each combination of the other axes' values."""
    along, curves = axes_of_sweep(data)
    if len(along) != 1:
        raise refused("data", f"curves need one axis of numbers, this sweep has {len(along)}; contours take two")
    axis = along[0]
    values, name, unit = metric_values(data, metric)
    order = np.argsort(axis.values)
    x = axis.values[order]
    log = scale_of(axis.values) == "log"
    names = [curve.dimension for curve in curves]
    table = values.transpose(*names, axis.dimension).values
    domain = data["domain"].transpose(*names, axis.dimension).values
    left = idle = False
    for at in np.ndindex(*table.shape[:-1]):
        y, beyond = table[at][order], domain[at][order] != 0
        if beyond.any():
            left = True
            ax.plot(*_outside(x, y, beyond, log), color=OUTSIDE_BAND, linewidth=6, solid_capstyle="butt", zorder=1)
        idle = idle or bool(np.isnan(y).any())
        alone = np.isfinite(y) & np.isnan(np.r_[np.nan, y[:-1]]) & np.isnan(np.r_[y[1:], np.nan])
        look = _look(curves, at)
        ax.plot(x, y, label=", ".join(curve.value(n) for curve, n in zip(curves, at)), zorder=2, **look)
        ax.plot(x[alone], y[alone], marker="o", markersize=2, linestyle="", color=look["color"], zorder=2)
    if log:
        ax.set_xscale("log")
    ax.set_xlim(x[0], x[-1]) if len(x) > 1 else None
    finite = table[np.isfinite(table)]
    if finite.size and 0.0 <= finite.min() < 0.6 * finite.max():
        ax.set_ylim(bottom=0.0)
    ax.set_xlabel(axis.label)
    label_y(ax, named(name, unit), height)
    entries = [line for line in ax.get_lines() if not line.get_label().startswith("_")] if curves else []
    if left:
        entries.append(Line2D([], [], color=OUTSIDE_BAND, linewidth=6, label="outside the model's domain"))
    if idle:
        entries.append(Line2D([], [], linestyle="", label="no line: does not flap"))
    if with_key and entries:
        key(ax, entries)


def _levels(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    finite = values[np.isfinite(values)]
    least, most = float(finite.min()), float(finite.max())
    if not most > least:
        least, most = least - 1e-3 * max(abs(least), 1.0), most + 1e-3 * max(abs(most), 1.0)
    levels: npt.NDArray[np.float64] = MaxNLocator(9).tick_values(least, most)
    return levels


def draw_contours(ax: Any, data: xarray.Dataset, metric: str) -> None:
    """A metric over two axes of numbers: grey where nothing flaps, hatched outside the domain, dashed where the lift is
    the weight."""
    along, curves = axes_of_sweep(data)
    if len(along) != 2 or any(len(curve.values) > 1 for curve in curves):
        raise refused("data", "contours need two axes of numbers and nothing else; select the rest with data.sel(...)")
    across, up = along
    values, name, unit = metric_values(data, metric)
    orders = np.argsort(across.values), np.argsort(up.values)
    x, y = across.values[orders[0]], up.values[orders[1]]

    def gridded(array: xarray.DataArray) -> npt.NDArray[np.float64]:
        picked = array.isel({curve.dimension: 0 for curve in curves}).transpose(up.dimension, across.dimension)
        grid: npt.NDArray[np.float64] = picked.values[np.ix_(orders[1], orders[0])].astype(float)
        return grid

    grid = gridded(values)
    entries: list[Any] = []
    ax.set_facecolor(IDLE)
    if np.isfinite(grid).any():
        filled = ax.contourf(x, y, grid, levels=_levels(grid))
        # Within the axes, so that they keep their place and any layout of the figure will do.
        bar = ax.figure.colorbar(filled, cax=ax.inset_axes([1.02, 0.0, 0.03, 1.0]))
        bar.outline.set_visible(False)
        pinned(bar.ax).tick_params(length=0)
    if np.isnan(grid).any():
        entries.append(Patch(facecolor=IDLE, label="does not flap"))
    beyond = gridded(data["domain"] != 0)
    if beyond.any():
        ax.contourf(x, y, beyond, levels=[0.5, 1.5], colors="none", hatches=["////"])
        ax.contour(x, y, beyond, levels=[0.5], colors=BOUNDARY, linewidths=0.7)
        entries.append(Patch(facecolor="none", edgecolor=BOUNDARY, hatch="////", label="outside the model's domain"))
    weight = DataSet(data).lift_to_weight if "lift_to_weight" in data else None
    if weight is not None:
        lifted = np.nan_to_num(gridded(weight.where(status_of(data) == "flapping")))
        if (lifted >= 1.0).any() and (lifted < 1.0).any():
            ax.contour(x, y, lifted, levels=[1.0], colors="white", linewidths=2.4)
            ax.contour(x, y, lifted, levels=[1.0], colors="black", linewidths=1.1, linestyles=[(0, (5, 2))])
            entries.append(Line2D([], [], color="black", linewidth=1.1, linestyle=(0, (5, 2)), label="lift = weight"))
    for which, axis in (("x", across), ("y", up)):
        if scale_of(axis.values) == "log":
            getattr(ax, f"set_{which}scale")("log")
    ax.set_xlabel(across.label)
    label_y(ax, up.label)
    for side in ("top", "right"):
        ax.spines[side].set_visible(True)
    ax.set_title(named(name, unit))
    if entries:
        # Above stands what the panel shows.
        key(ax, entries, below=True)


def lines(
    data: xarray.Dataset, metric: str, *, ax: Axes | None = None, width: float | str = "89 mm"
) -> Axes:
    """A metric of a sweep over its axis of numbers, a curve for each combination of its other axes.

    The colour of a curve shows springs, condition or an ordered number, its dash the formulation. A grey band marks
    designs outside the model's domain; there is no line if the vehicle does not flap.

    Parameters
    ----------
    data : xarray.Dataset
        The data set of a sweep.
    metric : str
        The name of a metric.
    ax : matplotlib Axes, optional
        The Axes to draw into; default: those of a new figure.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Axes
        A curve for each combination of the other axes.

    Raises
    ------
    InputError
        For a metric that the data set does not have, and for a sweep of no or of several axes of numbers.

    Examples
    --------
    >>> import wingbeat.plot
    >>> vehicle = wb.read("friction2022-springs")
    >>> data = vehicle.sweep({"supply.voltage": [2, 3, 4], "springs": [True, False]})
    >>> wingbeat.plot.lines(data, "lift_mean").get_ylabel()
    'mean lift (mN)'
    """
    with styled():
        ax = axes_of(ax, width, 2.2)
        draw_lines(ax, data, metric, 1.6)
    return ax


def trends(
    data: xarray.Dataset, metrics: Iterable[str], *, figure: Figure | None = None, width: float | str = "89 mm"
) -> Figure:
    """Several metrics of a sweep over the same axis of numbers, a panel each: see `wingbeat.plot.lines`.

    Parameters
    ----------
    data : xarray.Dataset
        The data set of a sweep.
    metrics : list of str
        Names of metrics.
    figure : matplotlib Figure, optional
        The Figure or SubFigure to draw into; default: a new one.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Figure
        A panel for each metric.

    Raises
    ------
    InputError
        For a metric that the data set does not have, and for a sweep of no or of several axes of numbers.

    Examples
    --------
    >>> import wingbeat.plot
    >>> data = wb.read("friction2022").sweep({"supply.voltage": [2, 3, 4]})
    >>> len(wingbeat.plot.trends(data, ["lift_mean", "efficiency_system"]).axes)
    2
    """
    rows = [metrics] if isinstance(metrics, str) else list(metrics)
    if not rows:
        raise refused("metrics", "expected at least one")
    with styled():
        figure, axes = panels_of(figure, width, len(rows), 1.5)
        for n, (ax, metric) in enumerate(zip(axes, rows)):
            draw_lines(ax, data, metric, 1.2, with_key=n == 0)
            if n + 1 < len(rows):
                ax.set_xlabel("")
        figure.align_ylabels(axes)
    return figure


def contours(
    data: xarray.Dataset, metric: str, *, ax: Axes | None = None, width: float | str = "89 mm"
) -> Axes:
    """A metric of a sweep over its two axes of numbers, with a colour bar.

    Designs that do not flap are grey, designs outside the model's domain hatched; a dashed line marks a lift equal to
    the weight.

    Parameters
    ----------
    data : xarray.Dataset
        The data set of a sweep.
    metric : str
        The name of a metric.
    ax : matplotlib Axes, optional
        The Axes to draw into; default: those of a new figure.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Axes
        The Axes, with a colour bar.

    Raises
    ------
    InputError
        For a metric that the data set does not have, and for a sweep of other than two axes of numbers.

    Examples
    --------
    >>> import wingbeat.plot
    >>> axes = {"supply.voltage": [2, 3, 4], "transmission.crank_radius": ["5 mm", "6 mm"]}
    >>> data = wb.read("friction2022").sweep(axes)
    >>> wingbeat.plot.contours(data, "lift_mean").get_xlabel()
    'supply voltage (V)'
    """
    with styled():
        ax = axes_of(ax, width, 2.6)
        draw_contours(ax, data, metric)
    return ax
