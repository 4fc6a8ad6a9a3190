"""Ctrl-C ends every long call at once; threads and processes."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
import wingbeat as wb
import xarray  # noqa: F401, an import that is interrupted would be no call of ours
from shared import CASES, DATA, reference

#: Seconds of this process's work after which a call must have ended: a machine may do other things meanwhile.
SOON = 0.5


def design(name):
    return wb.read(DATA / "designs" / f"{name}.toml")


class Interrupts(unittest.TestCase):
    def setUp(self):
        # A test started in the background ignores it.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))

    def ends(self, act, after=0.3):
        """Calls `act` again and again, one call of which is interrupted."""
        sent = []

        def interrupt():
            sent.append(time.process_time())
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(after, interrupt)
        timer.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                while True:
                    act()
        finally:
            timer.cancel()
            timer.join()
        self.assertLess(time.process_time() - sent[0], SOON)
        self.assertEqual(threading.active_count(), 1)

    def test_solves(self):
        slow = reference().replace({"motor.armature_inductance": 0.0, "motor.inertia": "1e-3 kg m2"})
        self.ends(lambda: slow.solve(method="transient", tolerance=1e-10))
        for name in ("hang-250", "hang-pitch-10", "p136", "undecided-901-2"):
            vehicle = wb.read(CASES / f"{name}.toml")
            self.ends(lambda: vehicle.solve(tolerance=1e-10))
            self.ends(lambda: vehicle.simulate(tolerance=1e-10))

    def test_searches_for_a_lift_and_a_frequency(self):
        vehicle = wb.read(CASES / "slow-lift-9.toml")
        self.ends(lambda: vehicle.solve(lift="1 mN"))
        pitching = design("pitch-hinge")
        self.ends(lambda: pitching.solve(lift="50 mN", allow_extrapolation=True, tolerance=1e-10))
        self.ends(lambda: reference().solve(frequency="22 Hz", tolerance=1e-12))

    def test_gradients_and_cycles(self):
        battery = design("friction2022-battery")
        result = battery.solve(tolerance=1e-9)
        self.ends(lambda: result.gradient("endurance", ["friction.radius", "transmission.crank_radius"]))

    def test_flights(self):
        battery = design("friction2022-battery")
        self.ends(battery.endurance)
        self.ends(lambda: battery.solve(endurance=True))

    def test_linear_models(self):
        self.ends(reference().linearise)

    def test_simulations(self):
        simulation = reference().simulation(tolerance=1e-10)
        simulation.step_to(0.01)
        before = simulation.save()
        self.ends(lambda: simulation.step_to(1e5))
        self.assertEqual(simulation.save(), before)
        # Each step is short, and so is none of the calls that follow each other.
        times = np.linspace(0.01, 1e3, 1_000_000)
        self.ends(lambda: simulation.record(times))
        self.assertEqual(simulation.save(), before)

    def test_curves_and_rates_of_very_many(self):
        many = np.linspace(0.0, 1.0, 2_000_000)
        vehicle, equations = reference(), reference().equations_of_motion()
        states = np.vstack([many, 100 + many, many])
        self.ends(lambda: equations.rates(0.0, states))
        self.ends(lambda: vehicle.kinematics(crank_angle=many))
        self.ends(lambda: vehicle.coefficient_curves(angle_of_attack=many))
        self.ends(lambda: vehicle.motor_curves(speed=many))

    def test_sweeps_and_columns(self):
        voltages = np.linspace(2, 5, 20_000)
        self.ends(lambda: reference().solve_columns({"supply.voltage": voltages}, tolerance=1e-10))
        # Designs of one chunk that take much longer than a block of others.
        inertia = np.linspace(1e-4, 1e-3, 64)
        self.ends(lambda: reference().solve_columns({"motor.inertia": inertia}, tolerance=1e-12, frequency=22.0))
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "kept.nc"
            many = np.linspace(2, 5, 100_000)  # the first call is the one interrupted
            self.ends(lambda: reference().sweep({"supply.voltage": many}, tolerance=1e-10, output=file))
            self.assertFalse(file.exists())
        self.ends(lambda: reference().sweep({"supply.voltage": voltages}, tolerance=1e-10))

    def test_studies(self):
        uncertain = {
            "samples": {"count": 65536},
            "parameter": [{"key": "friction.radius", "distribution": "normal", "relative_deviation": 0.05}],
        }
        self.ends(lambda: wb.tolerance(uncertain, vehicle=reference()))
        self.ends(lambda: wb.fit(DATA / "bench" / "flapper.toml", compare_friction=True))
        parameters = [
            {"key": "supply.voltage", "lower": 2, "upper": 8},
            {"key": "transmission.crank_radius", "lower": 4e-3, "upper": 7e-3},
        ]
        optimum = {"objective": {"minimise": "power_electrical_w", "starts": 500}, "parameter": parameters}
        self.ends(lambda: wb.optimise(optimum, vehicle=reference()), after=1.0)
        own = {**optimum, "objective": {"minimise": lambda result: result.power_electrical, "starts": 500}}
        self.ends(lambda: wb.optimise(own, vehicle=reference()), after=1.0)
        flights = {**optimum, "objective": {"maximise": "endurance_s", "starts": 4}, "parameter": parameters[1:]}
        self.ends(lambda: wb.optimise(flights, vehicle=design("friction2022-battery")), after=1.0)


class Processes(unittest.TestCase):
    def run_script(self, text):
        head = "from shared import *\nimport numpy as np, threading, time\n"
        return subprocess.run([sys.executable, "-c", head + text], capture_output=True, text=True, timeout=250)

    def test_a_daemon_thread_does_not_outlive_python(self):
        for act in (
            "reference().simulation(tolerance=1e-10).step_to(1e5)",
            "reference().simulation(tolerance=1e-10, voltage=lambda time: 3.0).step_to(1e5)",
            "reference().solve_columns({'supply.voltage': np.linspace(2, 5, 400_000)}, tolerance=1e-10)",
        ):
            script = f"threading.Thread(target=lambda: {act}, daemon=True).start()\ntime.sleep(0.3)\nprint('ends')"
            found = self.run_script(script)
            self.assertEqual((found.returncode, found.stdout, found.stderr), (0, "ends\n", ""), act)

    def test_processes_that_are_forked(self):
        script = """
import multiprocessing
def best(voltages):
    return float(reference().solve_columns({"supply.voltage": voltages}, threads=2).lift_mean.max())
here = best(np.linspace(2, 4, 2000))
with multiprocessing.get_context("fork").Pool(2) as pool:
    print(pool.map(best, [np.linspace(2, 4, 2000)] * 2) == [here, here])
"""
        found = self.run_script(script)
        self.assertEqual((found.returncode, found.stdout), (0, "True\n"), found.stderr)


if __name__ == "__main__":
    unittest.main()
