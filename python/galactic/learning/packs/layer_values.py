"""What layers of a policy pack compute, by torch: to compare them with the network that they were made of."""

from __future__ import annotations

from typing import Any, Optional, Sequence

import torch
from torch import Tensor
from torch.nn import functional

from galactic.learning.encoders import Inputs, SpaceToDepth, images


def value(
    layers: Sequence[dict[str, Any]], seen: int, inputs: Inputs, starts: Optional[Tensor] = None
) -> Tensor:
    """Rows [T n, F] of the last of `layers` (Layers.list). Value `seen` is the state of the inputs; what is
    before it is not computed. `starts`: bool [T, n], where a GRU forgets what was before. Raises ValueError for a layer that no encoder has.
    """
    values: dict[int, Tensor] = {seen: inputs.state.flatten(0, 1)}
    for number, layer in enumerate(layers[seen + 1 :], start=seen + 1):
        kind = layer["kind"]
        if kind == "image":
            values[number] = images(inputs)
        elif kind == "previous_action":
            assert inputs.previous is not None
            values[number] = inputs.previous.flatten(0, 1)
        elif kind == "constant":
            values[number] = torch.from_numpy(layer["values"]).expand(len(values[seen]), -1)
        elif kind == "gru" and starts is not None:
            values[number] = _remembered(layer, values[layer["inputs"][0]], starts)
        else:
            values[number] = _made(kind, layer, [values[one] for one in layer["inputs"]])
    return values[len(layers) - 1].flatten(1)


def _remembered(layer: dict[str, Any], x: Tensor, starts: Tensor) -> Tensor:
    """What a GRU says in each step."""
    names = ("input_weight", "state_weight", "input_bias", "state_bias")
    parameters = [torch.from_numpy(layer[name]) for name in names]
    memory = torch.zeros(starts.shape[1], layer["size"])
    said = []
    for rows, begun in zip(x.flatten(1).unflatten(0, starts.shape), starts):
        memory = torch.gru_cell(rows, memory * ~begun[:, None], *parameters)
        said.append(memory)
    return torch.cat(said)


def _made(kind: str, layer: dict[str, Any], given: list[Tensor]) -> Tensor:
    x, weight, bias = given[0], _tensor(layer.get("weight")), _tensor(layer.get("bias"))
    if kind == "linear":
        assert weight is not None
        return functional.linear(x.flatten(1), weight, bias)
    if kind == "convolution":
        assert weight is not None
        return functional.conv2d(x, weight, bias, layer["stride"], layer["padding"])
    if kind == "average_pool":
        return functional.avg_pool2d(x, layer["kernel"], layer["stride"], layer["padding"])
    if kind == "group_norm":
        return functional.group_norm(x, layer["groups"], weight, bias, layer["epsilon"])
    if kind == "layer_norm":
        assert weight is not None
        return functional.layer_norm(x.flatten(1), weight.shape, weight, bias, layer["epsilon"])
    if kind == "relu":
        return torch.relu(x)
    if kind == "tanh":
        return torch.tanh(x)
    if kind == "clamp":
        return x.clamp(layer["lower"], layer["upper"])
    if kind == "normalize":
        normal = (x.flatten(1) - _tensor(layer["mean"])) * _tensor(layer["inverse_deviation"])
        return normal.clamp(-layer["limit"], layer["limit"])
    if kind == "space_to_depth":
        return SpaceToDepth(layer["block"])(x)
    if kind == "sum":
        return x + given[1]
    if kind == "concatenate":
        return torch.cat([one.flatten(1) for one in given], -1)
    if kind == "slice":
        return x.flatten(1)[:, layer["first"] : layer["first"] + layer["size"]]
    raise ValueError(f"found a layer {kind}, expected one of an encoder")


def _tensor(numbers: Optional[Any]) -> Optional[Tensor]:
    return None if numbers is None else torch.from_numpy(numbers)
