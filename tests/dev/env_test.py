"""tests/dev/env_test.py PROGRAM: docs/examples/tautline_env.py steps worlds of `tautline worlds`."""
import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs" / "examples"))
import tautline_env  # noqa: E402

PROGRAM = sys.argv.pop(1)


def drive(env, steps=40):
    """Rows of clock, x, y and the sum of the ranges."""
    rows = []
    for _ in range(steps):
        seen, _, terminated, truncated, _ = env.step((0.25, 0.1))
        rows.append((*seen["state"][:3], float(sum(seen["ranges"]))))
        if terminated or truncated:
            break
    return rows


class OneWorld(unittest.TestCase):
    def setUp(self):
        self.env = tautline_env.Env("case1", seed=5, program=PROGRAM)
        self.addCleanup(self.env.close)

    def test_the_same_seed_gives_the_same_episode_and_another_one_another(self):
        first, info = self.env.reset(seed=5)
        self.assertEqual(info["seed"], 5)
        self.assertEqual(len(first["ranges"]), self.env.observation_space["ranges"].shape[0])
        self.assertGreater(len(first["ranges"]), 100)
        rows = drive(self.env)
        self.env.reset(seed=5)
        self.assertEqual(drive(self.env), rows)
        _, info = self.env.reset()
        self.assertEqual(info["seed"], 6)
        self.assertNotEqual(drive(self.env), rows)

    def test_an_episode_ends_and_says_how(self):
        self.env.reset()
        for _ in range(3000):
            _, reward, terminated, truncated, info = self.env.step((0.3, 0.0))
            if terminated or truncated:
                break
        self.assertTrue(terminated)
        self.assertEqual(info["outcome"], "collided")
        self.assertLess(reward, -0.9)

    def test_the_reward_is_progress_towards_the_goal(self):
        seen, _ = self.env.reset()
        start = seen["state"]
        rewards = [self.env.step((0.3, 0.0))[1] for _ in range(40)]
        self.assertAlmostEqual(sum(rewards), math.dist(start[1:3], start[6:8]) - math.dist(
            (self.env.before["x"], self.env.before["y"]), start[6:8]))
        self.assertGreater(sum(rewards), 0.1)
        self.env.reward = lambda before, after, outcome: 7
        self.assertEqual(self.env.step((0.3, 0.0))[1], 7)


@unittest.skipIf(tautline_env.numpy is None, "needs numpy")
class ManyWorlds(unittest.TestCase):
    def test_world_i_is_the_single_world_of_its_seed(self):
        many = tautline_env.VectorEnv("case1", num_envs=3, seed=5, program=PROGRAM)
        one = tautline_env.Env("case1", seed=6, program=PROGRAM)
        self.addCleanup(many.close)
        self.addCleanup(one.close)
        many.reset()
        one.reset()
        for _ in range(50):
            seen, rewards, *_ = many.step([(0.25, 0.1)] * 3)
            alone, reward, *_ = one.step((0.25, 0.1))
            self.assertEqual(list(seen["ranges"][1]), list(alone["ranges"]))
            self.assertEqual(list(seen["state"][1]), list(alone["state"]))
            self.assertEqual(rewards[1], reward)

    def test_a_world_that_ended_begins_anew_in_the_next_step(self):
        many = tautline_env.VectorEnv("case1", num_envs=2, seed=0, program=PROGRAM)
        self.addCleanup(many.close)
        many.reset()
        for _ in range(3000):
            _, _, terminated, truncated, info = many.step([(0.3, 0.0), (0.0, 0.0)])
            if terminated[0]:
                break
        self.assertEqual(info["outcome"][0], tautline_env.COLLIDED)
        seen, rewards, terminated, _, info = many.step([(0.3, 0.0), (0.0, 0.0)])
        self.assertEqual(seen["state"][0][0], 0.0)
        self.assertEqual(rewards[0], 0.0)
        self.assertFalse(terminated[0])
        self.assertEqual(list(info["seed"]), [2, 1])


if __name__ == "__main__":
    unittest.main()
