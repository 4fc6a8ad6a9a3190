"""Pages of the direct drive: its wing length, and the comparison with a crank."""
import numpy

from study_pages import text
from study_pages.figures import lines_figure
from study_pages.trends import statuses

length_question = "How long should the wings of a direct drive be if its springs keep it in resonance at 22 Hz?"
comparison_question = ("Does the same motor with the same wings lift more, and more efficiently, through a crank or "
                       "as a direct drive?")


def wing_length(title, d):
    name = "direct-wing-length"
    length, frequency, voltage = d["wing_planform_length"], d["supply_frequency"], d["supply_amplitude"]
    lift = 1e3 * d["lift_mean_n"]  # voltage, frequency, length
    resonance = int(numpy.argmin(abs(frequency - 22.0)))
    lines_figure(name, title, "wing length (mm)", ("mean lift (mN)", "system efficiency (%)"),
                 [(f"{v:.0f} V", 1e3 * length, (lift[k, resonance], 100 * d["efficiency_system"][k, resonance]))
                  for k, v in enumerate(voltage)])
    best = [int(numpy.nanargmax(lift[k, resonance])) for k in range(len(voltage))]
    rows = []
    for k, v in enumerate(voltage):
        b = best[k]
        good = numpy.flatnonzero(lift[k, resonance] >= 0.95 * lift[k, resonance, b])
        rows.append((f"{v:.0f}", f"{1e3 * length[b]:.1f}",
                     f"{1e3 * length[good[0]]:.1f} to {1e3 * length[good[-1]]:.1f}", f"{lift[k, resonance, b]:.2f}",
                     f"{100 * d['efficiency_system'][k, resonance, b]:.1f} %",
                     f"±{numpy.degrees(d['stroke_amplitude_rad'][k, resonance, b]):.0f}"))
    away = []
    for n, f in enumerate(frequency):
        row = [f"{f:.0f}"]
        for k in range(len(voltage)):
            share = 100 * lift[k, n, best[k]] / lift[k, resonance, best[k]]
            row += ["100 %" if n == resonance else f"{share:.1f} %",
                    f"{1e3 * length[int(numpy.nanargmax(lift[k, n]))]:.1f}"]
        away.append(row)
    away_head = ["drive frequency (Hz)"]
    for v in voltage:
        away_head += [f"lift at {v:.0f} V", f"best length at {v:.0f} V (mm)"]
    lines = [
        f"# {title}", "",
        f"{length_question} This page is for designers of vehicles whose motor shaft is the wing hinge ([direct "
        "drive](../direct-drive.md)).", "",
        f"![Lift and efficiency](../img/{name}.svg)", "",
        "## The best length in resonance", "",
        *text.table(("amplitude of the supply (V)", "best wing length (mm)", "lift within 5 % of the best (mm)",
                     "lift (mN)", "system efficiency", "stroke (°)"), rows), "",
        "## Away from resonance", "",
        "Here the springs stay tuned to 22 Hz. The table shows the lift of the best wing above, relative to its lift "
        "at 22 Hz, and the best length at each drive frequency.", "",
        *text.table(away_head, away), "",
        "## What was computed", "",
        "Motor and aerodynamics are those of [data/designs/direct-drive.toml](../../data/designs/direct-drive.toml). "
        "One motor moves one wing. The root chord is a third of the length, the root is 4.5 mm from the hinge, the "
        "angle of attack is not below 45°, and there is no inductance. The springs are in resonance at 22 Hz at each "
        "length; the total inertia follows from stiffness and frequency.", "",
        text.sources(name)]
    return "\n".join(lines) + "\n"


