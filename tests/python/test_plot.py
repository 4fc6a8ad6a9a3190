"""Figures of wingbeat.plot: at both widths no text leaves them or meets another, and the colours are the program's."""

import functools
import importlib.util
import inspect
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import wingbeat as wb
from shared import DATA, ROOT, reference

INSTALLED = importlib.util.find_spec("matplotlib") is not None
if INSTALLED:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import matplotlib.text
    from wingbeat import plot
    from wingbeat._figures import CURVES, DASHED, FIRST, REFERENCE, SECOND

#: Figures are kept in the folder that this names.
KEPT = os.environ.get("WINGBEAT_FIGURES")


@functools.cache
def voltage_sweep():
    axes = {"supply.voltage": np.linspace(0.2, 14, 24)}
    return wb.read(DATA / "designs" / "friction2022-springs.toml").sweep({**axes, "springs": [True, False]})


@functools.cache
def plane():
    axes = {"supply.voltage": np.linspace(0.2, 13, 25), "transmission.crank_radius": np.linspace(4e-3, 10e-3, 13)}
    # Friction of the motor, which low voltages do not overcome.
    return reference().replace({"motor.friction_torque": "1 mN m"}).sweep(axes)


@functools.cache
def tolerances():
    keys = ("friction.radius", "motor.torque_constant", "motor.armature_resistance", "transmission.rod_length")
    spread = [{"key": key, "distribution": "normal", "relative_deviation": 0.03} for key in keys]
    return wb.tolerance({"samples": {"count": 256}, "parameter": spread}, vehicle=reference())


@functools.cache
def fitted():
    return wb.fit(DATA / "bench" / "flapper.toml", profiles=False)


@functools.cache
def a_front():
    study = {
        "search": {"population": 40, "generations": 5},
        "objective": [{"maximise": "lift_mean_n", "reference": 0},
                      {"minimise": "power_electrical_w", "reference": "4 W"}],
        "parameter": [{"key": "supply.voltage", "lower": 2, "upper": 8},
                      {"key": "transmission.crank_radius", "lower": 0.004, "upper": 0.007}],
    }
    return wb.optimise(study, vehicle=reference())


@functools.cache
def a_flight():
    vehicle = wb.read(DATA / "designs" / "friction2022-battery.toml")
    return vehicle.replace({"supply.cells": 2, "vehicle.mass": "5 g"}).endurance()


@functools.cache
def models():
    return reference().linearise(maps=False)


def powers():
    designs = {"friction2022": "3 V", "friction2022-springs": "3 V"}
    return {name: wb.read(DATA / "designs" / f"{name}.toml").solve(voltage=volt) for name, volt in designs.items()}


#: Every function, with what it is given.
FIGURES = {
    "cycle": lambda width: plot.cycle(reference().solve(voltage="3 V"), width=width),
    "cycle of a hinged wing": lambda width: plot.cycle(
        wb.read(DATA / "designs" / "pitch-hinge.toml").solve(), width=width),
    "cycle of a direct drive": lambda width: plot.cycle(
        wb.read(DATA / "designs" / "direct-drive.toml").solve(), width=width),
    "power_flow": lambda width: plot.power_flow(powers(), width=width),
    "lines": lambda width: plot.lines(voltage_sweep(), "lift_mean", width=width),
    "trends": lambda width: plot.trends(
        voltage_sweep(), ["lift_mean", "efficiency_system", "power_motor_reference"], width=width),
    "contours": lambda width: plot.contours(plane(), "lift_mean", width=width),
    "front": lambda width: plot.front(a_front(), width=width),
    "residuals": lambda width: plot.residuals(fitted(), width=width),
    "tolerance": lambda width: plot.tolerance(tolerances(), width=width),
    "sensitivity": lambda width: plot.sensitivity(tolerances(), "lift_mean", width=width),
    "start_up": lambda width: plot.start_up(reference().simulate(), width=width),
    "flight": lambda width: plot.flight(a_flight(), width=width),
    "step": lambda width: plot.step(models(), width=width),
    "bode": lambda width: plot.bode(models(), width=width),
}


