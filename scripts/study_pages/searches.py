"""Pages of optima, fronts and tolerance studies."""
import numpy

from study_pages import text

quantity = text.quantity


def front_findings(data, result):
    """Of several objectives: what the front spans, its ends and its knee, which parameters vary along it."""
    objectives = [str(name) for name in data["objective"][:]]
    front = {name: numpy.asarray(data[name][:]) for name in data.variables if data[name].dimensions == ("design",)
             and data[name].dtype.kind == "f"}
    unit = {name: data[name].units for name in front}
    parameters = list(result["front"][0]["parameters"])

    def of(key):
        return unit[key.replace(".", "_")]
    spans = [f"{name} from {quantity(front[name].min(), unit[name])} to {quantity(front[name].max(), unit[name])}"
             for name in objectives]
    history = numpy.asarray(data["hypervolume_history"][:])
    solved = len(data.dimensions["evaluated"])
    feasible = int(numpy.sum(data["evaluated_feasible"][:] == 1))
    lines = ["## The front", "",
             f"Of {solved} designs solved {feasible} are feasible. The front holds {len(data.dimensions['design'])} "
             f"of them and spans {' and '.join(spans)}.", ""]
    rows = []
    for pick in (f"end-{objectives[0]}", "knee", f"end-{objectives[1]}"):
        d = result["front"][result["picks"][pick]]
        rows.append((f"`{pick}`", *(quantity(d["metrics"][o], unit[o]) for o in objectives),
                     *(quantity(d["parameters"][key], of(key)) for key in parameters)))
    ranges = [[quantity(x, of(key)) for x in numpy.quantile(front[key.replace(".", "_")], [0.05, 0.95])]
              for key in parameters]
    rows.append(("nine tenths of the front", *("" for _ in objectives), *(f"{low} to {high}" for low, high in ranges)))
    lines += text.table(("design", *objectives, *parameters), rows)
    knee = result["front"][result["picks"]["knee"]]["metrics"]
    end = result["front"][result["picks"][f"end-{objectives[0]}"]]["metrics"]
    first, second = objectives[0], objectives[1]
    lines += ["", f"From `knee` to `end-{first}`, {first} grows by {100 * abs(end[first] / knee[first] - 1):.1f} % and "
                  f"{second} by {100 * abs(end[second] / knee[second] - 1):.1f} %."]
    if "lift_to_weight" in front and numpy.isfinite(front["lift_to_weight"]).any():
        lift = front["lift_to_weight"]
        if lift.max() >= 1.0:
            power = front["power_electrical_w"][lift >= 1.0].min()
            lines.append(f"The vehicle carries its weight on {100 * numpy.mean(lift >= 1.0):.0f} % of the front, with "
                         f"{power:.4g} W or more.")
        else:
            lines.append("The vehicle does not carry its weight anywhere on the front: the maximum lift is "
                         f"{lift.max():.3f} of the weight.")
    reference = ", ".join(f"{name} = {quantity(x, unit[name])}" for name, x in result["reference"].items())
    return lines + ["", "## Convergence", "",
                    f"The front dominates a hypervolume of {result['hypervolume']:.5g} {data['hypervolume'].units} up "
                    f"to the reference point {reference}. The screening alone reaches "
                    f"{100 * history[0] / history[-1]:.1f} % of it, half of the generations "
                    f"{100 * history[len(history) // 2] / history[-1]:.2f} %."]


def optimum_findings(data, result):
    """Of one objective: the optimum, its limits, how flat it is."""
    lines = ["## The optimum", ""]
    trials = result.get("motors", result.get("choices"))
    if trials:
        found = [t for t in trials if t.get("result", {}).get("outcome") == "found"]
        refused = [t for t in trials if "refused" in t]
        lines += [f"Of {len(trials)} rows of the catalogue {len(refused)} are incomplete. {len(found)} motors lift "
                  f"the vehicle, {len(trials) - len(refused) - len(found)} do not, whatever the other parameters "
                  "are.", ""]
        if not found:
            return lines
        best = result["best"]
        lines += [f"The best motor is {best}.", ""]
        result = next(t["result"] for t in found if t["model"] == best or best.startswith(str(t["model"]) + ","))
    key, starts = result["objective"], result["starts"]
    lines += [f"The {'largest' if result['maximise'] else 'least'} "
              f"{data[key].long_name.removesuffix(' of the optimum')} is "
              f"{quantity(result['value'], data[key].units)}. Of {starts['all']} local searches {starts['same']} "
              f"ended at this optimum, {starts['elsewhere']} at a worse one, and {starts['failed']} found "
              "nothing.", ""]

    def moves(d, k):
        name = k.replace(".", "_")
        a, b = (d[end][list(result["parameters"]).index(k)] for end in ("from", "to"))
        width = abs(float(data["upper_" + name][...]) - float(data["lower_" + name][...]))
        if abs(b - a) <= 1e-3 * width:
            return "unchanged"
        return f"{quantity(a, data[name].units)} to {quantity(b, data[name].units)}"
    directions = result["directions"]
    lines += text.table(("parameter", "optimum",
                         *(f"free direction {n + 1}{' (flat)' if d['flat'] else ''}"
                           for n, d in enumerate(directions))),
                        [(f"`{k}`", quantity(x, data[k.replace(".", "_")].units), *(moves(d, k) for d in directions))
                         for k, x in result["parameters"].items()])
    if directions:
        lines += ["", "Along a free direction the parameters move together; the objective is 0.1 % worse at both "
                      "ends of each range."]
    lines += ["", "## What limits it", ""]
    if not result["active"]:
        return lines + ["No constraint and no bound limits the optimum: it lies inside."]
    return lines + text.table(("limit", "change of the objective if the limit is tightened by 1 %"),
                              [(f"`{quoted_limit(limit['limit'])}`",
                                f"{limit['sensitivity']:.2g} % worse" if limit["sensitivity"] is not None else
                                "not determined")
                               for limit in result["active"]])


