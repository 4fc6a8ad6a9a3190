"""FMUs by an importer of the tests: every kind and version against the program, against each other and themselves."""

import json
import os
import pathlib
import re
import subprocess
import tempfile
import threading
import time
import unittest

import numpy as np
from description import problems_of
from importer import OK, FmuError, Instance, Package, integrate

PROGRAM = os.environ["WINGBEAT_PROGRAM"]
FOLDER = tempfile.TemporaryDirectory(prefix="wingbeat-fmus-")
CRANK, DIRECT, HINGED = "friction2022", "direct-drive", "pitch-hinge"
PWM = ("--set", "supply.type=\"pwm\"", "--set", "supply.voltage=4", "--set", "supply.duty=0.75",
       "--set", "supply.frequency=2e3")  # fmt: skip


def export(vehicle, version=2, *options):
    file = pathlib.Path(FOLDER.name) / f"{vehicle}{version}{abs(hash(options)) if options else ''}.fmu"
    if not file.exists():
        made = [PROGRAM, "export-fmu", vehicle, "-o", file, "--fmi", str(version), *options]
        subprocess.run(made, check=True, capture_output=True)
    return Package(file)


def run(vehicle, *options):
    found = subprocess.run([PROGRAM, "run", vehicle, "--json", "--tolerance", "1e-9", *options], capture_output=True)
    return json.loads(found.stdout)


def steps(instance, begin, end, length=1e-3):
    for k in range(round((end - begin) / length)):
        instance.step(begin + k * length, length)


class Descriptions(unittest.TestCase):
    def test_keep_the_rules_of_the_standard(self):
        for vehicle in (CRANK, DIRECT, HINGED):
            for version in (2, 3):
                for kind in ("me", "cs", "both"):
                    package = export(vehicle, version, "--kind", kind)
                    self.assertEqual(problems_of(package), [], (vehicle, version, kind))

    def test_every_number_of_the_vehicle_is_a_parameter(self):
        package = export(CRANK)
        self.assertEqual(package.variables["motor_inertia"].find("Real").get("unit"), "kg.m2")
        self.assertEqual(package.variables["friction_radius"].get("variability"), "tunable")
        self.assertEqual(package.variables["transmission_crank_radius"].get("variability"), "fixed")
        instance = Instance(package, True, 0.0)
        self.assertEqual(instance.text("transmission_type"), "slider-crank")
        instance.close()


