"""Environments: the interface of Gymnasium 1, seeds, rewards, and a controller that flies them."""

import importlib.util
import inspect
import os
import re
import subprocess
import sys
import textwrap
import unittest

import numpy as np
import wingbeat as wb
import wingbeat.gym
from shared import DATA, ROOT


def flyer(name="flight-friction2022"):
    return wb.read(DATA / "designs" / f"{name}.toml")


def check_space(case, space):
    """A box of finite numbers."""
    for name in ("shape", "low", "high", "dtype", "sample", "seed", "contains"):
        case.assertTrue(hasattr(space, name), name)
    case.assertEqual((space.low.shape, space.high.shape), (space.shape, space.shape))
    case.assertTrue((space.low < space.high).all() and np.isfinite(space.low).all() and np.isfinite(space.high).all())
    space.seed(3)
    first = space.sample()
    case.assertTrue(space.contains(first) and first in space)
    case.assertEqual((first.shape, first.dtype), (space.shape, space.dtype))
    space.seed(3)
    np.testing.assert_array_equal(space.sample(), first)
    case.assertFalse(space.contains(space.high + 1) or space.contains(first[:-1]) or space.contains(first.tolist()))


def check_environment(case, env):
    """What the documentation of gymnasium.Env and its env_checker ask of an environment."""
    case.assertIs(env.unwrapped, env)
    case.assertIsInstance(env.metadata["render_modes"], list)
    case.assertIsNone(env.render_mode)
    case.assertIsNone(env.render())
    check_space(case, env.observation_space)
    check_space(case, env.action_space)
    np.testing.assert_array_equal(env.action_space.high, -env.action_space.low)
    parameters = inspect.signature(env.reset).parameters
    for name in ("seed", "options"):
        case.assertIs(parameters[name].default, None)
        case.assertIs(parameters[name].kind, inspect.Parameter.KEYWORD_ONLY)
    case.assertFalse(callable(getattr(env, "seed", None)))
    starts, states = [], []
    for seed in (123, 123, 456):
        found = env.reset(seed=seed)
        case.assertIsInstance(found, tuple)
        observation, info = found
        case.assertTrue(env.observation_space.contains(observation))
        case.assertIsInstance(info, dict)
        starts.append(observation), states.append(env.np_random.bit_generator.state)
    np.testing.assert_array_equal(starts[0], starts[1])
    case.assertEqual(states[0], states[1])
    case.assertNotEqual(states[0], states[2])
    case.assertTrue((starts[0] != starts[2]).any())
    case.assertTrue((env.reset()[0] != starts[2]).any())
    env.reset(options={})
    found = env.step(env.action_space.sample())
    case.assertEqual(len(found), 5)
    observation, reward, terminated, truncated, info = found
    case.assertTrue(env.observation_space.contains(observation))
    case.assertIs(type(reward), float)
    case.assertTrue(np.isfinite(reward))
    case.assertEqual((type(terminated), type(truncated), type(info)), (bool, bool, dict))
    env.close()
    env.close()
    with env as entered:
        case.assertIs(entered, env)


