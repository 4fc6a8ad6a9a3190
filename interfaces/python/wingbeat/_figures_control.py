"""Figures of models for control, for wingbeat.plot."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import refused, wrong_type
from ._figures import CURVES, REFERENCE, display, key, label_y, named, panels_of, styled
from ._linear import ControlModels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SHOWN = ("lift_mean", "crank_speed_mean", "power_electrical")


def _outputs_of(models: ControlModels, outputs: Iterable[str] | None) -> list[int]:
    """Where the outputs stand in the model."""
    if not isinstance(models, ControlModels):
        raise wrong_type("models", "a wingbeat.ControlModels", models)
    known = models.discrete.outputs
    if outputs is None:
        return [known.index(name) for name in _SHOWN if name in known]
    wanted = [outputs] if isinstance(outputs, str) else list(outputs)
    for name in wanted:
        if name not in known:
            raise refused("outputs", f"the model has no output {name!r}; it has {', '.join(known)}")
    return [known.index(name) for name in wanted]


def step(
    models: ControlModels, outputs: Iterable[str] | None = None, *, figure: Figure | None = None,
    width: float | str = "89 mm",
) -> Figure:
    """Step responses of the means of a cycle to each input, relative to the steady change or, without one, the largest.

    Parameters
    ----------
    models : ControlModels
        The result of `wingbeat.linearise`.
    outputs : list of str, optional
        Names of outputs; default: lift, crank speed and electrical power.
    figure : matplotlib Figure, optional
        The Figure or SubFigure to draw into; default: a new one.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Figure
        A panel for each input.

    Raises
    ------
    InputError
        For an output that the model does not have.
    ValueError
        If the vehicle does not flap.

    Examples
    --------
    >>> import wingbeat.plot
    >>> figure = wingbeat.plot.step(wb.read("friction2022").linearise(maps=False))
    >>> figure.axes[1].get_xlabel(), [line.get_label() for line in figure.axes[0].get_lines()[:2]]
    ('time since the step (ms)', ['lift mean', 'crank speed mean'])
    """
    places = _outputs_of(models, outputs)
    model, discrete = models["model"], models.discrete
    period = float(model["period_s"])
    drawn = {name: _relative(models, n, places) for n, name in enumerate(discrete.inputs)}
    cycles = max(_settled(relative) for relative, _ in drawn.values())
    scale, unit = (1.0, "s") if period * cycles > 2.0 else (1e3, "ms")
    # As the means are: constant over their cycle, from the cycle before the step on.
    time = scale * period * np.arange(-1, cycles + 1)
    with styled():
        figure, axes = panels_of(figure, width, len(discrete.inputs), 1.4)
        for n, (ax, name) in enumerate(zip(axes, discrete.inputs)):
            relative, steady = drawn[name]
            for k, place in enumerate(places):
                curve = np.r_[0.0, relative[k, :cycles], relative[k, cycles - 1]]
                name_of_output = discrete.outputs[place].replace("_", " ")
                ax.step(time, curve, where="post", label=name_of_output, **CURVES[k % len(CURVES)])
            ax.axhline(1.0 if steady else 0.0, zorder=0, **REFERENCE)
            label_y(ax, "per steady change" if steady else "per largest change", 1.3)
            if n == 0:
                key(ax, ax.get_lines()[:-1])
            ax.annotate(f"step of {name.replace('_', ' ')}", (1.0, 0.06 if steady else 0.94), ha="right",
                        xycoords="axes fraction", va="bottom" if steady else "top")
        axes[-1].set_xlabel(named("time since the step", unit))
        figure.align_ylabels(axes)
    return figure


def _relative(models: ControlModels, column: int, places: list[int]) -> tuple[Any, bool]:
    """Responses of outputs to a step of an input, a row each, and whether they are over the steady changes."""
    model, discrete = models["model"], models.discrete
    responses = model["step_responses"][discrete.inputs[column]]
    gains = [float(model["steady_gain"][place][column]) for place in places]
    rows = np.array([responses[discrete.outputs[place]] for place in places], dtype=float)
    steady = all(gains)
    scales = np.array(gains) if steady else np.abs(rows).max(axis=1)
    return rows / np.where(scales == 0.0, 1.0, scales)[:, None], steady


def _settled(relative: Any) -> int:
    """Cycles that show responses until they have settled to 2 %, and two more."""
    moving = np.flatnonzero(np.abs(relative - relative[:, -1:]).max(axis=0) > 0.02)
    last = int(moving[-1]) if moving.size else 0
    return min(max(last + 3, 3), int(relative.shape[1]))


def bode(
    models: ControlModels, input: str = "voltage", outputs: Iterable[str] | None = None, *,
    figure: Figure | None = None, width: float | str = "89 mm",
) -> Figure:
    """The frequency response of the discrete model, up to half the flapping frequency.

    Parameters
    ----------
    models : ControlModels
        The result of `wingbeat.linearise`.
    input : str, default 'voltage'
        The name of an input of the model.
    outputs : list of str, optional
        Names of outputs; default: lift, crank speed and electrical power.
    figure : matplotlib Figure, optional
        The Figure or SubFigure to draw into; default: a new one.
    width : float or str, default "89 mm"
        Width of a new figure [m], or a text with a unit: "89 mm" is a column of a journal, "183 mm" two.

    Returns
    -------
    matplotlib Figure
        Gain over the steady gain [dB] and phase [deg] over frequency.

    Raises
    ------
    InputError
        For an input or output that the model does not have, and for outputs without a steady gain.
    ValueError
        If the vehicle does not flap.

    Examples
    --------
    >>> import wingbeat.plot
    >>> figure = wingbeat.plot.bode(wb.read("friction2022").linearise(maps=False))
    >>> figure.axes[1].get_ylabel()
    'phase (deg)'
    """
    places = _outputs_of(models, outputs)
    model = models.discrete
    if input not in model.inputs:
        raise refused("input", f"the model has no input {input!r}; it has {', '.join(model.inputs)}")
    column, period = model.inputs.index(input), float(model.dt or 0.0)
    steady = [float(models["model"]["steady_gain"][place][column]) for place in places]
    moving = [k for k, gain in enumerate(steady) if gain]
    if not moving:
        raise refused("outputs", f"none of them follows a steady {input.replace('_', ' ')}")
    frequency = np.geomspace(1e-3, 0.5, 200) / period
    response = _frequency_response(model, column, frequency)
    with styled():
        figure, (gain, phase) = panels_of(figure, width, 2, 1.4)
        for n, k in enumerate(moving):
            relative = response[:, places[k]] / steady[k]
            look = CURVES[n % len(CURVES)]
            name_of_output = model.outputs[places[k]].replace("_", " ")
            gain.plot(frequency, 20.0 * np.log10(np.abs(relative)), label=name_of_output, **look)
            phase.plot(frequency, np.degrees(np.unwrap(np.angle(relative))), **look)
        gain.set_xscale("log")
        phase.set_xscale("log")
        phase.set_xlim(frequency[0], frequency[-1])
        label_y(gain, "gain over steady gain (dB)", 1.3)
        label_y(phase, "phase (deg)", 1.3)
        phase.set_xlabel(f"frequency of the {input.replace('_', ' ')} (Hz)")
        key(gain)
        figure.align_ylabels([gain, phase])
    return figure


def _frequency_response(model: Any, column: int, frequency: Any) -> Any:
    """C (z I - A)^-1 B + D of one input on the unit circle, a row for each frequency."""
    z = np.exp(2j * np.pi * frequency * model.dt)
    inverse = np.linalg.inv(z[:, None, None] * np.eye(len(model.states)) - model.A)
    return np.einsum("os,fst,t->fo", model.C, inverse, model.B[:, column]) + model.D[:, column]