class Numbers(unittest.TestCase):
    def test_both_kinds_give_the_orbit_of_the_program(self):
        for vehicle in (CRANK, DIRECT, HINGED):
            expected = run(vehicle)
            transient = run(vehicle, "--method", "transient")
            for version in (2, 3):
                package = export(vehicle, version)
                for measure in (self.by_co_simulation, self.by_cvode):
                    with self.subTest(vehicle=vehicle, version=version, kind=measure.__name__):
                        lift, frequency, power, peak = measure(package, 1.5)
                        self.assertLess(abs(peak / expected["current_peak_a"] - 1.0), 1e-6)
                        for reference in (expected, transient):
                            self.assertLess(abs(lift / reference["lift_mean_n"] - 1.0), 1e-6)
                            self.assertLess(abs(frequency / reference["frequency_hz"] - 1.0), 1e-6)
                            self.assertLess(abs(power / reference["power_electrical_w"] - 1.0), 1e-6)

    def by_co_simulation(self, package, end):
        instance = Instance(package, True, 0.0, values={"solver_tolerance": 1e-10})
        steps(instance, 0.0, end, 0.05)
        self.assertEqual(instance.whole("status"), 1)
        lift, frequency, power = instance.get("lift_mean", "frequency_mean", "power_electrical_mean")
        peak = self.peak_current(instance, end, frequency)
        instance.close()
        return lift, frequency, power, peak

    def by_cvode(self, package, end):
        """Model exchange; the importer gives the peak of the first variable, the current, last."""
        one = Instance(package, False, 0.0)
        counts = [str(one.state_count), str(one.indicator_count)]
        one.close()
        names = ("current", "lift_mean", "frequency_mean", "power_electrical_mean")
        command = [os.environ["FMU_CVODE_IMPORTER"], package.binary(), package.root / "resources", package.token,
                   str(package.version), *counts, str(end), "1e-10",
                   *[str(package.reference(name)) for name in names]]  # fmt: skip
        found = subprocess.run(command, capture_output=True, text=True, check=True)
        return [float(line) for line in found.stdout.split()][1:]

    def peak_current(self, instance, begin, frequency):
        count = 2000
        length = 1.0 / frequency / count
        current = []
        for k in range(count + 2):
            instance.step(begin + k * length, length)
            current.append(instance.get("current")[0])
        n = min(max(int(np.argmax(current)), 1), count)
        a, b, c = current[n - 1 : n + 2]
        return b - 0.125 * (a - c) ** 2 / (a - 2 * b + c)

    def test_any_communication_step_gives_the_same(self):
        package = export(CRANK)
        found = []
        for length in (1e-3, 7e-3, 0.28):
            instance = Instance(package, True, 0.0, values={"solver_tolerance": 1e-10})
            steps(instance, 0.0, 0.56, length)
            found.append(instance.get("crank_angle", "current", "sum_lift"))
            instance.close()
        for other in found[1:]:
            np.testing.assert_allclose(other, found[0], rtol=1e-8)

    def test_a_step_of_voltage_and_a_tunable_change(self):
        for version in (2, 3):
            package = export(CRANK, version)
            co, me = Instance(package, True, 0.0, values={"solver_tolerance": 1e-10}), Instance(package, False, 0.0)
            steps(co, 0.0, 0.4, 0.1)
            integrate(me, 0.4, 1e-10)
            changes = {"voltage": 3.3, "load_torque": 2e-5, "friction_radius": 2e-3}
            co.set(changes)
            me.event_mode()
            me.set(changes)
            steps(co, 0.4, 1.6, 0.1)
            integrate(me, 1.6, 1e-10)
            names = ("lift_mean", "frequency_mean", "current_mean", "power_friction_mean")
            np.testing.assert_allclose(co.get(*names), me.get(*names), rtol=1e-6)
            slower = run(CRANK, "--voltage", "3.3 V", "--set", "friction.radius=2e-3")["frequency_hz"]
            self.assertLess(co.get("frequency_mean")[0], slower)  # the load takes some
            co.set({"load_torque": 0.0})
            steps(co, 1.6, 2.8, 0.1)
            self.assertLess(abs(co.get("frequency_mean")[0] / slower - 1.0), 1e-6)
            co.close(), me.close()

    def test_pwm_edges_are_events(self):
        package = export(CRANK, 2, *PWM)
        # Load-proportional friction fades with the speed; that of the motor holds it in the end.
        values = {"motor_friction_torque": 2e-4, "solver_tolerance": 1e-10}
        co, me = (Instance(package, kind, 0.0, values=values) for kind in (True, False))
        steps(co, 0.0, 0.2, 0.05)
        integrate(me, 0.2, 1e-9)
        names = ("crank_angle", "current", "lift_mean")
        np.testing.assert_allclose(co.get(*names), me.get(*names), rtol=1e-6)
        co.set({"duty": 0.0})
        steps(co, 0.2, 1.2, 0.1)
        self.assertEqual(co.whole("status"), 2)
        co.close(), me.close()

    def test_it_stalls_under_load_and_breaks_away(self):
        for co_simulation in (True, False):
            instance = Instance(export(CRANK), co_simulation, 0.0, values={"motor_friction_torque": 2e-4})

            def go(begin, end):
                if co_simulation:
                    steps(instance, begin, end, 0.01)
                else:
                    integrate(instance, end, 1e-9)
                    instance.event_mode()

            go(0.0, 0.3)
            instance.set({"voltage": 0.0})
            go(0.3, 1.3)
            self.assertEqual(instance.whole("status"), 2)
            self.assertEqual(instance.get("crank_speed")[0], 0.0)
            angle = instance.get("crank_angle")[0]
            go(1.3, 1.5)
            self.assertEqual(instance.get("crank_angle")[0], angle)
            instance.set({"voltage": 3.0})
            go(1.5, 2.5)
            self.assertEqual(instance.whole("status"), 1)
            expected = run(CRANK, "--set", "motor.friction_torque=2e-4")["frequency_hz"]
            self.assertLess(abs(instance.get("frequency_mean")[0] / expected - 1.0), 1e-6)
            instance.close()


