"""Optima: by functions in Python, fronts, and by a search in plain NumPy."""

import os
import signal
import threading
import unittest

import numpy as np
import wingbeat as wb
from shared import DATA, PROGRAM, reference

BOUNDS = {"supply.voltage": (2.0, 8.0), "transmission.crank_radius": (4e-3, 7e-3)}
PARAMETERS = [{"key": key, "lower": low, "upper": high} for key, (low, high) in BOUNDS.items()]


def springs():
    return wb.read(DATA / "designs" / "friction2022-springs.toml")


class OwnFunctions(unittest.TestCase):
    def setUp(self):
        study = {
            "objective": {"minimise": "power_electrical_w", "starts": 4, "screen": 256},
            "parameter": PARAMETERS,
            "constraint": [{"metric": "lift_to_weight", "at_least": 1}],
        }
        self.program = wb.optimise(study, vehicle=springs())

    def same_optimum(self, found, digits):
        self.assertEqual(found["outcome"], "found")
        self.assertAlmostEqual(found["value"] / self.program["value"], 1.0, digits)
        for key in BOUNDS:
            self.assertAlmostEqual(found.vehicle[key] / self.program.vehicle[key], 1.0, max(3, digits - 2))
        self.assertAlmostEqual(found.result.lift_to_weight, 1.0, digits - 1)

    def test_with_derivatives(self):
        seen = []

        def power(result):
            seen.append(result.vehicle["supply.voltage"])
            return result.power_electrical, {"power_electrical": 1.0}

        def lift(result):
            return result.lift_mean / result.vehicle.vehicle.mass / 9.80665, {"lift_mean": 1 / result.vehicle.vehicle.mass / 9.80665}

        own = {"objective": {"minimise": power}, "parameter": PARAMETERS, "constraint": [{"metric": lift, "at_least": 1.0}]}
        found = wb.optimise(own, vehicle=springs())
        self.same_optimum(found, 6)
        self.assertTrue(found["exact_gradients"])
        # The constraint may be the program's, and the objective a metric.
        found = wb.optimise({**own, "constraint": [{"metric": "lift_to_weight", "at_least": 1}]}, vehicle=springs())
        self.same_optimum(found, 6)
        found = wb.optimise({**own, "objective": {"maximise": lambda r: (-r.power_electrical, {"power_electrical": -1})}}, vehicle=springs())
        self.assertAlmostEqual(found["value"] / self.program["value"], -1.0, 6)
        found = wb.optimise({**own, "objective": {"minimise": "power_electrical_w"}}, vehicle=springs())
        self.same_optimum(found, 6)
        self.assertEqual(len(found["searches"]), 4)
        self.assertIn("best value", str(found))

    def test_without_derivatives(self):
        own = {
            "objective": {"minimise": lambda result: result.power_electrical, "starts": 1},
            "parameter": PARAMETERS,
            "constraint": [{"metric": lambda result: result.lift_to_weight, "at_least": 1.0}],
        }
        found = wb.optimise(own, vehicle=springs())
        self.assertFalse(found["exact_gradients"])
        self.same_optimum(found, 4)

    def test_derivatives_by_parameters(self):
        """A penalty on the crank radius itself, beside a metric."""

        def cost(result):
            radius = result.vehicle.transmission.crank_radius
            return result.lift_mean - 1e4 * (radius - 5e-3) ** 2, {"lift_mean": 1, "transmission.crank_radius": -2e4 * (radius - 5e-3)}

        found = wb.optimise({"objective": {"maximise": cost}, "parameter": PARAMETERS[1:]}, vehicle=springs())
        radius = found.vehicle.transmission.crank_radius
        slope = found.result.gradient("lift_mean", "transmission.crank_radius")
        self.assertAlmostEqual(slope / (2e4 * (radius - 5e-3)), 1.0, 4)

    def test_what_a_function_raises_comes_through(self):
        def broken(result):
            raise ZeroDivisionError("mine")

        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            wb.optimise({"objective": {"minimise": broken}, "parameter": PARAMETERS}, vehicle=springs())
        with self.assertRaisesRegex(wb.InputError, "^metric: there is no 'lift'"):
            wb.optimise({"objective": {"minimise": lambda r: (1.0, {"lift": 1})}, "parameter": PARAMETERS}, vehicle=springs())
        with self.assertRaisesRegex(wb.InputError, "a function has at_least"):
            wb.optimise({"objective": {"minimise": "power_electrical_w"}, "parameter": PARAMETERS,
                         "constraint": [{"metric": broken}]}, vehicle=springs())

    def test_nothing_that_counts(self):
        found = wb.optimise({"objective": {"minimise": lambda r: None}, "parameter": PARAMETERS}, vehicle=springs())
        self.assertEqual(found["outcome"], "nothing_flaps")
        self.assertIsNone(found.vehicle)
        found = wb.optimise({"objective": {"minimise": lambda r: (r.power_electrical, {"power_electrical": 1}), "starts": 1},
                             "constraint": [{"metric": "lift_to_weight", "at_least": 100}], "parameter": PARAMETERS}, vehicle=springs())
        self.assertEqual(found["outcome"], "infeasible")
        self.assertIsNone(found.result)

    def test_ctrl_c_ends_it(self):
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        calls = []

        def slow(result):
            calls.append(result)
            if len(calls) == 3:
                threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
            return result.power_electrical

        with self.assertRaises(KeyboardInterrupt):
            wb.optimise({"objective": {"minimise": slow, "screen": 100_000}, "parameter": PARAMETERS}, vehicle=springs())
        self.assertLess(len(calls), 100_000)


