"""Makes a policy pack of a trained policy: `python3 -m galactic.export runs/pick/best.pt -o picker.pack`.

The pack is played without Python and torch, by `galactic-run --policy picker.pack` or
galactic.LearnedPolicy. docs/policies.md tells what is in it.
"""

from __future__ import annotations

import argparse
import math
import operator
import pathlib
import sys
from typing import Any, Optional, Sequence

import numpy as np
import torch
from torch import fx, nn
from torch.nn import functional

from galactic import _core, files
from galactic.learning import checkpoint, own_code, pack_layers
from galactic.learning.command import EXIT_CODES, OK, Parser, named_path, told
from galactic.learning.distributions import DECISIONS, HIGHEST_LOG_STD, LOWEST_LOG_STD
from galactic.learning.encoders import (
    Encoder,
    Eyes,
    Inputs,
    ResNet,
    ResidualBlock,
    SimpleCNN,
    SpaceToDepth,
    StateEncoder,
    Tanh,
)
from galactic.learning.homes import camera_options
from galactic.learning.networks import (
    ActorHead,
    EncoderPolicy,
    FeedForwardPolicy,
    HeadLinear,
    Policy,
    RecurrentPolicy,
)
from galactic.learning.normalization import MOST
from galactic.learning.own_networks import seen_by, some_inputs
from galactic.learning.privileges import of_own_tasks, options_of_actor, parts_of_actor
from galactic.learning.refusals import CheckpointError, refusing
from galactic.learning.setting_fields import typed
from galactic.learning.settings import Settings
from galactic.learning.sight import FARTHEST
from galactic.learning.simulation_words import simulation_keywords


class ExportError(CheckpointError):
    """A module that no layer of a policy pack can express: names it and says what was expected."""


class _Tracer(fx.Tracer):
    """Follows a forward() down to the layers that Layers.module() is asked for."""

    def is_leaf_module(self, m: nn.Module, module_qualified_name: str) -> bool:
        if isinstance(m, nn.Sequential):
            return False
        return type(m).__module__.startswith(("torch.nn.", "galactic.learning."))


_RELU = (torch.relu, functional.relu, "relu")
_TANH = (torch.tanh, functional.tanh, "tanh")
_SUM = (operator.add, torch.add, "add")
_JOIN = (torch.cat, torch.concat)


def _is_image(node: fx.Node) -> bool:
    """Whether it reads a picture, which an export knows where Eyes do."""
    return node.target is getattr and node.args[1] in ("rgb", "depth")


def _is_plain(columns: Any) -> bool:
    """Whether it is a slice from one number to another."""
    return (
        isinstance(columns, slice)
        and isinstance(columns.start, int)
        and isinstance(columns.stop, int)
        and 0 <= columns.start < columns.stop
        and columns.step in (None, 1)
    )


_WORK = ("forward", "_conv_forward", "__call__", "__iter__")
"""What of a module of torch or of ours computes."""


def _is(module: nn.Module, *kinds: type[nn.Module]) -> bool:
    """Whether it computes what one of these does: a class that inherits from it may be made in another way, and do
    nothing else."""
    made = type(module)
    return any(
        isinstance(module, kind)
        and all(getattr(made, name, None) is getattr(kind, name, None) for name in _WORK)
        for kind in kinds
    )


def _require_no_hooks(encoder: nn.Module) -> None:
    """Raises ExportError where something runs around a forward(), which no layer tells."""
    for name, module in encoder.named_modules():
        where = f"{name or 'the network'} ({type(module).__name__})"
        if module._forward_hooks or module._forward_pre_hooks:
            raise ExportError(
                f"{where} has hooks around its forward(), as torch.nn.utils.weight_norm() adds them: train one "
                "without"
            )
        if "forward" in vars(module):
            raise ExportError(f"{where} was given another forward() than its class has")


def _require_unshared(node: fx.Node, given: fx.Node, in_place: Any) -> None:
    """Raises ExportError where an operation may change in place what others read: layers never do."""
    if in_place and (len(given.users) > 1 or given.target in (getattr, operator.getitem)):
        raise ExportError(
            f"{node.target} in forward() works in place on what is read elsewhere ({node.format_node()}): leave "
            "inplace=True out"
        )


