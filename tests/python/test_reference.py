"""The reference of the manual: docstrings name every parameter of the signature, errors, and examples that hold."""

import doctest
import inspect
import os
import re
import shutil
import tempfile
import unittest

import numpy as np
import wingbeat as wb
from shared import ROOT

TITLES = "Parameters|Attributes|Returns|Raises|Example"


def section(text, title):
    """Names that a section of a docstring lists, or its text."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^(?:{TITLES})\n-+\n|\Z)", inspect.cleandoc(text or ""), re.M | re.S)
    return found[1] if found else None


def named(body):
    return [name.strip() for names in re.findall(r"^(\S[^:\n]*) : ", body or "", re.M) for name in names.split(",")]


def is_method(value):
    return inspect.isfunction(value) or isinstance(value, (classmethod, staticmethod))


PUBLIC = {name: getattr(wb, name) for name in wb.__all__ if not inspect.ismodule(getattr(wb, name))}
FUNCTIONS = {name: value for name, value in PUBLIC.items() if inspect.isfunction(value)}
CLASSES = {name: value for name, value in PUBLIC.items() if inspect.isclass(value)}
METHODS = {
    f"{owner}.{name}": getattr(kind, name)
    for owner, kind in CLASSES.items()
    for name, value in vars(kind).items()
    if not name.startswith("_") and is_method(value)
}


def parameters(function):
    """Those of the function itself: `**options` are those of another one, which the text names."""
    kinds = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)
    given = inspect.signature(function).parameters.values()
    return [one.name for one in given if one.kind not in kinds and one.name not in ("self", "cls")]


class Docstrings(unittest.TestCase):
    def test_there_is_something_to_look_at(self):
        self.assertGreaterEqual(len(FUNCTIONS), 15)
        self.assertGreaterEqual(len(METHODS), 25)
        self.assertIn("sweep", FUNCTIONS)
        self.assertEqual(parameters(wb.Vehicle.replace), ["values"])

    def test_they_name_the_parameters_of_the_signature(self):
        for name, function in {**FUNCTIONS, **METHODS}.items():
            with self.subTest(name):
                listed = named(section(function.__doc__, "Parameters"))
                own = parameters(function)
                if name == "solve":  # its overloads have the parameters
                    own = listed
                    self.assertEqual(set(listed), {"vehicle", *inspect.signature(wb._result._solve).parameters})
                elif any("**" in str(one) for one in inspect.signature(function).parameters.values()):
                    self.assertRegex(function.__doc__, r"see wingbeat\.\w+")
                    continue
                self.assertEqual(listed, own)

    def test_functions_say_what_they_return_and_raise(self):
        for name, function in FUNCTIONS.items():
            with self.subTest(name):
                self.assertTrue(named(section(function.__doc__, "Raises")), "no errors")
                if name != "read":  # its first line says it
                    self.assertTrue(section(function.__doc__, "Returns"), "nothing of what comes back")

    def test_what_they_raise_exists(self):
        import builtins

        for name, value in {**FUNCTIONS, **METHODS, **CLASSES}.items():
            for error in named(section(value.__doc__, "Raises")):
                with self.subTest(name, error=error):
                    kind = getattr(wb, error, None) or getattr(builtins, error)
                    self.assertTrue(issubclass(kind, BaseException))

    def test_quantities_have_units(self):
        units = re.compile(r"\[[^\]]+\]")
        for name, unit in [("voltage", "V"), ("frequency", "Hz"), ("lift", "N"), ("time", "s"), ("speed", "rad/s"),
                           ("crank_angle", "rad"), ("current", "A"), ("hinge_offset", "m")]:
            for owner, function in {**FUNCTIONS, **METHODS}.items():
                text = section(function.__doc__, "Parameters")
                row = re.search(rf"^{name} : (.*(?:\n[ ]+.*)*)", text or "", re.M)
                if row:
                    with self.subTest(owner, parameter=name):
                        self.assertIn(f"[{unit}]", units.findall(row[1]))


class Examples(unittest.TestCase):
    def setUp(self):
        folder = os.getcwd()
        os.chdir(ROOT)
        self.addCleanup(os.chdir, folder)

    def test_functions_and_classes_have_one(self):
        for name, value in {**FUNCTIONS, **CLASSES}.items():
            with self.subTest(name):
                self.assertIn(">>> ", section(value.__doc__, "Example") or "")

    def test_they_hold(self):
        finder, runner = doctest.DocTestFinder(recurse=False), doctest.DocTestRunner(verbose=False)
        fronts = self.has_fronts()
        for name, value in {**FUNCTIONS, **METHODS, **CLASSES}.items():
            if name == "Front" and not fronts:
                continue
            for test in finder.find(value, name, globs={"wb": wb, "np": np}):
                report = []
                with self.subTest(name):
                    self.assertEqual(runner.run(test, out=report.append).failed, 0, "\n" + "".join(report))

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
