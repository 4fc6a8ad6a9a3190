"""What the figures of wingbeat.plot share: the style, colours by meaning, panels, keys, units."""

from __future__ import annotations

import pathlib
import textwrap
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ._arguments import number, refused
from ._quantity import Quantity
from ._tables import Metric, metric_called, metric_rows, parameters

try:
    import matplotlib
    import matplotlib.pyplot as plt
    from matplotlib.figure import Figure
    from matplotlib.transforms import ScaledTranslation
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        "wingbeat.plot needs matplotlib, which is not installed: install Debian's package python3-matplotlib, or run "
        "pip install matplotlib",
        name=error.name,
    ) from None

if TYPE_CHECKING:
    import numpy.typing as npt

#: The style file.
STYLE = str(pathlib.Path(__file__).with_name("figure.mplstyle"))
#: Widths of a printed figure: one column and two columns of a journal.
SINGLE_COLUMN = Quantity(0.089, "m", "width of a column")
DOUBLE_COLUMN = Quantity(0.183, "m", "width of two columns")
#: By meaning, as src/report/style.hpp has them.
COLOURS: dict[str, str] = {
    "with_springs": "#0072b2",
    "without_springs": "#d55e00",
    "copper": "#e69f00",
    "viscous": "#f0e442",
    "motor_friction": "#882255",
    "gearbox": "#009e73",
    "hinges": "#8c6d46",
    "electronics": "#5f6b7a",
    "friction": "#cc79a7",
    "residual": "#bbbbbb",
    "aerodynamic": "#56b4e9",
    "ink": "#000000",
    "grey": "#707070",
    "outside_domain": "#a0a0a0",
    "in_air": "#000000",
    "in_vacuum": "#44aa99",
    "without_wings": "#999933",
}
#: An ordered quantity, small to large.
ORDERED = ("#b79fd0", "#8d68b5", "#653a92", "#35125e")
#: Between the formulations the dash decides, never the colour; in points at a line width of 1.
SOLID: Any = "-"
DASHED, DOTTED, DASH_DOTTED = (0, (4, 2)), (0, (1, 1.5)), (0, (5, 1.5, 1, 1.5))
#: Curves that have no meaning of their own, distinguished by grey and dash, and a value to compare with.
FIRST = {"color": COLOURS["ink"], "linestyle": SOLID}
SECOND = {"color": COLOURS["grey"], "linestyle": DASHED}
THIRD = {"color": COLOURS["ink"], "linestyle": DOTTED}
REFERENCE = {"color": COLOURS["grey"], "linestyle": DASH_DOTTED, "linewidth": 0.7}
CURVES = (FIRST, SECOND, THIRD, {"color": COLOURS["grey"], "linestyle": DASH_DOTTED})

_PREFIXES = ((1e-9, "n"), (1e-6, "µ"), (1e-3, "m"), (1.0, ""), (1e3, "k"))

Drawn = TypeVar("Drawn", bound=Callable[..., Any])


class Drawing(Figure):  # type: ignore[misc]
    """A Figure that a notebook shows once, also where it is the value of a cell."""

    def _ipython_display_(self) -> None:
        # The inline backend shows what is still open at the end of a cell once more.
        if "inline" in plt.get_backend():
            plt.close(self)
        raise NotImplementedError  # by which IPython displays it as any other Figure


@contextmanager
def styled() -> Iterator[None]:
    """The style, for what is drawn within."""
    interactive = plt.isinteractive()
    try:
        with plt.style.context(STYLE, after_reset=True):
            yield
            # A backend that is loaded by the first figure, as in a notebook, decides it for those that follow.
            interactive = plt.isinteractive()
    finally:
        matplotlib.interactive(interactive)


def display(unit: str, largest: float, efficiency: bool = False) -> tuple[float, str]:
    """What SI values are multiplied by for the eye, and the unit then, as the program's figures choose them."""
    if efficiency:
        return 100.0, "%"
    if unit in ("1", ""):
        return 1.0, ""
    if unit in ("rad", "degree"):
        return (float(np.degrees(1.0)) if unit == "rad" else 1.0), "deg"
    simple = unit.startswith("N m") or not any(c in " /0123456789" for c in unit)
    if not simple or unit in ("Hz", "V") or not largest > 0.0:
        return 1.0, typeset(unit)
    if unit == "kg":
        return 1e3, "g"
    size, prefix = max((p for p in _PREFIXES if largest >= 0.9999 * p[0]), default=_PREFIXES[0])
    return 1.0 / size, prefix + typeset(unit)


