"""A task of one's own: what it pays, when it ends, what is observed beside, which episodes begin."""

import sys

import numpy as np
import galactic


class Reach(galactic.Task):
    """Come near the target with the hand. Pays each meter nearer, ends within `radius` meters of it.

    Each env begins with the `share` of episodes in which the target is nearest, and has all of them
    after the first `easy` part of the training.
    """

    options = {"episode_steps": 100}
    parts = {"distance": 1}

    def __init__(self, radius=0.3, share=0.25, easy=0.03):
        self.radius = radius
        self.share = share
        self.easy = easy

    def prepare(self, envs):
        self.memory = {"distance": np.zeros(envs.num_envs, np.float32)}
        episodes = envs.world.episode_table()
        ways = episodes.target.translation - episodes.base[:, :3]
        by_distance = np.argsort(np.linalg.norm(ways, axis=1), kind="stable")
        can_start = ~np.isin(by_distance, envs.simulator.skipped_episodes)
        self.near_first = by_distance[can_start]

    def choose(self, envs, which):
        share = self.share if envs.progress < self.easy else 1.0
        count = int(np.ceil(share * len(self.near_first)))
        drawn = envs.uniform("episode")[which, 0]
        return self.near_first[(drawn * count).astype(int)]

    def begin(self, envs, which):
        self.memory["distance"][which] = distances(envs)[which]

    def step(self, envs):
        now = distances(envs)
        rewards = self.memory["distance"] - now
        self.memory["distance"][:] = now
        return galactic.Outcome(rewards, successes=now < self.radius)

    def observe(self, envs):
        return {"distance": self.memory["distance"][:, np.newaxis]}


def distances(envs):
    """From the hands to the targets, meters."""
    return np.linalg.norm(envs.observations["grip_target"], axis=1)


if __name__ == "__main__":
    homes = galactic.VectorEnv(sys.argv[1], 32, task=Reach)
    random = np.random.default_rng(2)
    observations, _ = homes.reset()
    print(f"observed: {', '.join(homes.observation_parts)}")
    returns = []
    for step in range(400):
        homes.progress = step / 400
        actions = random.uniform(-1, 1, homes.action_space.shape)
        observations, rewards, terminations, truncations, infos = homes.step(actions)
        if terminations.any():
            reached = infos["final_info"]["episode_index"][terminations]
            print(f"step {step}: reached the targets of episodes {sorted(set(reached.tolist()))}")
        if "episode" in infos:
            returns.extend(infos["episode"]["r"][infos["_episode"]])
    print(f"{len(returns)} episodes, which paid {np.mean(returns):.2f} m in the mean")
