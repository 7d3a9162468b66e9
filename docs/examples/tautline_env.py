"""docs/examples/tautline_env.py: worlds of Tautline to train in (docs/external-controllers.md).

Env is one world; VectorEnv is many, stepped together, and needs numpy. With gymnasium installed they
are a gymnasium.Env and a gymnasium.vector.VectorEnv; without it they work alike. Metres, radians, seconds.

An observation is a dict: "ranges", B floats [m], and "state", 9 floats: run clock, x, y, heading, v,
omega by odometry in W, goal x, goal y, true clearance. An action is (v [m/s], omega [rad/s]). An episode is
terminated when the robot has reached its goal, collided or got stuck, and truncated when its time is over.
"""
import array
import json
import math
import subprocess

try:
    import numpy
except ImportError:
    numpy = None
try:
    import gymnasium
    from gymnasium.spaces import Box, Dict
except ImportError:
    gymnasium = None

RUNNING, REACHED, COLLIDED, STUCK, OUT_OF_TIME, OVERTURNED, FALLEN = range(7)
OUTCOMES = ("running", "reached", "collided", "stuck", "out_of_time", "overturned", "fallen")
STATE = ("stamp", "x", "y", "heading", "v", "omega", "goal_x", "goal_y", "clearance")

if gymnasium is None:

    class Box:
        """A box of numbers: low, high, shape, dtype."""

        def __init__(self, low, high, shape, dtype="float32"):
            self.low, self.high, self.shape, self.dtype = low, high, shape, dtype

    class Dict:
        """Spaces by name."""

        def __init__(self, spaces):
            self.spaces = spaces

        def __getitem__(self, name):
            return self.spaces[name]


_Single = gymnasium.Env if gymnasium else object
_Vector = gymnasium.vector.VectorEnv if gymnasium else object


def progress_reward(before, after, outcome):
    """[m] nearer to the goal; 1 more for reaching it, 1 less for a collision.

    before, after: states as dicts of numbers, or of arrays with one value a world. outcome: likewise.
    """
    def distance(state):
        dx, dy = state["goal_x"] - state["x"], state["goal_y"] - state["y"]
        return (dx * dx + dy * dy) ** 0.5
    ends = (outcome == REACHED) * 1.0 - (outcome == COLLIDED) * 1.0
    return distance(before) - distance(after) + ends