def comparison(title, direct, crank):
    name = "direct-comparison"
    cases = [("direct drive", direct["supply_amplitude"], {k: v for k, v in direct.items() if v.ndim == 1})]
    for k, label in enumerate(("crank, rod-force", "crank, virtual-work")):
        cases.append((label, crank["supply_voltage"], {n: c[k] for n, c in crank.items() if c.ndim == 2}))
    lines_figure(name, title, "supply voltage: constant, or amplitude of the sine (V)",
                 ("mean lift over weight", "system efficiency (%)"),
                 [(label, x, (c["lift_to_weight"], 100 * c["efficiency_system"])) for label, x, c in cases])
    efficiencies, hovers, lifts, rows, outside = [], [], [], [], []
    for label, x, c in cases:
        e, weight = c["efficiency_system"], c["lift_to_weight"]
        alpha, power = c["angle_of_attack_min_deg"], c["power_electrical_w"]
        best, most = int(numpy.nanargmax(e)), int(numpy.nanargmax(weight))
        efficiencies.append((label, f"{100 * e[best]:.1f} %", f"{x[best]:.1f}"))
        carrying = numpy.flatnonzero(weight >= 1.0)
        if len(carrying):
            n = carrying[0]
            hovers.append((label, f"{x[n]:.1f}", f"{power[n]:.2f}", f"{100 * e[n]:.1f} %",
                           f"±{numpy.degrees(c['stroke_amplitude_rad'][n]):.0f}",
                           f"{1e3 * c['current_peak_a'][n]:.0f}"))
        else:
            hovers.append((label, "never", "-", "-", "-", "-"))
        lifts.append((label, f"{weight[most]:.2f}", f"{x[most]:.1f}", f"{alpha[most]:.0f}"))
        negative = numpy.flatnonzero(alpha < 0.0)
        if len(negative):
            outside += ["", f"From {x[negative[0]]:.1f} V on, the smallest angle of attack of the {label} is below "
                            "zero. The coefficients are extrapolated there and the numbers are not reliable."]
        for v in (2.0, 3.0, 4.0, 5.0, 6.0):
            n = int(numpy.argmin(abs(x - v)))
            if not numpy.isfinite(c["frequency_hz"][n]):
                rows.append((label, f"{x[n]:.1f}", statuses[int(c["status"][n])], "-", "-", "-", "-", "-", "-"))
                continue
            p = power[n]
            rows.append((label, f"{x[n]:.1f}", f"{c['frequency_hz'][n]:.2f}",
                         f"±{numpy.degrees(c['stroke_amplitude_rad'][n]):.1f}",
                         f"{weight[n]:.3f}", f"{p:.3f}", f"{100 * c['power_copper_w'][n] / p:.0f} %",
                         f"{100 * e[n]:.1f} %",
                         f"{c['lift_mean_n'][n] / p:.4f}"))
    lines = [
        f"# {title}", "",
        f"{comparison_question} This page is for designers who choose between a crank and a [direct "
        "drive](../direct-drive.md).", "",
        "The direct drive swings the geared motor itself in resonance at 22 Hz. Its only friction is the motor's "
        "viscous damping. The crank has the friction of its rod (2.5 mm radius) and the springs of the 2022 friction "
        "paper.", "",
        f"![Lift and efficiency](../img/{name}.svg)", "",
        "## Best efficiency", "",
        *text.table(("drive", "best system efficiency", "at (V)"), efficiencies), "",
        "## The lowest voltage that carries the weight", "",
        *text.table(("drive", "from (V)", "input (W)", "efficiency", "stroke (°)", "peak current (mA)"), hovers), "",
        "## Maximum lift", "",
        *text.table(("drive", "maximum lift / weight", "at (V)", "smallest angle of attack there (°)"), lifts),
        *outside]
    wide = numpy.flatnonzero(direct["stroke_amplitude_rad"] > 0.5 * numpy.pi)
    if len(wide):
        lines += ["", "The stroke limits the direct drive. It grows with voltage and beyond "
                      f"{direct['supply_amplitude'][wide[0]]:.1f} V it passes 90° to either side. The frequency "
                      "limits the crank: its stroke is fixed, and lift grows with speed alone."]
    lines += ["", "## Over voltage", "",
              *text.table(("drive", "voltage (V)", "frequency (Hz)", "stroke (°)", "lift / weight", "input (W)",
                           "copper loss", "efficiency", "lift per input (N/W)"), rows), "",
              text.sources(name, name + "-crank")]
    return "\n".join(lines) + "\n"
