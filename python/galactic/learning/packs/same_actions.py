"""Checks that a policy pack acts like the network from which it was made, by playing it before it
is kept."""

from __future__ import annotations

import pathlib
import tempfile
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import torch
from torch import Tensor

from galactic import _core
from galactic._core import ErrorCode
from galactic.errors import Error
from galactic.learning.encoders import Encoder, Inputs
from galactic.learning.packs.layers import ExportError
from galactic.learning.user_code.own_networks import Seen, some_inputs

STEPS, ENVS = 4, 8
"""The size of the inputs with which a pack is tried."""
SAME = 1e-3
"""The tolerance between a head of a network and of its pack, relative to the head's largest number:
sums in a different order differ by less, a different network by more."""
_ROUNDING = 1e-5
"""The absolute tolerance, for sums in a different order in a head whose numbers are almost zero."""


class Network(NamedTuple):
    """A network with which a pack is compared. Its heads are the means of the continuous actions,
    the logarithms of their standard deviations, and, for each discrete action, the log-odds of its
    other values against the first."""

    heads: Callable[[Inputs, Tensor, Tensor], tuple[Sequence[Tensor], Tensor]]
    """Called with inputs [1, n, ...], memory [n, M] and starts bool [1, n] for one step of n envs.
    Returns the heads, [n, F] each, and the memory after the step."""
    memory: int
    """M; 0: no memory."""
    columns: Sequence[int] | None = None
    """Which columns of the network's state the pack observes; None: all."""


def made_up(state: int, image: Mapping[str, Any] | None, actions: int) -> Inputs:
    """Made-up inputs for STEPS steps of ENVS envs: rows of `state` numbers, pictures as in the
    pack's `image`, and `actions` previous actions."""
    images: dict[str, tuple[int, ...]] = {}
    if image is not None:
        edges = (image["height"], image["width"])
        images = {"rgb": (*edges, 3)} if image["color"] else {}
        images |= {"depth": edges} if image["depth"] else {}
    inputs = some_inputs(Encoder(), Seen(state, {}, images, actions), STEPS, ENVS)
    previous = torch.zeros(STEPS, ENVS, actions)
    # The numbers of a state have both signs.
    return inputs._replace(state=4.0 * inputs.state - 2.0, previous=previous)


def step_of(inputs: Inputs, step: int) -> Inputs:
    """One step of the inputs."""
    state, *others = inputs
    at = slice(step, step + 1)
    return Inputs(state[at], *(None if part is None else part[at] for part in others))


def require_same_actions(content: dict[str, Any], network: Network, inputs: Inputs, remedy: str) -> None:  # fmt: skip
    """Raises ExportError if a pack of this content (_core.write_policy_pack()) computes something
    else than the network from inputs of made_up(). Compares all numbers of all heads, over episodes
    that end and begin. `remedy`: what to do in that case."""
    layers, sizes = _with_heads(content)
    actions, total = _actions_of(content), sum(sizes)
    found, wanted = [], []
    # Play packs whose actions are the numbers of the heads, as many at a time as there are actions.
    for first in range(0, total, actions):
        said = {"kind": "slice", "inputs": [len(layers) - 1], "first": first, "size": actions}
        everything = {"count": actions, "mean": len(layers), "log_deviation": len(layers)}
        part = {**content, "layers": [*layers, said], "continuous": everything, "discrete": []}
        played, heads = _played(part, network, inputs)
        found.append(played)
        wanted.append(heads[..., first : first + actions])
    ends = np.cumsum(sizes)
    _require_near(
        np.split(np.concatenate(found, -1), ends, -1)[: len(sizes)],
        np.split(np.concatenate(wanted, -1), ends, -1)[: len(sizes)],
        remedy,
    )
    played, heads = _played(content, network, inputs)
    if content["continuous"] is not None:
        means = sizes[0]
        _require_near([played[..., :means]], [heads[..., :means]], remedy)


