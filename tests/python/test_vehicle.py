"""Vehicles as values: keys, errors, copies, files."""

import copy
import io
import os
import pathlib
import pickle
import tempfile
import unittest

import numpy as np
import user_script
import wingbeat as wb
from shared import DATA, reference


class Vehicles(unittest.TestCase):
    def test_every_vehicle_of_the_data_survives_toml_dict_and_pickle(self):
        files = sorted((DATA / "designs").glob("*.toml"))
        self.assertGreater(len(files), 5)
        for file in files:
            vehicle = wb.read(file)
            self.assertEqual(wb.Vehicle.from_toml(vehicle.to_toml()), vehicle, file)
            self.assertEqual(wb.Vehicle(vehicle.to_dict()), vehicle, file)
            self.assertEqual(wb.Vehicle(dict(vehicle)), vehicle, file)
            self.assertEqual(pickle.loads(pickle.dumps(vehicle)), vehicle, file)
            self.assertEqual(copy.deepcopy(vehicle), vehicle, file)
            self.assertEqual(vehicle.replace({}), vehicle, file)

    def test_keys_are_attributes_in_si_with_units(self):
        vehicle = reference()
        self.assertEqual(vehicle.transmission.crank_radius, 0.005)
        self.assertEqual(vehicle.transmission.crank_radius.unit, "m")
        self.assertEqual(vehicle["wing.planform"].s2, vehicle.wing.planform.s2)
        self.assertEqual(vehicle.transmission.formulation, "rod-force")
        self.assertIsNone(vehicle.motor.gear_ratio)
        self.assertIs(vehicle["aerodynamics.added_mass"], vehicle.aerodynamics.added_mass)
        self.assertIn("crank_radius", dir(vehicle.transmission))
        self.assertIn("transmission", dir(vehicle))

    def test_every_key_of_the_table_can_be_asked_for(self):
        vehicle = reference()
        for key, parameter in wb.parameters.items():
            value = vehicle[key]
            if parameter.unit and value is not None:
                self.assertIsInstance(value, wb.Quantity, key)
            self.assertIn("Default", parameter.doc)
            self.assertFalse(parameter.always and value is None, key)
        self.assertEqual(vehicle.motor.gear_efficiency, 1.0)

    def test_texts_have_units_and_numbers_are_si(self):
        vehicle = reference()
        for value in ("7 mm", 0.007, np.float64(0.007), "0.7 cm"):
            self.assertEqual(vehicle.replace({"transmission.crank_radius": value}).transmission.crank_radius, 0.007)
        nested = vehicle.replace({"motor": {"inertia": "2e-7 kg m2"}, "wing.count": 4})
        self.assertEqual((nested.motor.inertia, nested.wing.count), (2e-7, 4))
        self.assertEqual(vehicle.motor.inertia, 1.5e-7)

    def test_alternatives_replace_each_other(self):
        vehicle = reference().replace({"transmission.stroke_amplitude": "30 deg"})
        self.assertIn("stroke_amplitude", vehicle.to_toml())
        self.assertNotIn("hinge_offset", vehicle.to_toml())

    def test_a_table_of_rows(self):
        chords = [[0.0, 0.02], ["30 mm", "25 mm"], [0.06, 0.0]]
        vehicle = reference().replace({"wing.planform": {"shape": "tabulated", "chords": np.array(
            [[0.0, 0.02], [0.03, 0.025], [0.06, 0.0]])}})
        self.assertEqual(vehicle, reference().replace({"wing.planform": {"shape": "tabulated", "chords": chords}}))
        self.assertEqual(vehicle["wing.planform.chords"][1], ["0.03 m", "0.025 m"])

    def test_a_vehicle_does_not_change(self):
        vehicle = reference()
        with self.assertRaisesRegex(AttributeError, r"vehicle\.replace\(\{'motor\.inertia'"):
            vehicle.motor.inertia = 1.0
        with self.assertRaises(AttributeError):
            vehicle.anything = 1.0
        self.assertEqual(len({vehicle, reference()}), 1)

    def test_a_name_with_quotes_and_other_alphabets(self):
        name = 'Flügel "zwei" \\ 翼\n\x7f'
        self.assertEqual(reference().replace({"vehicle.name": name}).name, name)

    def test_a_name_with_what_toml_escapes_or_cannot_hold(self):
        name = "a\x7f\x9b\u202e\u2028\ufeff\U0001f600\x00\x1b"
        vehicle = reference().replace({"vehicle.name": name})
        self.assertEqual(vehicle.name, name)
        self.assertEqual(wb.Vehicle.from_toml(vehicle.to_toml()).name, name)
        for hidden in "\x7f\x9b\u202e\u2028\ufeff":
            self.assertNotIn(hidden, vehicle.to_toml())
        with self.assertRaisesRegex(wb.InputError, "vehicle.name: is not a text in Unicode"):
            reference().replace({"vehicle.name": "half \ud83d"})

    def test_keys_and_metrics_explain_themselves(self):
        inertia = type(reference().motor).inertia
        self.assertIn("[kg m2] Range: > 0.", inertia.__doc__)
        self.assertEqual(wb.RunResult.lift_mean.__doc__, "Mean lift [N].")
        self.assertIn("motor.inertia", wb.parameters)
        with self.assertRaises(AttributeError):
            reference().motor.inerti

    def test_a_users_script(self):
        self.assertGreater(user_script.main(str(DATA / "designs" / "friction2022.toml")), 20.0)


