"""Converts torch modules to layers of a policy pack."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from torch import nn

from galactic.learning.encoders import FullLinear, ResidualBlock, SpaceToDepth, Tanh
from galactic.learning.policies.networks import Policy
from galactic.learning.policies.normalization import MOST
from galactic.learning.refusals import CheckpointError


LARGEST = float(np.finfo(np.float32).max)
"""A limit that clamps nothing."""


class ExportError(CheckpointError):
    """A module that cannot be expressed in layers of a policy pack. The message names it and says
    what was expected."""


class Layers:
    """The layers of a pack, in order. Every method adds some and returns the number of the last."""

    def __init__(self) -> None:
        self.list: list[dict[str, Any]] = []

    def add(self, kind: str, *inputs: int, **fields: Any) -> int:
        """Adds a layer. `kind` is one of schema/policy.fbs, in snake_case without "Layer"."""
        self.list.append({"kind": kind, "inputs": list(inputs), **fields})
        return len(self.list) - 1

    def module(self, module: Any, x: int) -> int:
        """Adds the layers of a torch module that reads layer `x`."""
        if computes_as(module, nn.Sequential):
            for part in module:
                x = self.module(part, x)
            return x
        if computes_as(module, nn.Linear, FullLinear):
            weight, bias = numbers_of(module.weight), numbers_of(module.bias)
            return self.add("linear", x, outputs=module.out_features, weight=weight, bias=bias)
        if computes_as(module, nn.Conv2d):
            return self._convolution(module, x)
        if computes_as(module, nn.AvgPool2d):
            return self._average_pool(module, x)
        if computes_as(module, nn.GroupNorm, nn.LayerNorm):
            return self._norm(module, x)
        if computes_as(module, nn.ReLU):
            return self.add("relu", x)
        if computes_as(module, nn.Tanh, Tanh):
            return self.add("tanh", x)
        if computes_as(module, SpaceToDepth):
            return self.add("space_to_depth", x, block=module.block)
        if computes_as(module, ResidualBlock):
            both = self.add("sum", self.module(module.layers, x), self.module(module.around, x))
            return self.add("relu", both)
        if computes_as(module, nn.Flatten):
            return x  # linear layers read images as vectors in the same order
        described = str(module)
        if "\n" in described:  # str() lists its parts
            described = type(module).__name__
        raise ExportError(f"a policy pack has no layer for {described}")

    def gru(self, gru: nn.GRU, x: int) -> int:
        if gru.num_layers != 1 or gru.bidirectional or not gru.bias:
            raise ExportError(f"{gru} is not one layer in one direction, with biases")
        parameters = dict(gru.named_parameters())
        return self.add(
            "gru",
            x,
            size=gru.hidden_size,
            input_weight=numbers_of(parameters["weight_ih_l0"]),
            state_weight=numbers_of(parameters["weight_hh_l0"]),
            input_bias=numbers_of(parameters["bias_ih_l0"]),
            state_bias=numbers_of(parameters["bias_hh_l0"]),
        )

    def seen(self, policy: Policy, state: int, columns: Sequence[int]) -> int:
        """Adds the layers in front of the encoder: the state and the output of the eyes, as the
        actor reads them. The layer `state` has these columns of an observed row."""
        normal, size, chosen = state, len(columns), list(columns)
        if policy.normalize is not None:
            mean = numbers_of(policy.normalize.mean[chosen])
            scale = numbers_of(policy.normalize.scale[chosen])
            normal = self.add("normalize", state, mean=mean, inverse_deviation=scale, limit=MOST)
        parts = [normal]
        if policy.closeup is not None:
            parts += [self.closeup(scale, state, size) for scale in policy.closeup.scales]
        if policy.eyes is not None:
            parts.append(self.module(policy.eyes.layers, self.add("image")))
        return normal if len(parts) == 1 else self.add("concatenate", *parts)

    def closeup(self, scale: float, state: int, size: int) -> int:
        return self.add("tanh", self.times(1.0 / scale, state, size))

    def times(self, factor: float, x: int, size: int) -> int:
        """Layer `x`, of `size` numbers, times a factor."""
        return self.scaled(x, torch.zeros(size), torch.full((size,), factor))

    def scaled(self, x: int, mean: torch.Tensor, factors: torch.Tensor) -> int:
        """(x - mean) * factors, all of the same size."""
        fields = {"mean": numbers_of(mean), "inverse_deviation": numbers_of(factors)}
        return self.add("normalize", x, **fields, limit=LARGEST)

    def _convolution(self, module: nn.Conv2d, x: int) -> int:
        kernel, stride, padding = _edge(module.kernel_size), _edge(module.stride), module.padding
        plain = module.groups == 1 and _edge(module.dilation) == 1
        if not plain or isinstance(padding, str) or module.padding_mode != "zeros":
            raise ExportError(f"{module} has groups, dilation or padding other than zeros")
        return self.add(
            "convolution",
            x,
            outputs=module.out_channels,
            kernel=kernel,
            stride=stride,
            padding=_edge(padding),
            weight=numbers_of(module.weight),
            bias=numbers_of(module.bias),
        )

    def _average_pool(self, module: nn.AvgPool2d, x: int) -> int:
        if module.ceil_mode or not module.count_include_pad or module.divisor_override:
            raise ExportError(f"{module} does not count zeros around the image")
        kernel, stride = _edge(module.kernel_size), _edge(module.stride)
        padding = _edge(module.padding)
        return self.add("average_pool", x, kernel=kernel, stride=stride, padding=padding)

    def _norm(self, module: Any, x: int) -> int:
        if module.weight is None or module.bias is None:
            raise ExportError(f"{module} has no weights")
        fields = {
            "epsilon": module.eps,
            "weight": numbers_of(module.weight),
            "bias": numbers_of(module.bias),
        }
        if isinstance(module, nn.GroupNorm):
            return self.add("group_norm", x, groups=module.num_groups, **fields)
        return self.add("layer_norm", x, **fields)


_WORK = ("forward", "_conv_forward", "__call__", "__iter__")
"""The methods that define what a module computes."""


def computes_as(module: nn.Module, *kinds: type[nn.Module]) -> bool:
    """Whether a module computes the same as one of these classes. A derived class qualifies if it
    overrides none of the methods that compute."""
    made = type(module)
    return any(
        isinstance(module, kind)
        and all(getattr(made, name, None) is getattr(kind, name, None) for name in _WORK)
        for kind in kinds
    )


def numbers_of(tensor: torch.Tensor | None) -> np.ndarray | None:
    """A tensor as the array that a layer takes."""
    return None if tensor is None else tensor.detach().float().cpu().numpy()


def _edge(size: Any) -> int:
    """The edge of a square size."""
    if isinstance(size, tuple):
        if len(set(size)) != 1:
            raise ExportError(f"{size} is not a perfect square")
        return int(size[0])
    return int(size)
