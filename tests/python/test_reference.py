"""The reference of the manual: docstrings name every parameter of the signature, errors, and examples that hold."""

import ast
import doctest
import importlib.util
import inspect
import os
import re
import shutil
import tempfile
import unittest

import numpy as np
import wingbeat as wb
from shared import ROOT

TITLES = "Parameters|Attributes|Returns|Raises|Notes|Examples"


def section(text, title):
    """The text of a section of a docstring, or None."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^(?:{TITLES})\n-+\n|\Z)", inspect.cleandoc(text or ""), re.M | re.S)
    return found[1] if found else None


def rows(body):
    """The entries of a section in the form of numpydoc: by name the type and the meaning, which is indented."""
    found = {}
    for row in re.split(r"\n(?=\S)", (body or "").strip("\n")):
        head, _, meaning = row.partition("\n")
        names, _, kind = head.partition(" : ")
        found |= {name.strip(): (kind, " ".join(meaning.split())) for name in names.split(",") if name.strip()}
    return found


def is_method(value):
    return inspect.isfunction(value) or isinstance(value, (classmethod, staticmethod))


PUBLIC = {name: getattr(wb, name) for name in [*wb.__all__, "SweepData"] if not inspect.ismodule(getattr(wb, name))}
FUNCTIONS = {name: value for name, value in PUBLIC.items() if inspect.isfunction(value)}
FIGURES = {}
if importlib.util.find_spec("matplotlib"):
    matplotlib = __import__("matplotlib")
    matplotlib.use("Agg")
    import wingbeat.plot

    FIGURES = {f"plot.{name}": getattr(wb.plot, name) for name in wb.plot.__all__
               if inspect.isfunction(getattr(wb.plot, name))}
import wingbeat.gym

GYM = {f"gym.{name}": getattr(wb.gym, name) for name in wb.gym.__all__}
FUNCTIONS |= {name: value for name, value in GYM.items() if inspect.isfunction(value)}
CLASSES = {name: value for name, value in {**PUBLIC, **GYM}.items() if inspect.isclass(value)}
# What Vehicle takes from base classes that are not public is its own.
BASES = [kind for kind in wb.Vehicle.__mro__ if kind.__name__ in ("VehicleMethods", "FlightMethods")]
METHODS = {
    f"{owner}.{name}": getattr(kind, name)
    for owner, kind in CLASSES.items()
    for base in [kind, *(BASES if kind is wb.Vehicle else [])]
    for name, value in vars(base).items()
    if not name.startswith("_") and is_method(value)
    and (kind is not wb.SweepData or value.__qualname__.startswith("SweepData."))
}
#: The function or class that a method of Vehicle is.
OPERATIONS = {"Vehicle.simulation": wb.Simulation, "Vehicle.equations_of_motion": wb.EquationsOfMotion,
              "Vehicle.flight_simulation": wb.FlightSimulation} | {
    f"Vehicle.{name}": FUNCTIONS[name] for base in BASES for name in vars(base) if name in FUNCTIONS}


def parameters(function):
    found = inspect.signature(function).parameters.values()
    return [one for one in found if one.name not in ("self", "cls")]


class Signatures(unittest.TestCase):
    def test_there_is_something_to_look_at(self):
        self.assertGreaterEqual(len(FUNCTIONS), 21)
        self.assertGreaterEqual(len(METHODS), 54)
        self.assertEqual(len(OPERATIONS), 19)
        self.assertIn("sweep", FUNCTIONS)
        self.assertEqual([one.name for one in parameters(wb.Vehicle.replace)], ["values"])

    def test_they_have_names(self):
        """Nothing is `**options`; what xarray's method takes is its own."""
        kinds = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)
        for name, function in {**FUNCTIONS, **FIGURES, **METHODS, **CLASSES}.items():
            if name not in ("SweepData", "SweepData.to_netcdf"):
                with self.subTest(name):
                    self.assertEqual([one.name for one in parameters(function) if one.kind in kinds], [])

    def test_methods_of_a_vehicle_have_those_of_the_functions(self):
        for name, function in OPERATIONS.items():
            with self.subTest(name):
                own = {one.name: (one.default, one.annotation) for one in parameters(getattr(wb.Vehicle, name[8:]))}
                other = {one.name: (one.default, one.annotation) for one in parameters(function)}
                given = {"solve": {"design", "vehicle", "metrics", "threads", "progress"}}.get(name[8:], set())
                other = {key: value for key, value in other.items() if key not in given}
                first = next(iter(other)) if name[8:] not in ("solve", "solve_columns") else "vehicle"
                other.pop(first, None)
                if name[8:] in ("fit", "tolerance", "flight_tolerance", "optimise"):  # which need what functions may go without
                    needed = "data" if name[8:] == "fit" else "study"
                    own.pop(needed), other.pop(needed)
                self.assertEqual(own, other)

    def test_a_wrong_keyword_is_a_type_error_that_names_it(self):
        vehicle = wb.read("friction2022")
        for call in (vehicle.solve, vehicle.simulate, vehicle.simulation, vehicle.endurance, vehicle.linearise,
                     vehicle.motor_curves, vehicle.kinematics, vehicle.equations_of_motion, vehicle.coefficient_curves,
                     lambda **o: wb.solve(vehicle, **o), lambda **o: vehicle.sweep({"supply.voltage": [3]}, **o),
                     lambda **o: wb.solve({"supply.voltage": [3]}, vehicle=vehicle, **o)):
            with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'volts'"):
                call(volts=3)

    def test_options_of_the_other_kind_of_design(self):
        vehicle, columns = wb.read("friction2022"), {"friction.radius": [2e-3, 3e-3]}
        for act, text in (
            (lambda: wb.solve(vehicle, metrics=["lift_mean"]), "^metrics: is an option for columns, not for a v"),
            (lambda: wb.solve(vehicle, vehicle=vehicle), "^vehicle: is an option for columns"),
            (lambda: wb.solve(columns, vehicle=vehicle, method="transient"), "^method: is an option for a vehicle"),
            (lambda: wb.solve(columns, vehicle=vehicle, voltage=3), "give the column supply.voltage$"),
        ):
            with self.assertRaisesRegex(TypeError, text):
                act()


