"""Clones an expert's behavior with a network of one's own: reads the demonstrations of a folder, and then
plays each episode of a world once."""

import sys

import numpy as np
import torch
import galactic
from torch import nn

shown = galactic.Demonstrations(sys.argv[1])
solved = [one for one in shown if one.is_solved]
states = torch.from_numpy(np.concatenate([one.state[:-1][one.by_expert] for one in solved]))
actions = torch.from_numpy(np.concatenate([one.actions[one.by_expert] for one in solved]))
print(f"{len(solved)} of {len(shown)} episodes, {len(states)} steps")

motions = shown.about.motions
mean, spread = states.mean(0), states.std(0) + 1e-3
torch.manual_seed(1)
network = nn.Sequential(
    nn.Linear(states.shape[1], 256),
    nn.Tanh(),
    nn.Linear(256, 256),
    nn.Tanh(),
    nn.Linear(256, motions + 2),
)
optimizer = torch.optim.Adam(network.parameters(), 1e-3)
for update in range(4000):
    rows = torch.randint(len(states), (512,))
    found = network((states[rows] - mean) / spread)
    wanted = actions[rows]
    of_motions = (found[:, :motions] - wanted[:, :motions]).square().sum(1)
    of_decisions = nn.functional.binary_cross_entropy_with_logits(
        found[:, motions:], wanted[:, motions:], reduction="none"
    ).sum(1)
    loss = (of_motions + of_decisions).mean()
    optimizer.zero_grad()
    loss.backward()
    optimizer.step()
    if update % 1000 == 999:
        print(f"after {update + 1} updates: loss {loss.item():.3f}")


def act(observations):
    """The motions that the expert would make, and what it would rather do than not."""
    with torch.no_grad():
        found = network((torch.from_numpy(observations) - mean) / spread).numpy()
    found[:, motions:] = found[:, motions:] > 0
    return np.clip(found, -1, 1)


homes = galactic.VectorEnv(sys.argv[2], 64, order="partition", **shown.about.options)
observations, infos = homes.reset(seed=1)
successes = episodes = 0
while not homes.idle.all():
    observations, rewards, terminations, truncations, infos = homes.step(act(observations))
    successes += int(homes.simulators[0].successes.sum())
    episodes += int((terminations | truncations).sum())
print(f"{successes} of {episodes} episodes solved")
