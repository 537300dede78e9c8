"""What a policy does to its observations before the first layer."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn

MOST = 10.0
"""Normalized values are clamped to [-10, 10]."""
_EPSILON = 1e-5


class Normalizer(nn.Module):
    """(x - mean) / sqrt(variance + 1e-5), clamped to [-10, 10]; element by element.

    Mean and variance are buffers: they are saved with the policy, and only absorb() changes them,
    which the trainer calls after each update. In between, and in evaluations, they are constant, so
    that the policy that is trained is the one that acted.
    """

    mean: Tensor
    scale: Tensor
    count: Tensor
    center: Tensor
    square: Tensor

    def __init__(self, size: int):
        super().__init__()
        self.register_buffer("mean", torch.zeros(size))
        self.register_buffer("scale", torch.ones(size))
        # Double precision, to add up billions of steps.
        self.register_buffer("count", torch.zeros((), dtype=torch.float64))
        self.register_buffer("center", torch.zeros(size, dtype=torch.float64))
        self.register_buffer("square", torch.zeros(size, dtype=torch.float64))

    def forward(self, inputs: Tensor) -> Tensor:
        return torch.clamp((inputs - self.mean) * self.scale, -MOST, MOST)

    @staticmethod
    def sums(batch: Tensor, center: Tensor) -> Tensor:
        """Count, sums and sums of squares about `center` of rows [..., S]; float64 [1 + 2 S].

        The sums of several ranks may be added if they are about the same center.
        """
        rows = batch.reshape(-1, batch.shape[-1]).double() - center
        count = torch.full((1,), float(len(rows)), dtype=torch.float64, device=rows.device)
        return torch.cat([count, rows.sum(0), (rows * rows).sum(0)])

    def absorb(self, sums: Tensor) -> None:
        """Updates mean and variance with the result of sums() about `self.center` (Chan, Golub,
        LeVeque 1979)."""
        size = self.mean.numel()
        count, first, second = sums[0], sums[1 : 1 + size], sums[1 + size :]
        total = self.count + count
        shift = first / count
        self.square += second - count * shift * shift
        self.square += shift * shift * (self.count * count / total)
        self.center += shift * (count / total)
        self.count.copy_(total)
        self.mean.copy_(self.center)
        self.scale.copy_(torch.rsqrt(self.square / total + _EPSILON))


class Closeup(nn.Module):
    """tanh(x / scale), element by element, for each of the scales, whose rows are concatenated: it
    magnifies values near zero.

    A target may be anywhere in a home. Normalized by the variance of its distance, the last five
    centimeters of reach shrink to a hundredth of a unit, and a network needs millions of steps to
    learn weights large enough to resolve them. This row complements the normalized one: it
    saturates far away and is linear where hands meet objects.
    """

    def __init__(self, scales: Sequence[float]):
        super().__init__()
        self.scales = tuple(scales)

    def forward(self, inputs: Tensor) -> Tensor:
        return torch.cat([torch.tanh(inputs * (1.0 / scale)) for scale in self.scales], -1)
