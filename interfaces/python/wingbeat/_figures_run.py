"""Figures of single vehicles, for wingbeat.plot."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import refused, wrong_type
from ._figures import (
    COLOURS, FIRST, REFERENCE, SECOND, SOLID, axes_of, display, key, label_y, largest, named, panels_of, pinned,
    styled,
)
from ._result import EnergyBalance, RunResult, StartUp
from ._studies import Flight

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def cycle(result: RunResult, *, figure: Figure | None = None, width: float | str = "89 mm") -> Figure:
    """The waveforms of one flapping cycle: motion, lift, rod force or current, powers; pitch of wings on hinges.

    Parameters
    ----------
    result : RunResult
        A RunResult that flaps.
    figure : matplotlib Figure, optional
        The Figure or SubFigure to draw into; default: a new one.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Figure
        A panel for each quantity over the time since stroke reversal.

    Raises
    ------
    ValueError
        If the vehicle does not flap.

    Examples
    --------
    >>> import wingbeat.plot
    >>> figure = wingbeat.plot.cycle(wb.read("friction2022").solve())
    >>> [ax.get_ylabel() for ax in figure.axes[1:4]]
    ['lift (mN)', 'rod force (mN)', 'power (mW)']
    """
    if not isinstance(result, RunResult):
        raise wrong_type("result", "a wingbeat.RunResult", result)
    waves = result.cycle
    order, time = _since_reversal(waves)
    scale, unit = display("s", float(np.abs(time).max()))

    def wave(name: str) -> Any:
        return waves[name].values[order]

    pitching = "pitch_angle" in waves and bool(np.isfinite(waves.pitch_angle.values).all())
    rod = "rod_force" in waves and bool(np.isfinite(waves.rod_force.values).all())
    force = ("rod_force", "rod force") if rod else ("current", "current")
    with styled():
        figure, axes = panels_of(figure, width, 5 if pitching else 4, 1.15)
        panels = iter(axes)

        def panel(name: str, *curves: tuple[str, str, Mapping[str, Any]]) -> Any:
            ax = next(panels)
            factors: dict[str, float] = {}
            for unit in {waves[column].attrs["units"] for column, _, _ in curves}:
                own = [largest(wave(column)) for column, _, _ in curves if waves[column].attrs["units"] == unit]
                factors[unit], shown = display(unit, max(own))
            for column, label, look in curves:
                ax.plot(scale * time, factors[waves[column].attrs["units"]] * wave(column), label=label, **look)
            label_y(ax, named(name, shown), 1.0)
            return ax

        ax = panel("stroke angle", ("stroke_angle", "stroke angle", FIRST))
        right = pinned(ax.twinx())
        right.plot(scale * time, wave("flapping_velocity"), label="flapping velocity (right)", **SECOND)
        right.spines["right"].set_visible(True)
        label_y(right, "velocity (rad/s)", 1.0)
        key(ax, [*ax.get_lines(), *right.get_lines()])
        if pitching:
            curves = [("pitch_angle", "pitch angle", FIRST), ("angle_of_attack", "angle of attack", SECOND)]
            key(panel("pitch", *curves))
        ax = panel("lift", ("lift", "lift of all wings", FIRST))
        factor, shown = display("N", largest(waves.lift.values))
        mean = factor * float(np.trapz(waves.lift.values, waves.time.values)) / float(waves.time[-1] - waves.time[0])
        ax.axhline(mean, label=f"mean, {mean:.4g} {shown}", **REFERENCE)
        key(ax)
        panel(force[1], (*force, FIRST))
        key(panel("power", ("power_electrical", "electrical", FIRST), ("power_motor", "motor output", SECOND),
                  ("power_aerodynamic", "aerodynamic", {"color": COLOURS["aerodynamic"], "linestyle": SOLID})))
        axes[-1].set_xlabel(named("time since stroke reversal", unit))
        axes[-1].set_xlim(scale * time[0], scale * time[-1])
        figure.align_ylabels(axes)
    return figure


def _since_reversal(waves: xarray.Dataset) -> tuple[Any, Any]:
    """Rows of a cycle in the order in which they are drawn, and their times since stroke reversal (the least stroke
    angle): from -1/8 to 7/8 of a period, so that nothing has its peak at the edge."""
    time, angle = waves.time.values, waves.stroke_angle.values
    period = time[-1] - time[0]
    since = ((time[:-1] - time[np.argmin(angle)]) / period + 0.125) % 1.0 - 0.125
    order = np.argsort(since)
    return np.r_[order, order[0]], period * np.r_[since[order], since[order[0]] + 1.0]


#: Parts of the input as they follow each other in a bar: field of EnergyBalance, name, colour.
_PARTS = (
    ("electronics", "electronics", "electronics"), ("copper", "copper", "copper"), ("viscous", "viscous", "viscous"),
    ("motor_friction", "motor friction", "motor_friction"), ("gear", "gearbox", "gearbox"),
    ("hinge", "hinges", "hinges"), ("friction", "friction", "friction"), ("aerodynamic", "aerodynamic", "aerodynamic"),
    ("residual", "residual", "residual"),
)


def power_flow(
    results: RunResult | Mapping[str, RunResult], *, ax: Axes | None = None, width: float | str = "89 mm"
) -> Axes:
    """The power balance, a bar for each result.

    Parameters
    ----------
    results : RunResult or dict
        A RunResult that flaps; or a dict of several, by the names of their bars.
    ax : matplotlib Axes, optional
        The Axes to draw into; default: those of a new figure.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Axes
        A bar for each result.

    Raises
    ------
    ValueError
        If any of them does not flap.

    Notes
    -----
    A negative residual of the formulation is drawn left of zero.

    Examples
    --------
    >>> import wingbeat.plot
    >>> vehicle = wb.read("friction2022")
    >>> ax = wingbeat.plot.power_flow({"3 V": vehicle.solve(voltage=3), "4 V": vehicle.solve(voltage=4)})
    >>> [label.get_text() for label in ax.get_yticklabels()]
    ['3 V', '4 V']
    """
    many = results if isinstance(results, Mapping) else {"": results}
    bars: dict[str, EnergyBalance] = {}
    for name, result in many.items():
        if not isinstance(result, RunResult):
            raise wrong_type("results", "a wingbeat.RunResult, or a dict of such", result)
        balance = result.energy_balance
        if balance is None:
            raise ValueError(f"there is no energy balance: {result.evidence}")
        bars[str(name)] = balance
    if not bars:
        raise refused("results", "expected at least one")
    factor, unit = display("W", max(balance.electrical for balance in bars.values()))
    with styled():
        ax = axes_of(ax, width, 0.75 + 0.32 * len(bars))
        rows = np.arange(len(bars))
        right, left = np.zeros(len(bars)), np.zeros(len(bars))
        for field, name, colour in _PARTS:
            power = factor * np.array([getattr(balance, field) for balance in bars.values()])
            if not power.any():
                continue
            start = np.where(power >= 0.0, right, left)
            ax.barh(rows, power, left=start, height=0.6, color=COLOURS[colour], label=name)
            right, left = right + np.maximum(power, 0.0), left + np.minimum(power, 0.0)
        for row, balance in zip(rows, bars.values()):
            ax.annotate(f"{factor * balance.electrical:.4g} {unit}", (right[row], row), xytext=(3, 0),
                        textcoords="offset points", va="center")
        ax.set_xlim(min(0.0, 1.05 * float(left.min())), 1.22 * float(right.max()))
        ax.set_yticks(rows, ["\n".join(textwrap.wrap(name, 20)) for name in bars])
        ax.tick_params(axis="y", length=0)
        ax.spines["left"].set_visible(False)
        ax.invert_yaxis()
        ax.set_xlabel(named("power", unit))
        key(ax, room=0.8 if list(bars) == [""] else 0.6)
    return ax


def start_up(start: StartUp, *, figure: Figure | None = None, width: float | str = "89 mm") -> Figure:
    """Crank speed and current over a start-up, with the inrush current and the time to steady flapping.

    Parameters
    ----------
    start : StartUp
        The result of `wingbeat.simulate`.
    figure : matplotlib Figure, optional
        The Figure or SubFigure to draw into; default: a new one.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Figure
        A panel for the speed and one for the current.

    Raises
    ------
    TypeError
        For another kind of result.

    Examples
    --------
    >>> import wingbeat.plot
    >>> figure = wingbeat.plot.start_up(wb.read("friction2022").simulate())
    >>> [ax.get_ylabel() for ax in figure.axes]
    ['crank speed (rad/s)', 'current (mA)']
    """
    if not isinstance(start, StartUp):
        raise wrong_type("start", "a wingbeat.StartUp", start)
    samples = start.samples
    scale, unit = display("s", largest(samples.time.values))
    factor, ampere = display("A", largest(samples.current.values))
    with styled():
        figure, (speed, current) = panels_of(figure, width, 2, 1.4)
        speed.plot(scale * samples.time, samples.crank_speed, **FIRST)
        current.plot(scale * samples.time, factor * samples.current, **FIRST)
        inrush = f"inrush, {factor * start.inrush_current:.4g} {ampere}"
        current.plot(scale * start.inrush_current_time, factor * start.inrush_current, "o", fillstyle="none",
                     color=COLOURS["ink"], label=inrush)
        if start.settled:
            what = "steady" if start.status == "flapping" else "at rest"
            label = f"{what} after {scale * start.time_to_steady:.3g} {unit}"
            for ax in (speed, current):
                ax.axvline(scale * start.time_to_steady, label=label if ax is speed else None, **REFERENCE)
        label_y(speed, "crank speed (rad/s)", 1.3)
        label_y(current, named("current", ampere), 1.3)
        current.set_xlabel(named("time since switching on", unit))
        current.set_xlim(0.0, scale * largest(samples.time.values))
        for ax in (speed, current):
            if ax.get_legend_handles_labels()[0]:
                key(ax)
        figure.align_ylabels([speed, current])
    return figure


def flight(found: Flight, *, figure: Figure | None = None, width: float | str = "89 mm") -> Figure:
    """Lift, powers, voltage and charge over a flight to the end of the battery, hatched outside the model's domain.

    Parameters
    ----------
    found : Flight
        The result of `wingbeat.endurance`.
    figure : matplotlib Figure, optional
        The Figure or SubFigure to draw into; default: a new one.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Figure
        A panel for each quantity.

    Raises
    ------
    ValueError
        If the vehicle does not flap.

    Examples
    --------
    >>> import wingbeat.plot
    >>> figure = wingbeat.plot.flight(wb.read("friction2022-battery").endurance())
    >>> figure.axes[-1].get_ylabel()
    'charge (%)'
    """
    if not isinstance(found, Flight):
        raise wrong_type("found", "a wingbeat.Flight", found)
    history = found["history"]
    if not history or len(history["time_s"]) < 2:
        raise ValueError(f"there is no flight: {found['status']}")

    def column(name: str) -> Any:
        return np.array(history[name], dtype=float)

    scale, unit = (1.0 / 60.0, "min") if history["time_s"][-1] >= 120.0 else (1.0, "s")
    time = scale * column("time_s")
    lift, ratio = column("lift_mean_n"), column("lift_to_weight")
    weight = float(lift[0] / ratio[0]) if np.isfinite(ratio[0]) and ratio[0] > 0.0 else None
    hover = found["hover_s"]
    lost = hover if hover and hover < history["time_s"][-1] else None
    air = {"color": COLOURS["aerodynamic"], "linestyle": SOLID}
    with styled():
        figure, axes = panels_of(figure, width, 4, 1.1)
        factor, newton = display("N", largest([largest(lift), weight or 0.0]))
        axes[0].plot(time, factor * lift, label="mean lift", **FIRST)
        if weight is not None:
            axes[0].axhline(factor * weight, label=f"weight, {factor * weight:.4g} {newton}", **REFERENCE)
        factor, watt = display("W", largest(column("power_electrical_w")))
        axes[1].plot(time, factor * column("power_electrical_w"), label="electrical", **FIRST)
        axes[1].plot(time, factor * column("power_aerodynamic_w"), label="aerodynamic", **air)
        axes[2].plot(time, column("terminal_voltage_v"), label="terminals", **FIRST)
        axes[2].plot(time, column("open_circuit_voltage_v"), label="open circuit", **SECOND)
        axes[3].plot(time, 100.0 * column("charge"), label="state of charge", **FIRST)
        beyond = np.array([domain != "inside" for domain in history["domain"]])
        for ax, label in zip(axes, (named("lift", newton), named("power", watt), "voltage (V)", "charge (%)")):
            ax.set_ylim(bottom=0.0)
            if lost is not None:
                ax.axvline(scale * lost, color=COLOURS["grey"], linestyle=":", linewidth=0.7,
                           label="hover lost" if ax is axes[0] else None)
            if beyond.any():
                ax.fill_between(time, 0, 1, where=beyond, transform=ax.get_xaxis_transform(), facecolor="none",
                                edgecolor="#909090", hatch="////", linewidth=0.0, zorder=0,
                                label="outside the model's domain" if ax is axes[3] else None)
            label_y(ax, label, 1.0)
            key(ax)
        axes[3].set_xlabel(named("time", unit))
        axes[3].set_xlim(0.0, time[-1])
        figure.align_ylabels(axes)
    return figure
