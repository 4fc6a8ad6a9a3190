"""Very many vehicles: columns of designs, and sweeps."""

import os
import pathlib
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
import wingbeat as wb
import xarray as xr
from shared import DATA, PROGRAM, reference


class Columns(unittest.TestCase):
    def test_each_design_is_what_it_is_alone(self):
        vehicle = wb.read(DATA / "designs" / "friction2022-springs.toml")
        voltages = np.linspace(0.2, 5.0, 25)
        radii = np.linspace(4e-3, 6e-3, 25)
        found = wb.solve({"supply.voltage": voltages, "transmission.crank_radius": radii}, vehicle=vehicle)
        self.assertEqual(len(found), 25)
        for n in range(25):
            alone = vehicle.replace({"supply.voltage": voltages[n], "transmission.crank_radius": radii[n]}).solve()
            self.assertEqual(found.status[n], alone.status)
            self.assertEqual(found.flapping[n], alone.status == "flapping")
            if alone.status == "flapping":
                self.assertAlmostEqual(found.lift_mean[n] / alone.lift_mean, 1.0, 5)
            else:
                self.assertTrue(np.isnan(found.lift_mean[n]))
        self.assertIn("locked", found.status)
        self.assertEqual(found.to_xarray().lift_mean.attrs["units"], "N")
        self.assertIn("locked", repr(found))

    def test_a_held_lift_is_that_of_each_design_alone(self):
        vehicle = wb.read(DATA / "designs" / "two-wing-four-bar.toml")
        gears = np.linspace(6.0, 20.0, 8)
        hovers = vehicle.solve_columns({"motor.gear_ratio": gears}, lift_to_weight=1)
        self.assertTrue(hovers.flapping.all())
        np.testing.assert_allclose(hovers.lift_to_weight, 1.0, rtol=1e-6)
        alone = [vehicle.replace({"motor.gear_ratio": gear}).solve(lift_to_weight=1, tolerance=1e-9) for gear in gears]
        np.testing.assert_allclose(hovers.voltage, [float(result.voltage) for result in alone], rtol=1e-5)
        slopes = hovers.gradient(["power_electrical", "lift_to_weight"], ["motor.gear_ratio", "vehicle.mass"])
        np.testing.assert_allclose(slopes[:, 1], 0.0, atol=1e-9)
        one = alone[3].gradient("power_electrical", ["motor.gear_ratio", "vehicle.mass"])
        np.testing.assert_allclose(slopes[3, 0], one, rtol=1e-4)
        step = 1e-4 * gears[3]
        beside = [vehicle.replace({"motor.gear_ratio": gears[3] + s}).solve(lift_to_weight=1, tolerance=1e-10) for s in (step, -step)]
        change = float(beside[0].power_electrical) - float(beside[1].power_electrical)
        self.assertAlmostEqual(change / (2.0 * step) / one[0], 1.0, 5)
        powers = vehicle.solve_columns({"motor.gear_ratio": gears}, power="1.5 W")
        np.testing.assert_allclose(powers.power_electrical, 1.5, rtol=1e-6)
        one_power = vehicle.replace({"motor.gear_ratio": gears[2]}).solve(power=1.5, tolerance=1e-9)
        self.assertAlmostEqual(float(one_power.lift_mean) / powers.lift_mean[2], 1.0, 5)
        with_mass = vehicle.solve_columns({"vehicle.mass": [0.016, 0.018], "lift": [0.15, 0.2]})
        np.testing.assert_allclose(with_mass.lift_mean, [0.15, 0.2], rtol=1e-6)
        data = vehicle.sweep({"motor.gear_ratio": [8, 12], "lift_to_weight": [1, 1.2]}, metrics=["lift_to_weight"])
        self.assertEqual(data.lift_to_weight.dims, ("motor_gear_ratio", "held_lift_to_weight"))
        np.testing.assert_allclose(data.lift_to_weight, [[1, 1.2], [1, 1.2]], rtol=1e-6)

    def test_gradients_are_those_of_each_design_alone(self):
        vehicle = wb.read(DATA / "designs" / "friction2022-springs.toml")
        columns = {"supply.voltage": np.linspace(0.2, 5.0, 21), "transmission.crank_radius": np.linspace(4e-3, 6e-3, 21)}
        found = wb.solve(columns, vehicle=vehicle, tolerance=1e-9)
        metrics, keys = ["lift_mean", "current_peak"], ["supply.voltage", "friction.radius", "spring.stiffness"]
        slopes = found.gradient(metrics, keys)
        self.assertEqual(slopes.shape, (21, 2, 3))
        np.testing.assert_array_equal(np.isnan(slopes).all(axis=(1, 2)), ~found.flapping)
        for n in np.flatnonzero(found.flapping)[::4]:
            row = {key: values[n] for key, values in columns.items()}
            alone = vehicle.replace(row).solve(tolerance=1e-9)
            for m, metric in enumerate(metrics):
                np.testing.assert_allclose(slopes[n, m], alone.gradient(metric, keys), rtol=1e-6)
        np.testing.assert_array_equal(found.gradient("lift_mean", keys[1]), slopes[:, 0, 1])
        held = vehicle.solve_columns({"frequency": [20.0, 22.0]})
        np.testing.assert_allclose(held.gradient("frequency", ["friction.radius"]), 0.0, atol=1e-4)
        again = pickle.loads(pickle.dumps(held))
        np.testing.assert_array_equal(again.gradient("voltage", keys), held.gradient("voltage", keys))
        with self.assertRaisesRegex(wb.InputError, "did you mean lift_mean"):
            found.gradient("lift_meen", keys)
        with self.assertRaisesRegex(wb.InputError, "piezo"):
            found.gradient("lift_mean", "piezo.force_per_volt")

    def test_gradients_report_their_progress(self):
        found = reference().solve_columns({"supply.voltage": np.linspace(2.0, 5.0, 3000)}, metrics=["lift_mean"])
        reported = []
        found.gradient("lift_mean", "friction.radius", threads=1,
                       progress=lambda done, designs: reported.append((done, designs)))
        self.assertTrue(reported)
        self.assertEqual(reported, sorted(reported))
        self.assertEqual({designs for _, designs in reported}, {3000})
        self.assertLessEqual(reported[-1][0], 3000)

    def test_a_whole_vehicle_in_columns(self):
        columns = {**dict(reference()), "supply.voltage": ["2 V", "3 V"]}
        found = wb.solve(columns, metrics=["lift_mean"])
        self.assertAlmostEqual(found.lift_mean[1] / reference().solve().lift_mean, 1.0, 5)
        with self.assertRaisesRegex(AttributeError, "or it was not asked for"):
            found.frequency

    def test_a_data_frame(self):
        import pandas

        frame = pandas.DataFrame({"supply.voltage": [2.0, 3.0], "friction.radius": ["2 mm", "2.5 mm"]}, index=[7, 8])
        found = wb.solve(frame, vehicle=reference())
        self.assertAlmostEqual(found.lift_mean[1] / reference().solve().lift_mean, 1.0, 5)

    def test_a_frequency_is_held(self):
        vehicle = reference()
        found = vehicle.solve_columns({"frequency": [20.0, 22.0], "friction.radius": ["2 mm", "2.5 mm"]})
        np.testing.assert_allclose(found.frequency, [20.0, 22.0], rtol=1e-6)
        np.testing.assert_allclose(vehicle.solve_columns({"friction.radius": [2.5e-3]}, frequency="22 Hz").voltage,
                                   found.voltage[1], rtol=1e-6)

    def test_designs_out_of_range_are_invalid(self):
        found = reference().solve_columns({"motor.inertia": [1.5e-7, -1.0]})
        self.assertEqual(list(found.status), ["flapping", "invalid"])

    def test_what_is_refused(self):
        vehicle = reference()
        with self.assertRaisesRegex(wb.InputError, "did you mean motor.inertia"):
            vehicle.solve_columns({"motor.inerti": [1.0], "motor.inertia": [1.0]})
        with self.assertRaisesRegex(wb.InputError, "spring.resonance_ratio: only with"):
            vehicle.solve_columns({"spring.resonance_ratio": [1.0]})
        with self.assertRaisesRegex(wb.InputError, 'supply.voltage: expected a voltage such as "3 V", got "3 m"'):
            vehicle.solve_columns({"supply.voltage": ["3 m"]})
        with self.assertRaisesRegex(wb.InputError, "^tolerance: "):
            vehicle.solve_columns({"supply.voltage": [1.0]}, tolerance=1.0)
        with self.assertRaisesRegex(wb.InputError, "^supply.voltage: has no effect where the frequency is held"):
            vehicle.solve_columns({"supply.voltage": [1.0], "frequency": [20.0]})
        with self.assertRaisesRegex(wb.InputError, "^supply.type: a sine supply gives no steady flapping"):
            sine = vehicle.replace({"supply": {"type": "sine", "amplitude": "3 V", "frequency": "20 Hz"}})
            sine.solve_columns({"supply.amplitude": [1.0]})
        battery = wb.read(DATA / "designs" / "friction2022-battery.toml")
        slow = battery.solve_columns({"friction.radius": [2e-3, 3e-3]}, frequency=20.0)
        np.testing.assert_allclose(slow.frequency, 20.0, rtol=1e-6)
        with self.assertRaisesRegex(wb.InputError, "^supply.duty: has no effect where the frequency is held: the duty"):
            battery.solve_columns({"supply.duty": [0.5]}, frequency=20.0)
        with self.assertRaisesRegex(ValueError, "motor.inertia has 2 values, supply.voltage has 1"):
            vehicle.solve_columns({"supply.voltage": [1.0], "motor.inertia": [1.0, 2.0]})
        with self.assertRaisesRegex(ValueError, "no key has an array"):
            wb.solve({"supply.voltage": 3.0}, vehicle=vehicle)

    def test_arrays_own_their_numbers(self):
        lift = reference().solve_columns({"supply.voltage": np.linspace(2, 3, 600)}).lift_mean
        kept = lift.copy()
        reference().solve_columns({"supply.voltage": np.linspace(4, 5, 600)})
        np.testing.assert_array_equal(lift, kept)