def texts(figure):
    """What is written in a figure and where, [pixel]."""
    figure.canvas.draw()
    # A legend shows its texts, an axis those ticks that are within its limits.
    shown = []
    for ax in [*figure.axes, *(inner for ax in figure.axes for inner in ax.child_axes)]:
        ticks = [label for axis in (ax.xaxis, ax.yaxis) for tick in axis.get_major_ticks() + axis.get_minor_ticks()
                 for label in (tick.label1, tick.label2)]
        kept = [tick for axis in (ax.xaxis, ax.yaxis) for tick in axis._update_ticks()]
        drawn = [label for tick in kept for label in (tick.label1, tick.label2)]
        shown += [text for text in ax.findobj(matplotlib.text.Text)
                  if (text not in ticks or text in drawn) and (text.axes is ax or text.axes is None)]
        hidden = [text for axis in (ax.xaxis, ax.yaxis) if not axis.get_visible()
                  for text in axis.findobj(matplotlib.text.Text)]
        shown = [text for text in shown if text not in hidden]
    shown += figure.texts
    seen = {id(text): text for text in shown if text.get_visible() and text.get_text().strip()}
    return [(text.get_text(), text.get_window_extent()) for text in seen.values()]


def width_mm(figure):
    return 25.4 * figure.get_figwidth()


