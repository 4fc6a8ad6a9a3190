"""Figures of the study pages, laid out as those of `wingbeat sweep --plot` (src/report/style.hpp, sweep_lines.cpp):
springs decide the colour, the formulation the dash."""
import os
import pathlib
import re
import subprocess

root = pathlib.Path(__file__).resolve().parent.parent.parent

solid, dashed = "1", "(8,4)"
page_width, left, right = 89 / 25.4, 0.125, 0.965  # width [in]; a panel's sides, fractions of it
pixels, point = 192, 192 / 72  # to the inch, to a point


def stroke(label, k):
    if "crank" in label and "mm" in label:
        colour = ["#b79fd0", "#8d68b5", "#653a92", "#35125e"][k % 4]
    elif "springs on" in label or "springs off" in label:
        colour = "#0072b2" if "springs on" in label else "#d55e00"
    else:
        colour = ["#000000", "#707070", "#653a92", "#b79fd0"][k % 4]
    if "rod-force" in label or "virtual-work" in label:
        return f"lw 1.1 dt {dashed if 'virtual-work' in label else solid} lc rgb '{colour}'"
    return f"lw 1.1 dt {[solid, dashed, '(2,3)', '(10,3,2,3)'][k % 4]} lc rgb '{colour}'"


def draw(script, name):
    picture = root / f"docs/img/{name}.svg"
    plain = {variable: os.environ[variable] for variable in ("PATH", "HOME") if variable in os.environ}
    drawn = subprocess.run(["gnuplot", "-d"], env=plain, input="\n".join(script) + "\n", text=True, check=True,
                           stdout=subprocess.PIPE).stdout
    # Names of curves would be tooltips beside a key that says the same.
    picture.write_text(re.sub(r"<title>.*?</title>|<desc>.*?</desc>", "", drawn, flags=re.DOTALL))


def lines_figure(name, title, x_label, panels, curves):
    """Panels (the names of the columns of a curve's values) over x for curves of (label, x, columns)."""
    beside = 2 if all(len(label) <= 22 for label, _, _ in curves) else 1
    panel, gap, foot = 1.45, 0.45, 0.49
    head = 0.58 + 0.15 * -(-len(curves) // beside)
    height = head + len(panels) * panel + (len(panels) - 1) * gap + foot

    def at(x, y):  # fraction of the width, inches from the top
        return f"screen {x:.5g},{1 - y / height:.5g}"

    def text(n, content, place, size):
        return f"set label {n} '{content}' at {place} front font ',{size * point:.4g}'"

    script = [f"set terminal svg noenhanced size {pixels * page_width:.0f},{pixels * height:.0f} dynamic butt "
              f"font 'sans-serif,{7.5 * point:.4g}' lw 2.4 dl 0.6 background '#ffffff'",
              "set encoding utf8", "set minussign", "set border 3 lw 0.6 lc rgb '#404040'",
              "set tics nomirror out scale 0.5", "unset key", "set yrange [0:*]", "set offsets 0,0,graph 0.06,0"]
    for k, (_, x, columns) in enumerate(curves):
        script.append(f"$c{k} << END")
        script += [" ".join(f"{v:.8g}" for v in (place, *(c[n] for c in columns))) for n, place in enumerate(x)]
        script.append("END")
    script += ["set multiplot", f"set lmargin at screen {left}", f"set rmargin at screen {right}",
               text(1, title, at(0.5, 0.11) + " center", 8)]
    for k, (label, _, _) in enumerate(curves):
        x, y = (left if k % beside == 0 else 0.56), 0.31 + 0.15 * (k // beside)
        # Strokes of one width and colour would be joined, whatever their dashes: a white one parts them.
        script += [f"set arrow {2 * k + 1} from {at(x, y)} to {at(x + 0.057, y)} nohead front {stroke(label, k)}",
                   f"set arrow {2 * k + 2} from {at(x, y)} to {at(x, y)} nohead front dt 1 lw 0.01 lc rgb '#fefefe'",
                   text(10 + k, label, at(x + 0.065, y) + " left", 7)]
    for p, label in enumerate(panels):
        top = head + p * (panel + gap)
        script += [] if p == 0 else ["unset label", "unset arrow"]
        script += [f"set tmargin at screen {1 - top / height:.5g}", "set bmargin at screen "
                                                                    f"{1 - (top + panel) / height:.5g}",
                   text(2, label, at(left, top - 0.12) + " left", 7.5)]
        script.append("set format x ''" if p + 1 < len(panels) else "set format x '%g'")
        if p + 1 == len(panels):
            script.append(text(3, x_label, at(0.5 * (left + right), height - 0.1) + " center", 7.5))
        script.append("plot " + ", ".join(f"$c{k} using 1:{p + 2} with lines {stroke(name_of, k)}"
                                          for k, (name_of, _, _) in enumerate(curves)))
    draw([*script, "unset multiplot", "unset output"], name)