def typeset(unit: str) -> str:
    """A unit with superscripts: "kg m²"."""
    for digit, raised in (("2", "²"), ("3", "³")):
        unit = unit.replace("-" + digit, "⁻" + raised).replace("m" + digit, "m" + raised)
        unit = unit.replace("s" + digit, "s" + raised)
    return unit


def named(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit else name


def largest(values: Any) -> float:
    finite = np.abs(np.asarray(values, dtype=float))
    finite = finite[np.isfinite(finite)]
    return float(finite.max()) if finite.size else 0.0


def metric_row(metric: str) -> Metric:
    return metric_rows[metric_called(metric)]


def metric_display(row: Metric, values: Any) -> tuple[float, str]:
    return display(row.unit, largest(values), row.name.startswith("efficiency"))


def words(key: str) -> str:
    """A key of the vehicle in words; with its section where the last word alone says too little."""
    above, _, leaf = key.rpartition(".")
    if not above:
        return leaf.replace("_", " ")
    if "_" in leaf and sum(other.rpartition(".")[2] == leaf for other in parameters) == 1:
        return leaf.replace("_", " ")
    return f"{above.rpartition('.')[2]} {leaf}".replace("_", " ")


def inches(width: float | str) -> float:
    """A width [m] in inches."""
    metres = number("width", width, "m")
    if not 0.04 <= metres <= 1.0:
        hint = '; with its unit it is a text such as "89 mm"'
        given = str(width) if isinstance(width, str) else f"{float(width):g} m{hint}"
        raise refused("width", f"must be from 40 to 1000 mm, got {given}")
    return metres / 0.0254


def pinned(ax: Any) -> Any:
    """Axes of which ticks that come later, when they are drawn, have this style as well."""
    for axis in ("x", "y"):
        given = {name: plt.rcParams[f"{axis}tick.{name}"] for name in ("labelsize", "direction")}
        given |= {"width": plt.rcParams[f"{axis}tick.major.width"], "length": plt.rcParams[f"{axis}tick.major.size"]}
        ax.tick_params(axis=axis, **given)
    return ax


def axes_of(ax: Any, width: float | str, height: float) -> Any:
    """The axes given, or those of a new figure, of which the height is in inches."""
    if ax is None:
        return pinned(plt.figure(figsize=(inches(width), height)).subplots())
    if not hasattr(ax, "plot") or not hasattr(ax, "figure"):
        raise TypeError(f"ax: expected matplotlib Axes, got {type(ax).__name__}")
    return ax


def panels_of(figure: Any, width: float | str, count: int, height: float, shared: bool = True) -> tuple[Any, list[Any]]:
    """The figure given, or a new one, and its panels one above the other, each of a height in inches."""
    if figure is None:
        figure = plt.figure(figsize=(inches(width), count * height + 0.3), FigureClass=Drawing)
    elif not hasattr(figure, "subplots"):
        raise TypeError(f"figure: expected a matplotlib Figure, got {type(figure).__name__}")
    axes = figure.subplots(count, 1, sharex=shared, squeeze=False)[:, 0]
    return figure, [pinned(ax) for ax in axes]


def label_y(ax: Any, text: str, height: float = 1.0) -> None:
    """The name of a vertical axis, in lines that a panel of that height [in] has room for."""
    ax.set_ylabel("\n".join(textwrap.wrap(text, max(10, int(height / 0.068)))))


def key(ax: Any, entries: Sequence[Any] | None = None, room: float = 0.8, below: bool = False) -> None:
    """The key above a panel, or below its horizontal axis, in as many columns as that part of the figure's width has
    room for."""
    handles = list(entries) if entries is not None else ax.get_legend_handles_labels()[0]
    renderer = ax.figure.canvas.get_renderer() if hasattr(ax.figure.canvas, "get_renderer") else None
    place: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0)}
    if below:
        moved = ax.transAxes + ScaledTranslation(0.0, -0.36, ax.figure.dpi_scale_trans)
        place = {"loc": "upper left", "bbox_to_anchor": (0.0, 0.0), "bbox_transform": moved}
    for columns in range(len(handles), 0, -1):
        legend = ax.legend(handles=handles, ncol=columns, **place)
        if renderer is None or legend.get_window_extent(renderer).width < room * ax.figure.bbox.width:
            break


def scale_of(values: npt.NDArray[np.float64]) -> str:
    """"log" for values in a geometric sequence over more than a factor of three."""
    ordered = np.sort(values)
    if len(ordered) < 3 or ordered[0] <= 0.0 or ordered[-1] < 3.0 * ordered[0]:
        return "linear"
    ratios = ordered[1:] / ordered[:-1]
    return "log" if np.allclose(ratios, ratios[0], rtol=1e-3) else "linear"