@unittest.skipUnless(INSTALLED, "matplotlib is not installed")
class Figures(unittest.TestCase):
    def tearDown(self):
        plt.close("all")

    def draw(self, name, width):
        drawn = FIGURES[name](width)
        return drawn if hasattr(drawn, "axes") and isinstance(drawn.axes, list) else drawn.figure

    def test_every_function_is_drawn(self):
        self.assertEqual({name.split()[0] for name in FIGURES},
                         {name for name in plot.__all__ if inspect.isfunction(getattr(plot, name))})

    def test_no_text_leaves_the_figure_or_meets_another(self):
        for name in FIGURES:
            for width in (plot.single_column, plot.double_column):
                with self.subTest(name, width=width):
                    figure = self.draw(name, width)
                    self.assertAlmostEqual(width_mm(figure), 1e3 * width, 6)
                    found = texts(figure)
                    if KEPT:
                        figure.savefig(pathlib.Path(KEPT) / f"{name.replace(' ', '-')}-{1e3 * width:.0f}.png")
                    self.assertGreater(len(found), 5)
                    page = figure.bbox
                    for text, box in found:
                        inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= page.x1 + 1 and box.y1 <= page.y1 + 1
                        self.assertTrue(inside, f"{text!r} leaves the figure: {box} of {page}")
                    for n, (text, box) in enumerate(found):
                        for other, place in found[:n]:
                            across = min(box.x1, place.x1) - max(box.x0, place.x0)
                            up = min(box.y1, place.y1) - max(box.y0, place.y0)
                            self.assertFalse(across > 1 and up > 2, f"{text!r} meets {other!r}")
                    plt.close(figure)

    def test_the_check_of_texts_can_fail(self):
        with plt.style.context(plot.style):
            figure = plt.figure()
            figure.text(0.9, 0.5, "leaves the figure")
        (_, box), = texts(figure)
        self.assertGreater(box.x1, figure.bbox.x1)

    def test_axes_and_figures_of_the_user(self):
        figure, (left, right) = plt.subplots(1, 2)
        self.assertIs(plot.lines(voltage_sweep(), "lift_mean", ax=left), left)
        self.assertIs(plot.front(a_front(), ax=right), right)
        self.assertEqual(len(figure.axes), 2)
        whole = plt.figure()
        self.assertIs(plot.start_up(reference().simulate(), figure=whole), whole)
        halves = plt.figure().subfigures(1, 2)
        self.assertIs(plot.bode(models(), figure=halves[1]), halves[1])
        before = dict(plt.rcParams)
        ax = plot.power_flow(reference().solve())
        self.assertEqual(dict(plt.rcParams), before)
        ax.set_title("edited")
        self.assertEqual(ax.get_title(), "edited")
        with self.assertRaisesRegex(TypeError, "^ax: expected matplotlib Axes, got int"):
            plot.lines(voltage_sweep(), "lift_mean", ax=3)
        with self.assertRaisesRegex(TypeError, "^figure: expected a matplotlib Figure, got int"):
            plot.cycle(reference().solve(), figure=3)

    def test_settings_of_the_user_do_not_matter(self):
        plain = texts(plot.contours(plane(), "lift_mean").figure)
        with plt.rc_context({"figure.autolayout": True, "axes.grid": True, "font.size": 14}):
            figure = plot.contours(plane(), "lift_mean").figure
            found = texts(figure)
            with tempfile.TemporaryDirectory() as folder:
                figure.savefig(pathlib.Path(folder) / "tight.png", bbox_inches="tight")  # as notebooks do
        self.assertEqual([(text, *box.extents) for text, box in found], [(text, *box.extents) for text, box in plain])

    def test_a_width(self):
        self.assertAlmostEqual(width_mm(plot.power_flow(reference().solve(), width="183 mm").figure), 183, 9)
        self.assertAlmostEqual(width_mm(plot.power_flow(reference().solve(), width=0.183).figure), 183, 9)
        self.assertAlmostEqual(width_mm(plot.power_flow(reference().solve()).figure), 89, 9)
        text = '^width: must be from 40 to 1000 mm, got 183 m; with its unit it is a text such as "89 mm"$'
        with self.assertRaisesRegex(wb.InputError, text):
            plot.power_flow(reference().solve(), width=183)
        with self.assertRaisesRegex(wb.InputError, "^width: must be from 40 to 1000 mm, got 3 km"):
            plot.power_flow(reference().solve(), width="3 km")

    def test_what_cannot_be_drawn(self):
        stalled = reference().replace({"motor.friction_torque": "1 mN m"}).solve(voltage="0.1 V")
        for draw in (plot.cycle, plot.power_flow):
            with self.assertRaisesRegex(ValueError, re.escape(stalled.evidence)):
                draw(stalled)
        with self.assertRaisesRegex(wb.InputError, "^metric: the data set has no hover"):
            plot.lines(voltage_sweep(), "hover")
        with self.assertRaisesRegex(wb.InputError, "^data: contours need two axes of numbers"):
            plot.contours(voltage_sweep(), "lift_mean")
        with self.assertRaisesRegex(wb.InputError, "^data: curves need one axis of numbers, this sweep has 2"):
            plot.lines(plane(), "lift_mean")
        with self.assertRaisesRegex(TypeError, "^found: expected the result of wingbeat.fit"):
            plot.residuals(tolerances())
        with self.assertRaisesRegex(wb.InputError, "^outputs: the model has no output 'thrust'"):
            plot.step(models(), ["thrust"])
        with self.assertRaisesRegex(wb.InputError, "^metric: the study has no shares of the variance of voltage"):
            plot.sensitivity(tolerances(), "voltage")

    def test_power_flow_shows_all_losses(self):
        result = reference().replace({"motor.friction_torque": "0.2 mN m"}).solve(tolerance=1e-9)
        ax = plot.power_flow(result)
        widths = {bars.get_label(): bars.patches[0].get_width() for bars in ax.containers}
        self.assertAlmostEqual(widths["motor friction"], 1e3 * result.energy_balance.motor_friction, 9)
        self.assertAlmostEqual(sum(widths.values()), 1e3 * result.power_electrical, 5)

    def test_numbers(self):
        result = reference().solve(voltage="3 V", tolerance=1e-9)
        balance = result.energy_balance
        ax = plot.power_flow(result)
        widths = {bars.get_label(): 1e3 * bars.patches[0].get_width() / 1e3 for bars in ax.containers}
        self.assertAlmostEqual(widths["copper"], 1e3 * balance.copper, 9)
        self.assertAlmostEqual(widths["aerodynamic"], 1e3 * balance.aerodynamic, 9)
        self.assertAlmostEqual(sum(widths.values()), 1e3 * (balance.electrical - balance.imbalance), 6)
        motion = plot.cycle(result).axes[0].get_lines()[0]
        self.assertAlmostEqual(motion.get_ydata().max(), np.degrees(float(result.cycle.stroke_angle.max())), 9)
        time = motion.get_xdata()
        self.assertAlmostEqual(time[-1] - time[0], 1e3 / result.frequency, 6)
        self.assertAlmostEqual(time[np.argmin(motion.get_ydata())], 0.0, 9)
        with_springs, without = [line for line in plot.lines(voltage_sweep(), "lift_mean").get_lines()
                                 if not line.get_label().startswith("_")]
        data = voltage_sweep()
        np.testing.assert_allclose(with_springs.get_ydata(), 1e3 * data.lift_mean.sel(springs="on"))
        self.assertEqual((with_springs.get_label(), without.get_label()), ("springs on", "springs off"))
        self.assertAlmostEqual(plot.bode(models()).axes[0].get_lines()[0].get_ydata()[0], 0.0, 1)
        response = plot.step(models()).axes[0].get_lines()[0].get_ydata()
        self.assertAlmostEqual(response[-1], 1.0, 2)
        measured = fitted()["points"][0]
        below = plot.residuals(fitted()).axes[1].get_lines()[0].get_ydata()
        self.assertAlmostEqual(below[0], (measured["measured"] - measured["fitted"]) / measured["deviation"], 12)

    def test_outside_the_domain(self):
        data = voltage_sweep()
        self.assertTrue((data["domain"] != 0).any())
        bands = [line for line in plot.lines(data, "lift_mean").get_lines() if line.get_linewidth() == 6]
        for line, springs in zip(bands, data["springs"].values):
            domain = data["domain"].sel(springs=springs).values
            voltage = data["supply_voltage"].values[domain != 0]
            drawn = line.get_xdata()
            step = float(data["supply_voltage"][1] - data["supply_voltage"][0])
            self.assertTrue(np.isin(voltage, drawn).all())
            self.assertGreaterEqual(drawn.min(), voltage.min() - 0.51 * step)
            self.assertLessEqual(drawn.max(), voltage.max() + 0.51 * step)
        self.assertTrue((plane()["domain"] != 0).any() and (plane().status != "flapping").any())
        ax = plot.contours(plane(), "lift_mean")
        hatched = [one for one in ax.collections if getattr(one, "get_hatch", lambda: None)()]
        shown = [text.get_text() for text in ax.get_legend().get_texts()]
        self.assertIn("outside the model's domain", shown)
        self.assertIn("does not flap", shown)
        self.assertTrue(hatched or any(getattr(one, "hatches", [None]) != [None] for one in ax.get_children()))

    def test_saved_with_live_text(self):
        with tempfile.TemporaryDirectory() as folder, plt.style.context(plot.style):
            file = pathlib.Path(folder) / "front.svg"
            plot.front(a_front()).figure.savefig(file)
            self.assertIn(">mean lift (mN)</text>", file.read_text())


