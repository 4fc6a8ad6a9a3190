"""Parts by themselves: motor, force coefficients, transmission."""

import unittest

import numpy as np
import wingbeat as wb
from shared import DATA, reference


class Parts(unittest.TestCase):
    def test_motor_curves(self):
        vehicle = reference().replace({"motor.friction_torque": "0.1 mN m"})
        curves = vehicle.motor_curves(voltage="3 V")
        motor = vehicle.motor
        self.assertEqual(curves.attrs["voltage"], 3.0)
        self.assertAlmostEqual(float(curves.stall_current), 3 / motor.armature_resistance, 15)
        self.assertAlmostEqual(float(curves.stall_torque), motor.torque_constant * 3 / motor.armature_resistance - 1e-4, 15)
        self.assertEqual(float(curves.speed[-1]), float(curves.no_load_speed))
        self.assertAlmostEqual(float(curves.torque[-1]), 0.0, 15)
        self.assertEqual((curves.torque.attrs["units"], curves.speed.attrs["units"]), ("N m", "rad/s"))
        # In vacuum without wings the vehicle turns at the no-load speed.
        free = vehicle.solve(voltage=3, condition="wingless", tolerance=1e-10)
        self.assertAlmostEqual(free.frequency * 2 * np.pi / float(curves.no_load_speed), 1.0, 8)
        self.assertAlmostEqual(free.current_mean / float(curves.no_load_current), 1.0, 8)
        losses = motor.armature_resistance * curves.current**2 + motor.viscous_damping * curves.speed**2 + 1e-4 * curves.speed
        np.testing.assert_allclose(curves.power_electrical - losses, curves.power_mechanical, atol=1e-15)
        np.testing.assert_allclose(curves.efficiency, curves.power_mechanical / curves.power_electrical)
        driven = vehicle.motor_curves(speed=[1.2 * float(curves.no_load_speed)])
        self.assertTrue(np.isnan(driven.efficiency[0]))
        self.assertLess(driven.torque[0], 0)

    def test_a_motor_without_a_vehicle(self):
        own = {"armature_resistance": "9 ohm", "armature_inductance": "29 mH", "torque_constant": "10 mN m/A",
               "inertia": "1.5e-7 kg m2", "viscous_damping": "3.6e-6 N m s/rad"}
        curves = wb.motor_curves(own, voltage="3 V")
        np.testing.assert_array_equal(curves.torque, reference().motor_curves(voltage=3).torque)
        with self.assertRaisesRegex(TypeError, "needs a voltage"):
            wb.motor_curves(own)
        with self.assertRaisesRegex(wb.InputError, "^motor.torque_constan: unknown key"):
            wb.motor_curves({**own, "torque_constan": 1}, voltage=3)

    def test_coefficient_curves(self):
        alpha = np.radians([10.0, 45.0, 80.0])
        own = reference().coefficient_curves(angle_of_attack=alpha)
        np.testing.assert_allclose(own.lift, 0.225 + 1.58 * np.sin(2.13 * alpha - np.radians(7.2)), rtol=1e-14)
        np.testing.assert_allclose(own.drag, 1.92 - 1.55 * np.cos(2.04 * alpha - np.radians(9.82)), rtol=1e-14)
        np.testing.assert_allclose(own.normal_force, own.lift * np.cos(alpha) + own.drag * np.sin(alpha), rtol=1e-14)
        named = wb.coefficient_curves("translational-2022", angle_of_attack=alpha)
        np.testing.assert_array_equal(named.lift, own.lift)
        rows = [["0 deg", 0.0, 0.3], ["45 deg", 1.5, 1.0], ["90 deg", 0.0, 2.0]]
        table = wb.coefficient_curves({"table": rows}, angle_of_attack=np.radians([0, 45, 90]))
        np.testing.assert_allclose(table.lift, [0, 1.5, 0], atol=1e-14)
        self.assertNotIn("centre_of_pressure", own)
        hinged = wb.read(DATA / "designs" / "pitch-hinge.toml").coefficient_curves()
        self.assertAlmostEqual(float(hinged.centre_of_pressure[-1]), 0.46, 12)

    def test_kinematics(self):
        for file in ("friction2022", "two-wing-four-bar"):
            vehicle = wb.read(DATA / "designs" / f"{file}.toml")
            law = vehicle.kinematics()
            step = float(law.crank_angle[1])
            slope = (law.stroke_angle.values[2:] - law.stroke_angle.values[:-2]) / (2 * step)
            np.testing.assert_allclose(law.stroke_slope[1:-1], slope, atol=2e-3)
            curve = (law.stroke_slope.values[2:] - law.stroke_slope.values[:-2]) / (2 * step)
            np.testing.assert_allclose(law.stroke_curve[1:-1], curve, atol=2e-2)
            amplitude = float(law.stroke_angle.max() - law.stroke_angle.min()) / 2
            self.assertAlmostEqual(float(law.stroke_amplitude) / amplitude, 1.0, 3)
            turning = vehicle.kinematics(crank_angle=law.reversal_angle)
            np.testing.assert_allclose(turning.stroke_slope, 0.0, atol=1e-9)
            self.assertEqual(len(law.reversal_angle), 2)
            cycle = vehicle.solve().cycle
            np.testing.assert_allclose(
                vehicle.kinematics(crank_angle=cycle.crank_angle).stroke_angle, cycle.stroke_angle, atol=1e-9
            )
        self.assertEqual(float(wb.kinematics(dict(reference().to_dict()["transmission"])).stroke_amplitude),
                         float(reference().kinematics().stroke_amplitude))
        with self.assertRaisesRegex(wb.InputError, "^transmission.type: a direct drive has no transmission"):
            wb.read(DATA / "designs" / "direct-drive.toml").kinematics()


if __name__ == "__main__":
    unittest.main()
