"""Encoders turn what a policy sees into features, a row of numbers per step, which the heads read.
User-defined networks (own_networks.py) are encoders, too."""

from __future__ import annotations

import math
from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional

from galactic.learning.policies.sight import FARTHEST

FEATURES = 512
"""Width of the paper's networks."""


class Inputs(NamedTuple):
    """What a policy sees in T steps of n envs."""

    state: Tensor  # [T, n, S] float32: a row of observations
    rgb: Tensor | None = None  # [T, n, H, W, 3] uint8
    depth: Tensor | None = None  # [T, n, H, W] float32, meters
    previous: Tensor | None = None  # [T, n, A]: the action before, zero where an episode starts


class FullLinear(nn.Linear):
    """A linear layer in float32, even if the layers around it are computed in bfloat16. The 8 bits
    of bfloat16 are too few for what these layers must resolve: centimeters in a state in meters,
    advantages in values, and ratios of probabilities in log-stds."""

    def forward(self, input: Tensor) -> Tensor:
        # On a processor, entering the context takes a third of the time of a small layer.
        if not (torch.is_autocast_enabled() or torch.is_autocast_cpu_enabled()):
            return functional.linear(input, self.weight, self.bias)
        with torch.autocast(input.device.type, enabled=False):
            return functional.linear(input.float(), self.weight, self.bias)


class Encoder(nn.Module):
    """Inputs -> features [T, n, F].

    An encoder with a memory of its own also takes the memory before the first step, [n, M], and
    where episodes begin, bool [T, n], and also returns the memory after the last step:

        features, memory = encoder(inputs, memory, starts)

    Where an episode begins, the encoder must start from an empty memory, which is all zeros: see
    sequences.run_gru().
    """

    features = 0
    """F."""
    memory = 0
    """M, numbers for each env; 0: no memory."""
    needs_previous = False
    """Whether the encoder reads Inputs.previous."""


class Eyes(nn.Module):
    """Convolutions over pictures -> numbers [T, n, F]: `layers` turn each picture, [C, H, W] as
    from images(), into F numbers."""

    def __init__(self, layers: nn.Module):
        super().__init__()
        self.layers = layers

    def forward(self, inputs: Inputs) -> Tensor:
        return self.layers(images(inputs)).float().view(*inputs.state.shape[:2], -1)


class StateEncoder(Encoder):
    """A perceptron on the state, in front of a GRU."""

    def __init__(self, state: int, width: int, layers: int, activation: str):
        super().__init__()
        self.features = width
        self.layers = perceptron(state, width, layers, activation)

    def forward(self, inputs: Inputs) -> Tensor:
        return self.layers(inputs.state)


class SimpleCNN(Encoder):
    """Three convolutions and a linear layer, as in Habitat 2.0 (paper, appendix B)."""

    def __init__(self, state: int):
        super().__init__()
        self.features = FEATURES + state
        self.visual = nn.Sequential(
            nn.Conv2d(4, 32, 8, 4),
            nn.ReLU(inplace=True),
            nn.Conv2d(32, 64, 4, 2),
            nn.ReLU(inplace=True),
            nn.Conv2d(64, 32, 3, 1),
            nn.Flatten(),
            nn.Linear(32 * 12 * 12, FEATURES),
            nn.ReLU(inplace=True),
        )
        _kaiming(self.visual)

    def forward(self, inputs: Inputs) -> Tensor:
        seen = self.visual(images(inputs)).float()
        return torch.cat([seen.view(*inputs.state.shape[:2], FEATURES), inputs.state], -1)


class ResNet(Encoder):
    """The paper's ResNet9 and ResNet18: space to depth, four stages, GroupNorm everywhere."""

    needs_previous = True

    def __init__(self, state: int, actions: int, blocks: int):
        super().__init__()
        self.features = FEATURES + FEATURES + 32
        stages: list[nn.Module] = []
        channels = 32
        for stage, width in enumerate((32, 64, 128, 256)):
            for block in range(blocks):
                stride = 2 if stage > 0 and block == 0 else 1
                stages.append(ResidualBlock(channels, width, stride))
                channels = width
        self.visual = nn.Sequential(
            SpaceToDepth(4),
            nn.Conv2d(64, 32, 1, bias=False),
            nn.GroupNorm(16, 32),
            nn.ReLU(inplace=True),
            *stages,
            nn.Conv2d(256, 64, 3, padding=1, bias=False),
            nn.GroupNorm(16, 64),
            nn.ReLU(inplace=True),
            nn.Flatten(),
            nn.Linear(64 * 4 * 4, FEATURES, bias=False),
            nn.LayerNorm(FEATURES),
            nn.ReLU(inplace=True),
        )
        self.state = FullLinear(state, FEATURES)
        self.previous = FullLinear(actions, 32)
        _kaiming(self.visual)

    def forward(self, inputs: Inputs) -> Tensor:
        assert inputs.previous is not None
        seen = self.visual(images(inputs)).float().view(*inputs.state.shape[:2], FEATURES)
        return torch.cat([seen, self.state(inputs.state), self.previous(inputs.previous)], -1)