class Errors(unittest.TestCase):
    def refused(self, act, text):
        with self.assertRaises(wb.InputError) as caught:
            act()
        self.assertEqual(str(caught.exception), text)
        return caught.exception

    def test_the_sentences_of_the_program(self):
        vehicle = reference()
        error = self.refused(lambda: vehicle.replace({"motor.torque_constan": 1.0}),
                             "motor.torque_constan: unknown key; did you mean motor.torque_constant?")
        self.assertEqual(error.key, "motor.torque_constan")
        self.assertIsNone(error.file)
        self.refused(lambda: vehicle.replace({"motor.inertia": -1}), "motor.inertia: must be > 0 [kg m2], got -1")
        self.refused(lambda: vehicle.solve(voltage="3 kg"),
                     'supply.voltage: expected a voltage such as "3 V", got "3 kg"')
        self.refused(lambda: vehicle.solve(frequency="3 V"),
                     'frequency: expected a frequency such as "22 Hz", got "3 V"')
        self.refused(lambda: vehicle.solve(tolerance=1.0), "tolerance: must be a number between 1e-12 and 1e-2")
        self.refused(lambda: vehicle.solve(condition="water"),
                     'condition: must be air, vacuum or wingless, got "water"')

    def test_all_that_is_wrong_is_told(self):
        with self.assertRaises(wb.InputError) as caught:
            reference().replace({"motor.inertia": -1, "wing.count": "two"})
        self.assertEqual([error.key for error in caught.exception.others], ["wing.count"])
        self.assertEqual(len(str(caught.exception).splitlines()), 2)

    def test_files_have_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "bad.toml"
            text = (DATA / "designs" / "friction2022.toml").read_text().replace("9 ohm", "9 m")
            file.write_text(text)
            with self.assertRaises(wb.InputError) as caught:
                wb.read(file)
        error = caught.exception
        line = 1 + text.splitlines().index('armature_resistance = "9 m"')
        self.assertEqual((error.file, error.line, error.key), (str(file), line, "motor.armature_resistance"))

    def test_files_may_be_open(self):
        path = DATA / "designs" / "friction2022.toml"
        with open(path, encoding="utf-8") as file:
            self.assertEqual(wb.read(file), wb.read(path))
        self.assertEqual(wb.read(io.StringIO(path.read_text())), wb.read(str(path)))
        with self.assertRaises(wb.InputError) as caught:
            wb.read(io.StringIO("[motor"))
        self.assertEqual((caught.exception.file, caught.exception.line), ("vehicle", 1))
        with open(path, "rb") as file, self.assertRaisesRegex(TypeError, "open for reading text, got BufferedReader"):
            wb.read(file)
        with self.assertRaisesRegex(TypeError, "^file: expected a path or a file open for reading text, got int$"):
            wb.read(1)

    def test_shipped_vehicles_have_names(self):
        designs = {file.stem for file in (DATA / "designs").glob("*.toml")}
        self.assertEqual(set(wb.shipped()), designs)
        for name in sorted(designs):
            self.assertEqual(wb.read(name), wb.read(DATA / "designs" / f"{name}.toml"))
        self.assertEqual(wb.read("friction2022.toml"), reference())
        self.assertEqual(set(wb.shipped("bench")), {file.stem for file in (DATA / "bench").glob("*.toml")})
        with tempfile.TemporaryDirectory() as folder:
            here = os.getcwd()
            self.addCleanup(os.chdir, here)
            os.chdir(folder)
            own = reference().replace({"vehicle.name": "mine"})
            pathlib.Path("friction2022.toml").write_text(own.to_toml())  # a file of that name is meant
            self.assertEqual(wb.read("friction2022"), own)
            self.assertEqual(wb.read("hawkmoth"), wb.read(DATA / "designs" / "hawkmoth.toml"))
            os.chdir(here)
        with self.assertRaisesRegex(wb.InputError, "^friction2023: no such file, .*; did you mean friction2022"):
            wb.read("friction2023")
        with self.assertRaisesRegex(wb.InputError, "^folder/friction2022: no such file$"):
            wb.read("folder/friction2022")
        with self.assertRaisesRegex(wb.InputError, '^kind: must be vehicle, study, bench, .*, got "figure"'):
            wb.shipped("figure")

    def test_what_is_no_value_at_all(self):
        with self.assertRaises(TypeError):
            reference().replace({"motor.inertia": object()})
        with self.assertRaises(TypeError):
            wb.Vehicle("friction2022.toml")
        with self.assertRaises(AttributeError):
            reference().wings
        with self.assertRaises(KeyError):
            reference()["motor.inerti"]
        self.refused(lambda: reference().replace({"motor.inertia": float("nan")}),
                     'motor.inertia: expected a moment of inertia such as "1.5e-7 kg m2", got the number nan')


if __name__ == "__main__":
    unittest.main()