class Layers:
    """The layers of a pack, in order. Every method adds some and returns the number of the last."""

    def __init__(self) -> None:
        self.list: list[dict[str, Any]] = []

    def add(self, kind: str, *inputs: int, **fields: Any) -> int:
        """A layer of the kinds of schema/policy.fbs, in snake_case without "Layer"."""
        self.list.append({"kind": kind, "inputs": list(inputs), **fields})
        return len(self.list) - 1

    def module(self, module: Any, x: int) -> int:
        """What a module of torch makes of value `x`."""
        if _is(module, nn.Sequential):
            for part in module:
                x = self.module(part, x)
            return x
        if _is(module, nn.Linear, HeadLinear):
            weight, bias = _numbers(module.weight), _numbers(module.bias)
            return self.add("linear", x, outputs=module.out_features, weight=weight, bias=bias)
        if _is(module, nn.Conv2d):
            return self._convolution(module, x)
        if _is(module, nn.AvgPool2d):
            return self._average_pool(module, x)
        if _is(module, nn.GroupNorm, nn.LayerNorm):
            return self._norm(module, x)
        if _is(module, nn.ReLU):
            return self.add("relu", x)
        if _is(module, nn.Tanh, Tanh):
            return self.add("tanh", x)
        if _is(module, SpaceToDepth):
            return self.add("space_to_depth", x, block=module.block)
        if _is(module, ResidualBlock):
            both = self.add("sum", self.module(module.layers, x), self.module(module.around, x))
            return self.add("relu", both)
        if _is(module, nn.Flatten):
            return x  # linear layers read images as vectors, in the same order
        raise ExportError(f"a policy pack has no layer for {module}")

    def gru(self, gru: nn.GRU, x: int) -> int:
        if gru.num_layers != 1 or gru.bidirectional or not gru.bias:
            raise ExportError(f"{gru} is not one layer in one direction, with biases")
        parameters = dict(gru.named_parameters())
        return self.add(
            "gru",
            x,
            size=gru.hidden_size,
            input_weight=_numbers(parameters["weight_ih_l0"]),
            state_weight=_numbers(parameters["weight_hh_l0"]),
            input_bias=_numbers(parameters["bias_ih_l0"]),
            state_bias=_numbers(parameters["bias_hh_l0"]),
        )

    def seen(self, policy: Policy, state: int, columns: Sequence[int]) -> int:
        """The state and what the eyes see, as the actor reads them. `state` has these columns of a row of
        observations."""
        normal, size, chosen = state, len(columns), list(columns)
        if policy.normalize is not None:
            mean = _numbers(policy.normalize.mean[chosen])
            scale = _numbers(policy.normalize.scale[chosen])
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
        """Value `x`, of `size` numbers, times a factor."""
        return self.add(
            "normalize",
            x,
            mean=np.zeros(size, np.float32),
            inverse_deviation=np.full(size, factor, np.float32),
            limit=float(np.finfo(np.float32).max),
        )

    def encoder(self, encoder: Any, seen: int) -> int:
        """What an encoder makes of the state and what it sees."""
        _require_no_hooks(encoder)
        if _is(encoder, StateEncoder):
            return self.module(encoder.layers, seen)
        if _is(encoder, SimpleCNN):
            image = self.module(encoder.visual, self.add("image"))
            return self.add("concatenate", image, seen)
        if _is(encoder, ResNet):
            image = self.module(encoder.visual, self.add("image"))
            felt = self.module(encoder.state, seen)
            before = self.module(encoder.previous, self.add("previous_action"))
            return self.add("concatenate", image, felt, before)
        return self.traced(encoder, seen)

    def traced(self, encoder: Encoder, seen: int) -> int:
        """What an encoder of the user's does, as torch.fx follows its forward()."""
        if encoder.memory:
            raise ExportError(
                "the network has a memory of its own, and a policy pack has a GRU alone: train one without, with "
                "--recurrent"
            )
        try:
            graph = _Tracer().trace(encoder)
        except Exception as error:  # torch.fx raises whatever the code does with what it is given
            raise ExportError(
                f"forward() cannot be followed ({type(error).__name__}: {error}): write it of layers alone, without "
                "conditions on what is seen"
            ) from error
        values: dict[fx.Node, int] = {}
        for node in graph.nodes:
            if node.op == "output":
                (made,) = node.all_input_nodes
                return values[made]
            if node.op.startswith(("call", "get")) and not _is_image(node):
                values[node] = self._node(encoder, node, values, seen)
        raise ExportError("forward() returns nothing")

    def _node(self, encoder: Encoder, node: fx.Node, values: dict[fx.Node, int], seen: int) -> int:
        """What one operation of a forward() makes of the values before it."""
        if node.op == "call_module":
            module = encoder.get_submodule(str(node.target))
            if isinstance(module, Eyes):
                return self.module(module.layers, self.add("image"))
            (made,) = node.all_input_nodes if len(node.all_input_nodes) == 1 else (node,)
            if made in values:
                _require_unshared(node, made, getattr(module, "inplace", False))
                return self.module(module, values[made])
        if node.target is getattr and node.args[1] == "state":
            return seen
        if node.target is getattr and node.args[1] == "previous":
            return self.add("previous_action")
        given = node.args[0] if node.args else None
        if isinstance(given, fx.Node) and given in values:
            if node.target in (*_RELU, *_TANH) and {*node.kwargs} <= {"inplace"}:
                in_place = node.kwargs.get("inplace", False) or len(node.args) > 1
                _require_unshared(node, given, in_place)
                return self.add("relu" if node.target in _RELU else "tanh", values[given])
            other = node.args[1] if len(node.args) > 1 else None
            if node.target in _SUM and isinstance(other, fx.Node) and not node.kwargs:
                return self.add("sum", values[given], values[other])
            columns = other[-1] if isinstance(other, tuple) and other[:1] == (...,) else None
            if node.target is operator.getitem and _is_plain(columns):
                size = columns.stop - columns.start
                return self.add("slice", values[given], first=columns.start, size=size)
        if node.target in _JOIN and isinstance(given, (list, tuple)):
            joined = [values[one] for one in given if isinstance(one, fx.Node) and one in values]
            along = {*node.args[1:], *node.kwargs.values()}
            if along == {-1} and len(joined) == len(given):
                return self.add("concatenate", *joined)
        name = getattr(node.target, "__name__", node.target)
        raise ExportError(
            f"a policy pack has no layer for {name} in forward() ({node.format_node()}): it has the layers of "
            "docs/policies.md, slices of the last dimension, torch.cat(..., -1), sums, ReLU and tanh; images are for "
            "encoders.Eyes"
        )

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
            weight=_numbers(module.weight),
            bias=_numbers(module.bias),
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
            "weight": _numbers(module.weight),
            "bias": _numbers(module.bias),
        }
        if isinstance(module, nn.GroupNorm):
            return self.add("group_norm", x, groups=module.num_groups, **fields)
        return self.add("layer_norm", x, **fields)


