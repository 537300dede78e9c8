"""A task of one's own, with its own reward and end, in episodes of one's own choice."""

import sys

import numpy as np
import galactic


class Reach:
    """Come near the target with the hand. Pays each meter nearer, ends within 30 cm of it.

    `episodes` are those that begin from now on: change them while you train.
    """

    def __init__(self, world, num_envs, episodes):
        self.homes = galactic.VectorEnv(
            world, num_envs, task="none", episode_steps=100, observation="dict"
        )
        self.episodes = episodes
        self.random = np.random.default_rng(1)

    def reset(self):
        return self._begin(np.ones(self.homes.num_envs, bool))

    def step(self, actions):
        """Observations, rewards, terminations, truncations, and the last observations, which differ
        from the first ones where episodes ended."""
        last, _, _, truncations, infos = self.homes.step(actions)
        for env in np.flatnonzero(truncations):
            for name, value in infos["final_obs"][env].items():
                last[name][env] = value
        distances = np.linalg.norm(last["grip_target"], axis=1)
        rewards = self.distances - distances
        terminations = distances < 0.3
        observations = self._begin(terminations | truncations)
        return observations, rewards, terminations, truncations & ~terminations, last

    def _begin(self, mask):
        episodes = self.random.choice(self.episodes, self.homes.num_envs)
        observations, _ = self.homes.reset(options={"reset_mask": mask, "episodes": episodes})
        self.distances = np.linalg.norm(observations["grip_target"], axis=1)
        return observations


world = galactic.World(sys.argv[1])
# An env for each episode, at its start: how far away are the targets?
starts = galactic.Simulator(world, envs=world.episodes, order="linear", task="none")
targets = starts.observations[:, starts.observation_parts["robot_target"]]
near_first = starts.episodes()[np.argsort(np.linalg.norm(targets, axis=1))]

task = Reach(world, 32, near_first[: len(near_first) // 4 + 1])
random = np.random.default_rng(2)
observations = task.reset()
for step in range(400):
    if step == 200:
        task.episodes = near_first
    actions = random.uniform(-1, 1, task.homes.action_space.shape)
    observations, rewards, terminations, truncations, last = task.step(actions)
    if terminations.any():
        print(f"step {step}: reached in envs {np.flatnonzero(terminations).tolist()}")
