"""FMUs by an importer of the tests: every kind and version against the program, against each other and themselves."""

import ctypes as c
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
TWO = ("--set", "vehicle.motors=2")
STOPS = ("--set", "pitch.stop=20 deg")
HINGED_CRANK = "pitch-hinge-crank"


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

    def test_of_two_drives_keep_them_too(self):
        for vehicle in (CRANK, HINGED):
            for version in (2, 3):
                package = export(vehicle, version, *TWO)
                self.assertEqual(problems_of(package), [], (vehicle, version))
                for name in ("voltage_left", "voltage_right", "roll_moment", "status_left", "lift"):
                    self.assertIn(name, package.variables)
                self.assertNotIn("voltage", package.variables)

    def test_display_units_and_the_status(self):
        for version in (2, 3):
            package = export(CRANK, version)
            tag = "Real" if version == 2 else "Float64"

            def attributes(name):
                variable = package.variables[name]
                return variable[0] if version == 2 else variable

            for name, unit in (("crank_speed", "rpm"), ("stroke_angle", "deg"), ("flapping_velocity", "deg/s"),
                               ("transmission_rod_length", "mm")):  # fmt: skip
                self.assertEqual((attributes(name).tag, attributes(name).get("displayUnit")), (tag, unit))
            units = {d.get("name"): float(d.get("factor")) for d in package.xml.iter("DisplayUnit")}
            self.assertAlmostEqual(units["deg"] * np.pi, 180.0, 12)
            self.assertAlmostEqual(units["rpm"] * 2.0 * np.pi, 60.0, 12)
            self.assertEqual(attributes("status").tag, "Enumeration")
            items = {item.get("name"): int(item.get("value")) for item in package.xml.iter("Item")}
            self.assertEqual(items, {"starting": 0, "flapping": 1, "standing": 2, "jammed": 3})

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


    def test_at_a_standstill_the_means_are_0(self):
        package = export(CRANK)
        means = [name for name in package.variables if name.endswith("_mean")]
        instance = Instance(package, True, 0.0)
        steps(instance, 0.0, 0.5)
        cycles = instance.whole("cycles")
        self.assertEqual(instance.whole("status"), 1)
        instance.set({"voltage": 0.0})  # nothing but air and load-proportional friction brakes it
        steps(instance, 0.5, 1.5)
        self.assertEqual(instance.whole("status"), 2)
        self.assertEqual(instance.get(*means), [0.0] * len(means))
        # The other way round cycles count as well.
        stood = instance.whole("cycles")
        self.assertLess(stood, cycles + 5)
        instance.set({"voltage": -3.0})
        steps(instance, 1.5, 1.52)
        self.assertEqual(instance.whole("status"), 0)
        steps(instance, 1.52, 2.5)
        self.assertEqual(instance.whole("status"), 1)
        self.assertGreater(instance.whole("cycles"), stood + 10)
        lift, frequency = instance.get("lift_mean", "frequency_mean")
        self.assertGreater(lift, 5e-3)
        # And after a reversal without a standstill.
        instance.set({"voltage": 3.0})
        steps(instance, 2.5, 3.5)
        expected = run(CRANK)
        self.assertEqual(instance.whole("status"), 1)
        found = instance.get("lift_mean", "frequency_mean")
        np.testing.assert_allclose(found, [expected["lift_mean_n"], expected["frequency_hz"]], rtol=1e-5)
        instance.close()
        direct = Instance(export(DIRECT), True, 0.0)
        steps(direct, 0.0, 0.5)
        self.assertEqual(direct.whole("status"), 1)
        direct.set({"voltage": 0.0})
        steps(direct, 0.5, 3.0, 0.01)
        self.assertEqual(direct.whole("status"), 2)
        self.assertEqual(direct.get("lift_mean", "frequency_mean"), [0.0, 0.0])
        direct.close()

    def test_an_input_that_was_set_wins_over_its_parameter(self):
        for version in (2, 3):
            for name, parameter, vehicle in (("voltage", "supply_voltage", CRANK),
                                             ("frequency", "supply_frequency", DIRECT)):  # fmt: skip
                instance = Instance(export(vehicle, version), True)
                instance.set({name: 2.5})
                instance.set({parameter: 2.0})
                instance.initialise()
                self.assertEqual(instance.get(name), [2.5])
                instance.reset()
                instance.set({parameter: 2.0})
                instance.initialise()
                self.assertEqual(instance.get(name), [2.0])
                instance.close()

    def test_the_drive_frequency_is_an_input(self):
        package = export(DIRECT, 2)
        co = Instance(package, True, 0.0, values={"solver_tolerance": 1e-10})
        me = Instance(package, False, 0.0)
        steps(co, 0.0, 0.213, 0.213)
        integrate(me, 0.213, 1e-10)
        before = co.get("terminal_voltage")[0]
        co.set({"frequency": 18.0})
        self.assertEqual(co.get("terminal_voltage")[0], before)  # the phase goes on
        me.event_mode()
        me.set({"frequency": 18.0})
        steps(co, 0.213, 1.513, 0.1)
        integrate(me, 1.513, 1e-10)
        names = ("frequency_mean", "lift_mean", "current_mean", "stroke_angle", "current")
        np.testing.assert_allclose(co.get(*names)[:3], me.get(*names)[:3], rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(co.get(*names)[3:], me.get(*names)[3:], rtol=1e-5, atol=1e-6)
        expected = run(DIRECT, "--set", "supply.frequency=18")
        self.assertLess(abs(co.get("frequency_mean")[0] / 18.0 - 1.0), 1e-9)
        self.assertLess(abs(co.get("lift_mean")[0] / expected["lift_mean_n"] - 1.0), 1e-5)
        for wrong in (0.0, -1.0, float("inf")):
            with self.assertRaises(FmuError):
                co.set({"frequency": wrong})
        co.close(), me.close()

    def test_restarting_where_the_fmu_says_so_is_enough(self):
        """As importers do that restart their integrators only where valuesOfContinuousStatesChanged is true."""
        for vehicle, options, end in ((CRANK, PWM, 0.06), (HINGED_CRANK, STOPS, 0.2), (HINGED, STOPS, 0.1)):
            package = export(vehicle, 2, *options)
            found = []
            for only_where_told in (False, True):
                me = Instance(package, False, 0.0)
                jumps = euler_until(me, end, only_where_told)
                found.append(me.states())
                self.assertGreater(jumps, 3)
                me.close()
            self.assertEqual(found[0], found[1], vehicle)

    def test_two_drives_move_each_for_itself(self):
        single = {v: run(CRANK, "--voltage", f"{v} V") for v in (2.8, 3.2)}
        for version in (2, 3):
            for co_simulation in (True, False):
                package = export(CRANK, version, *TWO)
                instance = Instance(package, co_simulation, 0.0,
                                    values={"voltage_left": 3.2, "voltage_right": 2.8, "hinge_offset": 5e-3})  # fmt: skip
                if co_simulation:
                    steps(instance, 0.0, 1.2, 0.05)
                else:
                    integrate(instance, 1.2, 1e-8)
                for side, voltage in (("left", 3.2), ("right", 2.8)):
                    frequency, lift = instance.get(f"frequency_mean_{side}", f"lift_mean_{side}")
                    self.assertLess(abs(frequency / single[voltage]["frequency_hz"] - 1.0), 1e-5)
                    self.assertLess(abs(lift / single[voltage]["lift_mean_n"] - 1.0), 1e-5)
                    self.assertEqual(instance.whole(f"status_{side}"), 1)
                names = ("lift", "current", "roll_moment", "pitch_moment", "lift_left", "lift_right",
                         "stroke_angle_left", "stroke_angle_right", "current_left", "current_right")  # fmt: skip
                lift, current, roll, pitch, left, right, beta_left, beta_right, i_left, i_right = instance.get(*names)
                self.assertAlmostEqual(lift, left + right, 12)
                self.assertAlmostEqual(current, i_left + i_right, 12)
                # S_3/S_2 of a semi-ellipse without offset, from the moments that both give.
                a = [left * np.cos(beta_left) - right * np.cos(beta_right),
                     left * np.sin(beta_left) + right * np.sin(beta_right)]  # fmt: skip
                lever = pitch / a[1]
                self.assertTrue(0.03 < lever < 0.06, lever)
                self.assertAlmostEqual(roll, lever * a[0] + 5e-3 * (left - right), 12)
                instance.close()

    def test_two_drives_alike_are_the_vehicle(self):
        battery = "friction2022-battery"
        expected = run(battery, *TWO)
        instance = Instance(export(battery, 2, *TWO), True, 0.0, values={"solver_tolerance": 1e-10})
        steps(instance, 0.0, 1.5, 0.05)
        lift, power, roll, yaw = instance.get("lift_mean", "power_electrical_mean", "roll_moment", "yaw_moment")
        self.assertLess(abs(lift / expected["lift_mean_n"] - 1.0), 1e-5)
        self.assertLess(abs(power / expected["power_electrical_w"] - 1.0), 1e-5)
        self.assertEqual((roll, yaw), (0.0, 0.0))
        instance.close()


def euler_until(instance, end, only_where_told):
    """Model exchange by two-step Adams formulas on a fixed grid that events divide; returns the number of restarts. An
    importer that does not restart uses the rate before the event."""
    time, restarts, before = 0.0, 0, None
    _, _, following = instance.update()
    while time < end - 1e-12:
        stop = min(time + 1e-5, end, following if following is not None else end)
        y, rate = np.array(instance.states()), np.array(instance.rates())
        last = rate if before is None else before
        h = stop - time
        instance.put(stop, y + h * (1.5 * rate - 0.5 * last))
        before, time = rate, stop
        if (following is None or time < following) and min(instance.indicators()) > 0.0:
            continue
        instance.event_mode()
        states, rates = instance.states(), instance.rates()
        _, changed, following = instance.update()
        jumps = instance.states() != states or instance.rates() != rates
        if changed if only_where_told else jumps:
            before, restarts = None, restarts + 1
    return restarts


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


class Sources(unittest.TestCase):
    def test_gcc_compiles_them_by_itself(self):
        for version in (2, 3):
            package = export(CRANK, version, "--sources")
            self.assertEqual(problems_of(package), [])
        sources = package.root / "sources"
        told = (sources / "README.txt").read_text().replace("\\\n", " ")
        command = next(line for line in told.splitlines() if line.strip().startswith("gcc ")).split()
        # As README.txt says but for optimisation, and with the list of all files read.
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

    @unittest.skipUnless(os.environ.get("ARM_COMPILER"), "needs a cross compiler for ARM and qemu")
    def test_they_give_the_same_numbers_on_arm(self):
        package = export(CRANK, 3, "--sources")
        sources = package.root / "sources"
        compiler, emulator = os.environ["ARM_COMPILER"], os.environ["ARM_EMULATOR"].split(";")
        subprocess.run([compiler, "-std=c++20", "-O0", "-fPIC", "-shared", "-fvisibility=hidden", "-fno-gnu-unique",
                        "-DFMI2_OVERRIDE_FUNCTION_PREFIX", "-DFMI3_OVERRIDE_FUNCTION_PREFIX", "-I.", "fmu.cpp", "-o",
                        "arm.so"], cwd=sources, check=True)  # fmt: skip
        importer = pathlib.Path(FOLDER.name) / "arm_importer"
        examples = pathlib.Path(os.environ["FMU_EXAMPLES"])
        subprocess.run([compiler.replace("g++", "gcc"), "-std=gnu11", "-I", examples.parent.parent / "src",
                        examples / "importer.c", "-o", importer, "-ldl"], check=True)  # fmt: skip
        references = [str(package.reference(name)) for name in ("crank_angle", "current", "lift_mean")]

        def told(command, binary):
            line = [*command, binary, package.root / "resources", package.token, "3", "0.2", "0.001", *references]
            return [float(x) for x in subprocess.run(line, capture_output=True, check=True).stdout.split()]

        here = told([os.environ["FMU_IMPORTER"]], package.binary())
        np.testing.assert_allclose(told([*emulator, importer], sources / "arm.so"), here, rtol=1e-9)


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
