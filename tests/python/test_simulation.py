"""Vehicles in time, stepped under commanded voltages."""

import copy
import os
import pickle
import signal
import threading
import time
import unittest

import numpy as np
import wingbeat as wb
from shared import DATA, reference


def ramp(at):
    """A function that pickle finds."""
    return 2.0 + 10.0 * at


def ramp_to_3(at):
    return min(3.0, ramp(at))


class Simulations(unittest.TestCase):
    def test_it_settles_in_the_orbit(self):
        simulation = reference().simulation(tolerance=1e-11)
        self.assertEqual(simulation.states, ("crank_angle", "crank_speed", "current"))
        simulation.step_to(0.5)
        starts = []
        for _ in range(2):
            simulation.step("1 s", until="revolution")
            starts.append(simulation.time)
        result = reference().solve(tolerance=1e-11)
        self.assertAlmostEqual((starts[1] - starts[0]) * result.frequency, 1.0, 9)
        first = result.cycle.isel(time=0)
        for name, value in simulation.now.items():
            if name in ("time", "crank_angle") or value is None:
                continue
            scale = float(np.abs(result.cycle[name]).max()) or 1.0
            self.assertAlmostEqual(value / scale, float(first[name]) / scale, 7, name)
            self.assertEqual(value.unit, result.cycle[name].attrs["units"])

    def test_voltages_of_every_form(self):
        ends = []
        for voltage in (4.0, "4 V", "4000 mV", lambda t: 4.0, ([0.0, 1.0], [4.0, 4.0]), (np.zeros(1), np.full(1, 4.0))):
            simulation = reference().simulation(voltage=voltage)
            simulation.step_to("50 ms")
            ends.append(simulation.state)
        supplied = reference().replace({"supply.voltage": 4.0}).simulation()
        supplied.step_to(0.05)
        ends.append(supplied.state)
        for end in ends:
            np.testing.assert_allclose(end, ends[0], rtol=1e-6)
        simulation = reference().simulation(voltage=ramp)
        simulation.step_to(0.05)
        sampled = reference().simulation(voltage=([0.0, 0.1], [2.0, 3.0]))
        sampled.step_to(0.05)
        np.testing.assert_allclose(simulation.state, sampled.state, rtol=1e-6)
        self.assertAlmostEqual(simulation.now["voltage"], 2.5)
        simulation.voltage = None
        self.assertEqual(simulation.now["voltage"], 3.0)

    def test_a_saved_state_gives_the_same_bits(self):
        for file in ("friction2022-springs", "direct-drive", "pitch-hinge", "pitch-hinge-crank"):
            vehicle = wb.read(DATA / "designs" / f"{file}.toml")
            for voltage in (None, 3.3, ramp, ([0.0, 0.02, 0.04], [1.0, 4.0, 2.0])):
                simulation = vehicle.simulation(voltage=voltage)
                simulation.step_to(0.0213)
                state = pickle.loads(pickle.dumps(simulation.save()))
                self.assertEqual(state, simulation.save())
                self.assertEqual(state.time, 0.0213)
                others = [vehicle.simulation(), copy.copy(simulation), pickle.loads(pickle.dumps(simulation)), simulation]
                others[0].restore(state)
                events = [other.step_to(0.05) for other in others]
                for other, seen in zip(others, events):
                    np.testing.assert_array_equal(other.state, simulation.state, f"{file} {voltage}")
                    self.assertEqual(other.save(), simulation.save())
                    self.assertEqual(seen, events[0])
                self.assertGreater(simulation.time, state.time)

    def test_events_have_their_place(self):
        sticking = reference().replace({"motor.friction_torque": "1 mN m"})
        simulation = sticking.simulation(voltage=0.5)
        self.assertEqual(simulation.step_to(0.1), [])
        self.assertTrue(simulation.stands)
        simulation.voltage = 4.0
        events = simulation.step(0.5)
        self.assertEqual((events[0].kind, events[0].crank_angle), ("breakaway", 0.0))
        turns = [event for event in events if event.kind == "revolution"]
        self.assertGreater(len(turns), 5)
        np.testing.assert_allclose([event.crank_angle / (2 * np.pi) for event in turns], np.arange(1, 1 + len(turns)), rtol=1e-12)

    def test_a_start_somewhere_else(self):
        simulation = reference().simulation(angle="90 deg", speed=100, current="0.2 A")
        np.testing.assert_allclose(simulation.state, [np.pi / 2, 100, 0.2])
        self.assertAlmostEqual(simulation.now["crank_angle"], np.pi / 2)

    def test_records_are_data_sets(self):
        times = np.linspace(0, 0.2, 101)
        record = reference().simulation().record(times)
        np.testing.assert_array_equal(record.time, times)
        self.assertEqual(record.lift.attrs["units"], "N")
        started = reference().simulate(max_time=0.2, tolerance=1e-9)
        np.testing.assert_allclose(record.crank_angle[-1], np.interp(0.2, started.samples.time, started.samples.crank_angle), rtol=1e-4)
        revolutions = record.event_time[record.event == "revolution"]
        own = [event.time for event in started.events if event.kind == "revolution" and event.time < 0.2]
        np.testing.assert_allclose(revolutions, own, rtol=1e-6)
        jamming = reference().replace({"motor.inertia": 1e-9, "friction.radius": 3e-3}).simulation()
        record = jamming.record([0.0, 1e-4, 1.0])
        self.assertTrue(jamming.ended)
        self.assertEqual(str(record.event[-1].values), "jam")
        self.assertTrue(np.isnan(record.lift[-1]))
        self.assertLess(jamming.time, 1.0)

    def test_a_controller_in_the_loop(self):
        """A discrete PI controller holds a frequency."""
        simulation = reference().simulation(voltage=3.0)
        wanted, integral, period = 2 * np.pi * 25, 0.0, 2e-3
        while simulation.time < 2.0:
            error = wanted - simulation.state[1]
            integral += error * period
            simulation.voltage = float(np.clip(3.0 + 2e-3 * error + 0.3 * integral, 0, 8))
            simulation.step(period)
        turns = [event.time for event in simulation.step(0.5) if event.kind == "revolution"]
        self.assertAlmostEqual(1 / np.diff(turns).mean(), 25.0, 0)

    def test_what_a_command_raises_comes_through(self):
        def command(at):
            if at > 0.02:
                raise RuntimeError("no more")
            return 3.0

        simulation = reference().simulation()
        simulation.step_to(0.01)
        before = simulation.save()
        simulation.voltage = command
        with self.assertRaisesRegex(RuntimeError, "no more"):
            simulation.step_to(0.1)
        self.assertEqual(simulation.save().numbers, before.numbers)
        simulation.voltage = lambda at: simulation.state[0]
        with self.assertRaisesRegex(RuntimeError, "being stepped"):
            simulation.step_to(0.1)

    def test_what_is_refused(self):
        simulation = reference().simulation()
        for act, text in (
            (lambda: reference().simulation(condition="water"), "^condition: must be air"),
            (lambda: reference().simulation(tolerance=1), "^tolerance: must be a number between"),
            (lambda: reference().simulation(voltage="3 kg"), "^voltage: expected a voltage such as"),
            (lambda: simulation.step_to("3 V"), "^time: expected a time such as"),
            (lambda: simulation.step(1, until="lunch"), "^until: must be revolution, .* or jam, got \"lunch\"$"),
            (lambda: simulation.record([1.0, 0.5]), "^times: must not fall"),
            (lambda: setattr(simulation, "voltage", ([0.0], [1.0, 2.0])), "^voltage: must have as many samples"),
            (
                lambda: simulation.restore(wb.read(DATA / "designs" / "pitch-hinge.toml").simulation().save()),
                "^state: is that of another kind of vehicle",
            ),
        ):
            with self.assertRaisesRegex(wb.InputError, text):
                act()
        with self.assertRaisesRegex(TypeError, r'^voltage: expected a number \[V\] or a voltage such as "3 V", got list$'):
            simulation.voltage = [1, 2, 3]

    def test_ctrl_c_ends_a_step(self):
        # A test started in the background ignores it.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        for voltage in (None, ramp_to_3):
            simulation = reference().simulation(tolerance=1e-10, voltage=voltage)
            simulation.step_to(0.01)
            before = simulation.save()
            threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
            begin = time.process_time()
            with self.assertRaises(KeyboardInterrupt):
                simulation.step_to(1e5)
            # 0.3 s until then at most, and 50 ms between two looks at signals.
            self.assertLess(time.process_time() - begin, 1.0)
            self.assertEqual(simulation.save(), before)
            simulation.step(0.01)
            self.assertEqual(simulation.time, 0.02)

    def test_other_threads_run_meanwhile(self):
        counted = [0]
        stop = threading.Event()

        def count():
            while not stop.is_set():
                counted[0] += 1
                time.sleep(1e-3)

        thread = threading.Thread(target=count)
        thread.start()
        reference().simulation(tolerance=1e-12).step_to(5.0)
        stop.set()
        thread.join()
        self.assertGreater(counted[0], 5)


if __name__ == "__main__":
    unittest.main()
