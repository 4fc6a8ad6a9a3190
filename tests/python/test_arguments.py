"""What callers give: of the wrong type, out of range, contradictory; and copies of whatever comes back."""

import copy
import datetime
import pathlib
import pickle
import re
import tempfile
import unittest
from decimal import Decimal
from fractions import Fraction

import numpy as np
import wingbeat as wb
from shared import DATA, reference


def design(name):
    return wb.read(DATA / "designs" / f"{name}.toml")


class Refusals(unittest.TestCase):
    def refused(self, act, text, kind=wb.InputError):
        with self.assertRaises(kind) as caught:
            act()
        self.assertIs(type(caught.exception), kind, caught.exception)
        self.assertRegex(str(caught.exception), f"^{text}")


class Types(Refusals):
    def test_what_is_no_vehicle(self):
        for act in (
            lambda v: wb.simulate(v),
            lambda v: wb.Simulation(v),
            lambda v: wb.EquationsOfMotion(v),
            lambda v: wb.endurance(v),
            lambda v: wb.linearise(v),
            lambda v: wb.sweep(v, {"supply.voltage": [2.0, 3.0]}),
            lambda v: wb.solve_columns({"supply.voltage": [2.0]}, vehicle=v),
            lambda v: wb.tolerance({"parameter": []}, vehicle=v),
        ):
            for wrong in ("friction2022", {"motor": {}}, 3):
                text = f"vehicle: expected a wingbeat.Vehicle, got {type(wrong).__name__}$"
                self.refused(lambda: act(wrong), text, TypeError)
        self.refused(lambda: wb.solve(3), "design: expected a wingbeat.Vehicle, or a dict or DataFrame of columns, got int$", TypeError)
        self.refused(lambda: wb.solve(None), "design: expected .*, got NoneType$", TypeError)
        self.refused(lambda: wb.motor_curves(3, voltage=1), r"motor: expected a wingbeat.Vehicle, or a dict .*, got int$", TypeError)
        self.refused(lambda: wb.kinematics([1]), r"transmission: expected .*, got list$", TypeError)
        self.refused(lambda: wb.coefficient_curves(3), "aerodynamics: expected .*, got int$", TypeError)

    def test_what_is_no_quantity(self):
        vehicle = reference()
        calls = {
            "frequency": lambda x: vehicle.solve(frequency=x),
            "lift": lambda x: vehicle.solve(lift=x),
            "tolerance": lambda x: vehicle.solve(tolerance=x),
            "max_time": lambda x: vehicle.simulate(max_time=x),
            "crank_speed": lambda x: vehicle.simulate(crank_speed=x),
            "angle": lambda x: vehicle.simulation(angle=x),
            "time": lambda x: vehicle.simulation().step_to(x),
            "duration": lambda x: vehicle.simulation().step(x),
            "hinge_offset": lambda x: vehicle.linearise(hinge_offset=x),
            "stroke_amplitude": lambda x: vehicle.drawing(x),
        }
        for name, call in calls.items():
            for wrong in ([3.0], np.array([3.0]), True, np.bool_(True), 3 + 1j, np.complex128(3), b"3", {}, object(),
                          datetime.date(2026, 1, 1), np.datetime64("2026-01-01"), np.ma.masked):
                kind = type(wrong).__name__
                with self.subTest(name=name, kind=kind):
                    self.refused(lambda: call(wrong), f"{name}: expected a.*, got {kind}$", TypeError)
            for wrong in (float("nan"), np.inf, 10**400, Decimal("1e400")):
                with self.subTest(name=name, value=str(wrong)[:10]):
                    self.refused(lambda: call(wrong), f"{name}: must be finite")
        self.refused(lambda: vehicle.solve(frequency=[3]),
                     r'frequency: expected a number \[Hz\] or a frequency such as "22 Hz", got list$', TypeError)

    def test_numbers_of_every_kind(self):
        vehicle = reference()
        wanted = vehicle.solve(frequency=22.0).lift_mean
        for same in (22, "22 Hz", "0.022 kHz", np.float64(22), np.float32(22), np.int8(22), np.uint64(22), np.longdouble(22),
                     np.array(22.0), Fraction(22), Decimal(22), wb.Quantity(22.0, "Hz")):
            self.assertEqual(vehicle.solve(frequency=same).lift_mean, wanted, repr(same))
            if not isinstance(same, (str, wb.Quantity)):
                self.assertEqual(vehicle.replace({"vehicle.mass": same}).vehicle.mass, 22.0)
        self.assertEqual(vehicle.solve(tolerance="1e-6").lift_mean, vehicle.solve().lift_mean)

    def test_quantities_of_another_unit(self):
        """What knows its unit is converted, or refused, wherever a quantity is expected."""
        import xarray

        vehicle = reference()
        wanted = vehicle.solve(voltage="2.5 V").lift_mean
        self.assertEqual(vehicle.solve(voltage=wb.Quantity(2500.0, "mV")).lift_mean, wanted)
        self.assertEqual(vehicle.replace({"supply.voltage": wb.Quantity(2500.0, "mV")}).supply.voltage, 2.5)
        self.assertEqual(vehicle.solve(voltage=wb.Quantity(2.5)).lift_mean, wanted)
        self.assertEqual(vehicle.replace(dict(vehicle)), vehicle)
        study = {"objective": {"minimise": "power_electrical_w", "starts": 1, "screen": 32},
                 "parameter": [{"key": "supply.voltage", "lower": wb.Quantity(2000.0, "mV"), "upper": wb.Quantity(3.0, "V")}]}
        self.assertEqual(wb.optimise(vehicle, study).vehicle.supply.voltage, 2.0)
        angle = vehicle.solve().angle_of_attack_min
        self.assertEqual(angle.unit, "degree")
        self.assertAlmostEqual(float(vehicle.solve(angle_of_attack=angle).angle_of_attack_min), float(angle), 6)
        length = vehicle.transmission.rod_length
        self.assertEqual(vehicle.replace({"friction.radius": length}).friction.radius, float(length))
        millivolts = xarray.DataArray([2500.0, 3000.0], dims="run", attrs={"units": "mV"})
        for given in (millivolts, [wb.Quantity(2500.0, "mV"), "3 V"], ["2.5 V", 3], xarray.DataArray([2.5, 3.0])):
            np.testing.assert_array_equal(vehicle.sweep({"supply.voltage": given}).supply_voltage, [2.5, 3.0])
            self.assertAlmostEqual(vehicle.solve_columns({"supply.voltage": given}).lift_mean[0] / wanted, 1.0, 6)
        angles = xarray.DataArray([0.0, 90.0], dims="angle", attrs={"units": "degree"})
        np.testing.assert_allclose(vehicle.kinematics(crank_angle=angles).crank_angle, [0.0, np.pi / 2])
        for act, text in (
            (lambda: vehicle.solve(voltage=length), "supply.voltage: expected a voltage such as .* got .*0.02 m"),
            (lambda: vehicle.solve(frequency=length), "frequency: expected a frequency such as .* got .*0.02 m"),
            (lambda: vehicle.replace({"motor.inertia": length}), "motor.inertia: expected a moment of inertia"),
            (lambda: vehicle.sweep({"friction.radius": millivolts}), "friction.radius: expected a length such as"),
            (lambda: vehicle.solve_columns({"friction.radius": [length, vehicle.supply.voltage]}), "friction.radius: expected a l"),
            (lambda: vehicle.kinematics(crank_angle=millivolts), "crank_angle: expected an angle such as"),
            (lambda: vehicle.simulation().record(millivolts), "times: expected a time such as"),
        ):
            with self.subTest(text):
                self.refused(act, text)

    def test_a_single_text_is_an_array_of_one(self):
        vehicle = reference()
        np.testing.assert_allclose(vehicle.motor_curves(speed="600 rpm").speed, [20 * np.pi])
        np.testing.assert_allclose(vehicle.kinematics(crank_angle="90 deg").crank_angle, [np.pi / 2])
        np.testing.assert_allclose(vehicle.coefficient_curves(angle_of_attack="45 deg").angle_of_attack, [np.pi / 4])
        np.testing.assert_allclose(vehicle.simulation().record("10 ms").time, [0.01])
        self.refused(lambda: vehicle.motor_curves(speed="3 V"), 'speed: expected .* got "3 V"')

    def test_messages_of_python_name_the_vehicle(self):
        vehicle = reference()
        for act in (lambda: vehicle.solve(3), lambda: vehicle.sweep(), lambda: vehicle.fit()):
            with self.assertRaisesRegex(TypeError, r"^Vehicle\.\w+\(\) (takes|missing)"):
                act()
        self.assertEqual(pickle.loads(pickle.dumps(vehicle.solve))(voltage=0).status, "stalled")

    def test_files_that_are_no_data_sets(self):
        with self.assertRaises(FileNotFoundError) as caught:
            wb.open_dataset("none.nc")
        self.assertEqual(str(caught.exception), "[Errno 2] No such file or directory: 'none.nc'")
        with self.assertRaisesRegex(wb.InputError, "friction2022.toml: is not a NetCDF file: "):
            wb.open_dataset(DATA / "designs" / "friction2022.toml")

    def test_choices_flags_and_counts(self):
        vehicle = reference()
        for act, text in (
            (lambda: vehicle.solve(condition=3), "condition: expected a text, got int"),
            (lambda: vehicle.solve(method=None), "method: expected a text, got NoneType"),
            (lambda: vehicle.solve(endurance="no"), "endurance: expected True or False, got str"),
            (lambda: vehicle.solve(allow_extrapolation=1), "allow_extrapolation: expected True or False, got int"),
            (lambda: vehicle.linearise(maps=None), "maps: expected True or False, got NoneType"),
            (lambda: vehicle.linearise(cycles=1.5), "cycles: expected a whole number, got float"),
            (lambda: vehicle.solve_columns({"supply.voltage": [2.0]}, threads="all"), "threads: expected a whole number, got str"),
            (lambda: vehicle.solve_columns({"supply.voltage": [2.0]}, threads=True), "threads: expected a whole number, got bool"),
            (lambda: vehicle.solve_columns({"supply.voltage": [2.0]}, progress=3), "progress: expected True, False or a function"),
            (lambda: vehicle.solve_columns({"supply.voltage": [2.0]}, metrics="lift_mean"), "metrics: expected a list of names, got str"),
            (lambda: vehicle.solve_columns({"supply.voltage": [2.0]}, metrics=3), "metrics: expected a list of names, got int"),
            (lambda: vehicle.solve_columns([1.0]), "columns: expected a dict or DataFrame of columns, got list"),
            (lambda: vehicle.solve_columns({3: [1.0]}), "columns: a key: expected a text, got int"),
            (lambda: vehicle.solve().gradient(3, "supply.voltage"), "metric: expected a text, got int"),
            (lambda: vehicle.solve().gradient("lift_mean", 3), "keys: expected a list of names, got int"),
            (lambda: vehicle.solve().gradient("lift_mean", [3]), "keys: expected a text, got int"),
            (lambda: vehicle.simulation().step(1.0, until=3), "until: expected a text, got int"),
            (lambda: vehicle.simulation().restore(3), "state: expected a wingbeat.SimulationState, got int"),
            (lambda: vehicle.simulation(voltage=lambda t: "x" if t > 1 else None).step(0.1), "voltage, what the function returns: expected .* got NoneType"),
            (lambda: wb.Vehicle.from_toml(3), "toml: expected a text, got int"),
            (lambda: wb.Vehicle("friction2022"), "values: expected a dict of keys, got str; wingbeat.read reads files"),
            (lambda: wb.read(3), "file: expected a path or a file open for reading text, got int"),
            (lambda: wb.fit(3), "bench: expected the path of a bench file, or a dict of its tables, got int"),
            (lambda: wb.identify_motor(None), "sheet: expected a path, got NoneType"),
            (lambda: wb.open_dataset(3), "file: expected a path, got int"),
            (lambda: wb.optimise(3), "study: expected the path of a study file, or a dict of its tables, got int"),
            (lambda: wb.optimise({"study": 3}), "study.study: expected a dict, got int"),
            (lambda: wb.tolerance({}, vehicle=vehicle, values=3), "values: expected a dict, got int"),
            (lambda: vehicle.sweep(3), "axes: expected a dict, got int"),
            (lambda: vehicle.sweep({"supply.voltage": [1.0]}, output=3), "output: expected a path, got int"),
            (lambda: vehicle.sweep({"supply.voltage": [1.0]}, title=3), "title: expected a text, got int"),
            (lambda: vehicle.replace(3), "values: expected a dict, got int"),
            (lambda: vehicle.replace({3: 1.0}), "values: a key: expected a text, got int"),
            (lambda: vehicle.replace({"motor.inertia": None}), "motor.inertia: expected a number, .*, got NoneType"),
            (lambda: vehicle.replace({"motor.inertia": 1j}), "motor.inertia: expected a number, .*, got complex"),
            (lambda: vehicle.replace({"motor": {"inertia": object()}}), "motor.inertia: expected a number, .*, got object"),
        ):
            with self.subTest(text=text):
                self.refused(act, text, TypeError)

    def test_arrays(self):
        vehicle, equations = reference(), reference().equations_of_motion()
        arrays = {
            "supply.voltage": lambda x: vehicle.solve_columns({"supply.voltage": x}),
            "friction.radius": lambda x: vehicle.sweep({"friction.radius": x}),
            "state": lambda x: equations.rates(0.0, x),
            "times": lambda x: vehicle.simulation().record(x),
            "crank_angle": lambda x: vehicle.kinematics(crank_angle=x),
            "angle_of_attack": lambda x: vehicle.coefficient_curves(angle_of_attack=x),
            "speed": lambda x: vehicle.motor_curves(speed=x),
            "voltage": lambda x: vehicle.simulation(voltage=([0.0, 1.0, 2.0], x)),
        }
        for name, call in arrays.items():
            for wrong in (np.array([1, 2, 3j]), [1.0, 2.0, 3j], np.array([True, False, True]), [True, True, False],
                          np.array(["2026-01-01"] * 3, dtype="datetime64[D]"), [1.0, None, 2.0], [object()] * 3):
                with self.subTest(name=name, value=repr(wrong)):
                    self.refused(lambda: call(wrong), f"{re.escape(name)}: expected .*, got", TypeError)
            masked = np.ma.array([1e-3, 2e-3, 3e-3], mask=[False, True, False])
            with self.subTest(name=name):
                self.refused(lambda: call(masked), f"{re.escape(name)}: value 1 is masked")
                self.refused(lambda: call([[1.0, 2.0], [1.0]]), f"{re.escape(name)}: ")
        # Without a masked value, not contiguous, of other types, read-only: the numbers count.
        wanted = vehicle.solve_columns({"supply.voltage": [2.0, 3.0, 4.0]}).lift_mean
        frozen = np.array([2.0, 3.0, 4.0])
        frozen.flags.writeable = False
        for same in (np.ma.array([2.0, 3.0, 4.0]), np.array([2, 0, 3, 0, 4, 0])[::2], np.array([4.0, 3.0, 2.0])[::-1], frozen,
                     np.array([2, 3, 4], dtype=">f4"), np.array([2, 3, 4], dtype=object), [2, "3 V", np.float32(4)],
                     range(2, 5), np.array([2, 3, 4], dtype=np.longdouble)):
            np.testing.assert_array_equal(vehicle.solve_columns({"supply.voltage": same}).lift_mean, wanted)
            np.testing.assert_array_equal(vehicle.sweep({"supply.voltage": same}).lift_mean.values, wanted)
        states = np.arange(30.0).reshape(3, 10)
        np.testing.assert_array_equal(equations.rates(0, np.asfortranarray(states)), equations.rates(0, states))
        np.testing.assert_array_equal(equations.rates(0, states[:, ::3]), equations.rates(0, states)[:, ::3])

    def test_empty_and_of_other_shapes(self):
        vehicle = reference()
        self.refused(lambda: vehicle.solve_columns({"supply.voltage": []}), "supply.voltage: expected a value for each design, got none")
        self.refused(lambda: vehicle.solve_columns({"supply.voltage": np.empty(0)}), "supply.voltage: expected a value for each design")
        self.refused(lambda: vehicle.sweep({"supply.voltage": []}), "axis.values: |supply.voltage: ")
        self.refused(lambda: vehicle.sweep({"supply.voltage": [[1.0, 2.0]]}), "supply.voltage: expected values along one axis, got an array of 2")
        self.refused(lambda: vehicle.sweep({"supply.voltage": np.ones((2, 2, 2))}), "supply.voltage: expected values along one axis, got an array of 3")
        self.refused(lambda: vehicle.sweep({"supply.voltage": 3.0}), "supply.voltage: expected an array of values, got float", TypeError)
        self.refused(lambda: vehicle.sweep({"supply.voltage": "3 V"}), "supply.voltage: expected an array of values, got str", TypeError)
        self.refused(lambda: vehicle.sweep({}), "study: nothing to vary|nothing to vary")
        self.refused(lambda: vehicle.motor_curves(speed=[]), "speed: expected speeds, got none")
        self.refused(lambda: vehicle.motor_curves(speed=[np.nan]), "speed: must be >= 0 rad/s and finite")
        self.refused(lambda: vehicle.kinematics(crank_angle=[np.inf]), "crank_angle: must be finite")
        self.refused(lambda: vehicle.coefficient_curves(angle_of_attack=np.nan), "angle_of_attack: must be finite")
        tabulated = wb.read(DATA / "loads" / "flapper.toml")
        self.refused(lambda: tabulated.coefficient_curves(), "aerodynamics.type: tabulated loads have no coefficients")
        self.assertEqual(wb.Vehicle.from_toml(tabulated.to_toml()).solve().lift_mean, tabulated.solve().lift_mean)
        self.assertEqual(len(vehicle.kinematics(crank_angle=[]).crank_angle), 0)
        self.assertEqual(len(vehicle.simulation().record([]).time), 0)
        self.refused(lambda: vehicle.equations_of_motion().rates(0.0, np.ones((3, 2, 2))), "expected a state of 3 numbers", ValueError)

    def test_texts_that_cannot_be_written(self):
        vehicle = reference()
        self.refused(lambda: vehicle.replace({"vehicle.name": "a\ud800"}), "vehicle.name: is not a text in Unicode")
        self.refused(lambda: vehicle.solve(condition="\udfff"), "condition: is not a text in Unicode")
        self.refused(lambda: vehicle.replace({"motor.inertia=1\nmotor.viscous_damping": 1}), "'motor.inertia=1.nmotor.*: unknown key")
        with tempfile.TemporaryDirectory() as folder:  # a name that is no UTF-8
            file = pathlib.Path(folder) / "caf\udce9.toml"
            file.write_text(vehicle.to_toml())
            self.assertEqual(wb.read(file), vehicle)