class Sweeps(unittest.TestCase):
    AXES = {"supply.voltage": np.linspace(2, 5, 7), "transmission.crank_radius": ["4 mm", "5 mm", "6 mm"]}

    @unittest.skipUnless(PROGRAM, "needs the program")
    def test_it_is_the_data_set_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "vehicle").write_text(reference().to_toml())
            study = (
                '[study]\nvehicle = "vehicle"\n'
                '[[axis]]\nkey = "supply.voltage"\nvalues = [2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0]\n'
                '[[axis]]\nkey = "transmission.crank_radius"\nvalues = ["4 mm", "5 mm", "6 mm"]\n'
            )
            (folder / "sweep").write_text(study)
            command = [PROGRAM, "sweep", "sweep", "-o", "program.nc"]
            subprocess.run(command, cwd=folder, check=True, capture_output=True)
            program = wb.open_dataset(folder / "program.nc")
        ours = reference().sweep(self.AXES)
        for attribute in ("study", "wingbeat_fingerprint"):  # how the study is spelled
            del program.attrs[attribute], ours.attrs[attribute]
        xr.testing.assert_identical(ours, program)

    def test_hdf5_prints_nothing(self):
        act = "from shared import reference; reference().sweep({'supply.voltage': [2.0, 3.0]})"
        found = subprocess.run([sys.executable, "-c", act], capture_output=True, text=True)
        self.assertEqual(found.returncode, 0, found.stderr)
        self.assertNotIn("HDF5", found.stderr)

    def test_names_of_the_package(self):
        data = reference().sweep(self.AXES, metrics=["lift_mean", "lift_to_weight"], title="A title")
        self.assertEqual(data.wingbeat.lift_mean.dims, ("supply_voltage", "transmission_crank_radius"))
        self.assertTrue((data.wingbeat.status == "flapping").all())
        self.assertTrue((data.status == "flapping").all())
        np.testing.assert_array_equal(data.lift_mean, data["lift_mean_n"])
        self.assertTrue((data.sel(supply_voltage=3).status == "flapping").all())
        self.assertEqual(float(data.lift_to_weight.where(data.status == "flapping").max()), data["lift_to_weight"].max())
        self.assertEqual(data.wingbeat.vehicle, reference())
        self.assertEqual(data.attrs["title"], "A title")
        with self.assertRaises(AttributeError):
            data.wingbeat.frequency
        best = float(data.wingbeat.lift_mean.sel(supply_voltage=3, transmission_crank_radius=0.005))
        self.assertAlmostEqual(best / reference().solve().lift_mean, 1.0, 5)

    def test_the_status_is_a_text_everywhere(self):
        vehicle = reference()
        data = vehicle.sweep({"supply.voltage": [0.0, 3.0, 4.0], "friction.radius": [2e-3, 3e-3]})
        column = vehicle.solve_columns({"supply.voltage": [0.0, 3.0, 4.0]})
        for one in (data.status, data["status"], data.wingbeat.status, data.coords["status"], column.to_xarray().status):
            self.assertEqual(one.dtype.kind, "U")
        self.assertEqual(column.status.dtype.kind, "U")
        self.assertEqual(list(column.status), [str(vehicle.solve(voltage=volts).status) for volts in (0, 3, 4)])
        self.assertEqual(data.status[:, 0].values.tolist(), list(column.status))
        np.testing.assert_array_equal(data.status_code[:, 0], column.status_code)

    def test_wrappers_stay_what_they_are(self):
        """Behind everything that a method or an operator of a data set returns; the status as it was."""
        data = reference().sweep({"supply.voltage": [0.0, 3.0, 4.0], "friction.radius": [2e-3, 3e-3]})
        volts = data.supply_voltage
        for name, act in {
            "where": lambda d: d.where(d.lift_mean > 0.01), "drop": lambda d: d.where(d.status == "flapping", drop=True),
            "sel": lambda d: d.sel(supply_voltage=3), "isel": lambda d: d.isel(supply_voltage=[0, 2]),
            "times": lambda d: 2 * d, "minus": lambda d: d - d.isel(supply_voltage=1, drop=True).reset_coords(drop=True),
            "minus itself": lambda d: d - d, "negative": lambda d: -d, "numpy": np.sqrt, "compared": lambda d: d > 0,
            "mean": lambda d: d.where(volts > 0).mean("friction_radius"), "fillna": lambda d: d.fillna(0.0),
            "assign": lambda d: d.assign(extra=2 * d.lift_mean), "copy": lambda d: d.copy(deep=True),
            "several": lambda d: d[["lift_mean", "power_electrical_w"]], "transpose": lambda d: d.transpose(),
            "stack": lambda d: d.stack(design=["supply_voltage", "friction_radius"]), "load": lambda d: d.load(),
            "pickled": lambda d: pickle.loads(pickle.dumps(d)), "map": lambda d: d.map(np.abs),
            "astype": lambda d: d.astype(float), "clip": lambda d: d.clip(min=0), "pipe": lambda d: d.pipe(lambda e: e + 1),
        }.items():
            with self.subTest(name):
                made = act(data)
                self.assertIs(type(made), wb.SweepData)
                self.assertEqual(made.lift_mean.name, "lift_mean_n")
                np.testing.assert_array_equal(made["lift_mean"], made["lift_mean_n"])
                if "supply_voltage" in made.dims and "friction_radius" in made.dims:
                    picked = data.sel(supply_voltage=made.supply_voltage).transpose(*made.status.dims)
                    self.assertEqual(made.status.dtype.kind, "U")
                    np.testing.assert_array_equal(made.status, picked.status)
        for between in (data.interp(supply_voltage=3.5), data.interp(supply_voltage=[3.5]), data.coarsen(supply_voltage=3).mean()):
            self.assertNotIn("status", between.variables)
            self.assertEqual(between.wingbeat.lift_mean.name, "lift_mean_n")
        for one in (data.lift_mean, data["lift_mean_n"], data.lift_mean.where(data.status == "flapping")):
            self.assertNotIn("status", one.coords)
            self.assertGreater(one.interp(supply_voltage=3.5)[0], one.sel(supply_voltage=3)[0])
            self.assertEqual(one.coarsen(supply_voltage=3).max().sizes["supply_voltage"], 1)
        lifting = data.where(data.lift_mean > 0.01)
        self.assertTrue(np.isnan(lifting.lift_mean[0]).all())
        self.assertEqual(float((data * 1e3).lift_mean.max()), 1e3 * float(data.lift_mean.max()))
        plain = xr.merge([xr.Dataset(data), xr.Dataset({"mine": 1.0})])
        self.assertEqual(plain.wingbeat.lift_mean.name, "lift_mean_n")
        self.assertEqual(plain.wingbeat.status.dtype.kind, "U")

    def test_designs_that_are_no_longer_there_have_no_status(self):
        data = reference().sweep({"supply.voltage": [3.0, 4.0]}).reindex(supply_voltage=[3.0, 9.0])
        self.assertEqual(data.wingbeat.status.values.tolist(), ["flapping", ""])
        self.assertEqual(data.status_code.values.tolist(), [0, -1])

    def test_what_it_writes_is_what_the_program_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            file, first = pathlib.Path(folder) / "kept.nc", pathlib.Path(folder) / "first.nc"
            data = reference().sweep({"supply.voltage": [0.0, 2.0, 3.0, 4.0]}, output=first)
            data.to_netcdf(file)
            xr.testing.assert_identical(wb.open_dataset(file), data)
            with xr.open_dataset(file) as plain, xr.open_dataset(first) as program:
                xr.testing.assert_identical(plain, program)
                self.assertEqual(plain["status"].dtype, program["status"].dtype)
                self.assertEqual(plain["status"].values.tolist(), [1, 0, 0, 0])
                self.assertEqual(plain["status"].attrs["flag_meanings"].split()[:2], ["flapping", "stalled"])
                np.testing.assert_array_equal(plain.wingbeat.status, data.status)

    def test_statuses_of_other_files(self):
        """A front has those of all designs that were evaluated."""
        with xr.open_dataset(self.kept({"supply.voltage": [0.0, 3.0]})) as data:
            flags = data["status"].attrs
        made = xr.Dataset({"evaluated_status": ("solved", np.array([1, 0, 6], dtype=np.int8), flags),
                           "own_status": ("solved", [1, 2, 3])})
        with tempfile.TemporaryDirectory() as folder:
            file, again = (pathlib.Path(folder) / name for name in ("front.nc", "again.nc"))
            made.to_netcdf(file)
            read = wb.open_dataset(file)
            self.assertEqual(read["evaluated_status"].values.tolist(), ["stalled", "flapping", "undecided"])
            self.assertEqual(read["own_status"].values.tolist(), [1, 2, 3])
            read.to_netcdf(again)
            with xr.open_dataset(file) as first, xr.open_dataset(again) as second:
                xr.testing.assert_identical(first, second)

    def kept(self, axes):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        reference().sweep(axes, output=pathlib.Path(folder.name) / "kept.nc")
        return pathlib.Path(folder.name) / "kept.nc"

    def test_choices_and_held_frequencies(self):
        axes = {"condition": ["air", "vacuum"], "frequency": ["20 Hz", "22 Hz"]}
        data = reference().sweep(axes)
        self.assertEqual(list(data.condition.values), ["air", "vacuum"])
        np.testing.assert_allclose(data.frequency_hz, [[20, 22], [20, 22]], rtol=1e-6)

    def test_a_file_is_kept_and_computed_once(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "kept.nc"
            first = reference().sweep(self.AXES, output=file)
            written = file.stat().st_mtime_ns
            xr.testing.assert_identical(reference().sweep(self.AXES, output=file), first)
            self.assertEqual(file.stat().st_mtime_ns, written)
            with self.assertRaisesRegex(wb.InputError, "kept.nc"):
                reference().sweep({"supply.voltage": [1.0, 2.0]}, output=file)
            reference().sweep({"supply.voltage": [1.0, 2.0]}, output=file, force=True)
            self.assertEqual(os.listdir(folder), ["kept.nc"])

    def test_what_is_refused(self):
        with self.assertRaisesRegex(wb.InputError, "^supply.voltag: unknown key; did you mean supply.voltage") as caught:
            reference().sweep({"supply.voltag": [1.0, 2.0]})
        self.assertIsNone(caught.exception.file)
        with self.assertRaisesRegex(wb.InputError, "the same value is given twice"):
            reference().sweep({"supply.voltage": [1.0, 1.0]})


class LongCalls(unittest.TestCase):
    COLUMNS = {"supply.voltage": np.linspace(2, 5, 400_000)}

    def test_ctrl_c_ends_it(self):
        # A test started in the background ignores it.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        begin = time.process_time()
        with self.assertRaises(KeyboardInterrupt):
            reference().solve_columns(self.COLUMNS, tolerance=1e-10)
        self.assertLess(time.process_time() - begin, 5.0)

    def test_an_exception_of_the_progress_function_ends_it(self):
        calls = []

        def progress(done, designs):
            calls.append((done, designs))
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            reference().solve_columns(self.COLUMNS, tolerance=1e-10, progress=progress)
        self.assertEqual(len(calls), 1)
        self.assertEqual(calls[0][1], 400_000)


if __name__ == "__main__":
    unittest.main()
