"""A task of one's own that tests share, and what they play it with."""

import numpy as np

from galactic import Outcome, Task

ACTIONS = 8  # of the small home's robot


class Approach(Task):
    """Pays each meter that the hand comes nearer to the target, and observes how far it came."""

    options = {"episode_steps": 20}
    parts = {"gained": 1, "dice": 2}
    measures = ("twice_gained", "env")

    def prepare(self, envs):
        count = envs.num_envs
        self.memory = {"distance": np.zeros(count), "gained": np.zeros(count, np.float32)}

    def begin(self, envs, which):
        self.memory["distance"][which] = distances(envs)[which]
        self.memory["gained"][which] = 0

    def step(self, envs):
        now = distances(envs)
        rewards = self.memory["distance"] - now
        self.memory["distance"][:] = now
        self.memory["gained"] += rewards.astype(np.float32)
        drawn = envs.uniform("end")[:, 0]
        return Outcome(rewards, successes=drawn < 0.05, failures=drawn > 0.97)

    def observe(self, envs):
        gained = self.memory["gained"][:, np.newaxis]
        return {"dice": envs.uniform("dice", 2), "gained": gained}

    def measure(self, envs, which):
        return {"env": envs.numbers[which], "twice_gained": 2 * self.memory["gained"][which]}


def distances(envs):
    return np.linalg.norm(envs.observations["grip_target"], axis=1).astype(np.float64)


def played(env, draw_actions, steps=60):
    """Observations, rewards and endings of `steps` steps."""
    rows = []
    for _ in range(steps):
        actions = draw_actions(env.num_envs, env.action_space.shape[1])
        observations, rewards, terminations, truncations, infos = env.step(actions)
        endings = np.zeros(env.num_envs, np.uint8)
        returns = np.zeros(env.num_envs, np.float32)
        if infos:
            endings = infos["final_info"]["ending"]
            returns = infos["final_info"]["episode"]["r"]
        rows.append((observations, rewards, terminations, truncations, endings, returns))
    return [np.stack(column) for column in zip(*rows)]


def drawing(seed=3):
    generator = np.random.default_rng(seed)
    return lambda envs, count: generator.uniform(-1, 1, (envs, count)).astype(np.float32)