class DepthCNN(nn.Module):
    """Depth [T, n, S, S] -> numbers [T, n, F]: SimpleCNN with fewer channels, for processors."""

    def __init__(self, image_size: int, features: int):
        super().__init__()
        self.features = features
        edge = ((image_size - 8) // 4 - 3) // 2 - 1  # of the last convolution's image
        self.layers = nn.Sequential(
            nn.Conv2d(1, 16, 8, 4),
            nn.ReLU(inplace=True),
            nn.Conv2d(16, 32, 4, 2),
            nn.ReLU(inplace=True),
            nn.Conv2d(32, 32, 3, 1),
            nn.ReLU(inplace=True),
            nn.Flatten(),
            nn.Linear(32 * edge * edge, features),
            nn.ReLU(inplace=True),
        )
        _kaiming(self.layers)

    def forward(self, inputs: Inputs) -> Tensor:
        assert inputs.depth is not None
        depth = inputs.depth.clamp(0.0, FARTHEST) * (1.0 / FARTHEST)
        seen = self.layers(depth.flatten(0, 1).unsqueeze(1)).float()
        return seen.view(*depth.shape[:2], self.features)


class ResidualBlock(nn.Module):
    """Two 3x3 convolutions with a skip connection."""

    def __init__(self, channels: int, width: int, stride: int):
        super().__init__()
        self.layers = nn.Sequential(
            nn.Conv2d(channels, width, 3, stride, 1, bias=False),
            nn.GroupNorm(16, width),
            nn.ReLU(inplace=True),
            nn.Conv2d(width, width, 3, 1, 1, bias=False),
            nn.GroupNorm(16, width),
        )
        self.around = nn.Sequential()
        if stride != 1:
            self.around.append(nn.AvgPool2d(3, stride, 1))
        if stride != 1 or channels != width:
            self.around.append(nn.Conv2d(channels, width, 1, bias=False))
            self.around.append(nn.GroupNorm(16, width))

    def forward(self, inputs: Tensor) -> Tensor:
        return torch.relu(self.layers(inputs) + self.around(inputs))


class SpaceToDepth(nn.Module):
    """[B, C, H, W] -> [B, b b C, H/b, W/b]: channel (row in block, column in block, C)."""

    def __init__(self, block: int):
        super().__init__()
        self.block = block

    def forward(self, inputs: Tensor) -> Tensor:
        batch, channels, height, width = inputs.shape
        size = self.block
        cut = inputs.view(batch, channels, height // size, size, width // size, size)
        return (
            cut.permute(0, 3, 5, 1, 2, 4)
            .reshape(batch, size * size * channels, height // size, width // size)
            .contiguous(memory_format=torch.channels_last)
        )


def images(inputs: Inputs) -> Tensor:
    """The pictures as networks read them: [T n, C, H, W], in [0, 1], channels last in memory. The
    channels are red, green and blue, if there are colors, then depth, if there is any.

    RGB stays in bytes until here. Depth is clamped to 10 m.
    """
    there = [part for part in (inputs.rgb, inputs.depth) if part is not None]
    assert there, "the network sees no images"
    batch, (height, width) = there[0].shape[:2].numel(), there[0].shape[2:4]
    colors = 0 if inputs.rgb is None else 3
    channels = colors + (inputs.depth is not None)
    packed = torch.empty(batch, height, width, channels, device=inputs.state.device)
    if inputs.rgb is not None:
        packed[..., :3] = inputs.rgb.reshape(batch, height, width, 3)
        packed[..., :3] *= 1.0 / 255.0
    if inputs.depth is not None:
        packed[..., colors] = inputs.depth.reshape(batch, height, width)
        packed[..., colors].clamp_(0.0, FARTHEST).mul_(1.0 / FARTHEST)
    return packed.permute(0, 3, 1, 2)


class Tanh(nn.Tanh):
    """tanh computed from a sigmoid: on processors three times as fast as torch's, and equal to
    within 2e-7."""

    def forward(self, input: Tensor) -> Tensor:
        return _SigmoidTanh.apply(input) if input.device.type == "cpu" else torch.tanh(input)


class _SigmoidTanh(torch.autograd.Function):
    @staticmethod
    def forward(context, inputs: Tensor) -> Tensor:  # type: ignore[override]
        outputs = (inputs + inputs).sigmoid_().mul_(2.0).sub_(1.0)
        context.save_for_backward(outputs)
        return outputs

    @staticmethod
    def backward(context, gradient: Tensor) -> Tensor:  # type: ignore[override]
        (outputs,) = context.saved_tensors
        return torch.ops.aten.tanh_backward(gradient, outputs)


ACTIVATIONS = {"tanh": Tanh, "relu": nn.ReLU}


def perceptron(inputs: int, width: int, layers: int, activation: str) -> nn.Sequential:
    """`layers` linear layers of `width`, each with its activation."""
    chain: list[nn.Module] = []
    for layer in range(layers):
        chain += [
            orthogonal(FullLinear(inputs if layer == 0 else width, width), math.sqrt(2.0)),
            ACTIVATIONS[activation](),
        ]
    return nn.Sequential(*chain)


def orthogonal(layer: nn.Linear, gain: float) -> nn.Linear:
    nn.init.orthogonal_(layer.weight, gain)
    nn.init.zeros_(layer.bias)
    return layer


def _kaiming(layers: nn.Module) -> None:
    for layer in layers.modules():
        if isinstance(layer, (nn.Conv2d, nn.Linear)):
            nn.init.kaiming_normal_(layer.weight, nonlinearity="relu")
            if layer.bias is not None:
                nn.init.zeros_(layer.bias)