def _with_heads(content: dict[str, Any]) -> tuple[list[dict[str, Any]], list[int]]:
    """The layers, with an additional last one that holds the numbers of all heads, padded with
    zeros to a multiple of the actions; and the sizes of the heads."""
    layers, heads, sizes = [*content["layers"]], [], []
    continuous = content["continuous"]
    if continuous is not None:
        heads = [continuous["mean"], continuous["log_deviation"]]
        sizes = 2 * [continuous["count"]]
    for action in content["discrete"]:
        count = len(action["values"])
        weight = np.eye(count, dtype=np.float32)[1:]
        weight[:, 0] = -1.0
        odds = {"outputs": count - 1, "weight": weight, "bias": None}
        heads.append(len(layers))
        layers.append({"kind": "linear", "inputs": [action["logits"]], **odds})
        sizes.append(count - 1)
    missing = -sum(sizes) % _actions_of(content)
    if missing:
        heads.append(len(layers))
        zeros = np.zeros(missing, np.float32)
        layers.append({"kind": "constant", "inputs": [], "values": zeros})
    layers.append({"kind": "concatenate", "inputs": heads})
    return layers, sizes


def _actions_of(content: dict[str, Any]) -> int:
    continuous = content["continuous"]
    return (0 if continuous is None else continuous["count"]) + len(content["discrete"])


def _played(
    content: dict[str, Any], network: Network, inputs: Inputs
) -> tuple[np.ndarray, np.ndarray]:
    """The likeliest actions of a pack, [STEPS, ENVS, A], and the heads of the network in the same
    episodes, padded with zeros at the end."""
    player = _player_of(content)
    image = content["image"] or {"color": False, "depth": False}
    columns = slice(None) if network.columns is None else list(network.columns)
    memory = torch.zeros(ENVS, network.memory)
    previous = torch.zeros(ENVS, player.action_count)
    found, wanted = [], []
    for step in range(STEPS):
        # All envs begin an episode in the first step, later ones in turn.
        starts = (torch.arange(ENVS) + step) % STEPS == 0 if step else torch.ones(ENVS) > 0
        seen = step_of(inputs, step)._replace(previous=(previous * ~starts[:, None])[None])
        heads, memory = network.heads(seen, memory, starts[None].clone())
        played = player.act(
            seen.state[0][:, columns].numpy(),
            starts.numpy(),
            seen.rgb[0].numpy() if image["color"] and seen.rgb is not None else None,
            seen.depth[0].numpy() if image["depth"] and seen.depth is not None else None,
        )
        previous = torch.from_numpy(played).clamp(-1.0, 1.0)
        row = torch.cat([*heads, torch.zeros(ENVS, player.action_count)], -1)
        found.append(played)
        wanted.append(row.detach().float().numpy())
    return np.stack(found), np.stack(wanted)


def _player_of(content: dict[str, Any]) -> _core.LearnedPolicy:
    """A player of the likeliest actions of a pack."""
    with tempfile.TemporaryDirectory() as folder:
        pack = pathlib.Path(folder) / "tried.pack"
        try:
            _core.write_policy_pack(pack, content, {}, "", b"")
        except Error as error:
            if error.code == ErrorCode.IO:
                raise
            # The user does not know this temporary file, so name the policy.
            where = error.where.replace(str(pack), content["name"])
            raise Error(error.code, where, error.message) from None
        return _core.LearnedPolicy(pack, ENVS, deterministic=True, threads=1)


def _require_near(found: list[np.ndarray], wanted: list[np.ndarray], remedy: str) -> None:
    """Raises ExportError if a head differs from the wanted one by more than the tolerance."""
    for one, other in zip(found, wanted):
        apart = np.abs(one - other).max(initial=0.0)
        # A comparison with NaN is false.
        if not apart <= SAME * np.abs(other).max(initial=0.0) + _ROUNDING:
            raise ExportError(
                f"the layers of the pack make other actions than the network ({apart:.3g} apart on made-up inputs): "
                f"{remedy}"
            )
