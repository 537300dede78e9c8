"""An encoder as layers of a policy pack: ours by what they are made of, the user's as torch.fx follows them."""

from __future__ import annotations

import contextlib
import math
import operator
import pathlib
import traceback
from typing import Any, Iterator, Optional

import torch
from torch import fx, nn
from torch.nn import functional

from galactic.learning.encoders import Encoder, Eyes, Inputs, ResNet, SimpleCNN, StateEncoder
from galactic.learning.packs import layer_values
from galactic.learning.packs.layers import ExportError, Layers, computes_as


SAME = 1e-3
"""Between features of a network and of its layers, as a share of the largest: sums in another order differ by
less, another network by more."""
_RELU = (torch.relu, functional.relu, "relu")
_TANH = (torch.tanh, functional.tanh, "tanh")
_SUM = (operator.add, torch.add, "add")
_JOIN = (torch.cat, torch.concat)


def encoded(layers: Layers, encoder: Any, seen: int) -> int:
    """What an encoder makes of the state and what it sees."""
    _require_no_hooks(encoder)
    if computes_as(encoder, StateEncoder):
        return layers.module(encoder.layers, seen)
    if computes_as(encoder, SimpleCNN):
        image = layers.module(encoder.visual, layers.add("image"))
        return layers.add("concatenate", image, seen)
    if computes_as(encoder, ResNet):
        image = layers.module(encoder.visual, layers.add("image"))
        felt = layers.module(encoder.state, seen)
        before = layers.module(encoder.previous, layers.add("previous_action"))
        return layers.add("concatenate", image, felt, before)
    return _traced(layers, encoder, seen)


def _traced(layers: Layers, encoder: Encoder, seen: int) -> int:
    """What an encoder of the user's does, as torch.fx follows its forward()."""
    if encoder.memory:
        raise ExportError(
            "the network has a memory of its own, and a policy pack has a GRU alone: train one without, with "
            "--recurrent"
        )
    tracer = _Tracer(encoder)
    fault = tracer.follow()
    for node in tracer.graph.nodes:
        if node.op == "call_module":
            with tracer.telling_line(node):
                _require_layer(encoder.get_submodule(str(node.target)))
    if fault is not None:
        raise ExportError(tracer.told(fault)) from fault
    values: dict[fx.Node, int] = {}
    for node in tracer.graph.nodes:
        if node.op == "output":
            (made,) = node.all_input_nodes
            return values[made]
        if node.op.startswith(("call", "get")) and not _is_image(node):
            with tracer.telling_line(node):
                values[node] = _of_node(layers, encoder, node, values, seen)
    raise ExportError("forward() returns nothing")


def _require_layer(module: nn.Module) -> None:
    """Raises ExportError for a module that no layers express."""
    Layers().module(module.layers if isinstance(module, Eyes) else module, 0)


def _of_node(layers: Layers, encoder: Encoder, node: fx.Node, values: dict[fx.Node, int],
             seen: int) -> int:  # fmt: skip
    """What one operation of a forward() makes of the values before it."""
    if node.op == "call_module":
        module = encoder.get_submodule(str(node.target))
        if isinstance(module, Eyes):
            return layers.module(module.layers, layers.add("image"))
        (made,) = node.all_input_nodes if len(node.all_input_nodes) == 1 else (node,)
        if made in values:
            _require_unshared(node, made, getattr(module, "inplace", False))
            return layers.module(module, values[made])
    if node.target is getattr and node.args[1] == "state":
        return seen
    if node.target is getattr and node.args[1] == "previous":
        return layers.add("previous_action")
    given = node.args[0] if node.args else None
    if isinstance(given, fx.Node) and given in values:
        if node.target in (*_RELU, *_TANH) and {*node.kwargs} <= {"inplace"}:
            in_place = node.kwargs.get("inplace", False) or len(node.args) > 1
            _require_unshared(node, given, in_place)
            return layers.add("relu" if node.target in _RELU else "tanh", values[given])
        other = node.args[1] if len(node.args) > 1 else None
        if node.target in _SUM and isinstance(other, fx.Node) and not node.kwargs:
            return layers.add("sum", values[given], values[other])
        columns = other[-1] if isinstance(other, tuple) and other[:1] == (...,) else None
        if node.target is operator.getitem and _is_plain(columns):
            size = columns.stop - columns.start
            return layers.add("slice", values[given], first=columns.start, size=size)
    if node.target in _JOIN and isinstance(given, (list, tuple)):
        joined = [values[one] for one in given if isinstance(one, fx.Node) and one in values]
        along = {*node.args[1:], *node.kwargs.values()}
        if along == {-1} and len(joined) == len(given):
            return layers.add("concatenate", *joined)
    name = getattr(node.target, "__name__", node.target)
    raise ExportError(
        f"a policy pack has no layer for {name} in forward() ({node.format_node()}): it has the layers of "
        "docs/policies.md, slices of the last dimension, torch.cat(..., -1), sums, ReLU and tanh; images are for "
        "encoders.Eyes"
    )


