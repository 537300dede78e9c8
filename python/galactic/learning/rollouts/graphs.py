"""CUDA graphs: what a network launches, recorded once and replayed as one."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence

import torch
from torch import Tensor

Tensors = tuple[Tensor | None, ...]
Function = Callable[..., Tensors]
Record = Callable[[Function, Tensors], tuple[Tensors, Callable[[], None]]]
"""Runs a function on tensors that stay where they are. Returns its results, which stay where they are as
well, and what computes them again from what the tensors hold then."""


class Replayed:
    """A function of tensors of always the same shapes, which `record` keeps as a graph at the first call.

    A call copies its arguments to where the graph reads them; its results are overwritten by the next call.
    Parameters and buffers that the function reads have to be changed in place, as optimizers do.
    """

    def __init__(self, function: Function, record: Record):
        self._function = function
        self._record = record
        self._places: Tensors = ()
        self._results: Tensors = ()
        self._replay: Callable[[], None] | None = None

    def prepare(self, *arguments: Tensor | None) -> None:
        """Records what it does of such arguments, unless it has."""
        if self._replay is None:
            self._places = tuple(None if one is None else one.clone() for one in arguments)
            self._results, self._replay = self._record(self._function, self._places)

    def __call__(self, *arguments: Tensor | None) -> Tensors:
        self.prepare(*arguments)
        assert self._replay is not None
        self._place(arguments)
        self._replay()
        return self._results

    def _place(self, arguments: Sequence[Tensor | None]) -> None:
        if len(arguments) != len(self._places):
            raise ValueError(f"{len(arguments)} arguments, recorded with {len(self._places)}")
        for number, (place, argument) in enumerate(zip(self._places, arguments)):
            if (place is None) != (argument is None):
                raise ValueError(f"argument {number} is there once and not the other time")
            if place is None or argument is None:
                continue
            if place.shape != argument.shape or place.dtype != argument.dtype:
                raise ValueError(
                    f"argument {number} is {argument.dtype} {tuple(argument.shape)}, recorded with "
                    f"{place.dtype} {tuple(place.shape)}"
                )
            place.copy_(argument)


def record_cuda(function: Function, places: Tensors) -> tuple[Tensors, Callable[[], None]]:
    """Records on the current CUDA device. Libraries choose their kernels and workspaces in the first calls, on
    a stream of their own, as torch's documentation of CUDA graphs asks for. What other threads do on the
    device meanwhile spoils it in versions of torch before 2.1."""
    warming = torch.cuda.Stream()
    warming.wait_stream(torch.cuda.current_stream())
    with torch.cuda.stream(warming):
        for _ in range(3):
            function(*places)
    torch.cuda.current_stream().wait_stream(warming)
    graph = torch.cuda.CUDAGraph()
    has_modes = "capture_error_mode" in inspect.signature(torch.cuda.graph).parameters
    mode = {"capture_error_mode": "thread_local"} if has_modes else {}
    with torch.cuda.graph(graph, **mode):
        results = function(*places)
    return results, graph.replay
