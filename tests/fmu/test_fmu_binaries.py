"""FMUs whose binaries are made or run elsewhere: from their own sources, by an importer in C, on ARM and Windows."""

import os
import pathlib
import shutil
import subprocess
import unittest

import numpy as np
from description import problems_of
from exported import CRANK, DIRECT, FOLDER, export, steps
from importer import Instance


def compile_and_link(command, folder):
    """In two steps, the first of which ccache remembers, where it is installed, as it does for the build."""
    compiled = [word for word in command if word != "-shared" and not word.startswith("-l")]
    compiled[compiled.index("-o") + 1] = "fmu.o"
    cache = [shutil.which("ccache")] if shutil.which("ccache") else []
    subprocess.run([*cache, *compiled, "-c"], cwd=folder, check=True)
    linked = ["fmu.o" if word == "fmu.cpp" else word for word in command if word not in ("-MD", "-MF", "read.txt")]
    subprocess.run(linked, cwd=folder, check=True)


class Sources(unittest.TestCase):
    def test_gcc_compiles_them_by_itself(self):
        for version in (2, 3):
            package = export(CRANK, version, "--sources")
            self.assertEqual(problems_of(package), [])
        sources = package.root / "sources"
        readme = (sources / "README.txt").read_text().replace("\\\n", " ")
        command = next(line for line in readme.splitlines() if line.strip().startswith("gcc ")).split()
        # As README.txt says but for optimisation, and with the list of all files read.
        command[command.index("-O2")] = "-O0"
        compile_and_link([*command, "-MD", "-MF", "read.txt"], sources)
        read = (sources / "read.txt").read_text()
        self.assertIn(" cycle/", read)
        self.assertNotRegex(read, "/[^ ]*/(eigen3|ceres|xsimd|wingbeat)/")  # all relative: from this folder
        found = []
        for binary in (None, sources / "fmu.so"):
            instance = Instance(package, True, 0.0, binary=binary)
            steps(instance, 0.0, 0.1)
            found.append(instance.get("crank_angle", "current", "lift", "sum_lift"))
            instance.close()
        np.testing.assert_allclose(found[1], found[0], rtol=1e-12)
        # Linked statically each function has the model identifier before its name.
        command = ["gcc", "-std=c++20", "-E", "-P", "-I.", "fmu.cpp"]
        text = subprocess.run(command, cwd=sources, capture_output=True, text=True, check=True).stdout
        self.assertIn(f" {package.identifier}_fmi3DoStep(", text)
        self.assertNotIn(" fmi3DoStep(", text)


class Arm(unittest.TestCase):
    """Where ARM_COMPILER and ARM_EMULATOR are named: scripts/check-processors aarch64."""

    def test_sources_give_the_same_numbers(self):
        package = export(CRANK, 3, "--sources")
        sources = package.root / "sources"
        compiler, emulator = os.environ["ARM_COMPILER"], os.environ["ARM_EMULATOR"].split(";")
        compile_and_link([compiler, "-std=c++20", "-O0", "-fPIC", "-shared", "-fvisibility=hidden", "-fno-gnu-unique",
                          "-DFMI2_OVERRIDE_FUNCTION_PREFIX", "-DFMI3_OVERRIDE_FUNCTION_PREFIX", "-I.", "fmu.cpp", "-o",
                          "arm.so"], sources)  # fmt: skip
        importer = pathlib.Path(FOLDER.name) / "arm_importer"
        examples = pathlib.Path(os.environ["FMU_EXAMPLES"])
        subprocess.run([compiler.replace("g++", "gcc"), "-std=gnu11", "-I", examples.parent.parent / "src",
                        examples / "importer.c", "-o", importer, "-ldl"], check=True)  # fmt: skip
        references = [str(package.reference(name)) for name in ("crank_angle", "current", "lift_mean")]

        def computed(command, binary):
            line = [*command, binary, package.root / "resources", package.token, "3", "0.2", "0.001", *references]
            return [float(x) for x in subprocess.run(line, capture_output=True, check=True).stdout.split()]

        here = computed([os.environ["FMU_IMPORTER"]], package.binary())
        np.testing.assert_allclose(computed([*emulator, importer], sources / "arm.so"), here, rtol=1e-9)


class Importers(unittest.TestCase):
    REFERENCES = ("crank_angle", "current", "frequency_mean", "lift_mean", "power_friction")

    def computed(self, importer, package, binary, folder=""):
        references = [str(package.reference(name)) for name in self.REFERENCES]
        command = [*importer, folder + str(binary), folder + str(package.root / "resources"), package.token,
                   str(package.version), "0.5", "0.001", *references]  # fmt: skip
        found = subprocess.run(command, capture_output=True, text=True, check=True, timeout=500)
        return [float(line) for line in found.stdout.split()]

    def test_one_in_c(self):
        for version in (2, 3):
            package = export(CRANK, version)
            found = self.computed([os.environ["FMU_IMPORTER"]], package, package.binary())
            instance = Instance(package, True, 0.0)
            for k in range(500):
                instance.step(k * 0.001, 0.001)
            self.assertEqual(found, instance.get(*self.REFERENCES))
            instance.close()

    @unittest.skipUnless(os.environ.get("FMU_IMPORTER_WINDOWS"), "needs the binary for Windows and wine")
    def test_the_windows_binary_gives_the_same_numbers(self):
        for vehicle in (CRANK, DIRECT):
            for version in (2, 3):
                package = export(vehicle, version)
                if vehicle == DIRECT:
                    self.REFERENCES = ("stroke_angle", "current", "lift_mean")
                here = self.computed([os.environ["FMU_IMPORTER"]], package, package.binary())
                wine = [os.environ["WINE"], os.environ["FMU_IMPORTER_WINDOWS"]]
                there = self.computed(wine, package, package.binary(windows=True), "Z:")
                np.testing.assert_allclose(there, here, rtol=1e-12)


if __name__ == "__main__":
    unittest.main()