class Contradictions(Refusals):
    def test_what_excludes_each_other(self):
        vehicle = reference()
        for act, text in (
            (lambda: vehicle.solve(voltage=9, frequency=22), "frequency: cannot be asked for beside voltage"),
            (lambda: vehicle.solve(voltage=9, lift=0.01), "lift: cannot be asked for beside voltage"),
            (lambda: vehicle.solve(frequency=22, lift=0.01), "lift: cannot be asked for beside frequency"),
            (lambda: vehicle.linearise(frequency=22, lift=0.01), "lift: cannot be asked for beside frequency"),
            (lambda: vehicle.solve_columns({"frequency": [20.0]}, frequency=22), "frequency: is given in the columns and beside them"),
            (lambda: vehicle.solve_columns({"frequency": 20.0, "friction.radius": [2e-3]}, frequency=22), "frequency: is given in the columns"),
            (lambda: vehicle.sweep({"frequency": [20.0, 21.0]}, frequency=22), "frequency: is an axis, and held beside it"),
            (lambda: vehicle.solve(lift=0.01, lift_to_weight=1), "lift_to_weight: cannot be asked for beside lift"),
            (lambda: vehicle.solve(lift_to_weight=0), "lift_to_weight: must be > 0"),
            (lambda: vehicle.solve_columns({"lift": [0.01]}, lift_to_weight=1), "lift_to_weight: cannot be asked for beside lift"),
            (lambda: vehicle.sweep({"lift": [0.01, 0.02]}, lift="9 mN"), "lift: is an axis, and held beside it"),
            (lambda: vehicle.sweep({"supply.voltage": [3, 4]}, lift="9 mN"), "supply.voltage: has no effect where the mean lift is held"),
            (lambda: vehicle.replace({"motor.inertia": 1e-7, "motor": {"inertia": 2e-7}}), "motor.inertia: is given twice"),
            (lambda: wb.tolerance({"study": {"vehicle": "friction2022"}}, vehicle=vehicle), "study.vehicle: is given in the study and beside it"),
        ):
            with self.subTest(text=text):
                self.refused(act, text)

    def test_out_of_range(self):
        vehicle = reference()
        simulation = vehicle.simulation()
        simulation.step_to(0.02)
        for act, text in (
            (lambda: vehicle.solve(frequency=-1), "frequency: must be > 0"),
            (lambda: vehicle.solve(lift=-1e-3), "lift: must be > 0"),
            (lambda: vehicle.solve(lift=0), "lift: must be > 0"),
            (lambda: vehicle.solve(voltage=-1), "supply.voltage: must be >= 0"),
            (lambda: vehicle.simulate(max_time=-1), "max_time: must be >= 0"),
            (lambda: vehicle.simulate(record_interval=-1), "record_interval: must be >= 0"),
            (lambda: vehicle.linearise(cycles=-1), "cycles: must be a whole number from 0 to 100000, got -1"),
            (lambda: vehicle.linearise(hinge_offset=-1), "hinge_offset: must be >= 0"),
            (lambda: vehicle.solve_columns({"supply.voltage": [2.0]}, threads=-1), "threads: must be a whole number from 0 to 4096, got -1"),
            (lambda: vehicle.solve_columns({"supply.voltage": [2.0]}, threads=10**30), "threads: must be a whole number"),
            (lambda: simulation.step(-1), "duration: must be >= 0 s, got -1$"),
            (lambda: simulation.step("-1 ms"), "duration: must be >= 0 s, got -1 ms$"),
            (lambda: simulation.step_to(0.01), "time: must not lie in the past: the simulation is at 0.02 s, got 0.01 s$"),
            (lambda: simulation.record([0.01, 0.03]), "times: must not fall, nor begin in the past"),
            (lambda: simulation.record([0.03, np.nan]), "times: must not fall, nor begin in the past, and must be finite"),
            (lambda: simulation.step(1.0, until=""), 'until: must be revolution, .*, got ""'),
        ):
            with self.subTest(text=text):
                self.refused(act, text)
        self.assertEqual(simulation.time, 0.02)
        self.assertEqual(simulation.step(0), [])
        self.assertEqual(simulation.step_to(0.02), [])


