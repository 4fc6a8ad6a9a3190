"""Pages of one parameter that varies, each case a curve: the best design, where the case flaps, what formulation and
springs change."""
import numpy

from study_pages import text
from study_pages.figures import lines_figure

statuses = ["flapping", "stalled", "locked", "jammed", "unreached", "invalid", "undecided"]
# What ends a range, in words.
ends = {"stalled": "it stalls", "locked": "the crank locks", "jammed": "it jams",
        "unreached": "the frequency cannot be held", "invalid": "the parameters are impossible",
        "undecided": "the start-up is undecided", "outside the model's domain": "the model's domain ends"}
# What keeps the best design from lying farther along the axis.
limits = {"the study ends": "the range of the study", "the model's domain ends": "the model's domain"}
near_best = 0.95  # of the best efficiency: the operating range

designers = ("This page, for designers of crank-driven flappers, repeats a trend of section 5 of the 2022 friction "
             "paper with the reference vehicle.")
own = ("This page is for designers of crank-driven flappers with hinge springs. The example is the reference vehicle "
       "of the 2022 friction paper.")
# study: axis, its name, factor and unit of the page, question, reader
studies = {
    "trend-crank-fixed-hinge": (
        "transmission_crank_radius", "crank radius", 1e3, "mm",
        "Which crank radius is most efficient at 3 V if the hinge offset stays, so that a longer crank makes a "
        "larger stroke?", designers),
    "trend-crank-fixed-stroke": (
        "transmission_crank_radius", "crank radius", 1e3, "mm",
        "Which crank radius is most efficient at 3 V if the hinge offset follows the crank, so that the stroke stays?",
        designers),
    "trend-rod": (
        "transmission_rod_length", "rod length", 1e3, "mm",
        "How long should the connecting rod be, at 3 V with the 5 mm crank? The mass of the rod is not included.",
        designers),
    "trend-voltage": (
        "supply_voltage", "supply voltage", 1.0, "V",
        "How do efficiency and lift depend on the supply voltage, for four crank radii?", designers),
    "trend-spring": (
        "spring_resonance", "resonance frequency", 1.0, "Hz",
        "To which resonance frequency should the springs tune the wings at 3 V, and from which frequency does the "
        "crank lock?", own),
    "trend-stiffness": (
        "spring_stiffness", "spring stiffness", 1e3, "mN m/rad",
        "How stiff should the springs at the wing hinges be at 3 V, and from which stiffness does the crank lock?",
        own),
    "trend-frequency": (
        "frequency", "flapping frequency", 1.0, "Hz",
        "At which flapping frequencies is the vehicle near its best efficiency? The voltage is found for each "
        "frequency.",
        "This page is for designers who choose the frequency at which a crank-driven flapper works. The reference "
        "vehicle of the 2022 friction paper is the example."),
}


class Curve:
    """One combination of the choices, along the study's axis."""

    def __init__(self, label, x, columns):
        self.label, self.x, self.columns = label, x, columns
        # A design outside the model's domain is left out, like one that does not flap.
        self.inside = columns["domain"] == 0
        self.efficiency = numpy.where(self.inside, columns["efficiency_system"], numpy.nan)
        self.flaps = numpy.isfinite(self.efficiency)
        self.best = int(numpy.nanargmax(self.efficiency)) if self.flaps.any() else None

    def within(self, fraction):
        """Ends of the run of designs around the best whose efficiency is at least that fraction of it."""
        low = high = self.best
        good = numpy.nan_to_num(self.efficiency, nan=-1.0) >= fraction * self.efficiency[self.best]
        while low > 0 and good[low - 1]:
            low -= 1
        while high + 1 < len(good) and good[high + 1]:
            high += 1
        return low, high

    def intervals(self):
        """Runs of designs that flap inside the domain: first and last design of each, and what lies below and above."""
        padded = numpy.concatenate(([False], self.flaps, [False])).astype(int)
        changes = numpy.diff(padded)
        return [(low, high, self.end(low - 1), self.end(high + 1))
                for low, high in zip(numpy.flatnonzero(changes == 1), numpy.flatnonzero(changes == -1) - 1)]

    def end(self, n):
        """Why a design beside a range is left out."""
        if not 0 <= n < len(self.x):
            return "the study ends"
        return ends[statuses[int(self.columns["status"][n])] if self.inside[n] else "outside the model's domain"]

    def limit(self):
        """Why no neighbour of the best design is better."""
        for beyond in (self.best - 1, self.best + 1):
            if not 0 <= beyond < len(self.x) or not self.flaps[beyond]:
                return limits.get(self.end(beyond), self.end(beyond))
        return "nothing (interior maximum)"


def curves_of(data, axis):
    dimensions = data["status"].dimensions
    others = [d for d in dimensions if d != axis]
    x = numpy.asarray(data[axis][:])
    labels = []
    for d in others:
        if d in ("transmission_formulation", "springs"):
            labels.append([("springs " if d == "springs" else "") + str(v) for v in data[d][:]])
        else:
            labels.append([f"{1e3 * v:.0f} mm crank" for v in data[d][:]])
    columns = {name: numpy.moveaxis(numpy.ma.filled(data[name][:].astype(float), numpy.nan), dimensions.index(axis), -1)
               for name in data.variables if data[name].dimensions == dimensions}
    shape = columns["status"].shape[:-1]
    return x, [Curve(", ".join(labels[k][i] for k, i in enumerate(at)), x, {n: c[at] for n, c in columns.items()})
               for at in numpy.ndindex(shape)]


