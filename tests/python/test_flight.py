"""Vehicles in flight: simulation, trim, stability, and their bodies as models of MuJoCo."""

import copy
import ctypes
import json
import pathlib
import subprocess
import tempfile
import threading
import unittest
import xml.etree.ElementTree as xml

import numpy as np
import wingbeat as wb
from shared import DATA, PROGRAM, ROOT

VEHICLES = ("flight-friction2022", "flight-x-wing", "flight-purdue")


def flyer(name=VEHICLES[0]):
    return wb.read(DATA / "designs" / f"{name}.toml")


def in_trim(vehicle, **options):
    """A flight in the trim of hover, and that trim."""
    hover = vehicle.trim()
    flight = vehicle.flight_simulation(**options)
    flight.start(hover.body, hover.drives)
    flight.command(hover.controls)
    return flight, hover


class Simulations(unittest.TestCase):
    def test_energy_is_conserved(self):
        for name in VEHICLES:
            with self.subTest(name):
                flight, _ = in_trim(flyer(name), tolerance=1e-9)
                flight.blow([0.3, -0.2, 0.1])
                before = flight.stored_energy
                self.assertTrue(flight.step_to("60 ms"))
                t = flight.totals
                spent = t.motor + t.friction + t.wing_air + t.residual + t.stops
                gained = t.electrical + t.body_air - spent
                self.assertGreater(t.electrical, 1e-3)
                self.assertAlmostEqual((flight.stored_energy - before - gained) / t.electrical, 0.0, 6)

    def test_momentum_follows_from_the_impulse(self):
        """Of a flight that does not turn, body axes are those of the earth."""
        vehicle = flyer("flight-x-wing")
        flight, _ = in_trim(vehicle, tolerance=1e-9)
        self.assertTrue(flight.step_to(0.1))
        np.testing.assert_allclose(flight.body.euler_angles, 0.0, atol=1e-9)
        mass, weight = vehicle["vehicle.mass"], vehicle["vehicle.mass"] * 9.80665
        change = flight.totals.impulse + [0.0, 0.0, weight * 0.1]
        np.testing.assert_allclose(mass * flight.body.velocity, change, atol=1e-8 * weight)

    def test_wind_is_motion_against_the_air(self):
        vehicle = flyer()
        loads = []
        for speed, wind in ((0.8, None), (0.0, [-0.8, 0.0, 0.0]), (0.0, lambda time, place: (-0.8, 0.0, 0.0))):
            flight, hover = in_trim(vehicle, frozen=True)
            flight.start(wb.BodyState.at(velocity=[speed, 0, 0]), hover.drives)
            flight.blow(wind)
            self.assertTrue(flight.step("13 ms"))
            loads.append([*flight.loads.force, *flight.loads.moment, *flight.totals.impulse])
        self.assertGreater(np.abs(loads[0][0]), 1e-4)
        np.testing.assert_allclose(loads[1], loads[0], rtol=1e-7, atol=1e-12)  # as accurate as steps are
        np.testing.assert_array_equal(loads[2], loads[1])

    def test_a_frozen_body_in_trim_carries_its_weight(self):
        for name in VEHICLES[:2]:
            flight, hover = in_trim(flyer(name), frozen=True, tolerance=1e-9)
            period = 1.0 / hover["frequency_hz"]
            flight.step_to(period)
            force = flight.body.rotation @ flight.totals.impulse / period
            weight = hover.vehicle["vehicle.mass"] * 9.80665
            np.testing.assert_allclose(force / weight, [0.0, 0.0, -1.0], atol=1e-4)
            self.assertAlmostEqual(flight.totals.electrical / period / hover["power_electrical_w"], 1.0, 5)

    def test_copies_go_their_own_way(self):
        flight, hover = in_trim(flyer("flight-purdue"))
        flight.step_to(0.02)
        other = copy.deepcopy(flight)
        self.assertEqual(flight.step_to(0.03), other.step_to(0.03))
        np.testing.assert_array_equal(np.concatenate(flight.body), np.concatenate(other.body))
        np.testing.assert_array_equal(flight.drives, other.drives)
        other.command({"voltage_difference": "1 V"})
        flight.step_to(0.05), other.step_to(0.05)
        self.assertEqual(flight.controls["voltage_difference"], 0.0)
        self.assertGreater(abs(other.body.rates[0] - flight.body.rates[0]), 0.1)

    def test_what_the_wind_raises_leaves_the_flight_where_it_was(self):
        flight, _ = in_trim(flyer())
        flight.step_to(0.01)
        before = np.concatenate(flight.body)

        def broken(time, place):
            if time > 0.015:
                raise KeyError("no such wind")
            return (0.0, 0.0, 0.0)

        flight.blow(broken)
        with self.assertRaisesRegex(KeyError, "no such wind"):
            flight.step_to(0.03)
        self.assertEqual(flight.time, 0.01)
        np.testing.assert_array_equal(np.concatenate(flight.body), before)
        flight.blow(lambda time, place: flight.step_to(0.02) and (0, 0, 0))
        with self.assertRaisesRegex(RuntimeError, "is being stepped"):
            flight.step_to(0.03)
        flight.blow(None)
        self.assertTrue(flight.step_to(0.03))

    def test_other_threads_run_meanwhile(self):
        flight, _ = in_trim(flyer(), tolerance=1e-10)
        thread = threading.Thread(target=flight.step_to, args=(0.5,))
        thread.start()
        count = 0
        while thread.is_alive():
            count += 1
        self.assertGreater(count, 1000)

    def test_attitudes(self):
        angles = np.array([0.3, -0.4, 2.0])
        body = wb.BodyState.at(euler_angles=angles)
        np.testing.assert_allclose(body.euler_angles, angles, atol=1e-14)
        np.testing.assert_allclose(body.rotation @ body.rotation.T, np.eye(3), atol=1e-14)
        # Nose down by 0.4 rad: the nose points downwards, which is +z.
        self.assertAlmostEqual(body.rotation[2, 0], np.sin(0.4))

    def test_what_is_refused(self):
        flight = flyer().flight_simulation()
        for act, text in (
            (lambda: wb.read("friction2022").flight_simulation(), "^body.inertia_pitch: missing: flight needs"),
            (lambda: flight.command({"bias": 1}), "^bias: the vehicle has no such control; it has voltage, mean"),
            (lambda: flight.command({"voltage": np.nan}), "^voltage: must be finite"),
            (lambda: flight.start(drives=np.zeros((2, 9))), r"^drives: expected an array of 1 by 9, got \(2, 9\)"),
            (lambda: flight.step_to(-1), "^time: must be finite and not in the past"),
            (lambda: flight.step(-1), "^duration: must be >= 0 s"),
            (lambda: flight.blow([1, 2]), "^wind: must be three finite numbers"),
            (lambda: flyer().flight_simulation(tolerance=1), "^tolerance: must be a number between 1e-12 and 1e-2"),
        ):
            with self.assertRaisesRegex(wb.InputError, text):
                act()
        with self.assertRaisesRegex(TypeError, "^body: expected a wingbeat.BodyState, got list"):
            flight.place([0.0])
        self.assertEqual(flight.ranges["voltage"], (0.0, 9.0))


