"""Converts encoders to layers of a policy pack: built-in ones by their known structure, the user's
by tracing them with torch.fx."""

from __future__ import annotations

import contextlib
import operator
import pathlib
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeGuard

import torch
from torch import Tensor, fx, nn
from torch.nn import functional

from galactic.learning.encoders import Encoder, Eyes, ResNet, SimpleCNN, StateEncoder
from galactic.learning.packs.layers import LARGEST, ExportError, Layers, computes_as
from galactic.learning.sequences import run_gru

PLAIN_LAYERS = "write forward() of plain layers, none of which changes what another one reads"
"""The remedy if the traced layers compute something else than the module."""
_RELU = (torch.relu, functional.relu, "relu")
_TANH = (torch.tanh, functional.tanh, "tanh")
_SUM = (operator.add, torch.add, "add")
_DIFFERENCE = (operator.sub, torch.sub, "sub")
_PRODUCT = (operator.mul, torch.mul, "mul")
_RATIO = (operator.truediv, torch.div, "div")
_CLAMP = (torch.clamp, "clamp")
_CHUNK = (torch.chunk, "chunk")
_JOIN = (torch.cat, torch.concat)


def encoded(layers: Layers, encoder: Any, seen: int) -> int:
    """Adds the layers of an encoder, which reads layer `seen` and images; returns the layer of its
    features."""
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
    """Adds the layers of a user-defined encoder, traced with torch.fx."""
    made = followed(layers, encoder, seen)
    features = beside_memory(made) if encoder.memory else made
    if not isinstance(features, int):
        raise ExportError("forward() returns something else than features of what is seen")
    return features


def beside_memory(made: Any) -> Any:
    """What a forward() with a memory returns besides that memory, given the result of followed().
    Raises ExportError if the memory is not that of a GRU, the only kind that a pack has."""
    if not isinstance(made, tuple) or len(made) != 2 or made[1] is not AFTER:
        raise ExportError("forward() returns another memory than run_gru(): return that")
    return made[0]


def followed(layers: Layers, module: nn.Module, seen: int, tried_with: Sequence[Any] = ()) -> Any:
    """Traces forward() of a user-defined module with torch.fx. Returns what forward() returns, with
    layer numbers in place of what depends on the inputs, tensors in place of constants, and AFTER
    in place of the memory that run_gru() returns. `tried_with`: example arguments of forward(),
    from which sizes are measured; arithmetic with single numbers needs them."""
    _require_no_hooks(module)
    tracer = _Tracer(module)
    fault = tracer.follow()
    needed = tracer.needed()
    for node in tracer.graph.nodes:
        if node.op == "call_module" and (node in needed or fault is not None):
            with tracer.telling_line(node):
                _require_layer(module.get_submodule(str(node.target)))
    if fault is not None:
        raise ExportError(tracer.told(fault)) from fault
    found = _Followed(layers, tracer, seen, tracer.measured(tried_with) if tried_with else {})
    for node in tracer.graph.nodes:
        if node.op == "output":
            return found.of(node.args[0])
        if node in needed and node.op.startswith(("call", "get")) and not _is_image(node):
            with tracer.telling_line(node):
                found.values[node] = found.made_by(node)
    raise ExportError("forward() returns nothing")


def _require_layer(module: nn.Module) -> None:
    """Raises ExportError for a module that cannot be expressed in layers."""
    Layers().module(module.layers if isinstance(module, Eyes) else module, 0)


AFTER = "the memory after the last step"


class _Part(NamedTuple):
    """A range of the last dimension, which becomes a layer only when it is read."""

    x: int
    first: int
    size: int