def figure(curves, name, label, factor, title):
    # The curves of a figure: at most four can be distinguished.
    drawn = curves if len(curves) <= 4 else [c for c in curves if "rod-force" in c.label and "springs on" in c.label]
    lines_figure(name, title, label, ("system efficiency (%)", "mean lift over weight"),
                 [(c.label, factor * c.x, (100 * c.efficiency, c.columns["lift_to_weight"])) for c in drawn])
    return len(drawn) < len(curves)


def optimum(curves, what, factor, unit):
    best = max(curves, key=lambda c: c.efficiency[c.best])
    rows = []
    for c in curves:
        low, high = c.within(0.99)
        wide_low, wide_high = c.within(near_best)
        rows.append((c.label, f"{100 * c.efficiency[c.best]:.2f} %", f"{factor * c.x[c.best]:.4g}",
                     text.span(factor * c.x[low], factor * c.x[high]),
                     text.span(factor * c.x[wide_low], factor * c.x[wide_high]),
                     c.limit(), f"{numpy.nanmax(c.columns['lift_to_weight']):.3f}"))
    return ["## The best design of each case", "",
            f"The best system efficiency of all cases is {100 * best.efficiency[best.best]:.2f} %, at "
            f"{factor * best.x[best.best]:.4g} {unit} ({best.label}).", "",
            *text.table(("case", "best efficiency", f"{what} there ({unit})", "efficiency within 1 % of the best",
                         f"within {100 * (1 - near_best):.0f} %", "what limits it", "maximum lift / weight"), rows)]


def flapping_ranges(curves, what, factor, unit):
    x, whole = curves[0].x, "the study ends"
    none = [c.label for c in curves if c.best is None]
    rows = [(c.label, text.span(factor * c.x[low], factor * c.x[high]), below, above)
            for c in curves for low, high, below, above in c.intervals() if not below == above == whole]
    study = f"{text.span(factor * x[0], factor * x[-1])} {unit}"
    lines = ["", "## Where it flaps", ""]
    if not none and not rows:
        return lines + [f"Every case flaps over the whole study, {study}."]
    lines.append(f"The study covers {study}.")
    lines += [f"Nothing flaps inside the [domain of validity](../domain.md) with {label}." for label in none]
    if rows:
        others = "; the others flap over all of it" if len({row[0] for row in rows}) + len(none) < len(curves) else ""
        lines += [f"These cases flap inside the [domain of validity](../domain.md) over a part of it only{others}:", "",
                  *text.table(("case", f"{what} ({unit})", "below", "above"), rows)]
    return lines


def formulations(curves, what, factor, unit):
    rows = []
    for c in curves:
        other = [o for o in curves if o.label == c.label.replace("rod-force", "virtual-work")]
        if not c.label.startswith("rod-force") or not other:
            continue
        o, there = other[0], other[0].efficiency[c.best]
        share = c.columns["power_residual_w"][c.best] / c.columns["power_electrical_w"][c.best]
        rows.append((c.label.removeprefix("rod-force, "), f"{factor * c.x[c.best]:.4g}",
                     f"{100 * c.efficiency[c.best]:.2f} %",
                     f"{100 * there:.2f} %" if numpy.isfinite(there) else "does not flap", f"{100 * share:.1f} %",
                     f"{factor * o.x[o.best]:.4g}"))
    if not rows:
        return []
    return ["", "## The two formulations", "",
            "The table compares both [formulations](../formulations.md) at the optimum of `rod-force`, the formulation "
            "of the paper, which does not conserve a part of the input power.", "",
            *text.table(("case", f"optimum of `rod-force` ({unit})", "efficiency by `rod-force`",
                                                           "efficiency by `virtual-work`",
                         "input not conserved by `rod-force`", f"optimum of `virtual-work` ({unit})"), rows)]


def effect_of_springs(curves):
    gains = []
    for c in curves:
        off = [o for o in curves if o.label == c.label.replace("springs on", "springs off")]
        if "springs on" in c.label and off:
            gains.append((c.label.replace(", springs on", ""),
                          f"{c.efficiency[c.best] / off[0].efficiency[off[0].best]:.3f}"))
    if not gains:
        return []
    lines = ["", "## Effect of the springs", ""]
    if len(gains) > 2:
        return lines + text.table(("case", "best efficiency with springs, relative to without"), gains)
    return lines + ["Springs multiply the best efficiency by " + text.joined([f"{gain} with `{case}`" for case,
                                                                              gain in gains]) + "."]


def lift(curves):
    lifts = [(numpy.nanmax(c.columns["lift_to_weight"]), c.label) for c in curves]
    carrying = [label for most, label in lifts if most >= 1.0]
    lines = ["", "## Lift", ""]
    if not carrying:
        most, label = max(lifts)
        return lines + [f"The vehicle does not carry its weight in any case. The maximum lift is {most:.3f} of the "
                        f"weight ({label})."]
    if len(carrying) == len(curves):
        return lines + [f"The vehicle can carry its weight in all {len(curves)} cases (maximum lift / weight in the "
                        "first table)."]
    return lines + [f"The vehicle can carry its weight in {len(carrying)} of the {len(curves)} cases that flap, those "
                    "whose maximum lift / weight in the first table is 1 or more."]


def page(name, curves, title, reduced):
    _, what, factor, unit, question, reader = studies[name]
    flapping = [c for c in curves if c.best is not None]
    lines = [f"# {title}", "", f"{question} {reader}", "",
             f"![System efficiency and lift over weight](../img/{name}.svg)", ""]
    if reduced:
        lines += ["The figure shows `rod-force` with springs. The tables show all cases.", ""]
    lines += optimum(flapping, what, factor, unit) + flapping_ranges(curves, what, factor, unit)
    lines += formulations(flapping, what, factor, unit) + effect_of_springs(flapping) + lift(flapping)
    return "\n".join([*lines, "", text.sources(name)]) + "\n"
