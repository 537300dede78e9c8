"""Makes a policy pack of a network of one's own. Usage: export_own.py WORLD POLICY.pack"""

import sys

import torch
from torch import nn

import galactic
from galactic.learning import ActionParameters, export_module


class Actor(nn.Module):
    def __init__(self, seen: int, motions: int) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(seen))
        self.register_buffer("scale", torch.ones(seen))
        self.layers = nn.Sequential(nn.Linear(seen, 64), nn.Tanh(), nn.Linear(64, motions + 1))
        self.log_std = nn.Parameter(torch.full((motions,), -0.5))

    def forward(self, inputs):
        """`inputs.state` is [T, n, seen]: steps, envs, and the flat observation."""
        rows = self.layers(((inputs.state - self.mean) * self.scale).clamp(-10, 10))
        return ActionParameters(torch.tanh(rows[..., :-1]), self.log_std, [rows[..., -1:]])


world, pack = sys.argv[1:]
homes = galactic.VectorEnv(world, 64, task="pick", bump=True)
actor = Actor(homes.single_observation_space.shape[0], len(homes.world.actions) - 2)
# Here it would learn. The hand is open or closed, by the log-odds that it closes; nobody terminates.
export_module(pack, actor, homes, discrete=[(0, 1), (0,)])

policy = galactic.LearnedPolicy(pack, 64)
observations, _ = homes.reset()
rewards = homes.step(policy.act(observations))[1]
print(f"{policy.name}: paid {rewards.mean():.3f} in the first step")