class Functions(unittest.TestCase):
    def test_states_come_back_bit_for_bit(self):
        for vehicle in (CRANK, HINGED):
            for version in (2, 3):
                instance = Instance(export(vehicle, version), True, 0.0)
                names = [n for n, v in instance.package.variables.items() if v.get("causality") == "output"][:-2]
                steps(instance, 0.0, 0.2, 0.01)
                state = instance.save()
                steps(instance, 0.2, 0.4, 0.01)
                first = instance.get(*names)
                instance.restore(state)
                steps(instance, 0.2, 0.4, 0.01)
                self.assertEqual(instance.get(*names), first)
                content = instance.serialise(state)
                other = Instance(instance.package, True, 0.0)
                back = other.deserialise(content)
                other.restore(back)
                steps(other, 0.2, 0.4, 0.01)
                self.assertEqual(other.get(*names), first)
                instance.free(state), other.free(back)
                instance.reset()
                instance.initialise(0.0)
                steps(instance, 0.0, 0.2, 0.01)
                steps(instance, 0.2, 0.4, 0.01)
                self.assertEqual(instance.get(*names), first)
                instance.close(), other.close()

    def test_directional_derivatives(self):
        for vehicle in (CRANK, DIRECT, HINGED):
            for version in (2, 3):
                instance = Instance(export(vehicle, version), False, 0.0)
                integrate(instance, 0.317, 1e-6)
                variables = instance.package.variables
                derivatives = [n for n in variables if n.startswith("der(")]
                states = [n[4:-1] for n in derivatives]
                outputs = [n for n, v in variables.items() if v.get("causality") == "output"
                           and v.get("variability") == "continuous"]  # fmt: skip
                inputs = [n for n, v in variables.items() if v.get("causality") == "input"]
                unknowns, at = derivatives + outputs, np.array(instance.states())
                now = instance.get("time")[0]
                for known in states + inputs:
                    exact = np.array(instance.directional(unknowns, [known], [1.0]))

                    def values(change):
                        if known in inputs:
                            instance.set({known: begin + change})
                        else:
                            moved = at.copy()
                            moved[states.index(known)] += change
                            instance.put(now, moved)
                        return np.array(instance.get(*unknowns))

                    begin = instance.get(known)[0]
                    size = 1e-4 if known == "load_torque" else min(max(abs(begin), 1e-2), 100.0)
                    if known == "state_crank_angle":
                        size = 0.2
                    h = 1e-3 * size
                    difference = (8 * (values(h) - values(-h)) - (values(2 * h) - values(-2 * h))) / (12 * h)
                    values(0.0)
                    scale = np.abs(values(0.0)) / size + np.abs(exact)
                    scale[scale == 0.0] = 1.0
                    self.assertLess(np.max(np.abs(exact - difference) / scale), 1e-8, (vehicle, known))
                instance.close()

    def test_declared_dependencies_are_all(self):
        for vehicle in (CRANK, DIRECT, HINGED):
            package = export(vehicle, 3)
            instance = Instance(package, False, 0.0)
            integrate(instance, 0.317, 1e-6)
            names = {v.get("valueReference"): n for n, v in package.variables.items()}
            structure = package.xml.find("ModelStructure")
            states = [n[4:-1] for n in package.variables if n.startswith("der(")]
            knowns = states + [n for n, v in package.variables.items() if v.get("causality") == "input"]
            for element in [*structure.findall("Output"), *structure.findall("ContinuousStateDerivative")]:
                name = names[element.get("valueReference")]
                if package.variables[name].get("variability") == "discrete":
                    continue
                declared = {names[r] for r in element.get("dependencies").split()}
                for known in knowns:
                    slope = instance.directional([name], [known], [1.0])[0]
                    if known not in declared:
                        self.assertEqual(slope, 0.0, (vehicle, name, known))
            instance.close()

    def test_what_is_wrong_is_refused(self):
        for version in (2, 3):
            package = export(CRANK, version)
            instance = Instance(package, True)
            for values in ({"motor_inertia": -1.0}, {"motor_armature_resistance": float("nan")}, {"lift": 1.0}):
                with self.assertRaises(FmuError):
                    instance.set(values)
            instance.initialise()
            with self.assertRaisesRegex(FmuError, "motor_inertia must not be set now"):
                instance.set({"motor_inertia": 1e-7})
            with self.assertRaisesRegex(FmuError, "communication point"):
                instance.step(1.0, 0.1)
            with self.assertRaisesRegex(FmuError, "must not be called now"):
                instance.put(0.0, instance.states())
            instance.terminate()
            with self.assertRaises(FmuError):
                instance.step(0.0, 0.1)
            instance.close()
            package.token = "{other}"
            with self.assertRaisesRegex(FmuError, "token"):
                Instance(package, True)

    def test_a_parameter_counts_from_the_start(self):
        values = {"transmission_crank_radius": 4e-3, "motor_inertia": 2e-7, "solver_tolerance": 1e-10}
        instance = Instance(export(CRANK), True, 0.0, values=values)
        steps(instance, 0.0, 1.5, 0.1)
        options = ("--set", "transmission.crank_radius=4e-3", "--set", "motor.inertia=2e-7")
        self.assertLess(abs(instance.get("lift_mean")[0] / run(CRANK, *options)["lift_mean_n"] - 1.0), 1e-6)
        instance.close()

    def test_a_thousand_instances_in_threads(self):
        package = export(CRANK)
        found = [None] * 1000

        def work(first):
            made = [Instance(package, True, 0.0) for _ in range(first, 1000, 4)]
            for k, instance in enumerate(made):
                instance.step(0.0, 0.01)
                found[first + 4 * k] = tuple(instance.get("crank_angle", "current", "lift"))
            for instance in made:
                instance.close()

        threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(found)), 1)
        self.assertIsNotNone(found[0])

    def test_co_simulation_is_faster_than_real_time(self):
        instance = Instance(export(CRANK), True, 0.0)
        factor = 0.0
        for n in range(5):  # the fastest part: other programs may be running
            begin = time.process_time()
            steps(instance, 0.5 * n, 0.5 * (n + 1), 0.01)
            factor = max(factor, 0.5 / (time.process_time() - begin))
        print(f"co-simulation: {factor:.0f} times faster than real time, in steps of 10 ms")
        self.assertGreater(factor, 50.0)
        instance.close()

    def test_the_binary_needs_libc_and_libm_alone(self):
        package = export(CRANK)
        said = subprocess.run(["ldd", package.root / "binaries/linux64" / f"{package.identifier}.so"],
                              capture_output=True, text=True, check=True).stdout  # fmt: skip
        needed = {line.split()[0].split("/")[-1].split(".so")[0] for line in said.splitlines()}
        self.assertLessEqual(needed, {"linux-vdso", "libm", "libc", "ld-linux-x86-64"})
        said = subprocess.run(["objdump", "-T", package.binary()], capture_output=True, text=True, check=True).stdout
        newest = max(tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_([0-9.]+)", said))
        page = (package.root / "documentation/index.html").read_text()
        stated = re.search(r"glibc ([0-9.]+) or newer", page).group(1)
        self.assertLessEqual(newest, tuple(map(int, stated.split("."))))


class Sources(unittest.TestCase):
    def test_gcc_compiles_them_by_itself(self):
        for version in (2, 3):
            package = export(CRANK, version, "--sources")
            self.assertEqual(problems_of(package), [])
        sources = package.root / "sources"
        told = (sources / "README.txt").read_text().replace("\\\n", " ")
        command = next(line for line in told.splitlines() if line.strip().startswith("gcc ")).split()
        # As it is told but for optimisation, and with the list of all files read.
        command[command.index("-O2")] = "-O0"
        subprocess.run([*command, "-MD", "-MF", "read.txt"], cwd=sources, check=True)
        read = (sources / "read.txt").read_text()
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


class Importers(unittest.TestCase):
    REFERENCES = ("crank_angle", "current", "frequency_mean", "lift_mean", "power_friction")

    def told(self, importer, package, binary, folder=""):
        references = [str(package.reference(name)) for name in self.REFERENCES]
        command = [*importer, folder + str(binary), folder + str(package.root / "resources"), package.token,
                   str(package.version), "0.5", "0.001", *references]  # fmt: skip
        found = subprocess.run(command, capture_output=True, text=True, check=True, timeout=500)
        return [float(line) for line in found.stdout.split()]

    def test_one_in_c(self):
        for version in (2, 3):
            package = export(CRANK, version)
            found = self.told([os.environ["FMU_IMPORTER"]], package, package.binary())
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
                here = self.told([os.environ["FMU_IMPORTER"]], package, package.binary())
                wine = [os.environ["WINE"], os.environ["FMU_IMPORTER_WINDOWS"]]
                there = self.told(wine, package, package.binary(windows=True), "Z:")
                np.testing.assert_allclose(there, here, rtol=1e-12)


if __name__ == "__main__":
    unittest.main()