class Fronts(unittest.TestCase):
    def test_a_drive_train(self):
        lists = {name: {"catalogue": str(DATA / "motors" / f"{name}.csv")} for name in ("motors", "gearboxes", "batteries")}
        lists["motors"]["within_nominal_current"] = False
        study = {"drive_train": {"mass_without": "7 g", "refine": 1}, **lists,
                 "objective": {"minimise": "power_electrical_w"},
                 "constraint": [{"metric": "lift_to_weight", "at_least": 1}]}
        found = wb.optimise(study, vehicle=wb.read(DATA / "designs" / "x-wing-battery.toml"))
        self.assertEqual(found["screening"]["combinations"], 960)
        best = found["drive_trains"][0]
        self.assertEqual(found["best"], f"{best['model']}, {best['gearbox']}, {best['battery']}")
        result = found.vehicle.solve()
        self.assertAlmostEqual(result.power_electrical / best["result"]["value"], 1.0, places=5)
        self.assertGreaterEqual(result.lift_to_weight, 1.0)

    @unittest.skipUnless(PROGRAM, "needs the program's part with pagmo")
    def test_a_front(self):
        study = {
            "search": {"population": 40, "generations": 8, "designs": 3},
            "objective": [{"maximise": "lift_mean_n", "reference": 0}, {"minimise": "power_electrical_w", "reference": 4}],
            "parameter": PARAMETERS,
        }
        calls = []
        front = wb.optimise(study, vehicle=springs(), progress=lambda *reported: calls.append(reported))
        designs = front.designs
        self.assertGreater(designs.sizes["design"], 20)
        self.assertTrue(np.all(np.diff(designs.lift_mean) < 0))
        self.assertTrue(np.all(np.diff(designs.power_electrical) < 0))
        self.assertEqual(designs["supply.voltage"].attrs["units"], "V")
        self.assertIsInstance(front, wb.Front)
        knee = front.vehicles["knee"]
        self.assertEqual(front.vehicle, knee)
        place = front.all_vehicles.index(knee)
        self.assertAlmostEqual(knee.solve(tolerance=1e-8).lift_mean / float(designs.lift_mean[place]), 1.0, 6)
        self.assertIn("hypervolume", str(front))


class NumPy(unittest.TestCase):
    def test_a_search_in_numpy_finds_the_optimum_of_the_program(self):
        study = {
            "objective": {"minimise": "power_electrical_w", "starts": 4, "screen": 256},
            "parameter": PARAMETERS,
            "constraint": [{"metric": "lift_to_weight", "at_least": 1}, {"metric": "stroke_amplitude_rad", "at_most": "60 deg"}],
        }
        program = wb.optimise(study, vehicle=springs())
        random = np.random.default_rng(1)
        low, high = np.array(list(BOUNDS.values())).T
        centre, width, best = (low + high) / 2, high - low, np.inf
        for _ in range(24):
            x = np.clip(centre + width * random.uniform(-0.5, 0.5, (200, 2)), low, high)
            found = wb.solve(
                dict(zip(BOUNDS, x.T)), vehicle=springs(), tolerance=1e-8,
                metrics=["power_electrical", "lift_to_weight", "stroke_amplitude"],
            )
            good = found.flapping & (found.lift_to_weight >= 1) & (found.stroke_amplitude <= np.radians(60))
            power = np.where(good, found.power_electrical, np.inf)
            if power.min() < best:
                best, centre = power.min(), x[power.argmin()]
            width = width * 0.75
        self.assertAlmostEqual(best / program["value"], 1.0, 3)
        for value, key in zip(centre, BOUNDS):
            self.assertAlmostEqual(value / program.vehicle[key], 1.0, 2)


if __name__ == "__main__":
    unittest.main()
