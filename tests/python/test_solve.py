"""One vehicle: what it does, its cycle, its derivatives, its start-up."""

import json
import os
import shutil
import subprocess
import threading
import time
import unittest
import unittest.mock

import numpy as np
import wingbeat as wb
from shared import DATA, PROGRAM, reference


class Solve(unittest.TestCase):
    def test_metrics_have_units_and_names_without_them(self):
        result = reference().solve(voltage="3 V", tolerance=1e-9)
        self.assertEqual((result.status, result.domain, result.settled), ("flapping", "inside", True))
        self.assertEqual(result.evidence, "steady flapping at 21.95 Hz")
        self.assertEqual((result.lift_mean.unit, result.lift_mean.long_name), ("N", "mean lift"))
        self.assertEqual(repr(wb.Quantity(0.5, "N")), "0.5 N")
        self.assertIsNone(result.winding_temperature)
        self.assertEqual(set(result.metrics), set(wb.metrics))
        for name, metric in wb.metrics.items():
            unit = metric.key.removeprefix(name)
            self.assertEqual(unit == "", metric.unit == "1", metric)
        with self.assertRaises(AttributeError):
            result.lift

    def test_a_notebook_shows_the_mechanism(self):
        vehicle = reference()
        result = vehicle.solve()
        for file in ("friction2022", "two-wing-four-bar", "direct-drive"):
            drawing = wb.read(DATA / "designs" / f"{file}.toml").drawing()
            if shutil.which("gnuplot"):
                self.assertTrue(drawing.startswith("<svg"), drawing[:80])
                self.assertIn("wing" if file != "friction2022" else "slider", drawing)
        with unittest.mock.patch.dict(os.environ, {"PATH": "/nowhere"}):
            self.assertEqual(vehicle.drawing(), "")
            bare = result._repr_html_()
            self.assertNotIn("<svg", bare)
            self.assertIn("<code>lift_mean</code>", bare)
            self.assertIn("<code>motor.inertia</code></td><td style='text-align:left'>1.5e-07 kg m2", vehicle._repr_html_())
        if shutil.which("gnuplot"):
            self.assertIn("<svg", result._repr_html_())
            self.assertIn("<svg", vehicle._repr_html_())

    def test_the_energy_balance_closes(self):
        balance = reference().solve(tolerance=1e-10).energy_balance
        self.assertLess(abs(balance.error), 1e-10)
        self.assertAlmostEqual(sum(balance[1:]), balance.electrical, 15)

    def test_the_energy_balance_holds_the_motors_own_friction(self):
        vehicle = reference().replace({"motor.friction_torque": "0.2 mN m"})
        result = vehicle.solve(tolerance=1e-10)
        balance = result.energy_balance
        self.assertGreater(balance.motor_friction, 0.01 * balance.electrical)
        self.assertEqual(balance.motor_friction, result.power_motor_friction)
        self.assertLess(abs(balance.error), 1e-10)
        self.assertAlmostEqual(sum(balance[1:]), balance.electrical, 15)

    @unittest.skipUnless(PROGRAM, "needs the program")
    def test_every_number_is_the_programs(self):
        for file in sorted((DATA / "designs").glob("*.toml")):
            vehicle = wb.read(file)
            flight = ["--endurance"] if vehicle["supply.type"].startswith("battery") else []
            found = subprocess.run([PROGRAM, "run", file, "--json", *flight], capture_output=True, text=True)
            printed = json.loads(found.stdout)
            result = vehicle.solve(endurance=True)
            self.assertEqual(result.status, printed["status"], file)
            self.assertEqual(result.evidence, printed["status_detail"], file)
            for name, value in result.metrics.items():
                self.assertEqual(value, printed[wb.metrics[name].key], (file, name))

    def test_not_flapping_is_a_result(self):
        vehicle = reference().replace({"motor.friction_torque": "1 N m"})
        result = vehicle.solve()
        self.assertEqual(result.status, "stalled")
        self.assertIn("stall torque", result.evidence)
        self.assertIsNone(result.lift_mean)
        self.assertIsNone(result.energy_balance)
        self.assertEqual(result.domain, "")
        self.assertTrue(np.isnan(result.gradient("lift_mean", "motor.inertia")))
        with self.assertRaisesRegex(ValueError, "there is no cycle"):
            result.cycle
        self.assertIn("stalled", repr(result))

    def test_a_frequency_and_a_lift_are_reached(self):
        result = reference().solve(frequency="1320 rpm")
        self.assertAlmostEqual(result.frequency, 22.0, 4)
        self.assertEqual(result.vehicle.solve().lift_mean, result.lift_mean)
        self.assertNotEqual(result.vehicle, reference())
        self.assertAlmostEqual(reference().solve(lift="10 mN").lift_mean, 0.01, 7)
        out_of_reach = reference().solve(lift="1 N")
        self.assertEqual(out_of_reach.status, "unreached")
        self.assertIn("cannot be reached", out_of_reach.evidence)

    def test_an_angle_of_attack_at_mid_stroke_is_reached(self):
        result = reference().solve(angle_of_attack="45 deg", lift="10 mN", tolerance=1e-8)
        self.assertAlmostEqual(float(result.angle_of_attack_min), 45.0, 4)
        self.assertAlmostEqual(float(result.lift_mean) / 0.01, 1.0, 6)
        wings = result.vehicle.aerodynamics
        self.assertNotEqual(wings.pitch_coefficient, reference().aerodynamics.pitch_coefficient)
        again = result.vehicle.solve(tolerance=1e-8)
        self.assertAlmostEqual(float(again.angle_of_attack_min), 45.0, 4)
        self.assertAlmostEqual(float(result.cycle.angle_of_attack.min()), 45.0, 2)
        self.assertTrue(abs(result.gradient("power_electrical", "aerodynamics.pitch_coefficient")) > 0)
        with self.assertRaisesRegex(wb.InputError, "^angle_of_attack: must be > 0, < 90"):
            reference().solve(angle_of_attack="95 deg")

    def test_a_cycle_has_units_and_closes(self):
        result = reference().solve(tolerance=1e-9)
        cycle = result.cycle
        self.assertEqual(dict(cycle.sizes), {"time": 361})
        self.assertEqual(cycle.lift.attrs, {"units": "N", "long_name": "lift of all wings"})
        self.assertAlmostEqual(float(cycle.time[-1]) * result.frequency, 1.0, 9)
        self.assertAlmostEqual(float(cycle.crank_speed[0] / cycle.crank_speed[-1]), 1.0, 8)
        mean = float(cycle.lift.integrate("time")) * result.frequency
        self.assertAlmostEqual(mean / result.lift_mean, 1.0, 4)
        self.assertIs(result.cycle, cycle)

    def test_wings_that_pitch_have_one_column_more(self):
        result = wb.read(DATA / "designs" / "pitch-hinge.toml").solve()
        self.assertEqual(result.cycle.pitch_angle.attrs["units"], "rad")
        self.assertNotIn("pitch_angle", reference().solve().cycle)

    def test_gradients_are_those_of_differences(self):
        vehicle = reference()
        keys = ["transmission.crank_radius", "supply.voltage", "friction.radius"]
        result = vehicle.solve(tolerance=1e-11)
        slopes = result.gradient("lift_mean", keys)
        for key, slope in zip(keys, slopes):
            value, step = vehicle[key], 1e-4 * vehicle[key]
            ends = [vehicle.replace({key: value + s}).solve(tolerance=1e-12).lift_mean for s in (step, -step)]
            self.assertAlmostEqual(slope / ((ends[0] - ends[1]) / (2 * step)), 1.0, 6, key)
        self.assertEqual(result.gradient("lift_mean_n", keys[1]), slopes[1])
        held = vehicle.solve(frequency="22 Hz", tolerance=1e-11)
        self.assertAlmostEqual(held.gradient("frequency", "friction.radius"), 0.0, 8)
        with self.assertRaisesRegex(wb.InputError, "did you mean lift_mean"):
            result.gradient("lift_meen", keys)
        with self.assertRaisesRegex(wb.InputError, "unknown key"):
            result.gradient("lift_mean", ["transmission.crank"])

    def test_a_notebook_shows_a_table(self):
        html = reference().solve()._repr_html_()
        self.assertIn("<td><code>lift_mean</code></td>", html)