class _Tracer(fx.Tracer):
    """Follows a forward() down to the layers that Layers.module() is asked for."""

    def __init__(self, encoder: Encoder) -> None:
        super().__init__()
        self._encoder = encoder
        self._file = type(encoder).forward.__code__.co_filename
        self._lines: dict[fx.Node, int] = {}

    def follow(self) -> Optional[Exception]:
        """Makes `graph`; what it was cut off by, where it was."""
        try:
            self.trace(self._encoder)
        except Exception as error:  # torch.fx raises whatever the code does with what it is given
            return error
        return None

    def is_leaf_module(self, m: nn.Module, module_qualified_name: str) -> bool:
        if isinstance(m, nn.Sequential):
            return False
        return type(m).__module__.startswith(("torch.nn.", "galactic.learning."))

    def create_node(self, *arguments: Any, **keywords: Any) -> fx.Node:
        node = super().create_node(*arguments, **keywords)
        frames = (frame for frame, _ in traceback.walk_stack(None))
        own = (frame.f_lineno for frame in frames if frame.f_code.co_filename == self._file)
        line = next(own, None)
        if line is not None:
            self._lines[node] = line
        return node

    @contextlib.contextmanager
    def telling_line(self, node: fx.Node) -> Iterator[None]:
        """Around what may refuse a node: says where it is in the user's file."""
        try:
            yield
        except ExportError as error:
            line = self._lines.get(node)
            where = "" if line is None else f"{self._place(line)}: "
            raise ExportError(f"{where}{error}") from error

    def told(self, fault: Exception) -> str:
        """Why it could not go on."""
        frames = traceback.extract_tb(fault.__traceback__)
        own = [frame.lineno or 0 for frame in frames if frame.filename == self._file]
        where = f" in {self._place(own[-1])}" if own else ""
        # What else torch.fx stumbles over in itself tells nobody anything.
        is_said = isinstance(fault, fx.proxy.TraceError) or frames[-1].filename == self._file
        why = f" ({type(fault).__name__}: {fault})" if is_said else ""
        return (
            f"forward() cannot be followed{where}{why}: write it of layers alone, without conditions on what is seen, "
            "and without loops over it or its shape"
        )

    def _place(self, line: int) -> str:
        return f"line {line} of {pathlib.Path(self._file).name}"


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


def require_same(encoder: Encoder, inputs: Inputs, layers: Layers, seen: int) -> None:
    """Raises ExportError where the layers behind value `seen` are not what the network computes."""
    # Rows of a state have both signs.
    inputs = inputs._replace(state=4.0 * inputs.state - 2.0)
    with torch.no_grad():
        found = layer_values.value(layers.list, seen, inputs)
        wanted = encoder(inputs).flatten(0, 1)
    apart = float((found - wanted).abs().max()) if found.shape == wanted.shape else math.inf
    if not apart <= SAME * max(1.0, float(wanted.abs().max())):
        raise ExportError(
            f"the layers that were found in forward() make other features than it ({apart:.3g} apart on made-up "
            "inputs): write it of plain layers, none of which changes what another one reads"
        )