def content_of(saved: checkpoint.SavedPolicy, name: str, robot: str = "") -> dict[str, Any]:
    """A saved policy as write_policy_pack() wants it. The critic is left out, with all that it alone
    sees."""
    policy, privileges = saved.policy, saved.settings.critic_only
    observation = parts_of_actor(privileges, saved.parts)
    own = of_own_tasks(observation)
    if own:
        raise ExportError(
            f"the policy observes {', '.join(own)}, which its task {saved.settings.task} gives in Python "
            "alone; train one that keeps it for the critic (--critic-only), or play this one in Python"
        )
    layers = Layers()
    columns = [n for n in range(saved.shape.state) if n not in saved.shape.critic_only]
    seen = layers.seen(policy, layers.add("observation"), columns)
    if isinstance(policy, FeedForwardPolicy):
        features = layers.module(policy.encoder, seen)
    elif isinstance(policy, (RecurrentPolicy, EncoderPolicy)):
        features = layers.encoder(policy.encoder, seen)
        if saved.network is not None:
            sizes = seen_by(saved.settings, saved.shape, saved.parts)
            _require_same(policy.encoder, some_inputs(policy.encoder, sizes, 4, 8), layers, seen)
        if isinstance(policy, RecurrentPolicy):
            features = layers.gru(policy.rnn, features)
    else:
        raise ExportError(f"the policy {type(policy).__name__} is unknown")
    actions = _actions(layers, policy.action, features)
    return {
        "name": name,
        "robot": robot,
        "options": options_of_actor(
            privileges, simulation_keywords(saved.settings.without_robot_noise().simulation)
        ),
        "observation": observation,
        "image": _image(saved.settings) if saved.settings.sight else None,
        "layers": layers.list,
        **actions,
    }


SAME = 1e-3
"""Between features of a network and of its layers, as a share of the largest: sums in another order differ by
less, another network by more."""


def _require_same(encoder: Encoder, inputs: Inputs, layers: Layers, seen: int) -> None:
    """Raises ExportError where the layers behind value `seen` are not what the network computes."""
    # Rows of a state have both signs.
    inputs = inputs._replace(state=4.0 * inputs.state - 2.0)
    with torch.no_grad():
        found = pack_layers.value(layers.list, seen, inputs)
        wanted = encoder(inputs).flatten(0, 1)
    apart = float((found - wanted).abs().max()) if found.shape == wanted.shape else math.inf
    if not apart <= SAME * max(1.0, float(wanted.abs().max())):
        raise ExportError(
            f"the layers that were found in forward() make other features than it ({apart:.3g} apart on made-up "
            "inputs): write it of plain layers, none of which changes what another one reads"
        )