class Contract(unittest.TestCase):
    def test_environments_keep_it(self):
        for env in (wb.gym.HoverEnv(flyer()), wb.gym.TrackEnv(flyer("flight-purdue"), gusts=0.2, rate=50)):
            check_environment(self, env)

    def test_the_vectorised_form(self):
        envs = wb.gym.make_vec("hover", flyer(), 3)
        self.assertEqual(envs.num_envs, 3)
        for space, single in ((envs.observation_space, envs.single_observation_space),
                              (envs.action_space, envs.single_action_space)):
            check_space(self, space), check_space(self, single)
            self.assertEqual(space.shape, (3, *single.shape))
        observations, infos = envs.reset(seed=1)
        self.assertTrue(envs.observation_space.contains(observations))
        observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())
        self.assertTrue(envs.observation_space.contains(observations))
        self.assertEqual((rewards.shape, rewards.dtype), ((3,), np.float64))
        for flags in (terminations, truncations, infos["_distance"]):
            self.assertEqual((flags.shape, flags.dtype), ((3,), np.bool_))
        self.assertEqual((infos["position"].shape, infos["controls"].shape), ((3, 3), (3, 4)))
        self.assertIsNone(envs.render())
        envs.close()
        self.assertTrue(envs.closed)

    def test_with_gymnasium_its_classes_are_used(self):
        """A module in the place of Gymnasium, with what is taken from it."""
        script = """
            import enum, sys, types
            import numpy as np
            g = types.ModuleType("gymnasium"); v = types.ModuleType("gymnasium.vector"); made = {}
            class Env:
                def reset(self, *, seed=None, options=None):
                    if seed is not None:
                        self._np_random = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))
                np_random = property(lambda self: self._np_random)
            class Box:
                def __init__(self, low, high, dtype=None): self.low, self.high, self.shape = low, high, low.shape
            class Mode(enum.Enum): NEXT_STEP = "NextStep"; SAME_STEP = "SameStep"
            g.Env, g.vector, g.spaces = Env, v, types.SimpleNamespace(Box=Box)
            v.VectorEnv, v.AutoresetMode = type("VectorEnv", (), {}), Mode
            g.register = lambda id, **given: made.update({id: given})
            sys.modules |= {"gymnasium": g, "gymnasium.vector": v}
            import wingbeat as wb, wingbeat.gym
            assert sorted(made) == ["wingbeat/Hover-v0", "wingbeat/Track-v0"], made
            env = made["wingbeat/Track-v0"]["entry_point"]()
            assert isinstance(env, (Env,)) and isinstance(env.action_space, Box)
            print(env.reset(seed=5)[0].tobytes().hex())
            many = made["wingbeat/Hover-v0"]["vector_entry_point"](num_envs=2, rate=50)
            assert isinstance(many, v.VectorEnv) and many.metadata["autoreset_mode"] is Mode.NEXT_STEP
        """
        done = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], capture_output=True, text=True,
                              env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.strip(), wb.gym.TrackEnv().reset(seed=5)[0].tobytes().hex())