def quoted_limit(limit):
    """A limit `key <= 0.008 m` in the unit of the page."""
    name, sense, value, *unit = limit.split(" ", 3)
    return f"{name} {sense} {quantity(float(value), unit[0])}" if unit else limit


def tolerance_findings(_, result):
    p = result["probability"]
    lines = ["## Findings", "",
             f"The study solves {result['vehicles']} vehicles from {result['samples']} samples. "
             f"{100 * p['flapping']['share']:.2f} % of them flap."]
    if p["hover"]:
        lines.append(f"{100 * p['hover']['share']:.2f} % carry their weight (95 % interval: "
                     f"{100 * p['hover']['lower_95']:.2f} to {100 * p['hover']['upper_95']:.2f} %). The linear "
                     f"prediction is {100 * p['hover_linear']:.2f} %.")
    rows = []
    for name in ("lift_to_weight", "power_electrical_w"):
        output = result["outputs"].get(name)
        factors = [f for f in (output or {}).get("factors", []) if f.get("total") is not None]
        if factors:
            factors.sort(key=lambda f: -f["total"])
            rows.append((f"`{name}`", f"{output['mean']:.4g}", f"{output['deviation']:.3g}",
                         ", ".join(f"`{f['name']}` ({f['total']:.2f})" for f in factors[:3])))
    if rows:
        lines += ["", *text.table(("metric", "mean", "standard deviation",
                                   "largest contributions to the variance (total Sobol index)"), rows)]
    rows = []
    for choice in result.get("choices", []):
        effect = choice["outputs"]["lift_to_weight"]
        rows.append((f"`{choice['name']}`",
                     ", ".join(f"`{a['name']}` {a['outputs']['lift_to_weight']['mean']:.4g}"
                               for a in choice["alternatives"]),
                     f"{effect['difference']:.3g}", f"{effect['deviation_by_parameters']:.3g}"))
    if rows:
        lines += ["", "## Effect of the choices on lift_to_weight", "",
                  *text.table(("choice", "mean of each alternative", "difference",
                               "standard deviation by parameters alone"), rows)]
    return lines


search_picture = "Searches, the optimum between its bounds, and the walks along free directions"
tolerance_picture = "Distribution and where its variance comes from"
# study: command, what the figure shows, findings, question and reader
searches = {
    "optimise-hover": ("optimise", search_picture, optimum_findings,
                       "With how little electrical power can the flapper carry its weight, if crank, hinge, rod, "
                       "springs and voltage may change? This page is for designers who want to see what [wingbeat "
                       "optimise](../optimise.md) finds."),
    "optimise-motor": ("optimise", search_picture, optimum_findings,
                       "Which motor of a catalogue carries the flapper with the least power, with which gear ratio, "
                       "spring and voltage? This page is for designers who choose a motor. The vehicle without its "
                       "motor is assumed to weigh 2.5 g."),
    "optimise-pareto": ("optimise", "Front and feasible designs", front_findings,
                        "How much lift can the flapper have for how much electrical power, over crank, hinge springs "
                        "and voltage? This page is for designers who compare two objectives "
                        "([fronts](../optimise.md))."),
    "tolerance-hover": ("tolerance", tolerance_picture, tolerance_findings,
                        "Does every copy of the flapper hover at 5.5 V, and which parts decide it? This page is for "
                        "builders of more than one vehicle. The standard deviations of the ten parameters are "
                        "assumptions, not measurements."),
    "tolerance-model-form": ("tolerance", tolerance_picture, tolerance_findings,
                             "Is the choice of model or the scatter of parameters the larger uncertainty at 5.5 V? "
                             "This page is for readers who assess how sure a result is ([how sure is "
                             "it?](../accuracy.md)). The standard deviations are assumptions, not measurements."),
}


def page(name, data, result):
    _, shows, findings_of, question = searches[name]
    return "\n".join([f"# {data.title}", "", question, "", f"![{shows}](../img/{name}.svg)", "",
                      *findings_of(data, result), "",
                      text.sources(name)]) + "\n"