class SteadyFlight(unittest.TestCase):
    @unittest.skipUnless(PROGRAM, "the program is not built")
    def test_results_are_those_of_the_program(self):
        file = DATA / "designs" / "flight-friction2022.toml"

        def printed(*command):
            done = subprocess.run([PROGRAM, *command, "--json"], capture_output=True, text=True, check=True)
            return json.loads(done.stdout)

        found = flyer().trim(speed="0.4 m/s")
        self.assertEqual(dict(found), printed("trim", file, "--speed", "0.4 m/s")["flights"][0])
        found = flyer().flight_stability()
        self.assertEqual(dict(found), printed("stability", file))
        with tempfile.TemporaryDirectory() as folder:  # of fewer copies than the shipped study
            text = (DATA / "studies" / "tolerance-flight.toml").read_text()
            study = pathlib.Path(folder, "copies.toml")
            study.write_text(text.replace("count = 64", "count = 8").replace("../designs", str(DATA / "designs")))
            of_program = printed("tolerance", study, "--flight", "--speed", "0.4 m/s", "--threads", "2")
            counts = []
            found = wb.flight_tolerance(
                study, speed=0.4, progress=lambda done, all_of_them: counts.append((done, all_of_them))
            )
        self.assertEqual(dict(found), of_program)
        self.assertEqual({count for _, count in counts}, {8})
        self.assertEqual(counts, sorted(counts))

    def test_what_has_no_body_does_not_fly(self):
        spread = {"key": "friction.radius", "distribution": "normal", "relative_deviation": 0.1}
        study = {"samples": {"count": 4}, "parameter": [spread]}
        with self.assertRaisesRegex(wb.InputError, "body.inertia_pitch: missing: flight needs"):
            wb.read("friction2022").flight_tolerance(study)
        with self.assertRaisesRegex(wb.InputError, 'speed: expected a quantity in m/s, got "3 kg"'):
            flyer().flight_tolerance(study, speed="3 kg")

    def test_controls_of_trim(self):
        hover = flyer("flight-purdue").trim()
        self.assertEqual(list(hover.controls), ["voltage", "voltage_difference", "bias", "split_difference"])
        self.assertEqual([hover.controls[c].unit for c in hover.controls], ["V", "V", "V", "1"])
        self.assertEqual(hover.drives.shape, (2, 9))
        forward = flyer().trim(speed=0.5)
        np.testing.assert_allclose(forward.body.rotation @ forward.body.velocity, [0.5, 0, 0], atol=1e-12)
        self.assertAlmostEqual(forward.body.euler_angles[1], forward["pitch_rad"])

    def test_a_vehicle_out_of_trim_is_a_result(self):
        heavy = flyer().replace({"vehicle.mass": "500 g"})
        found = heavy.trim()
        self.assertNotEqual(found.status, "trimmed")
        self.assertTrue(found["status_detail"])
        if not heavy.flight_stability()["A"]:
            with self.assertRaisesRegex(ValueError, "^no linear model: "):
                heavy.flight_stability().A

    def test_modes_are_eigenvalues(self):
        found = flyer().flight_stability()
        eigenvalues = np.linalg.eigvals(found.A)
        self.assertGreater(np.count_nonzero(~np.isnan(found.averaged)), 3)
        for mode in found.averaged[~np.isnan(found.averaged)]:
            self.assertLess(np.abs(eigenvalues - mode).min(), 1e-8 * max(1.0, abs(mode)))
        self.assertEqual(found.B.shape, (8, 4))
        self.assertEqual(len(found.floquet), len(found.modes))
        system = found.model
        self.assertEqual(system.inputs[:4], found.controls)
        self.assertEqual(system.inputs[4:], ["wind_u_m_per_s", "wind_v_m_per_s", "wind_w_m_per_s"])
        self.assertEqual(system.outputs, found.states)
        np.testing.assert_array_equal(system.B, np.hstack([found.B, found.W]))
        np.testing.assert_allclose(found.W, -found.A[:, :3], atol=1e-12)  # in hover wind is motion the other way
        np.testing.assert_array_equal(system.C, np.eye(8))

    def test_the_linear_model_is_that_of_the_simulation(self):
        """Mean forces of a frozen body that moves by du, over a wingbeat, against the column of A."""
        vehicle = flyer("flight-x-wing")
        found = vehicle.flight_stability()
        du, means = 0.05, []
        for speed in (-du, du):
            flight, hover = in_trim(vehicle, frozen=True)
            flight.start(wb.BodyState.at(velocity=[speed, 0, 0]), hover.drives)
            flight.step_to(1.0)
            before, turns, start = flight.totals, flight.drives[0, 0], flight.time
            period = 1.0 / hover["frequency_hz"]
            flight.step(20 * period)
            self.assertAlmostEqual((flight.drives[0, 0] - turns) / (40 * np.pi), 1.0, 1)
            means.append((flight.totals.impulse[0] - before.impulse[0]) / (flight.time - start))
        slope = (means[1] - means[0]) / (2 * du) / vehicle["vehicle.mass"]
        self.assertAlmostEqual(slope / found.A[0, 0], 1.0, 1)

    def test_other_packages(self):
        found = flyer().flight_stability()
        try:
            import control
        except ImportError:
            with self.assertRaisesRegex(ImportError, "^the package `control` .python-control. is not installed$"):
                found.to_control()
        else:
            self.assertEqual(found.to_control().input_labels, found.model.inputs)
            self.assertTrue(control)

    @unittest.skipUnless(PROGRAM, "the program is not built")
    def test_the_linear_model_as_a_mat_file(self):
        import scipy.io

        vehicle = flyer("flight-purdue")
        found = vehicle.flight_stability()
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "flight.mat"
            design = DATA / "designs" / "flight-purdue.toml"
            subprocess.run([PROGRAM, "stability", design, "-o", file], capture_output=True, check=True)
            mat = scipy.io.loadmat(file, squeeze_me=True)
        for name in "ABCD":
            np.testing.assert_array_equal(mat[name], getattr(found.model, name))
        self.assertEqual(list(mat["state_names"]), found.states)
        self.assertEqual(list(mat["input_names"][4:]), found.model.inputs[4:])
        self.assertEqual(list(mat["input_names"][:2]), ["voltage_v", "voltage_difference_v"])
        self.assertEqual(mat["input_values"][0], found.trim.controls["voltage"])
        self.assertAlmostEqual(mat["state_values"][7], found.trim["pitch_rad"], 12)


