"""What commands print with --json is what `wingbeat schema` says of it, key by key, and nothing else is; and every key
that is described is written by some command."""

import copy
import functools
import importlib.machinery
import importlib.util
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

try:
    import jsonschema
except ImportError:
    jsonschema = None

SCRIPT = str(pathlib.Path(__file__).resolve().parents[2] / "scripts/describe-results")
LOADER = importlib.machinery.SourceFileLoader("describe_results", SCRIPT)
describe_results = importlib.util.module_from_spec(importlib.util.spec_from_loader("describe_results", LOADER))
LOADER.exec_module(describe_results)

PROGRAM = pathlib.Path(os.environ["WINGBEAT_PROGRAM"])
DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
TOLERANCE = """[study]
vehicle = "friction2022-springs"
[samples]
method = "{method}"
count = 8
seed = 1
[[parameter]]
key = "friction.radius"
distribution = "lognormal"
geometric_deviation = 1.1
[[parameter]]
key = "motor.torque_constant"
distribution = "normal"
relative_deviation = 0.03
"""
FRONT = """[study]
vehicle = "friction2022-springs"
[search]
method = "nsga2"
population = 8
generations = 2
seed = 1
[[objective]]
maximise = "lift_mean_n"
reference = "0 N"
[[objective]]
minimise = "power_electrical_w"
reference = "4 W"
[[parameter]]
key = "supply.voltage"
lower = "2 V"
upper = "8 V"
"""
MODEL_CHOICE = """[[choice]]
name = "formulation"
alternative = [{ name = "rod-force" }, { name = "virtual-work", set.transmission.formulation = "virtual-work" }]
"""

OPTIMUM = """[study]
vehicle = "friction2022-springs"
{more}
[objective]
maximise = "lift_mean_n"
starts = 2
[[parameter]]
key = "supply.voltage"
lower = "2 V"
upper = "{upper}"
{constraint}
"""
DRIVE_TRAINS = """[study]
vehicle = "x-wing-battery"
{more}
[drive_train]
mass_without = "7 g"
refine = 1
screen = 1
[motors]
catalogue = "{data}/motors/motors.csv"
within_nominal_current = false
[gearboxes]
catalogue = "{data}/motors/gearboxes.csv"
[batteries]
catalogue = "{data}/motors/batteries.csv"
[objective]
minimise = "power_electrical_w"
starts = 2
screen = 16
"""
MOTORS = """[motors]
catalogue = "{catalogue}"
gear_ratio = 10
mass_without = "2.5 g"
within_nominal_current = false
"""
SWEEP = """[study]
vehicle = "friction2022-springs"
[[axis]]
key = "springs"
values = [false, true]
[[axis]]
key = "supply.voltage"
from = "{low}"
to = "3 V"
count = 3
"""


FLIGHT = """[study]
vehicle = "{vehicle}"
duration = "0.2 s"
[controller]
type = "{controller}"
[sensors]
delay = "2 ms"
attitude = "0.5 deg"
"""
BENCH = """[bench]
vehicle = "friction2022-springs"
[[parameter]]
key = "friction.radius"
lower = 0
upper = 8e-3
start = 1e-3
[deviation]
default = { relative = 0.01 }
[[log]]
file = "log.csv"
condition = "air"
springs = true
"""
CHOICE = """[[parameter]]
key = "friction.radius"
values = ["2 mm", "2.5 mm"]
"""
BEYOND = """[[constraint]]
metric = "lift_mean_n"
at_least = "1 N"
"""


def described(schema):
    """Every key of a schema, `a.b` within objects, `a[].b` within lists."""
    return {path for path, _, _ in describe_results.members("", schema)}


def written(schema, value, path=""):
    """The keys of a schema that a value has."""
    for one in describe_results.alternatives(schema):
        if "anyOf" in schema and not jsonschema.Draft202012Validator(one).is_valid(value):
            continue
        if isinstance(value, list) and "items" in one:
            for item in value:
                yield from written(one["items"], item, path + "[]")
        if isinstance(value, dict):
            for key, within in value.items():
                if key in one.get("properties", {}):
                    here = f"{path}.{key}".lstrip(".")
                    yield here
                    yield from written(one["properties"][key], within, here)
                elif isinstance(one.get("additionalProperties"), dict):
                    yield from written(one["additionalProperties"], within, path + ".*")


