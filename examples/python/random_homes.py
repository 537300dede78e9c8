"""A hundred homes with random actions, and a picture of what four robots see."""

import sys

import numpy as np
import galactic

world = galactic.World(sys.argv[1])
homes = galactic.VectorEnv(world, 100, task="pick", images={"camera": "follow"}, seed=7)
observations, infos = homes.reset(seed=7)
random = np.random.default_rng(7)
for step in range(50):
    actions = random.uniform(-1, 1, homes.action_space.shape).astype(np.float32)
    observations, rewards, terminations, truncations, infos = homes.step(actions)
    for env in np.flatnonzero(terminations | truncations):
        ending = galactic.EpisodeEnd(infos["final_info"]["ending"][env])
        print(f"step {step}: env {env} ended with {ending.name}")
print(observations["state"].shape, observations["rgb"].shape, observations["depth"].max(), "m")
np.save("seen.npy", np.concatenate(observations["rgb"][:4], axis=1))