class Tasks(unittest.TestCase):
    def test_the_same_seed_gives_the_same_numbers_alone_and_in_a_batch(self):
        options = {"gusts": 0.3, "rate": 50}
        actions = np.random.default_rng(0).uniform(-0.3, 0.3, (12, 3, 4))
        batches = [wb.gym.make_vec("track", flyer(), 3, threads=threads, **options) for threads in (1, 2)]
        alone = wb.gym.make("track", flyer(), **options)
        seen = [envs.reset(seed=7)[0] for envs in batches]
        np.testing.assert_array_equal(seen[0], seen[1])
        np.testing.assert_array_equal(alone.reset(seed=8)[0], seen[0][1])
        for row in actions:
            first, second, one = batches[0].step(row), batches[1].step(row), alone.step(row[1])
            for k in range(4):
                np.testing.assert_array_equal(first[k], second[k])
                # NumPy rounds sums of arrays of other lengths otherwise; the flights are the same.
                np.testing.assert_allclose(first[k][1], one[k], rtol=1e-6 if k == 0 else 1e-14)
            np.testing.assert_array_equal(first[4]["position"][1], one[4]["position"])
            self.assertFalse(first[2].any())
        self.assertGreater(np.abs(first[4]["wind"]).max(), 0.0)

    def test_actions_are_settings(self):
        env = wb.gym.make("hover", flyer(), disturbance=0)
        hover = flyer().trim()
        env.reset(seed=0)
        for action, voltage in ((0.0, hover.controls["voltage"]), (1.0, 9.0), (-1.0, 0.0), (5.0, 9.0)):
            _, _, _, _, info = env.step([action, 0, 0, 0.5])
            self.assertAlmostEqual(info["controls"][0], voltage)
            self.assertAlmostEqual(info["controls"][3], np.radians(5))
        self.assertEqual(env.controls[0], "voltage")

    def test_rewards_and_observations_are_as_documented(self):
        env = wb.gym.make("hover", flyer())
        body = wb.BodyState.at(position=[0.1, -0.2, 0.05], velocity=[0.3, 0, 0.1], rates=[1, 2, -1],
                               euler_angles=[0.2, -0.1, 0.4])
        observation, info = env.reset(seed=0, options={"body": body})
        turn = body.rotation
        expected = [
            *(turn.T @ -body.position), *(-body.velocity / 2), *turn[2], *turn[0], *(body.rates / 10), 0, 0, 0, 0]
        np.testing.assert_allclose(observation, expected, rtol=1e-6, atol=1e-7)
        self.assertAlmostEqual(info["distance"], np.linalg.norm(body.position))
        action = np.array([0.1, -0.2, 0.3, 0.0])
        flight = flyer().flight_simulation(tolerance=1e-4)
        hover = flyer().trim()
        flight.start(body, hover.drives)
        observation, reward, _, _, info = env.step(action)
        flight.command(dict(zip(env.controls, info["controls"])))
        flight.step("10 ms")
        there = flight.body
        np.testing.assert_array_equal(info["position"], there.position)
        self.assertAlmostEqual(info["power"], flight.totals.electrical / 0.01, 12)
        distance, speed = np.linalg.norm(there.position), np.linalg.norm(there.velocity)
        expected = 0.5 * np.exp(-distance / 0.25) + 0.2 * np.exp(-speed) + 0.2 * there.rotation[2, 2]
        expected += 0.1 * np.exp(-np.linalg.norm(there.rates) / 10) - 0.05 * np.mean(action**2)
        self.assertAlmostEqual(reward, expected, 12)
        np.testing.assert_allclose(observation[15:], action, rtol=1e-6)

    def test_episodes_end(self):
        env = wb.gym.make("hover", flyer(), duration="30 ms")
        env.reset(seed=0)
        ends = [env.step(np.zeros(4))[2:4] for _ in range(3)]
        self.assertEqual(ends, [(False, False), (False, False), (False, True)])
        for body, reason in ((wb.BodyState.at(position=[2, 0, 0]), "distance"),
                             (wb.BodyState.at(euler_angles=["100 deg", 0, 0]), "attitude")):
            env.reset(options={"body": body})
            _, reward, terminated, _, info = env.step(np.zeros(4))
            self.assertEqual((reward, terminated, info["ended"]), (0.0, True, reason))

    def test_what_follows_an_end(self):
        """By both modes of Gymnasium."""
        for mode in ("NextStep", "SameStep"):
            envs = wb.gym.make_vec("hover", flyer(), 2, duration="20 ms", autoreset=mode)
            self.assertEqual(getattr(envs.metadata["autoreset_mode"], "value", envs.metadata["autoreset_mode"]), mode)
            envs.reset(seed=4)
            envs.step(np.zeros((2, 4)))
            last, rewards, _, over, infos = envs.step(np.zeros((2, 4)))
            self.assertTrue(over.all() and (rewards > 0).all())
            if mode == "SameStep":
                self.assertEqual(infos["final_info"]["time"].tolist(), [0.02, 0.02])
                self.assertEqual(infos["final_obs"][1].shape, (19,))
                self.assertTrue((infos["final_obs"][1] != last[1]).any())
                self.assertEqual(infos["time"].tolist(), [0.0, 0.0])
                continue
            self.assertEqual(infos["time"].tolist(), [0.02, 0.02])
            _, rewards, ends, over, infos = envs.step(np.ones((2, 4)))
            self.assertEqual((rewards.tolist(), ends.any(), over.any()), ([0.0, 0.0], False, False))
            self.assertEqual(infos["time"].tolist(), [0.0, 0.0])
            self.assertEqual(envs.step(np.zeros((2, 4)))[4]["time"].tolist(), [0.01, 0.01])

    def test_targets_move_as_fast_as_they_say(self):
        env = wb.gym.make("track", flyer(), rate="1 kHz")
        env.reset(seed=2)
        flights = env._flights
        for flights.steps[0] in (10, 700, 3000):
            place, speed = flights.targets()
            flights.steps[0] += 1
            ahead, _ = flights.targets()
            np.testing.assert_allclose((ahead - place)[0] * 1000, speed[0], atol=2e-3)
        self.assertGreater(np.linalg.norm(speed), 0.15)

    def test_what_is_refused(self):
        for act, text in (
            (lambda: wb.gym.make("loop"), '^task: must be "hover" or "track", got'),
            (lambda: wb.gym.make("hover", rate=0), "^rate: must be > 0"),
            (lambda: wb.gym.make("hover", disturbance=-1), "^disturbance: must be >= 0"),
            (lambda: wb.gym.make("hover", flyer().replace({"vehicle.mass": "500 g"})), "^vehicle: does not hover: "),
            (lambda: wb.gym.HoverEnv(render_mode="human"), "^render_mode: must be None"),
            (lambda: wb.gym.make_vec("hover", flyer(), 2, autoreset="never"), '^autoreset: must be "NextStep"'),
            (lambda: wb.gym.make_vec("hover", flyer(), 2).reset(seed=[1]), "^seed: must be 2 seeds, got 1"),
            (lambda: wb.gym.make("hover").reset(options={"wind": 1}), "^options: wind: is not an option"),
        ):
            with self.assertRaisesRegex(wb.InputError, text):
                act()
        env = wb.gym.make("hover")
        env.reset(seed=0)
        for action in (np.zeros(3), np.full(4, np.nan)):
            with self.assertRaisesRegex(wb.InputError, "^action: must be finite numbers of shape"):
                env.step(action)