class Worlds:
    """The process `tautline worlds`, and its numbers."""

    def __init__(self, scenario, count, seed=0, program="tautline", options=()):
        """options: of the command line, such as ("--physics", "kinematic")."""
        self.process = subprocess.Popen(
            [program, "worlds", scenario, "--worlds", str(count), "--seed", str(seed), *options],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        self.reader = self.process.stdout
        self.count = count
        line = bytearray()
        while not line.endswith(b"\n"):
            byte = self.reader.read(1)
            if not byte:
                raise RuntimeError("tautline worlds ended: see what it printed")
            line += byte
        self.info = json.loads(line)
        self.width = self.info["state_values"]
        self.size = count * (8 * self.width + 4 * self.info["beams"])
        self.data = bytearray(self.size)

    def read(self):
        """The bytes of all states, then those of all ranges."""
        view = memoryview(self.data)
        got = 0
        while got < self.size:
            more = self.reader.readinto(view[got:])
            if not more:
                raise RuntimeError("tautline worlds ended: see what it printed")
            got += more
        return self.data

    def send(self, actions):
        """actions: bytes of three doubles a world: v, omega, seed or -1."""
        view = memoryview(actions).cast("B")
        while view:
            view = view[self.process.stdin.write(view):]

    def close(self):
        if self.process.poll() is None:
            self.process.stdin.close()
            self.reader.close()
            self.process.wait(10)


def _spaces(info, leading=()):
    beams, far = info["beams"], info["range_max"]
    low, high = -math.inf, math.inf
    observation = Dict({
        "ranges": Box(low=0.0, high=far, shape=(*leading, beams)),
        "state": Box(low=low, high=high, shape=(*leading, len(STATE)), **_double())})
    limits = [info["max_v"], info["max_omega"]]
    if numpy is None:
        return observation, Box(low=[-x for x in limits], high=limits, shape=(*leading, 2), **_double())
    high = numpy.broadcast_to(numpy.array(limits), (*leading, 2)).copy()
    return observation, Box(low=-high, high=high, shape=(*leading, 2), **_double())


def _double():
    return {"dtype": numpy.float64 if numpy is not None else "float64"}


class Env(_Single):
    """One world, without numpy if need be: then ranges and state are arrays of the module array."""

    metadata = {"render_modes": []}

    def __init__(self, scenario="case1", seed=0, reward=progress_reward, program="tautline",
                 options=("--physics", "kinematic")):
        self.worlds = Worlds(scenario, 1, seed, program, options)
        self.observation_space, self.action_space = _spaces(self.worlds.info)
        self.reward = reward
        self.seed = seed
        self.fresh = True  # the process has begun with this seed already
        self.before = None

    def reset(self, *, seed=None, options=None):
        """Returns (observation, info). Without a seed, each reset takes the next one."""
        if self.fresh and seed in (None, self.seed):
            self.fresh = False
        else:
            self.seed = self.seed + 1 if seed is None else seed
            self.fresh = False
            if self.before is None:
                self._read()
            self.worlds.send(array.array("d", (0.0, 0.0, float(self.seed))))
        observation, outcome = self._read()
        return observation, {"outcome": OUTCOMES[outcome], "seed": self.seed}

    def step(self, action):
        """Returns (observation, reward, terminated, truncated, info)."""
        before = self.before
        self.worlds.send(array.array("d", (float(action[0]), float(action[1]), -1.0)))
        observation, outcome = self._read()
        reward = float(self.reward(before, self.before, outcome))
        terminated = outcome in (REACHED, COLLIDED, STUCK, OVERTURNED, FALLEN)
        return (observation, reward, terminated, outcome == OUT_OF_TIME,
                {"outcome": OUTCOMES[outcome], "seed": self.seed})

    def _read(self):
        data = self.worlds.read()
        cut = 8 * self.worlds.width
        state = array.array("d", bytes(data[:cut]))
        ranges = array.array("f", bytes(data[cut:]))
        outcome = int(state.pop())
        self.before = dict(zip(STATE, state))
        if numpy is not None:
            state, ranges = numpy.array(state), numpy.array(ranges)
        return {"ranges": ranges, "state": state}, outcome

    def close(self):
        self.worlds.close()


class VectorEnv(_Vector):
    """Many worlds, world i from the seed `seed` + i on. Needs numpy.

    Next-step autoreset: the step after an episode's end resets that world with its next seed (the old
    one plus num_envs); it ignores the action and gives reward 0. Observations are views that the
    next step overwrites: copy what you keep.
    """

    metadata = {"autoreset_mode": "next_step"}

    def __init__(self, scenario="case1", num_envs=64, seed=0, reward=progress_reward,
                 program="tautline", options=("--physics", "kinematic")):
        if numpy is None:
            raise ImportError("VectorEnv needs numpy")
        self.num_envs = num_envs
        self.worlds = Worlds(scenario, num_envs, seed, program, options)
        info = self.worlds.info
        self.single_observation_space, self.single_action_space = _spaces(info)
        self.observation_space, self.action_space = _spaces(info, (num_envs,))
        self.reward = reward
        self.seeds = numpy.arange(seed, seed + num_envs)
        self.begun = False
        self.done = numpy.zeros(num_envs, bool)
        self.actions = numpy.empty((num_envs, 3))
        self._map()
        self.worlds.read()

    def _map(self):
        """Arrays over the bytes that read() fills."""
        count, width = self.num_envs, self.worlds.width
        data = self.worlds.data
        self.states = numpy.frombuffer(data, "f8", count * width).reshape(count, width)
        self.ranges = numpy.frombuffer(data, "f4", -1, 8 * count * width).reshape(count, -1)
        self.observation = {"ranges": self.ranges, "state": self.states[:, :len(STATE)]}

    def _exchange(self):
        self.worlds.send(self.actions)
        self.worlds.read()

    def reset(self, *, seed=None, options=None):
        """Returns (observations, info). seed: of the first world; None: fresh ones after the first."""
        if seed is not None:
            self.seeds = seed + numpy.arange(self.num_envs)
        elif self.begun:
            self.seeds += self.num_envs
        self.begun = True
        self.actions[:, 2] = self.seeds
        self.actions[:, :2] = 0
        self._exchange()
        self.done[:] = False
        return self.observation, {"seed": self.seeds.copy()}

    def step(self, actions):
        """actions: (num_envs, 2). Returns observations, rewards, terminations, truncations, info."""
        before = self.states.copy()
        self.seeds[self.done] += self.num_envs
        self.actions[:, :2] = actions
        self.actions[:, 2] = numpy.where(self.done, self.seeds, -1)
        self._exchange()
        outcome = self.states[:, -1].astype(int)
        rewards = self.reward(dict(zip(STATE, before.T)), dict(zip(STATE, self.states.T)), outcome)
        rewards = numpy.where(self.done, 0.0, rewards)
        terminated = (outcome > RUNNING) & (outcome != OUT_OF_TIME)
        truncated = outcome == OUT_OF_TIME
        self.done = terminated | truncated
        return self.observation, rewards, terminated, truncated, {"outcome": outcome, "seed": self.seeds.copy()}

    def close(self, **unused):
        self.worlds.close()