class _Followed:
    """Converts the nodes of a graph to layers: `values` maps each node to the number of a layer, or
    to a tensor if the node is constant."""

    def __init__(self, layers: Layers, tracer: _Tracer, seen: int, sizes: Mapping[fx.Node, int]):
        self.values: dict[fx.Node, Any] = {}
        self._layers = layers
        self._tracer = tracer
        self._seen = seen
        self._sizes = sizes

    def of(self, argument: Any) -> Any:
        """An argument of a node, with its nodes replaced by their values."""
        return fx.node.map_arg(argument, lambda node: self.values.get(node, node))

    def made_by(self, node: fx.Node) -> Any:
        """The value of a node: one operation of a forward()."""
        if node.op == "call_module":
            return self._by_module(node)
        if node.op == "get_attr":
            return self._tracer.attribute(str(node.target))
        if node.target is getattr and node.args[1] == "state":
            return self._seen
        if node.target is getattr and node.args[1] == "previous":
            return self._layers.add("previous_action")
        if isinstance(node.target, type) and issubclass(node.target, tuple):
            return node.target(*self.of(node.args), **self.of(node.kwargs))
        if node.target is run_gru:
            return self._gru(node)
        read = [self.values.get(one) for one in node.all_input_nodes]
        if read and all(isinstance(one, Tensor) for one in read):
            return self._constant(node)
        made = self._by_function(node)
        if made is None:
            raise self._unknown(node)
        return made

    def _by_module(self, node: fx.Node) -> int:
        module = self._tracer.root.get_submodule(str(node.target))
        if isinstance(module, Eyes):
            return self._layers.module(module.layers, self._layers.add("image"))
        (made,) = node.all_input_nodes if len(node.all_input_nodes) == 1 else (node,)
        if not _is_layer(self.values.get(made)):
            raise self._unknown(node)
        _require_unshared(node, made, getattr(module, "inplace", False))
        return self._layers.module(module, self.values[made])

    def _by_function(self, node: fx.Node) -> Any:
        """The value of a node that calls a function or method; None if no layer can express it."""
        layers = self._layers
        given: Any = node.args[0] if node.args else None
        x = self.of(given)
        other = self.of(node.args[1]) if len(node.args) > 1 else None
        if (
            node.target in (*_RELU, *_TANH)
            and {*node.kwargs} <= {"inplace"}
            and _is_layer(x, given)
        ):
            in_place = node.kwargs.get("inplace", False) or len(node.args) > 1
            _require_unshared(node, given, in_place)
            return layers.add("relu" if node.target in _RELU else "tanh", x)
        if node.target in _CLAMP and _is_layer(x, given):
            return self._clamp(x, *node.args[1:], **node.kwargs)
        if node.target in (*_SUM, *_DIFFERENCE, *_PRODUCT, *_RATIO) and len(node.args) == 2:
            return None if node.kwargs else self._arithmetic(node, x, other)
        if node.target is operator.getitem and isinstance(x, tuple) and isinstance(other, int):
            part = x[other]
            return self._part(*part) if isinstance(part, _Part) else part
        if node.target is operator.getitem and _is_layer(x, given) and isinstance(other, tuple):
            return self._slice(x, self._sizes.get(given), *other)
        if node.target in _CHUNK and _is_layer(x, given):
            return self._chunks(x, self._sizes.get(given), *node.args[1:], **node.kwargs)
        if node.target in _JOIN and isinstance(given, (list, tuple)):
            along = {*node.args[1:], *node.kwargs.values()}
            if along == {-1} and all(map(_is_layer, x, given)):
                return layers.add("concatenate", *x)
        return None

    def _arithmetic(self, node: fx.Node, x: Any, other: Any) -> int | None:
        """Arithmetic on two values, or on a value and a constant in either order."""
        one, two = node.args
        if _is_layer(x, one) and _is_layer(other, two):
            return self._layers.add("sum", x, other) if node.target in _SUM else None
        is_first = _is_layer(x, one)
        value, constant = (x, other) if is_first else (other, x)
        variable = one if is_first else two
        if not _is_layer(value, variable) or isinstance(constant, (bool, fx.Node)):
            return None
        if not isinstance(constant, (int, float, Tensor)):
            return None
        numbers = self._spread(constant, variable)
        if numbers is None or (node.target in _RATIO and not is_first):
            return None
        zeros, ones = torch.zeros_like(numbers), torch.ones_like(numbers)
        if node.target in _PRODUCT:
            return self._layers.scaled(value, zeros, numbers)
        if node.target in _RATIO:
            return self._layers.scaled(value, zeros, 1.0 / numbers)
        if node.target in _SUM:
            return self._layers.scaled(value, -numbers, ones)
        return self._layers.scaled(value, numbers, ones if is_first else -ones)

    def _spread(self, constant: float | Tensor, variable: Any) -> Tensor | None:
        """A constant, expanded to the size of `variable`; None if it does not fit."""
        numbers = torch.as_tensor(constant, dtype=torch.float32).detach()
        size = self._sizes.get(variable, numbers.numel() if numbers.dim() else 0)
        if not size or numbers.numel() not in (1, size) or numbers.shape[:-1].numel() != 1:
            return None
        return numbers.flatten().expand(size)

    def _slice(self, x: int, size: int | None, *index: Any) -> int | None:
        """A range of the last dimension."""
        columns = index[-1]
        if index[:-1] != (...,) or not isinstance(columns, slice) or columns.step not in (None, 1):
            return None
        first, end = 0 if columns.start is None else columns.start, columns.stop
        if not isinstance(first, int) or not isinstance(end, (int, type(None))):
            return None
        if size is not None:
            first, end, _ = columns.indices(size)
        if end is None or not 0 <= first < end:
            return None
        return self._part(x, first, end - first)

    def _part(self, x: int, first: int, size: int) -> int:
        return self._layers.add("slice", x, first=first, size=size)

    def _chunks(
        self, x: int, size: int | None, chunks: Any, dim: Any = 0
    ) -> tuple[_Part, ...] | None:
        """Parts of the last dimension, of equal size except the last. The names of the parameters
        are torch's."""
        if size is None or dim != -1 or not isinstance(chunks, int):
            return None
        width = -(-size // chunks)
        firsts = range(0, size, width)
        return tuple(_Part(x, first, min(width, size - first)) for first in firsts)

    def _clamp(self, x: int, min: Any = None, max: Any = None) -> int | None:
        """A clamp. The names of the limits are torch's."""
        lower, upper = -LARGEST if min is None else min, LARGEST if max is None else max
        if not isinstance(lower, (int, float)) or not isinstance(upper, (int, float)):
            return None
        return self._layers.add("clamp", x, lower=float(lower), upper=float(upper))

    def _constant(self, node: fx.Node) -> Any:
        """The value of a constant node, computed by torch."""
        arguments, keywords = self.of(node.args), self.of(node.kwargs)
        work: Callable[..., Any]
        if node.op == "call_method":
            arguments, work = arguments[1:], getattr(arguments[0], str(node.target))
        elif callable(node.target):
            work = node.target
        with torch.no_grad():
            return work(*arguments, **keywords)

    def _gru(self, node: fx.Node) -> tuple[int, str]:
        given = [*node.args, *node.kwargs.values()]
        names = dict(zip(("rnn", "inputs", "hidden", "starts"), node.args), **node.kwargs)
        nodes = self._tracer.graph.nodes
        # The arguments of forward() after the inputs.
        ahead = [one for one in nodes if not one.op.startswith(("call", "get", "output"))][1:]
        rnn, x = self.of(names["rnn"]), self.of(names["inputs"])
        if len(given) != 4 or [names["hidden"], names["starts"]] != ahead:
            raise ExportError(
                "run_gru() gets something else than the memory and the starts that forward(inputs, memory, starts) "
                "was given: pass them on as they are"
            )
        if not computes_as(rnn, nn.GRU) or not _is_layer(x, names["inputs"]):
            raise self._unknown(node)
        if any(layer["kind"] == "gru" for layer in self._layers.list):
            raise ExportError("forward() runs more than one GRU: keep one")
        return self._layers.gru(rnn, x), AFTER

    def _unknown(self, node: fx.Node) -> ExportError:
        name = getattr(node.target, "__name__", node.target)
        return ExportError(
            f"a policy pack has no layer for {name} in forward() ({node.format_node()}): it has the layers of "
            "docs/policies.md, slices of the last dimension, torch.cat(..., -1), sums, products with constants, clamps, "
            "ReLU and tanh; images are for encoders.Eyes"
        )


class _Proxy(fx.Proxy):
    """A proxy that is unpacked by its tracer. Torch 1.13's own inspects the calling byte code,
    which is different from Python 3.11 on."""

    def __iter__(self) -> Iterator[Any]:
        return self.tracer.iter(self)


class _Tracer(fx.Tracer):
    """Traces a forward() down to the modules that Layers.module() converts."""

    def __init__(self, module: nn.Module) -> None:
        super().__init__(autowrap_functions=(run_gru,))
        self._module = module
        self._file = type(module).forward.__code__.co_filename
        self._lines: dict[fx.Node, int] = {}
        self._constants: dict[str, Any] = {}

    def follow(self) -> Exception | None:
        """Traces into `graph`. Returns the exception that cut it off, or None."""
        before = {*vars(self._module)}
        try:
            self.trace(self._module)
        except Exception as error:  # the traced code may raise anything when it gets proxies
            return error
        finally:
            # torch.fx leaves constants in the module, which is the user's; take them out again.
            members = vars(self._module)
            self._constants = {name: members.pop(name) for name in {*members} - before}
        return None

    def needed(self) -> set[fx.Node]:
        """The nodes that the result of forward() depends on, and those that may change it in place.
        This excludes a critic beside the actor."""
        needed: set[fx.Node] = set()
        for node in reversed(self.graph.nodes):
            if node.op == "output" or node in needed or self._is_in_place(node):
                needed.update([node, *node.all_input_nodes])
        return needed

    def _is_in_place(self, node: fx.Node) -> bool:
        if node.op == "call_module":
            return bool(getattr(self._module.get_submodule(str(node.target)), "inplace", False))
        name = str(getattr(node.target, "__name__", node.target))
        is_named = name.endswith("_") and not name.endswith("__")
        return is_named or bool(node.kwargs.get("inplace")) or node.target is operator.setitem

    def attribute(self, target: str) -> Any:
        """What a get_attr node reads: a module, or a copy of a tensor, since the graph may change
        it in place."""
        found: Any = self._constants.get(target, self._module)
        if found is self._module:
            for name in target.split("."):
                found = getattr(found, name)
        return found.detach().clone() if isinstance(found, Tensor) else found

    def measured(self, arguments: Sequence[Any]) -> dict[fx.Node, int]:
        """The last dimension of each node's value, measured with these arguments of forward()."""
        sizes: dict[str, int] = {}

        class Measuring(fx.Interpreter):
            def run_node(self, n: fx.Node) -> Any:
                made = super().run_node(n)
                if isinstance(made, Tensor) and made.dim():
                    sizes[n.name] = made.shape[-1]
                return made

        vars(self._module).update(self._constants)
        try:
            runnable = fx.GraphModule(self._module, self.graph)
        finally:
            for name in self._constants:
                del vars(self._module)[name]
        with torch.no_grad():
            Measuring(runnable).run(*arguments)
        return {node: sizes[node.name] for node in self.graph.nodes if node.name in sizes}

    def proxy(self, node: fx.Node) -> fx.Proxy:
        return _Proxy(node, self)

    def iter(self, obj: fx.Proxy) -> Iterator[Any]:
        if obj.node.target is run_gru:
            return self._items(obj, 2)
        chunks = obj.node.args[1] if obj.node.target in _CHUNK and len(obj.node.args) > 1 else None
        return self._items(obj, chunks) if isinstance(chunks, int) else super().iter(obj)

    def _items(self, obj: fx.Proxy, count: int) -> Iterator[Any]:
        numbers = range(count)
        return iter(
            [self.create_proxy("call_function", operator.getitem, (obj, n), {}) for n in numbers]
        )

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
        """A context for work on a node: adds its place in the user's file to an ExportError."""
        try:
            yield
        except ExportError as error:
            line = self._lines.get(node)
            where = "" if line is None else f"{self._place(line)}: "
            raise ExportError(f"{where}{error}") from error

    def told(self, fault: Exception) -> str:
        """The message for an exception that ended tracing."""
        frames = traceback.extract_tb(fault.__traceback__)
        own = [frame.lineno or 0 for frame in frames if frame.filename == self._file]
        where = f" in {self._place(own[-1])}" if own else ""
        # Exceptions from within torch.fx mean nothing to the user, except a TraceError.
        is_said = isinstance(fault, fx.proxy.TraceError) or frames[-1].filename == self._file
        why = f" ({type(fault).__name__}: {fault})" if is_said else ""
        return (
            f"forward() cannot be followed{where}{why}: write it of layers alone, without conditions on what is seen, "
            "and without loops over it or its shape"
        )

    def _place(self, line: int) -> str:
        return f"line {line} of {pathlib.Path(self._file).name}"


def _is_layer(value: Any, of: Any = None) -> TypeGuard[int]:
    """Whether a value is the number of a layer, and not a literal number in forward(): `of` is the
    argument that it was read from."""
    return isinstance(value, int) and (of is None or isinstance(of, fx.Node))


def _is_image(node: fx.Node) -> bool:
    """Whether a node reads a picture. Such nodes are skipped, as the layer of Eyes reads the
    image."""
    return node.target is getattr and node.args[1] in ("rgb", "depth")


def _require_no_hooks(encoder: nn.Module) -> None:
    """Raises ExportError if hooks run around a forward(), or if an instance has its own: layers
    would not include them."""
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
    """Raises ExportError if an operation may change in place what other nodes read: layers never
    change their inputs."""
    if in_place and (len(given.users) > 1 or given.target in (getattr, operator.getitem)):
        raise ExportError(
            f"{node.target} in forward() works in place on what is read elsewhere ({node.format_node()}): leave "
            "inplace=True out"
        )