@functools.cache
def schema_of(command):
    return json.loads(subprocess.run([PROGRAM, "schema", command], capture_output=True, text=True, check=True).stdout)


def refuses(validator, value):
    """Whether a value is not of a schema; looks at what the value's own keys may be first, which takes less."""
    schema = validator.schema
    outer = {**schema, "properties": dict.fromkeys(schema.get("properties", {}), True)}
    return not jsonschema.Draft202012Validator(outer).is_valid(value) or not validator.is_valid(value)


@unittest.skipUnless(jsonschema, "python3-jsonschema is not installed")
class Schema(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="wingbeat-schema-"))
        self.seen = {}
        self.addCleanup(lambda: subprocess.run(["rm", "-r", self.folder]))

    def file(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def printed(self, command, *arguments, statuses=(0,)):
        done = subprocess.run([PROGRAM, command, *arguments, "--json"], capture_output=True, text=True, cwd=self.folder,
                              timeout=280)
        self.assertIn(done.returncode, statuses, done.stderr)
        return json.loads(done.stdout)

    def check(self, command, *arguments, statuses=(0,)):
        """Prints by the command and validates; what is then changed must be refused."""
        return self.validate(command, arguments, self.printed(command, *arguments, statuses=statuses))

    def validate(self, command, arguments, shown):
        self.seen.setdefault(command, set()).update(written(schema_of(command), shown))
        validator = jsonschema.Draft202012Validator(schema_of(command))
        errors = [f"{'/'.join(map(str, e.absolute_path))}: {e.message[:300]}" for e in validator.iter_errors(shown)]
        self.assertEqual(errors, [], (command, *arguments))
        for key in shown:
            # A key of an alternative schema may be missing.
            if key in validator.schema.get("required", ()):
                without = {name: value for name, value in shown.items() if name != key}
                self.assertTrue(refuses(validator, without), f"{command} without {key}")
        self.assertTrue(refuses(validator, {**shown, "more": 1}), f"{command} with a key more")
        return shown

    def everything_is_written(self, command):
        """By what this test has checked."""
        keys = described(schema_of(command))
        self.assertGreater(len(keys), 3)
        self.assertEqual(sorted(keys - self.seen[command]), [], f"{command}: keys that no run has written")

    def test_schemas_are_schemas_of_every_command_with_json(self):
        listed = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
        commands = re.findall(r"^  (\S+)", listed.split("Subcommands:\n")[1].split("\n\n")[0], re.M)
        helps = {name: subprocess.run([PROGRAM, name, "--help"], capture_output=True, text=True, check=True).stdout
                 for name in commands}
        self.assertGreater(len(commands), 10)
        for name in commands:
            if "\n  --json" in helps[name]:
                jsonschema.Draft202012Validator.check_schema(schema_of(name))
        wrong = subprocess.run([PROGRAM, "schema", "runs"], capture_output=True, text=True)
        self.assertEqual((wrong.returncode, wrong.stdout), (2, ""))
        self.assertIn("did you mean run?", wrong.stderr)

    def test_metrics_of_a_run_are_those_of_the_table(self):
        schema = schema_of("run")["anyOf"][0]
        metrics = [metric["key"] for metric in self.printed("metrics")["metrics"]]
        self.assertEqual([key for key in schema["properties"] if key in metrics], metrics)
        self.assertTrue(set(metrics) < set(schema["required"]))

    def test_run(self):
        self.check("run", "friction2022")
        self.check("run", "friction2022", "--voltage", "5 V", "--set", "motor.thermal_resistance_winding=20 K/W",
                   "--set", "motor.thermal_resistance_case=48 K/W")
        locked = self.check("run", "friction2022-springs", "--voltage", "0.8 V", statuses=(3,))
        self.assertIsNone(locked["frequency_hz"])
        self.assertIn("start_up", self.check("run", "friction2022", "--method", "transient"))
        self.check("run", "friction2022", "--set",
                   'supply={type="pwm", voltage="6 V", duty=0.5, frequency="20 kHz"}')
        for vehicle in ("friction2022-battery", "direct-drive", "pitch-hinge", "x-wing-crank"):
            self.check("run", vehicle)
        self.check("run", "friction2022", "--angle-of-attack", "45 deg")
        sides = self.check("run", DATA / "designs/sides/purdue-flapper-trimmed.toml")
        self.assertEqual(sides["lift_mean_n"], sides["left"]["lift_mean_n"] + sides["right"]["lift_mean_n"])
        self.everything_is_written("run")

    def test_scale_and_synthesise(self):
        self.check("scale", "two-wing-direct", "--wing", "1.1")
        self.check("scale", "friction2022", "--vehicle", "0.5")
        self.everything_is_written("scale")
        target = ("--stroke", "80 deg", "--envelope", "25 mm")
        self.check("synthesise", "four-bar", *target, "--clearance", "0.02 mm", "--time-ratio", "1.1")
        self.check("synthesise", "slider-crank", *target)
        self.everything_is_written("synthesise")

    def test_validate(self):
        self.check("validate")
        self.check("validate", "gammabot-thrust", "robobee-numkin-becky")
        self.everything_is_written("validate")

    def test_a_wrong_value_is_refused(self):
        validator = jsonschema.Draft202012Validator(schema_of("run"))
        shown = self.printed("run", "friction2022")
        for key, value in (("status", "flies"), ("lift_mean_n", "8 mN"), ("warnings", None), ("domain", 1)):
            wrong = copy.deepcopy(shown)
            wrong[key] = value
            self.assertFalse(validator.is_valid(wrong), key)

    def test_lists(self):
        self.check("keys")
        self.check("metrics", "power")
        self.everything_is_written("keys")
        self.everything_is_written("metrics")

    def test_compare(self):
        self.check("compare", DATA / "published/friction2022.toml")
        self.everything_is_written("compare")

    def test_sweep(self):
        self.check("sweep", self.file("study.toml", SWEEP.format(low="2 V")), "-o", "sweep.nc")
        self.check("sweep", self.file("none.toml", SWEEP.format(low="0.1 V")), "-o", "none.nc")
        hovering = '[study]\nvehicle = "two-wing-direct"\nhold = { lift_to_weight = 1 }\n' \
                   '[[axis]]\nkey = "spring.stiffness"\nvalues = [0.012, 0.0133]\n'
        held = self.check("sweep", self.file("hover.toml", hovering), "-o", "hover.nc")
        self.assertIsNone(held["max_lift_mean"])
        self.assertGreater(held["min_power_electrical"]["power_electrical_w"], 0)
        self.everything_is_written("sweep")

    def test_motors(self):
        for sheet in ("0816K003SR", "pololu-1098", "0816K003SR-heating"):
            self.check("identify-motor", DATA / f"motors/{sheet}.toml")
        # A curve of the first seconds: what is left of the case.
        rows = (DATA / "bench/heating-0816.csv").read_text().splitlines()[:64]
        self.file("short.csv", "\n".join(rows) + "\n")
        self.file("short.toml", '[datasheet]\nresistance = "5.4 ohm"\n[heating]\nfile = "short.csv"\n'
                                'voltage = "2 V"\nambient_temperature = "22 degC"\n')
        short = self.check("identify-motor", self.folder / "short.toml", statuses=(2,))
        self.assertIsNone(short["heat"]["thermal_resistance_case"])
        self.assertGreater(short["heat"]["case_heat_capacity"]["value"], 0)
        # A winding that warms as one lump: the sum of both resistances.
        warming = [f"{5 * n},{25 + 40 * (1 - math.exp(-n / 20)) + 0.3 * (7 * n % 5 - 2):.2f}" for n in range(1, 121)]
        sum_of = ["time [s],winding_temperature [degC]"] + warming
        self.file("sum.csv", "\n".join(sum_of) + "\n")
        self.file("sum.toml", '[datasheet]\nresistance = "5.4 ohm"\n[heating]\nfile = "sum.csv"\ncurrent = "0.3 A"\n')
        summed = self.check("identify-motor", self.folder / "sum.toml", statuses=(2,))
        self.assertGreater(summed["heat"]["resistance_sum"]["value"], 0)
        self.everything_is_written("identify-motor")

    def test_fit(self):
        self.check("fit", DATA / "bench/flapper.toml")
        waveforms = self.check("fit", DATA / "bench/waveforms.toml", "--no-profiles")
        self.assertEqual({p["of"] for p in waveforms["parameters"]}, {"vehicle", "balance", "log"})
        rows = [f"{2 + n / 2},{self.printed('run', 'friction2022-springs', '--voltage', f'{2 + n / 2} V')['frequency_hz']!r}"
                for n in range(3)]
        self.file("log.csv", "\n".join(["voltage_V,frequency_Hz", *rows]) + "\n")
        compared = self.check("fit", self.file("bench.toml", BENCH), "--compare-friction", "--no-profiles")
        self.assertTrue(compared["friction"])
        self.file("log.csv", "\n".join(["voltage_V,frequency_Hz", "0.3,2", *rows]) + "\n")
        beyond = self.check("fit", self.file("bench.toml", BENCH), "--no-profiles", statuses=(3,))
        self.assertEqual([row["row"] for row in beyond["unreached"]], [f"{self.folder / 'log.csv'}:2"])
        self.everything_is_written("fit")

    def test_read_bench(self):
        self.check("read-bench", DATA / "bench/spreadsheet.csv")
        readings = self.check("read-bench", DATA / "bench/waveforms.toml")
        self.assertEqual([burst["number"] for burst in readings["logs"][0]["bursts"]], [1, 2])
        self.everything_is_written("read-bench")

    def test_tolerance(self):
        for method in ("sobol", "monte-carlo"):
            self.check("tolerance", self.file("study.toml", TOLERANCE.format(method=method)))
        self.check("tolerance", self.file("study.toml", TOLERANCE.format(method="sobol") + MODEL_CHOICE))
        flights = (DATA / "studies/tolerance-flight.toml").read_text().replace("../designs", str(DATA / "designs"))
        self.check("tolerance", self.file("flights.toml", flights.replace("count = 64", "count = 4")), "--flight")
        self.everything_is_written("tolerance")

    def test_optimise(self):
        one = {"more": "", "upper": "4 V", "constraint": ""}
        found = self.check("optimise", self.file("one.toml", OPTIMUM.format(**one)))
        self.assertEqual(found["outcome"], "found")
        none = one | {"constraint": BEYOND}
        found = self.check("optimise", self.file("none.toml", OPTIMUM.format(**none)), statuses=(0, 1, 3))
        self.assertEqual((found["outcome"], found["value"]), ("infeasible", None))
        # An optimum between the bounds, which has a direction to move along.
        inside = OPTIMUM.replace("lift_mean_n", "efficiency_system")
        self.check("optimise", self.file("inside.toml", inside.format(**one)))
        catalogue = MOTORS.format(catalogue=DATA / "motors/motors.csv")
        motors = inside.format(**one | {"more": catalogue, "upper": "12 V"}) + CHOICE
        self.assertIn("motors", self.check("optimise", self.file("motors.toml", motors)))
        self.check("optimise", self.file("bound.toml", OPTIMUM.format(**one) + CHOICE))
        chosen = self.check("optimise", self.file("choice.toml", inside.format(**one) + CHOICE))
        self.assertEqual([entry["choices"] for entry in chosen["choices"]],
                         [{"friction.radius": 0.002}, {"friction.radius": 0.0025}])
        self.assertTrue(self.check("optimise", self.file("front.toml", FRONT))["front"])
        self.check("optimise", self.file("motors-front.toml", FRONT + catalogue))
        none = self.check("optimise", self.file("no-front.toml", FRONT + BEYOND), statuses=(0, 1, 3))
        self.assertNotIn("front", none)
        choice = '[[parameter]]\nkey = "friction.radius"\nvalues = [0.0003, 0.0004]\n'
        least = '[[constraint]]\nmetric = "lift_to_weight"\nat_least = 1\n'
        trains = self.check("optimise", self.file("trains.toml", DRIVE_TRAINS.format(data=DATA, more="") + choice + least))
        self.assertEqual(trains["screening"]["combinations"], 2 * 960)
        self.assertIn("gear_torque", trains["drive_trains"][0]["result"])
        self.assertIn("battery", trains["drive_trains"][0])
        # One search ends at a constraint, another between its bounds.
        duty = '[[parameter]]\nkey = "supply.duty"\nlower = 0.5\nupper = 1\n'
        self.check("optimise", self.file("duty.toml", DRIVE_TRAINS.format(data=DATA, more="") + duty + least))
        held = 'hold = { lift_to_weight = 1 }\n[set]\nspring.stiffness = "0 N m/rad"\n'
        springs = '[[parameter]]\nkey = "spring.stiffness"\nlower = "0 N m/rad"\nupper = "0.1 N m/rad"\n'
        self.check("optimise", self.file("held.toml", DRIVE_TRAINS.format(data=DATA, more=held) + springs))
        self.everything_is_written("optimise")

    def test_flight(self):
        self.check("trim", "flight-x-wing-battery", "--to", "0.5 m/s", "--points", "2")
        self.check("trim", "flight-friction2022", "--set", 'vehicle.mass="30 g"', statuses=(3,))
        self.everything_is_written("trim")
        self.check("stability", "flight-friction2022", "--sensitivity")
        self.check("stability", "flight-purdue", "--speed", "0.2 m/s")
        self.everything_is_written("stability")
        for name, vehicle, controller in [("regulated", "flight-x-wing-battery", "lqr"), ("pid", "flight-friction2022", "pid"),
                                          ("purdue", "flight-purdue", "lqr")]:
            self.check("fly", self.file(f"{name}.toml", FLIGHT.format(vehicle=vehicle, controller=controller)))
        self.everything_is_written("fly")

    def test_endurance(self):
        lost = self.check("endurance", "friction2022-battery", "--set", "supply.cells=2", "--set", 'vehicle.mass="5 g"')
        self.assertEqual(lost["hover"], "lost")
        self.everything_is_written("endurance")

    def test_linearise(self):
        self.check("linearise", "friction2022", "--frequency", "22 Hz")
        self.check("linearise", "two-wing-direct-hinge")
        self.check("linearise", DATA / "designs/sides/purdue-flapper-trimmed.toml")
        locked = self.check("linearise", "friction2022-springs", "--voltage", "0.5 V", statuses=(3,))
        self.assertIsNone(locked["model"])
        self.everything_is_written("linearise")

    def test_loads_from_cfd(self):
        motion = ("pitch-hinge-crank", "--frequency", "22 Hz")
        for form, name in (("csv", "wings.csv"), ("wabbit", "wings.ini"), ("pterasoftware", "wings.py")):
            self.check("export-kinematics", *motion, "--format", form, "-o", self.folder / name)
        self.everything_is_written("export-kinematics")
        loads = DATA / "loads/pitch-hinge-crank-translational.csv"
        self.check("compare-loads", "pitch-hinge-crank", loads)
        self.check("compare-loads", *motion, loads, "--own-motion")
        self.everything_is_written("compare-loads")

    def test_reproduce(self):
        arguments = ["friction2022", "--coarse", "-o", self.folder / "reproduce"]
        if made := os.environ.get("WINGBEAT_REPRODUCED"):
            # cli.Reproduce compares the two.
            self.validate("reproduce", arguments, json.loads((pathlib.Path(made) / "claims.json").read_text()))
        else:
            self.check("reproduce", *arguments)
        self.everything_is_written("reproduce")


if __name__ == "__main__":
    unittest.main()