class Mjcf(unittest.TestCase):
    def model(self, vehicle):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "model.xml"
            vehicle.export_mjcf(file, timestep="0.2 ms")
            with self.assertRaisesRegex(wb.InputError, "^file: .*model.xml exists; force=True replaces it"):
                vehicle.export_mjcf(file)
            return xml.parse(file).getroot()

    def test_a_free_body_with_wings_that_weigh_nothing(self):
        root = self.model(flyer("flight-purdue").replace({"body.inertia_product": "2e-7 kg m2"}))
        self.assertEqual(root.find("option").get("timestep"), "0.0002")
        body = root.find("worldbody/body")
        self.assertIsNotNone(body.find("freejoint"))
        self.assertEqual(float(body.find("inertial").get("mass")), 0.0124481)
        inertia = [float(x) for x in body.find("inertial").get("fullinertia").split()]
        np.testing.assert_allclose(inertia, [4238.1e-9, 3970.2e-9, 2441.0e-9, 0, 2e-7, 0], rtol=1e-8)
        sites = {site.get("name"): site.get("pos") for site in body.iter("site")}
        self.assertEqual(sites["shoulder-right-0"], "-0.0001797 -0.01395 0.0203898")
        self.assertEqual(sites["shoulder-left-1"], "-0.0001797 0.01395 0.0203898")
        visual = root.find("default/default[@class='visual']/geom")
        self.assertEqual((visual.get("mass"), visual.get("contype"), visual.get("conaffinity")), ("0", "0", "0"))
        self.assertEqual({geom.get("class") for geom in body.iter("geom")}, {"visual"})

    def test_the_model_of_the_example_is_what_is_written(self):
        kept = (ROOT / "examples" / "mujoco" / "flight-x-wing.xml").read_text()
        self.assertEqual(kept, wb._mjcf.mjcf_of(flyer("flight-x-wing")))