class Docstrings(unittest.TestCase):
    def test_they_describe_the_parameters_of_the_signature(self):
        for name, function in {**FUNCTIONS, **FIGURES, **METHODS, **CLASSES}.items():
            if name in CLASSES and not section(function.__doc__, "Parameters"):
                continue  # made by the package, not by its user
            if name == "SweepData.to_netcdf":
                continue
            with self.subTest(name):
                listed, own = rows(section(function.__doc__, "Parameters")), parameters(function)
                self.assertEqual(list(listed), [one.name for one in own])
                for one in own:
                    kind, meaning = listed[one.name]
                    self.assertTrue(kind, f"{one.name} has no type")
                    self.assertGreater(len(meaning), 8, f"{one.name} has no meaning")
                    if one.default is None:
                        self.assertRegex(kind, ", optional$|^dict$", one.name)
                    elif one.default is not one.empty:
                        shown = re.search("default (.*)$", kind)
                        self.assertTrue(shown, f"{one.name}: {kind}")
                        self.assertEqual(ast.literal_eval(shown[1]), one.default, one.name)

    def test_they_say_what_comes_back(self):
        for name, function in {**FUNCTIONS, **FIGURES, **METHODS}.items():
            if inspect.signature(function).return_annotation not in (None, "None"):
                with self.subTest(name):
                    self.assertTrue(rows(section(function.__doc__, "Returns")), "nothing of what comes back")

    def test_functions_say_what_they_raise(self):
        for name, function in {**FUNCTIONS, **FIGURES}.items():
            with self.subTest(name):
                self.assertTrue(rows(section(function.__doc__, "Raises")), "no errors")

    def test_what_they_raise_exists(self):
        import builtins

        for name, value in {**FUNCTIONS, **FIGURES, **METHODS, **CLASSES}.items():
            for error, (_, when) in rows(section(value.__doc__, "Raises")).items():
                with self.subTest(name, error=error):
                    kind = getattr(wb, error, None) or getattr(builtins, error)
                    self.assertTrue(issubclass(kind, BaseException))
                    self.assertTrue(when)

    def test_quantities_have_units(self):
        flights = ("trim", "flight_stability", "flight_tolerance")
        forward = {*flights, *(f"Vehicle.{name}" for name in flights)}
        for name, unit in [("voltage", "V"), ("frequency", "Hz"), ("lift", "N"), ("power", "W"), ("time", "s"),
                           ("speed", "rad/s"), ("crank_angle", "rad"), ("current", "A"), ("hinge_offset", "m"),
                           ("angle_of_attack", "rad"), ("width", "m"), ("max_time", "s"), ("duration", "s"),
                           ("climb", "m/s"), ("turn_rate", "rad/s"), ("gravity", "m/s2"), ("rate", "Hz"),
                           ("gusts", "m/s"), ("wind", "m/s"), ("timestep", "s")]:
            for owner, function in {**FUNCTIONS, **FIGURES, **METHODS}.items():
                listed = rows(section(function.__doc__, "Parameters"))
                if name in listed:
                    with self.subTest(owner, parameter=name):
                        wanted = "m/s" if name == "speed" and owner in forward else unit
                        self.assertIn(f"[{wanted}]", listed[name][1])


class Examples(unittest.TestCase):
    def setUp(self):
        folder = os.getcwd()
        os.chdir(ROOT)
        self.addCleanup(os.chdir, folder)

    def test_functions_classes_and_methods_have_one(self):
        for name, value in {**FUNCTIONS, **FIGURES, **METHODS, **CLASSES}.items():
            with self.subTest(name):
                self.assertIn(">>> ", section(value.__doc__, "Examples") or "")

    def test_they_hold(self):
        finder, runner = doctest.DocTestFinder(recurse=False), doctest.DocTestRunner(verbose=False)
        fronts = self.has_fronts()
        for name, value in {**FUNCTIONS, **FIGURES, **METHODS, **CLASSES}.items():
            if name in ("Front", "plot.front") and not fronts:
                continue
            for test in finder.find(value, name, globs={"wb": wb, "np": np}):
                report = []
                with self.subTest(name):
                    self.assertEqual(runner.run(test, out=report.append).failed, 0, "\n" + "".join(report))
                    self.assertGreater(len(test.examples), 0)

    def test_the_first_page_of_the_manual_has_one_that_holds(self):
        front = (ROOT / "docs/site/front.html").read_text()
        code = re.search(r"<pre>(import wingbeat.*?)</pre>", front, re.S)[1]
        *lines, last = code.splitlines()
        names = {}
        with tempfile.TemporaryDirectory() as folder:
            shutil.copyfile("data/designs/friction2022.toml", f"{folder}/my-vehicle.toml")
            os.chdir(folder)
            exec("\n".join(lines), names)
            os.chdir(ROOT)
        self.assertGreater(eval(last, names), 0)

    @staticmethod
    def has_fronts():
        """The part with pagmo is not built everywhere."""
        folders = wb._optimise._module_folders()
        return any(os.path.exists(os.path.join(folder, "wingbeat-evolution.so")) for folder in folders)


if __name__ == "__main__":
    unittest.main()
