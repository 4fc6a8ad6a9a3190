"""The equations of motion for integrators of one's own, here SciPy's, and optima by SciPy."""

import unittest

import numpy as np
import scipy.integrate
import scipy.optimize
import wingbeat as wb
from shared import DATA, reference


class Equations(unittest.TestCase):
    def test_dop853_finds_the_orbit(self):
        vehicle = wb.read(DATA / "designs" / "friction2022-springs.toml")
        equations = vehicle.equations_of_motion()
        self.assertEqual(equations.states, ("crank_angle", "crank_speed", "current"))

        def revolution(time, state):
            return state[0] - 2 * np.pi

        revolution.terminal, revolution.direction = True, 1
        state = np.array([0.0, 100.0, 0.2])
        for tolerance in [1e-5] * 12 + [1e-11] * 6:
            found = scipy.integrate.solve_ivp(
                equations.rates, (0, 1), state, "DOP853", rtol=tolerance, atol=1e-2 * tolerance, events=revolution
            )
            period, state = found.t_events[0][0], found.y_events[0][0] - [2 * np.pi, 0, 0]
        result = vehicle.solve(tolerance=1e-11)
        self.assertAlmostEqual(period * result.frequency, 1.0, 8)
        cycle = result.cycle.isel(time=0)
        self.assertAlmostEqual(state[1] / float(cycle.crank_speed), 1.0, 8)
        self.assertAlmostEqual(state[2] / float(cycle.current), 1.0, 8)

    def test_dop853_finds_the_orbit_of_wings_that_pitch(self):
        for file in ("pitch-hinge", "pitch-hinge-crank"):
            vehicle = wb.read(DATA / "designs" / f"{file}.toml")
            equations, simulation = vehicle.equations_of_motion(), vehicle.simulation()
            self.assertEqual(equations.states, simulation.states)
            self.assertEqual(equations.states[-2:], ("pitch_angle", "pitch_velocity"))
            result = vehicle.solve(tolerance=1e-11)
            period, crank = 1 / result.frequency, equations.states[0] == "crank_angle"
            # From a simulation that has come near.
            simulation.step_to(40 * period)
            if crank:
                simulation.step(1, until="revolution")
            state, from_ = simulation.state, 0.0
            if crank:
                state[0] = 0.0

            def revolution(time, state):
                return state[0] - 2 * np.pi

            revolution.terminal, revolution.direction = True, 1
            for tolerance in [1e-6] * 10 + [1e-11] * 6:
                found = scipy.integrate.solve_ivp(
                    equations.rates, (0, 2 * period if crank else period), state, "DOP853", rtol=tolerance,
                    atol=1e-2 * tolerance, events=revolution if crank else None,
                )
                if crank:
                    self.assertAlmostEqual(found.t_events[0][0] / period, 1.0, 6)
                    state = found.y_events[0][0] - np.array([2 * np.pi] + [0] * (len(state) - 1))
                else:
                    state = found.y[:, -1]
            first, cycle = result.cycle.isel(time=0), result.cycle
            for name, value in zip(equations.states, state):
                if name not in ("crank_angle", "pitch_velocity"):
                    self.assertLess(abs(value - float(first[name])) / float(np.abs(cycle[name]).max()), 1e-8, (file, name))

    def test_states_in_columns_are_those_one_by_one(self):
        equations = wb.EquationsOfMotion(wb.read(DATA / "designs" / "direct-drive.toml"), condition="vacuum")
        self.assertEqual(equations.states[:2], ("stroke_angle", "flapping_velocity"))
        states = np.random.default_rng(1).normal(size=(len(equations.states), 5))
        many = equations.rates(0.01, states)
        for n in range(5):
            np.testing.assert_array_equal(many[:, n], equations.rates(0.01, states[:, n]))
            np.testing.assert_array_equal(many[:, n], equations.rates(0.01, list(states[:, n])))

    def test_a_commanded_voltage(self):
        stronger = reference().replace({"supply.voltage": 4.0}).equations_of_motion()
        state = [1.0, 100.0, 0.1]
        for voltage in (4.0, "4 V", "4000 mV"):
            np.testing.assert_array_equal(reference().equations_of_motion().rates(0, state, voltage), stronger.rates(0, state))

    def test_what_is_refused(self):
        with self.assertRaisesRegex(ValueError, "a state of 3 numbers"):
            reference().equations_of_motion().rates(0.0, [1.0, 2.0])
        with self.assertRaisesRegex(wb.InputError, "^condition: must be air"):
            reference().equations_of_motion(condition="water")


class Optima(unittest.TestCase):
    def test_scipy_finds_the_optimum_of_the_program(self):
        """The objective, its constraint and their derivatives are the user's, in Python."""
        vehicle = wb.read(DATA / "designs" / "friction2022-springs.toml")
        bounds = {"supply.voltage": (2.0, 8.0), "transmission.crank_radius": (4e-3, 7e-3)}
        keys, scale = list(bounds), np.array([1.0, 1e-3])
        study = {
            "objective": {"minimise": "power_electrical_w", "starts": 4},
            "parameter": [{"key": key, "lower": low, "upper": high} for key, (low, high) in bounds.items()],
            "constraint": [{"metric": "lift_to_weight", "at_least": 1}, {"metric": "stroke_amplitude_rad", "at_most": "60 deg"}],
        }
        program = wb.optimise(study, vehicle=vehicle)
        self.assertIsNotNone(program.vehicle, str(program))
        wanted = program.vehicle.solve(tolerance=1e-9)

        def at(x):
            return vehicle.replace(dict(zip(keys, x * scale))).solve(tolerance=1e-9)

        def term(metric, sign, limit):
            return {
                "type": "ineq",
                "fun": lambda x: sign * (at(x).metrics[metric] - limit),
                "jac": lambda x: sign * at(x).gradient(metric, keys) * scale,
            }

        found = scipy.optimize.minimize(
            lambda x: at(x).power_electrical,
            wanted.vehicle["supply.voltage"] * np.array([1.1, 0.0]) + [0.0, 5.0],
            jac=lambda x: at(x).gradient("power_electrical", keys) * scale,
            bounds=[(low / s, high / s) for (low, high), s in zip(bounds.values(), scale)],
            constraints=[term("lift_to_weight", 1, 1.0), term("stroke_amplitude", -1, np.radians(60))],
            method="SLSQP",
            options={"ftol": 1e-12},
        )
        self.assertTrue(found.success, found.message)
        self.assertAlmostEqual(found.fun / wanted.power_electrical, 1.0, 5)
        for key, value in zip(keys, found.x * scale):
            self.assertAlmostEqual(value / program.vehicle[key], 1.0, 4)


if __name__ == "__main__":
    unittest.main()