def _actions(layers: Layers, head: ActorHead, features: int) -> dict[str, Any]:
    motions = head.motions
    rows = layers.module(head.linear, features)
    mean = layers.add("tanh", layers.add("slice", rows, first=0, size=motions))
    if head.log_std is None:
        given = layers.add("slice", rows, first=motions, size=motions)
    else:
        given = layers.add("constant", values=_numbers(head.log_std))
    log_std = layers.add("clamp", given, lower=LOWEST_LOG_STD, upper=HIGHEST_LOG_STD)
    first = head.linear.out_features - 2 * DECISIONS
    discrete = []
    for decision in range(DECISIONS):
        logits = layers.add("slice", rows, first=first + 2 * decision, size=2)
        if head.odds_limit > 0.0:
            logits = _limited(layers, head.odds_limit, logits)
        # Where the task does not ask for it, nobody terminates.
        is_decided = decision + 1 < DECISIONS or head.decides_terminate
        discrete.append({"logits": logits, "values": [0.0, 1.0] if is_decided else [0.0, 0.0]})
    continuous = {"count": motions, "mean": mean, "log_deviation": log_std}
    return {"continuous": continuous, "discrete": discrete}


def _limited(layers: Layers, limit: float, logits: int) -> int:
    """The logits of no and yes whose odds stay within a limit: half of the difference each, with signs."""
    half = np.array([[0.5, -0.5], [-0.5, 0.5]], np.float32)
    apart = layers.add("linear", logits, outputs=2, weight=half, bias=None)
    return layers.times(0.5 * limit, layers.closeup(0.5 * limit, apart, 2), 2)


def _image(settings: Settings) -> dict[str, Any]:
    seen = camera_options(settings)
    return {
        "width": seen["width"],
        "height": seen["height"],
        "color": seen["color"] is not None,
        "color_scale": 1.0 / 255.0,
        "depth": "depth" in settings.sight,
        "depth_limit": FARTHEST,
        "depth_scale": 1.0 / FARTHEST,
        "camera": seen["camera"],
        "vertical_fov": math.radians(seen["fov_degrees"]),
        "position": seen["position"],
        "rpy_degrees": seen["rpy_degrees"],
        "near": seen["near"],
    }


def _numbers(tensor: Optional[torch.Tensor]) -> Optional[np.ndarray]:
    return None if tensor is None else tensor.detach().float().cpu().numpy()


def _edge(size: Any) -> int:
    """The edge of a square."""
    if isinstance(size, tuple):
        if len(set(size)) != 1:
            raise ExportError(f"{size} is not a perfect square")
        return int(size[0])
    return int(size)


def write(file: pathlib.Path, output: pathlib.Path, name: str = "", robot: str = "",
          network: Optional[str] = None) -> None:  # fmt: skip
    """Reads the checkpoint `file` and writes the policy pack `output`. `network`: what --network names."""
    code = own_code.named(network, "--network").file if network is not None else None
    files.require_apart({"--out": output}, [file, *([code] if code else [])])
    saved = checkpoint.load_with(network, file)
    trained_with = {
        field.replace("_", "-"): typed(value) for field, value in saved.settings.to_dict().items()
    }
    trained_with["trained-steps"] = saved.steps
    trained_with["success"] = saved.success
    with refusing(f"{file} cannot become a policy pack", "take another policy"):
        content = content_of(saved, name or output.stem, robot)
        _core.write_policy_pack(output, content, trained_with, file.name, file.read_bytes())


def make_parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="python3 -m galactic.export",
        description="Makes a policy pack of a trained policy, for galactic-run --policy.",
        epilog=EXIT_CODES,
    )
    parser.add_argument("policy", type=named_path, help="best.pt or policy.pt of a run")
    parser.add_argument(
        "-o",
        "--out",
        type=named_path,
        required=True,
        metavar="FILE.pack",
        help="the pack to write",
    )
    parser.add_argument(
        "--name", default="", help="name of the policy (default: the pack's file name)"
    )
    parser.add_argument(
        "--robot",
        default="",
        help="the only robot that it may move (default: any with as many actions)",
    )
    parser.add_argument(
        "--network",
        metavar="FILE.py:CLASS|MODULE:CLASS",
        help="the class of a network of your own, which a policy that was trained with one needs",
    )
    return parser


def main(arguments: Optional[Sequence[str]] = None) -> int:
    options = make_parser().parse_args(arguments)

    def export() -> int:
        write(options.policy, options.out, options.name, options.robot, options.network)
        return OK

    return told("galactic.export", export)


if __name__ == "__main__":
    sys.exit(main())
