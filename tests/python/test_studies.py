"""Studies are those of the program."""

import json
import os
import signal
import subprocess
import threading
import time
import unittest

import numpy as np
import wingbeat as wb
from shared import DATA, PROGRAM, reference


def printed(*arguments):
    found = subprocess.run([PROGRAM, *arguments, "--json"], capture_output=True, text=True)
    return json.loads(found.stdout)


class Studies(unittest.TestCase):
    @unittest.skipUnless(PROGRAM, "needs the program")
    def test_an_endurance_is_the_programs(self):
        file = DATA / "designs" / "friction2022-battery.toml"
        flight = wb.read(file).endurance()
        self.assertEqual(dict(flight), printed("endurance", file))
        trajectory = flight.trajectory
        self.assertEqual(float(trajectory.time[-1]), flight["endurance_s"])
        self.assertEqual(float(trajectory.charge[-1]), flight["charge_final"])
        self.assertEqual(trajectory.lift_mean.attrs["units"], "N")
        self.assertIn("battery", str(flight))
        with self.assertRaisesRegex(wb.InputError, "^supply.type: only a battery runs down"):
            reference().endurance()
        light = wb.read(file).replace({"vehicle.mass": "1.5 g"})
        hover = light.endurance(hover=True)
        self.assertEqual(dict(hover), printed("endurance", file, "--set", "vehicle.mass=1.5 g", "--hover"))
        self.assertEqual(hover["throttle"], "hover")

        np.testing.assert_allclose(hover.trajectory.lift_to_weight, 1.0, rtol=1e-9)
        duty = light.solve(lift_to_weight=1, tolerance=1e-9).vehicle.supply.duty
        self.assertAlmostEqual(hover["history"]["duty"][0] / duty, 1.0, 7)
        metric = light.replace({"supply.throttle": "hover"}).solve(endurance=True)
        self.assertAlmostEqual(float(metric.hover) / hover["hover_s"], 1.0, 5)

    @unittest.skipUnless(PROGRAM, "needs the program")
    def test_control_models_are_the_programs(self):
        models = reference().linearise(maps=False)
        self.assertEqual(dict(models), printed("linearise", "friction2022", "--no-maps"))
        model = models.discrete
        system = model.to_scipy()
        self.assertEqual(system.dt, models["model"]["period_s"])
        from scipy import signal

        steps = models["model"]["step_responses"]["voltage"]
        _, response, _ = signal.dlsim(system, np.tile([1.0, 0.0], (len(steps[model.outputs[0]]), 1)))
        for column, name in enumerate(model.outputs):
            np.testing.assert_allclose(response[:, column], steps[name], rtol=1e-9, atol=1e-12)
        self.assertEqual(models.continuous.states, [])  # all settles within a cycle
        with self.assertRaisesRegex(ValueError, "^no linear model: "):
            reference().replace({"supply.voltage": 0.0}).linearise().discrete

    @unittest.skipUnless(PROGRAM, "needs the program")
    def test_a_motor_is_the_programs(self):
        for file in sorted((DATA / "motors").glob("*.toml")):
            sized = "rotor_diameter" in file.read_text()
            found = wb.identify_motor(file, frequency="22 Hz", assume_steel_cylinder=sized, assume_typical_damping=True)
            fallbacks = ["--fallback", "inertia=solid-steel-cylinder"] * sized + ["--fallback", "viscous_damping=typical"]
            self.assertEqual(dict(found), printed("identify-motor", file, "--frequency", "22 Hz", *fallbacks), file)
            if found.motor is not None:
                text = reference().to_toml()
                start, end = text.index("[motor]"), text.index("[", text.index("[motor]") + 1)
                self.assertGreater(wb.Vehicle.from_toml(text[:start] + found.motor + text[end:]).motor.inertia, 0)

    @unittest.skipUnless(PROGRAM, "needs the program")
    def test_a_fit_is_the_programs(self):
        file = DATA / "bench" / "flapper.toml"
        found = wb.fit(file, profiles=False)
        self.assertEqual(dict(found), printed("fit", file, "--no-profiles"))
        self.assertEqual(dict(found), dict(wb.fit(file, profiles=False, threads=1)))
        self.assertEqual(found.vehicle is None, "misfit" in found.get("status", ""))

    def bench(self, logs):
        text = (DATA / "bench" / "flapper.toml").read_text()
        tables = {"parameter": [], "deviation": {"default": {"relative": 0.01}, "lift_mean": {"relative": 0.02}}}
        for part in text.split("[[parameter]]")[1:]:
            keys = dict(line.split("=", 1) for line in part.split("[deviation]")[0].splitlines() if "=" in line)
            keys = {key.strip(): value.split("#")[0].strip().strip('"') for key, value in keys.items()}
            tables["parameter"].append(keys)
        tables["log"] = [{"condition": name, "springs": False, **log} for name, log in logs.items()]
        return tables

    def test_a_fit_of_frames_is_that_of_files(self):
        import pandas
        import xarray

        vehicle = wb.read(DATA / "designs" / "friction2022-springs.toml")
        folder = DATA / "bench"
        air = pandas.read_csv(folder / "air.csv", comment="#")
        vacuum = pandas.read_csv(folder / "vacuum.csv", comment="#")
        wingless = pandas.read_csv(folder / "wingless.csv", comment="#")
        files = {name: {"file": str(folder / f"{name}.csv")} for name in ("air", "vacuum", "wingless")}
        expected = wb.fit(self.bench(files), vehicle=vehicle, profiles=False)
        frames = {
            "air": {"data": air.iloc[::-1].assign(note="a remark"), "columns": {"note": "ignore"}},
            "vacuum": {"data": xarray.Dataset({name: ("row", vacuum[name]) for name in vacuum})},
            "wingless": {"data": {name: wingless[name].to_numpy() for name in wingless}},
        }
        found = wb.fit(self.bench(frames), vehicle=vehicle, profiles=False)
        for ours, theirs in zip(found["parameters"], expected["parameters"]):
            self.assertEqual(ours["key"], theirs["key"])
            self.assertAlmostEqual(ours["value"] / theirs["value"], 1.0, 9)
        program = wb.fit(folder / "flapper.toml", profiles=False)
        self.assertEqual([p["value"] for p in program["parameters"]], [p["value"] for p in expected["parameters"]])
        air.loc[1, air.columns[-1]] = np.nan
        fewer = wb.fit(self.bench({**files, "air": {"data": air}}), vehicle=vehicle, profiles=False)
        self.assertNotEqual(fewer["parameters"][0]["value"], expected["parameters"][0]["value"])
        self.assertEqual(len(fewer["points"]), len(expected["points"]) - 1)

    def test_a_vehicle_and_data(self):
        """wb.fit(vehicle, data) is the fit of a bench with one log."""
        import pandas

        vehicle, folder = wb.read("friction2022-springs"), DATA / "bench"
        frames = {name: pandas.read_csv(folder / f"{name}.csv", comment="#") for name in ("air", "vacuum")}
        bounds = {"friction.radius": ("0 mm", 0.008, "1 mm"), "motor.viscous_damping": {"lower": 0, "upper": 2e-5}}
        tables = [{"key": "friction.radius", "lower": "0 mm", "upper": 0.008, "start": "1 mm"},
                  {"key": "motor.viscous_damping", "lower": 0, "upper": 2e-5}]
        deviation = {"default": {"relative": 0.01}, "lift_mean": {"relative": 0.02}}
        logs = [{"data": frame, "condition": name, "springs": False} for name, frame in frames.items()]
        whole = {"parameter": tables, "deviation": deviation, "log": logs}
        options = {"profiles": False, "parameters": bounds, "deviation": {"default": 0.01, "lift_mean": 0.02}}
        both = wb.fit(whole, vehicle=vehicle, profiles=False)
        self.assertTrue(both["converged"])
        for act in (
            lambda: wb.fit(vehicle, logs, **options), lambda: vehicle.fit(logs, **options),
            lambda: wb.fit(vehicle, [frames["air"], {"data": frames["vacuum"], "condition": "vacuum"}], springs=False, **options),
            lambda: wb.fit(vehicle, [folder / "air.csv", {"file": folder / "vacuum.csv", "condition": "vacuum"}],
                           springs=False, **options),
            lambda: wb.fit(vehicle, whole, profiles=False), lambda: wb.fit(data=whole, vehicle=vehicle, profiles=False),
            lambda: wb.fit(bench=whole, vehicle=vehicle, profiles=False),
            lambda: wb.fit(vehicle, {"log": logs, "deviation": deviation}, parameters=tables, profiles=False),
        ):
            found = act()
            self.assertEqual([one["value"] for one in found["parameters"]], [one["value"] for one in both["parameters"]])
            self.assertEqual(found["chi_square"], both["chi_square"])
        one = {"data": frames["air"], "condition": "air", "springs": False}
        alone = wb.fit(vehicle, frames["air"], springs=False, **options)
        table = wb.fit({**whole, "log": [one]}, vehicle=vehicle, profiles=False)
        self.assertEqual(alone["parameters"], table["parameters"])
        robust = wb.fit(vehicle, frames["air"], springs=False, loss="huber", **options)
        expected = wb.fit({**whole, "log": [one], "fit": {"loss": "huber"}}, vehicle=vehicle, profiles=False)
        self.assertEqual(robust["parameters"], expected["parameters"])
        self.assertNotEqual(robust["parameters"], alone["parameters"])
        estimated = wb.fit(vehicle, frames["air"], springs=False, parameters=bounds, profiles=False)
        stated = wb.fit({**whole, "log": [one], "deviation": {"default": "estimated"}}, vehicle=vehicle, profiles=False)
        self.assertEqual(estimated["parameters"], stated["parameters"])

    def test_data_that_state_their_units(self):
        """A fit to what another vehicle does finds that vehicle: its data sets have names and units of their own."""
        vehicle = wb.read("friction2022")
        other = vehicle.replace({"friction.radius": "2.2 mm"})
        designs = other.solve_columns({"supply.voltage": np.linspace(2, 5, 7)}, tolerance=1e-9).to_xarray()
        data = designs[["voltage", "frequency", "current_mean", "lift_mean"]]
        found = wb.fit(vehicle, data, parameters={"friction.radius": (0, "8 mm")}, deviation=0.01, profiles=False)
        self.assertAlmostEqual(found.vehicle.friction.radius / 2.2e-3, 1.0, 5)
        millinewtons = data.assign(lift_mean=1e3 * data.lift_mean)
        millinewtons.lift_mean.attrs["units"] = "mN"
        again = wb.fit(vehicle, millinewtons, parameters={"friction.radius": (0, "8 mm")}, deviation=0.01, profiles=False)
        self.assertAlmostEqual(again.vehicle.friction.radius / found.vehicle.friction.radius, 1.0, 9)
        millinewtons.lift_mean.attrs["units"] = "V"
        with self.assertRaisesRegex(wb.InputError, r"^log\[0\].data, column names: lift_mean: the unit .V. is wrong"):
            wb.fit(vehicle, millinewtons, parameters={"friction.radius": (0, "8 mm")})

    def test_data_of_a_vehicle_that_cannot_be_used(self):
        vehicle = wb.read("friction2022")
        air = {"voltage_V": [2, 3, 4], "frequency_Hz": [16.0, 22.0, 27.5], "current_mean_mA": [110, 180, 253]}
        bounds = {"friction.radius": (0, "8 mm")}
        bench = {"log": [{"data": air, "condition": "air"}], "parameter": [{"key": "friction.radius"}]}
        for act, text, error in (
            (lambda: wb.fit(vehicle), "^bench: a vehicle needs a bench beside it$", TypeError),
            (lambda: wb.fit(air, vehicle), "^vehicle: expected a wingbeat.Vehicle, got dict$", TypeError),
            (lambda: wb.fit(vehicle, air), "^parameters: expected what to fit, such as .*, got none$", TypeError),
            (lambda: wb.fit(vehicle, air, parameters=["friction.radius"]), "^parameters: expected bounds by key", TypeError),
            (lambda: wb.fit(vehicle, air, parameters={"friction.radius": 3}), r"^parameters\['friction.radius'\]: ", TypeError),
            (lambda: wb.fit(vehicle, air, parameters={"friction.radius": ("0 s", 1)}), 'expected a length such as "5 mm"', wb.InputError),
            (lambda: wb.fit(vehicle, air, parameters=bounds, deviation=[1]), "^deviation: expected a number relative", TypeError),
            (lambda: wb.fit(vehicle, air, parameters=bounds, deviation={"frequency": 1j}), r"^deviation\['frequency'\]: ", TypeError),
            (lambda: wb.fit(vehicle, air, parameters=bounds), "estimated.*intervals hold from 6 on", wb.InputError),
            (lambda: wb.fit(vehicle, air, parameters=bounds, condition="water"), "condition: expected one of air", wb.InputError),
            (lambda: wb.fit(vehicle, air, parameters=bounds, springs=1), "^springs: expected True or False", TypeError),
            (lambda: wb.fit(vehicle, 3, parameters=bounds), "^log.0..data: expected a DataFrame", TypeError),
            (lambda: wb.fit(vehicle, bench, parameters=bounds), "^parameters: is given in the bench and beside it$", wb.InputError),
            (lambda: wb.fit(vehicle, bench, condition="air"), "^condition: belongs to each log", wb.InputError),
            (lambda: wb.fit("flapper", deviation=0.1), "^deviation: is for data of a vehicle", TypeError),
            (lambda: wb.fit("data/bench/air.csv"), "^a log needs the vehicle and what to fit: ", TypeError),
            (lambda: wb.tolerance(vehicle), "^study: a vehicle needs a study beside it$", TypeError),
            (lambda: wb.optimise(vehicle, "optimise-hover"), "^a study file names its vehicle", TypeError),
        ):
            with self.subTest(text), self.assertRaisesRegex(error, text):
                act()

    def test_keys_are_attributes(self):
        flight = wb.read("friction2022-battery").endurance()
        for key in flight:
            self.assertEqual(getattr(flight, key), flight[key])
            self.assertIn(key, dir(flight))
        self.assertEqual(repr(flight), str(flight).rstrip("\n"))
        self.assertIn("battery", repr(flight))
        with self.assertRaisesRegex(AttributeError, "^'Flight' object has no attribute or key 'endurance'$"):
            flight.endurance

    def test_vehicle_and_study_in_either_order(self):
        spread = {"key": "friction.radius", "distribution": "normal", "relative_deviation": 0.05}
        study, vehicle = {"samples": {"count": 64}, "parameter": [spread]}, reference()
        wanted = dict(wb.tolerance(study, vehicle=vehicle))
        named = {**study, "study": {"vehicle": str(DATA / "designs" / "friction2022.toml")}}
        for act in (lambda: wb.tolerance(vehicle, study), lambda: vehicle.tolerance(study),
                    lambda: wb.tolerance(vehicle=vehicle, study=study), lambda: wb.tolerance(study=study, vehicle=vehicle)):
            self.assertEqual(dict(act()), wanted)
        for act in (lambda: wb.tolerance(named), lambda: wb.tolerance(study=named),
                    lambda: wb.tolerance(named, vehicle=None),
                    lambda: wb.tolerance({**study, "study": {"vehicle": "friction2022"}})):
            self.assertEqual(act()["outputs"], wanted["outputs"])
        best = {"objective": {"minimise": "power_electrical_w", "starts": 1, "screen": 32},
                "parameter": [{"key": "supply.voltage", "lower": 2, "upper": 3}]}
        self.assertEqual(dict(wb.optimise(vehicle, best)), dict(wb.optimise(best, vehicle=vehicle)))

    def test_a_frame_that_cannot_be_used_is_named(self):
        vehicle = wb.read(DATA / "designs" / "friction2022-springs.toml")

        def refused(log, pattern, error=wb.InputError):
            with self.assertRaisesRegex(error, pattern):
                wb.fit(self.bench({"air": log}), vehicle=vehicle, profiles=False)

        good = {"voltage_V": [2.0, 3.0], "frequency_Hz": [15.0, 22.0]}
        refused({"data": {**good, "current_mean_mA": [1.0]}}, r"^log\[0\].data: columns have different lengths$")
        refused({"data": {**good, "current_mean_mA": [120.0, -1.0]}}, r"^log\[0\].data, row 1: ")
        refused({"data": {"voltage_V": [2.0], "force": [1.0]}}, r"^log\[0\].data, column names: .*force")
        refused({"data": good, "file": "air.csv"}, "is given beside a file$")
        refused({"data": 3.0}, r"^log\[0\].data: expected a DataFrame", TypeError)
        refused({"data": {"voltage_V": 2.0}}, r"^log\[0\].data\['voltage_V'\]: expected an array", TypeError)
        refused({"data": {"voltage_V": [1j]}}, "expected numbers, got complex$", TypeError)
        with self.assertRaisesRegex(TypeError, "a bench file names its vehicle"):
            wb.fit(DATA / "bench" / "flapper.toml", vehicle=vehicle)

    @unittest.skipUnless(PROGRAM, "needs the program")
    def test_a_tolerance_study_is_the_programs(self):
        file = DATA / "studies" / "tolerance-hover.toml"
        calls = []
        found = wb.tolerance(file, progress=lambda done, of: calls.append((done, of)))
        self.assertEqual(dict(found), printed("tolerance", file))

    def test_a_study_from_a_dict(self):
        study = {
            "study": {"title": "Two uncertain parameters"},
            "samples": {"method": "sobol", "count": 64, "seed": 1},
            "parameter": [
                {"key": "friction.radius", "distribution": "normal", "relative_deviation": 0.05},
                {"key": "supply.voltage", "distribution": "uniform", "lower": "2.9 V", "upper": 3.1},
            ],
        }
        found = wb.tolerance(study, vehicle=reference())
        again = wb.tolerance(study, vehicle=reference(), values={"friction.radius": "2.5 mm"})
        self.assertEqual(dict(found), dict(again))
        virtual_work = {"name": "virtual-work", "set": {"transmission.formulation": "virtual-work"}}
        choice = {"name": "formulation", "alternative": [{"name": "rod-force"}, virtual_work]}
        chosen = wb.tolerance({**study, "choice": [choice]}, vehicle=reference())
        self.assertEqual([a["samples"] for a in chosen["choices"][0]["alternatives"]], [64, 64])
        self.assertEqual([f["name"] for f in chosen["outputs"]["lift_mean_n"]["factors"]][2], "formulation")
        self.assertNotIn("choices", found)
        with self.assertRaisesRegex(wb.InputError, "did you mean"):
            wb.tolerance({**study, "sample": {}}, vehicle=reference())
        with self.assertRaisesRegex(TypeError, "names its vehicle"):
            wb.tolerance("study.toml", vehicle=reference())

    def test_an_optimum_that_there_is_not(self):
        study = {
            "objective": {"minimise": "power_electrical_w", "starts": 1, "screen": 64},
            "parameter": [{"key": "supply.voltage", "lower": 2, "upper": 3}],
            "constraint": [{"metric": "lift_mean_n", "at_least": "1 N"}],
        }
        found = wb.optimise(study, vehicle=reference())
        self.assertIsNone(found.vehicle)
        self.assertIn("lift_mean", str(found))

    def test_ctrl_c_ends_a_fit(self):
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        begin = time.process_time()
        with self.assertRaises(KeyboardInterrupt):
            wb.fit(DATA / "bench" / "flapper.toml", compare_friction=True)
        # It takes some 8 s without an interrupt.
        self.assertLess(time.process_time() - begin, 2.0)

    def test_ctrl_c_ends_a_search(self):
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        keys = {"supply.voltage": (2, 8), "transmission.crank_radius": (4e-3, 7e-3), "motor.inertia": (1e-7, 2e-7)}
        study = {
            "objective": {"minimise": "power_electrical_w", "starts": 2000, "screen": 100_000},
            "parameter": [{"key": key, "lower": low, "upper": high} for key, (low, high) in keys.items()],
        }
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        begin = time.process_time()
        with self.assertRaises(KeyboardInterrupt):
            wb.optimise(study, vehicle=reference())
        self.assertLess(time.process_time() - begin, 10.0)


if __name__ == "__main__":
    unittest.main()