LOADS = pathlib.Path(PROGRAM).parent / "libwingbeat-flight.so" if PROGRAM else None


@unittest.skipUnless(LOADS and LOADS.exists(), "libwingbeat-flight is not built")
class Loads(unittest.TestCase):
    """The functions of C for a body that another program moves."""

    def setUp(self):
        self.loads = ctypes.CDLL(str(LOADS))
        self.loads.wingbeat_flight_create.restype = ctypes.c_void_p
        for name in ("error", "control_name"):
            getattr(self.loads, f"wingbeat_flight_{name}").restype = ctypes.c_char_p

    def call(self, name, flight, *given):
        """Calls a function; arrays of NumPy are pointers."""
        as_c = [x.ctypes.data_as(ctypes.c_void_p) if isinstance(x, np.ndarray) else ctypes.c_double(x) for x in given]
        return getattr(self.loads, f"wingbeat_flight_{name}")(ctypes.c_void_p(flight), *as_c)

    def test_a_step_from_a_turned_body(self):
        """Its mean force and torque are those of the flight in Python, in the axes of MuJoCo."""
        vehicle, step = flyer("flight-x-wing"), 1e-4
        flight = self.loads.wingbeat_flight_create(bytes(DATA / "designs" / "flight-x-wing.toml"))
        controls, qpos, qvel, force, torque = np.zeros(7), np.zeros(7), np.zeros(6), np.zeros(3), np.zeros(3)
        self.assertEqual(self.call("trim", flight, 0.0, controls, qpos, qvel), 0)
        self.assertAlmostEqual(controls[0], vehicle.trim().controls["voltage"], 12)
        body = wb.BodyState.at(position=[1, 2, -3], euler_angles=[0.3, -0.2, 1.0], velocity=[0.4, 0.1, -0.2],
                               rates=[1, -2, 3])
        half_turn = np.diag([1.0, -1.0, -1.0])
        qpos[:] = [*(half_turn @ body.position), *(body.attitude * [1, 1, -1, -1])]
        qvel[:] = [*(half_turn @ body.rotation @ body.velocity), *(half_turn @ body.rates)]
        self.assertEqual(self.call("step", flight, qpos, qvel, step, controls, force, torque), 0)
        self.loads.wingbeat_flight_free(ctypes.c_void_p(flight))
        alone, _ = in_trim(vehicle)
        alone.place(body)
        self.assertTrue(alone.step(step))
        weight = vehicle["vehicle.mass"] * 9.80665
        mean = half_turn @ body.rotation @ alone.totals.impulse / step
        np.testing.assert_allclose(force, mean, atol=1e-3 * weight)
        mean = half_turn @ body.rotation @ alone.totals.angular_impulse / step
        np.testing.assert_allclose(torque, mean, atol=1e-4 * weight)
        self.assertGreater(np.abs(torque).max(), 1e-3 * weight)

    def test_sides_that_differ(self):
        controls, qpos, qvel = np.zeros(7), np.zeros(7), np.zeros(6)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "uneven.toml"
            alike = (DATA / "designs" / "flight-purdue.toml").read_text()
            file.write_text(f'{alike}\n[right]\n"motor.armature_resistance" = "14 ohm"\n')
            flight = self.loads.wingbeat_flight_create(bytes(file))
            self.assertEqual(self.call("trim", flight, 0.0, controls, qpos, qvel), 0)
            self.loads.wingbeat_flight_free(ctypes.c_void_p(flight))
            difference = [self.loads.wingbeat_flight_control_name(k) for k in range(7)].index(b"voltage_difference")
            self.assertGreater(abs(controls[difference]), 0.1)
            if PROGRAM:
                done = subprocess.run([PROGRAM, "trim", file, "--json"], capture_output=True, text=True, check=True)
                expected = json.loads(done.stdout)["flights"][0]["control_voltage_difference_v"]
                self.assertAlmostEqual(controls[difference], expected, 12)

    def test_errors(self):
        names = [self.loads.wingbeat_flight_control_name(k) for k in range(8)]
        self.assertEqual(names[::4] + names[7:], [b"voltage", b"mean_stroke_angle", None])
        self.assertIsNone(self.loads.wingbeat_flight_create(b"nothing.toml"))
        self.assertIn(b"nothing.toml", self.loads.wingbeat_flight_error())
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "heavy.toml"
            heavy = flyer().replace({"body.wing_mass": "50 mg", "body.wing_centre": "25 mm"})
            file.write_text(heavy.to_toml())
            self.assertIsNone(self.loads.wingbeat_flight_create(bytes(file)))
            self.assertIn(b"body.wing_mass: ", self.loads.wingbeat_flight_error())


if __name__ == "__main__":
    unittest.main()
