"""FMUs by an importer of the tests: every kind and version against the program, against each other and themselves."""

import ctypes as c
import os
import subprocess
import unittest

import numpy as np
from description import problems_of
from exported import CRANK, DIRECT, FLYING, HINGED, HINGED_CRANK, PWM, STOPS, TWO, export, run, steps
from importer import FmuError, Instance, integrate


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


class Bodies(unittest.TestCase):
    def test_keep_the_rules_of_the_standard(self):
        for options in ((), TWO, ("--set", "body.wing_mass=50 mg", "--set", "body.wing_centre=20 mm")):
            for version in (2, 3):
                package = export(FLYING, version, *options)
                self.assertEqual(problems_of(package), [], (options, version))
                for name in ("state_body_attitude_0", "wind_x", "body_force_z", "initial_body_pitch"):
                    self.assertIn(name, package.variables)

    def test_both_kinds_fly_alike(self):
        """Thrown in wind, with the stroke planes moved and the voltage changed on the way."""
        values = {"initial_body_velocity_x": 0.5, "initial_body_pitch": 0.2, "initial_body_rate_x": 1.0,
                  "initial_body_position_z": -2.0, "wind_y": 0.4, "mean_stroke_angle": 0.05}  # fmt: skip
        states = [f"body_{what}_{axis}" for what in ("position", "velocity", "rate") for axis in "xyz"]
        states += [f"body_attitude_{k}" for k in range(4)] + ["crank_angle", "body_force_x", "lift_mean"]
        found = []
        for version in (2, 3):
            package = export(FLYING, version)
            co = Instance(package, True, 0.0, values={**values, "solver_tolerance": 1e-10})
            me = Instance(package, False, 0.0, values=values)
            for part in range(2):
                steps(co, 0.1 * part, 0.1 * (part + 1), 0.01)
                integrate(me, 0.1 * (part + 1), 1e-9)
                if part == 1:
                    break
                me.event_mode()
                for instance in (co, me):
                    instance.set({"voltage": 5.0, "wind_x": -0.3, "stroke_plane_difference": 0.02})
            np.testing.assert_allclose(co.get(*states), me.get(*states), rtol=1e-5, atol=1e-6)
            found.append(co.get(*states))
            self.assertGreater(np.linalg.norm(co.get("body_position_x", "body_position_y")), 0.02)
            co.close(), me.close()
        self.assertEqual(found[0], found[1])

    def test_without_body_it_is_the_drive(self):
        for version in (2, 3):
            package = export(FLYING, version, "--without-body")
            self.assertFalse([name for name in package.variables if name.startswith(("body_", "wind", "state_body"))])
            instance = Instance(package, True, 0.0)
            steps(instance, 0.0, 1.0, 0.1)
            expected = run(FLYING)
            self.assertLess(abs(instance.get("lift_mean")[0] / expected["lift_mean_n"] - 1.0), 1e-5)
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


if __name__ == "__main__":
    unittest.main()