class Copies(unittest.TestCase):
    def test_everything_that_comes_back_can_be_pickled_and_copied(self):
        vehicle = reference()
        study = {
            "samples": {"count": 64},
            "parameter": [{"key": "friction.radius", "distribution": "normal", "relative_deviation": 0.05}],
        }
        optimum = {"objective": {"minimise": "power_electrical_w", "starts": 1, "screen": 32},
                   "parameter": [{"key": "supply.voltage", "lower": 2, "upper": 3}]}
        result = vehicle.solve()
        result.cycle
        flight = vehicle.simulation()
        events = flight.step(0.1)
        whole = [
            vehicle, vehicle.motor, vehicle.wing.planform, vehicle.transmission.crank_radius, result, result.energy_balance,
            vehicle.simulate(), vehicle.solve_columns({"supply.voltage": [2.0, 3.0]}), vehicle.sweep({"supply.voltage": [2.0, 3.0]}),
            vehicle.equations_of_motion(condition="vacuum"), flight, flight.save(), events, vehicle.linearise(maps=False),
            vehicle.linearise(maps=False).discrete, design("friction2022-battery").endurance(), wb.tolerance(study, vehicle=vehicle),
            wb.optimise(optimum, vehicle=vehicle), wb.identify_motor(DATA / "motors" / "0816K003SR.toml"),
            wb.parameters["motor.inertia"], wb.metrics["lift_mean"], vehicle.kinematics(),
        ]
        for one in whole:
            for made in (pickle.loads(pickle.dumps(one)), copy.copy(one), copy.deepcopy(one)):
                with self.subTest(kind=type(one).__name__):
                    self.assertIs(type(made), type(one))
                    self.assertEqual(repr(made), repr(one))
                    if type(one).__eq__ is not object.__eq__ and not hasattr(one, "dims"):
                        self.assertEqual(made, one)
        again = pickle.loads(pickle.dumps(result))
        self.assertEqual((again.metrics, again.vehicle), (result.metrics, result.vehicle))
        self.assertEqual(again.gradient("lift_mean", "supply.voltage"), result.gradient("lift_mean", "supply.voltage"))
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(whole[9])).rates(0, [1, 2, 3]), whole[9].rates(0, [1, 2, 3]))
        self.assertEqual(len({vehicle.motor, reference().motor}), 1)
        self.assertNotEqual(vehicle.motor, vehicle.replace({"motor.inertia": 1e-7}).motor)

    def test_errors_can_be_pickled(self):
        with self.assertRaises(wb.InputError) as caught:
            reference().replace({"motor.inertia": -1, "wing.count": "two"})
        made = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((str(made), made.key), (str(caught.exception), "motor.inertia"))
        self.assertEqual([other.key for other in made.others], ["wing.count"])


if __name__ == "__main__":
    unittest.main()