class Manual(unittest.TestCase):
    def test_the_code_of_the_page_works(self):
        page = (ROOT / "docs" / "flight-python.md").read_text()
        blocks = re.findall(r"^```python\n(.*?)^```", page, re.M | re.S)
        self.assertGreaterEqual(len(blocks), 3)
        if not importlib.util.find_spec("scipy"):
            blocks = [block.replace("found.to_scipy()", "found") for block in blocks]
        exec("\n".join(blocks), {})


@unittest.skipUnless(importlib.util.find_spec("scipy"), "SciPy is not installed")
class Control(unittest.TestCase):
    RATE = 100.0

    def regulator(self, vehicle):
        """A linear regulator from the averaged model, with position and heading."""
        from scipy.linalg import solve_discrete_are
        from scipy.signal import cont2discrete

        found = vehicle.flight_stability()
        controls = found.trim.controls
        A, B = np.zeros((12, 12)), np.zeros((12, len(controls)))
        A[:8, :8], B[:8] = found.A, found.B
        A[8:11, 0:3], A[11, 5] = np.eye(3), 1.0
        A, B, *_ = cont2discrete((A, B, np.eye(12), np.zeros((12, len(controls)))), 1 / self.RATE)
        low, high = np.array(list(vehicle.flight_simulation().ranges.values())).T
        Q = np.diag(1 / np.array([1, 1, 1, 10, 10, 10, 0.3, 0.3, 0.3, 0.3, 0.3, 0.5]) ** 2)
        R = np.diag((0.25 * (high - low)) ** -2.0)
        P = solve_discrete_are(A, B, Q, R)
        gain = np.linalg.solve(R + B.T @ P @ B, B.T @ P @ A)
        steady = np.array([float(setting) for setting in controls.values()])

        def act(o):
            roll, pitch = np.arctan2(o[:, 7], o[:, 8]), np.arcsin(-np.clip(o[:, 6], -1, 1)) - found.trim["pitch_rad"]
            x = np.column_stack([-2 * o[:, 3:6], 10 * o[:, 12:15], roll, pitch, -o[:, 0:3], -o[:, 10]])
            change = -x @ gain.T
            return np.where(change > 0, change / (high - steady), change / (steady - low))

        return act

    def test_a_regulator_flies_where_nothing_does_not(self):
        vehicle, n = flyer(), 4
        act = self.regulator(vehicle)
        envs = wb.gym.make_vec("hover", vehicle, n, rate=self.RATE, duration=3, wind=["0.1 m/s", 0, 0])
        idle = wb.gym.make_vec("hover", vehicle, n, rate=self.RATE, duration=3)
        observations, _ = envs.reset(seed=1)
        idle.reset(seed=1)
        ended, fallen, sums = np.zeros(n, bool), np.zeros(n, bool), np.zeros(n)
        for _ in range(299):
            observations, rewards, ends, over, infos = envs.step(act(observations))
            ended |= ends
            sums += rewards
            if not fallen.all():
                fallen |= idle.step(np.zeros((n, 4)))[2]
        self.assertTrue(fallen.all())
        self.assertFalse(ended.any())
        self.assertLess(infos["distance"].max(), 0.2)
        self.assertGreater(sums.min() / 299, 0.7)


if __name__ == "__main__":
    unittest.main()