class StartUp(unittest.TestCase):
    def test_it_ends_where_the_orbit_is(self):
        vehicle = reference()
        start = vehicle.simulate(tolerance=1e-8)
        self.assertEqual(start.status, "flapping")
        self.assertGreater(start.time_to_steady, 0.0)
        self.assertEqual(start.inrush_current.unit, "A")
        self.assertAlmostEqual(start.lift_mean / vehicle.solve(tolerance=1e-9).lift_mean, 1.0, 6)
        samples = start.samples
        self.assertEqual(samples.crank_speed.attrs["units"], "rad/s")
        self.assertEqual(float(samples.crank_speed[0]), 0.0)
        self.assertAlmostEqual(float(samples.current.max()) / start.inrush_current, 1.0, 2)
        self.assertTrue(any(what == "revolution" for _, _, what in start.events))

    def test_one_that_stays_locked(self):
        vehicle = wb.read(DATA / "designs" / "friction2022-springs.toml")
        start = vehicle.replace({"supply.voltage": "0.4 V"}).simulate()
        self.assertEqual(start.status, "locked")
        self.assertIsNone(start.lift_mean)


class Threads(unittest.TestCase):
    def test_other_threads_run_meanwhile(self):
        vehicle = wb.read(DATA / "designs" / "friction2022-springs.toml").replace({"motor.armature_inductance": "1 uH"})
        counted = 0
        done = threading.Event()

        def count():
            nonlocal counted
            while not done.wait(0.001):
                counted += 1

        other = threading.Thread(target=count)
        other.start()
        begin = time.monotonic()
        while time.monotonic() - begin < 0.3:
            vehicle.simulate(tolerance=1e-10)
        done.set()
        other.join()
        self.assertGreater(counted, 20)


if __name__ == "__main__":
    unittest.main()
