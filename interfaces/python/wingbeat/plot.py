"""Figures of results with matplotlib, which you can edit.

    import wingbeat.plot
    figure = wingbeat.plot.cycle(vehicle.solve())       # a matplotlib Figure
    ax = wingbeat.plot.power_flow(result, width="183 mm")  # Axes of a new figure
    wingbeat.plot.lines(data, "lift_mean", ax=ax)       # or into Axes that are there

Functions of one panel take Axes as `ax` and return them; functions of several panels take a Figure or SubFigure as
`figure` and return it. Without one they make a figure of `width` ("89 mm") with matplotlib.pyplot; none calls
`plt.show()`. The style, also for figures of your own, is the file `style`: `plt.style.use(wingbeat.plot.style)`.
`colours` are the colours of the program's figures by meaning (`colours["copper"]`), `ordered` those of an ordered
quantity, `single_column` and `double_column` widths of 89 and 183 mm, as SI numbers with their unit.

Only this module needs matplotlib; `import wingbeat` does not import it.
"""

from collections.abc import Mapping

from ._figures import COLOURS, DOUBLE_COLUMN, ORDERED, SINGLE_COLUMN, STYLE
from ._figures_control import bode, step
from ._figures_run import cycle, flight, power_flow, start_up
from ._figures_studies import front, residuals, sensitivity, tolerance
from ._figures_sweep import contours, lines, trends
from ._quantity import Quantity

__all__ = [
    "bode", "colours", "contours", "cycle", "double_column", "flight", "front", "lines", "ordered", "power_flow",
    "residuals", "sensitivity", "single_column", "start_up", "step", "style", "tolerance", "trends",
]

#: The path of the style file.
style: str = STYLE
#: Colours of the program's figures by their meaning: "copper", "with_springs", ...
colours: Mapping[str, str] = COLOURS
#: Colours of an ordered quantity, small to large.
ordered: tuple[str, ...] = ORDERED
#: Widths of a figure: 89 and 183 mm [m].
single_column: Quantity = SINGLE_COLUMN
double_column: Quantity = DOUBLE_COLUMN