@unittest.skipUnless(INSTALLED, "matplotlib is not installed")
class Style(unittest.TestCase):
    """Held to src/report/style.hpp, the home of colours, sizes and dashes."""

    def setUp(self):
        self.header = (ROOT / "src/report/style.hpp").read_text()

    def number(self, name):
        return float(re.search(rf"\b{name} = ([0-9.]+)", self.header)[1])

    def test_colours(self):
        home = dict(re.findall(r'inline constexpr const char\* (\w+) = "(#[0-9a-f]{6})";', self.header))
        self.assertGreater(len(home), 12)
        self.assertEqual(dict(plot.colours), home)
        ordered = re.search(r"ordered\[\] = \{([^}]*)\}", self.header)[1]
        self.assertEqual(list(plot.ordered), re.findall(r'"(#\w+)"', ordered))

    def test_curves(self):
        for name, curve in (("first_curve", FIRST), ("second_curve", SECOND), ("third_curve", CURVES[2]),
                            ("reference_line", REFERENCE)):
            dash, colour = re.search(rf"{name} = \"dt (\S+) lw \S+ lc rgb '(#\w+)'", self.header).groups()
            self.assertEqual(curve["color"], colour)
            lengths = [float(length) for length in re.findall(r"[0-9.]+", dash)]
            if len(lengths) == 1:
                self.assertEqual(curve["linestyle"], "-")
            else:
                # gnuplot's dashes are in half points.
                self.assertEqual([2 * length for length in curve["linestyle"][1]], lengths)
        self.assertEqual(SECOND["linestyle"], DASHED)

    def test_sizes(self):
        values = matplotlib.rc_params_from_file(plot.style, use_default_template=False)
        self.assertEqual(values["font.size"], self.number("text_size"))
        self.assertEqual(values["axes.labelsize"], self.number("heading_size"))
        self.assertEqual(values["figure.titlesize"], self.number("title_size"))
        self.assertAlmostEqual(values["figure.figsize"][0], self.number("single_column"), 3)
        self.assertAlmostEqual(plot.single_column / 0.0254, self.number("single_column"), 3)
        self.assertAlmostEqual(plot.double_column / 0.0254, self.number("double_column"), 3)
        self.assertEqual(values["font.sans-serif"][0], "DejaVu Sans")
        plt.style.use(plot.style)
        plt.rcdefaults()

    def test_a_program_figure_has_these_colours(self):
        program = os.environ.get("WINGBEAT_PROGRAM")
        if not program or not shutil.which("gnuplot"):
            self.skipTest("no program or no gnuplot")
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "power.svg"
            subprocess.run([program, "run", DATA / "designs/friction2022.toml", "--plot-power", file], check=True,
                           capture_output=True)
            drawn = {"#" + "".join(f"{int(part):02x}" for part in found)
                     for found in re.findall(r"rgb\( *(\d+), *(\d+), *(\d+)\)", file.read_text())}
            drawn |= {colour.lower() for colour in re.findall(r"#[0-9a-fA-F]{6}", file.read_text())}
            ax = plot.power_flow(reference().solve())
            for bars in ax.containers:
                colour = matplotlib.colors.to_hex(bars.patches[0].get_facecolor())
                self.assertIn(colour, drawn, bars.get_label())
        plt.close("all")


class Optional(unittest.TestCase):
    """In a Python of its own, where matplotlib is hidden."""

    def run_python(self, script):
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path[1:])}
        return subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, env=environment)

    def test_wingbeat_does_not_import_it(self):
        script = "import sys, wingbeat; sys.exit('matplotlib' in sys.modules)"
        self.assertEqual(self.run_python(script).returncode, 0)

    def test_without_it_one_sentence_says_what_to_install(self):
        script = "import sys; sys.modules['matplotlib'] = None; sys.modules['matplotlib.pyplot'] = None\n" \
            "import wingbeat\nprint(wingbeat.read)\nimport wingbeat.plot"
        ended = self.run_python(script)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("<function read", ended.stdout)
        self.assertEqual(
            ended.stderr.strip().split("\n")[-1],
            "ModuleNotFoundError: wingbeat.plot needs matplotlib, which is not installed: install Debian's package "
            "python3-matplotlib, or run pip install matplotlib",
        )
