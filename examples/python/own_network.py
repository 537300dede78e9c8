"""A network of one's own: what it makes of the observation, beside what all policies have, heads and critic."""

import torch
from torch import nn

from galactic.learning.encoders import Encoder
from galactic.learning.sequences import run_gru


class TargetFirst(Encoder):
    """A perceptron on all that is observed, and another one on where the target is, as the robot sees it."""

    def __init__(self, seen, width=64):
        super().__init__()
        self.features = 2 * width
        self.target = seen.parts["robot_target"]
        self.all = nn.Sequential(nn.Linear(seen.state, width), nn.Tanh())
        size = self.target.stop - self.target.start
        self.near = nn.Sequential(
            nn.Linear(size, width), nn.Tanh(), nn.Linear(width, width), nn.Tanh()
        )

    def forward(self, inputs):
        near = self.near(inputs.state[..., self.target])
        return torch.cat([self.all(inputs.state), near], -1)


class Remembering(Encoder):
    """A linear layer and a GRU: a memory of one's own, which is empty where an episode starts."""

    def __init__(self, seen, width=64):
        super().__init__()
        self.features = self.memory = width
        self.all = nn.Linear(seen.state, width)
        self.rnn = nn.GRU(width, width)

    def forward(self, inputs, memory, starts):
        return run_gru(self.rnn, torch.tanh(self.all(inputs.state)), memory, starts)


def until_solved(folder, settings):
    """A callback: logs how long the weights are, and ends the run when nine of ten episodes are solved."""

    def call(moment):
        weights = torch.cat([one.detach().flatten() for one in moment.policy.parameters()])
        moment.log("weights", float(weights.norm()))
        if moment.row.get("validation_success", 0.0) >= 0.9:
            moment.stop("nine of ten episodes are solved")

    return call
