"""Functions of the standard: states, derivatives, dependencies, refusals, threads, speed."""

import ctypes as c
import re
import subprocess
import threading
import time
import unittest

import numpy as np
from exported import CRANK, DIRECT, HINGED, TWO, export, run, steps
from importer import FmuError, Instance, integrate


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
                    if known in ("state_crank_angle", "state_supply_phase"):
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

    def test_no_number_hangs_or_ends_the_host(self):
        inf, nan = float("inf"), float("nan")
        for version in (2, 3):
            package = export(CRANK, version)
            for start in (nan, inf, -inf, 1e300):
                instance = Instance(package, True)
                with self.assertRaisesRegex(FmuError, "start time"):
                    instance.initialise(start)
                instance.initialise(0.0)
                instance.close()
            instance = Instance(package, True, 0.0)
            for length, said in ((inf, "finite"), (nan, "finite"), (-1.0, "go back"), (1e9, "at most 1000 s")):
                with self.assertRaisesRegex(FmuError, said):
                    instance.step(0.0, length)
            with self.assertRaisesRegex(FmuError, "finite"):
                instance.step(nan, 0.1)
            instance.step(0.0, 0.1)
            state = instance.save()
            content = instance.serialise(state)
            for size in (2**63, 2**64 - 1, 2**40, len(content) + 1, len(content) - 1, 0, 7):
                with self.assertRaisesRegex(FmuError, "no state that was serialised"):
                    instance.deserialise(content, size)
            for at in (0, 30, 200, len(content) - 1):
                spoilt = bytearray(content)
                spoilt[at] ^= 0x55
                with self.assertRaisesRegex(FmuError, "no state that was serialised"):
                    instance.deserialise(bytes(spoilt))
            other = Instance(export(DIRECT, version), True, 0.0)
            back = other.deserialise(content)
            with self.assertRaisesRegex(FmuError, "another FMU"):
                other.restore(back)
            other.free(back)
            instance.free(state)
            with self.assertRaisesRegex(FmuError, "has been freed"):
                instance.restore(state)
            function = instance.functions.fmi2GetReal if version == 2 else instance.functions.fmi3GetFloat64
            for handle, count in ((None, 1), (instance.handle, 1), (instance.handle, 2**63)):
                arguments = [handle, None, c.c_size_t(count), None]
                self.assertEqual(function(*arguments, *([] if version == 2 else [c.c_size_t(count)])), 3)
            instance.step(0.1, 0.1)
            instance.close(), other.close()
            me = Instance(package, False, 0.0)
            me.update()
            for t in (nan, inf, 1e9):
                with self.assertRaisesRegex(FmuError, "SetTime"):
                    me.put(t, me.states())
            me.close()

    def test_a_parameter_that_takes_a_state_away_is_refused(self):
        instance = Instance(export(CRANK), True)
        with self.assertRaisesRegex(FmuError, "armature_inductance: must stay > 0 H"):
            instance.set({"motor_armature_inductance": 0.0})
            instance.initialise()
        instance.close()
        two = Instance(export(CRANK, 2, *TWO), True)
        with self.assertRaisesRegex(FmuError, "vehicle_motors must not be"):
            two.set({"vehicle_motors": 1.0})
        two.close()

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
        symbols = subprocess.run(["readelf", "--symbols", "--wide", package.binary()], capture_output=True, text=True,
                                 check=True).stdout  # fmt: skip
        self.assertNotIn("UNIQUE", symbols)
        newest = max(tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_([0-9.]+)", said))
        page = (package.root / "documentation/index.html").read_text()
        stated = re.search(r"glibc ([0-9.]+) or newer", page).group(1)
        self.assertLessEqual(newest, tuple(map(int, stated.split("."))))


if __name__ == "__main__":
    unittest.main()
