"""The distribution of an action: Gaussian motions and two yes-or-no decisions.

An action is a row of `motions + 2` numbers: first the motions, continuous in [-1, 1], which are the
changes of the joints, forward, turn and, for bases that can, sideways; then hand and terminate,
each 0 or 1 (paper, appendix A). torch.distributions would do the same at several times the cost, as
it checks its arguments and wraps every call.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import torch
from torch import Tensor
from torch.nn import functional

DECISIONS = 2
LOWEST_LOG_STD = -5.0
HIGHEST_LOG_STD = 2.0

_HALF_LOG_TAU = 0.5 * math.log(2.0 * math.pi)


class ActionDistribution(NamedTuple):
    """Independent motions and decisions, for a batch of any shape [...].

    The log-probability is that of the Gaussian sample before the simulator clamps it to [-1, 1]:
    clamping is part of the world, not of the policy. `decides_terminate` is false in tasks in which
    terminating does nothing: the decision is then always 0, and neither its probability nor its
    entropy counts.
    """

    mean: Tensor  # [..., motions], in (-1, 1)
    log_std: Tensor  # [..., motions]
    logits: Tensor  # [..., 2]: log-odds of hand and terminate
    decides_terminate: bool

    def sample(self, noise: Tensor) -> Tensor:
        """An action for each row of `noise` [..., motions + 2]: normally distributed numbers, then
        uniform ones."""
        motions = self.mean.shape[-1]
        moved = self.mean + self.log_std.exp() * noise[..., :motions]
        decided = noise[..., motions:] < torch.sigmoid(self.logits)
        return self._joined(moved, decided)

    def mode(self) -> Tensor:
        """The likeliest action: the means, and each decision by its odds."""
        return self._joined(self.mean, self.logits > 0.0)

    def log_prob(self, action: Tensor) -> Tensor:
        """Log-density of each row of `action` [..., motions + 2]; shape [...]."""
        motions = self.mean.shape[-1]
        distance = (action[..., :motions] - self.mean) * torch.exp(-self.log_std)
        density = (-0.5 * distance * distance - self.log_std).sum(-1) - motions * _HALF_LOG_TAU
        # log sigmoid(x) for yes, log sigmoid(-x) for no.
        decided = action[..., motions:]
        choice = functional.logsigmoid(self.logits * (2.0 * decided - 1.0))
        return density + self._of_decisions(choice)

    def entropy(self) -> Tensor:
        """Plain sum of the entropies of motions and decisions (paper, appendix B); shape [...]."""
        motions = self.mean.shape[-1]
        gaussian = self.log_std.sum(-1) + motions * (0.5 + _HALF_LOG_TAU)
        odds = functional.softplus(self.logits) - self.logits * torch.sigmoid(self.logits)
        return gaussian + self._of_decisions(odds)

    def divergence(self, other: ActionDistribution) -> Tensor:
        """Kullback-Leibler divergence of `other` from this distribution, over the decisions that
        both make; shape [...]. No gradient reaches the standard deviations of `other`, only its
        means and odds."""
        noise = other.log_std.detach()
        apart = (self.mean - other.mean).square() + torch.exp(2.0 * self.log_std)
        motions = noise - self.log_std + 0.5 * (apart * torch.exp(-2.0 * noise) - 1.0)
        odds = functional.softplus(other.logits) - functional.softplus(self.logits)
        decisions = odds + torch.sigmoid(self.logits) * (self.logits - other.logits)
        fewer = other if self.decides_terminate else self
        return motions.sum(-1) + fewer._of_decisions(decisions)

    def of(self, envs: Tensor) -> ActionDistribution:
        """The distribution for some envs of a batch [T, n, ...]."""
        return self._replace(
            mean=self.mean[:, envs], log_std=self.log_std[:, envs], logits=self.logits[:, envs]
        )

    def _of_decisions(self, terms: Tensor) -> Tensor:
        return terms.sum(-1) if self.decides_terminate else terms[..., 0]

    def _joined(self, motions: Tensor, decisions: Tensor) -> Tensor:
        action = torch.cat([motions, decisions.to(motions.dtype)], -1)
        if not self.decides_terminate:
            action[..., -1] = 0.0
        return action
