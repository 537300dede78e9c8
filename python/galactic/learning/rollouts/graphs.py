"""CUDA graphs: the launches of a network, recorded once and then replayed as a whole."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence

import torch
from torch import Tensor

Tensors = tuple[Tensor | None, ...]
Function = Callable[..., Tensors]
Record = Callable[[Function, Tensors], tuple[Tensors, Callable[[], None]]]
"""Records a function of tensors at fixed addresses. Returns its results, also at fixed addresses,
and a function that computes them anew from the tensors' current contents."""


class Replayed:
    """A function of tensors with fixed shapes, which `record` records as a graph at the first call.

    A call copies its arguments to where the graph reads them; the next call overwrites its results.
    Parameters and buffers that the function reads must be changed in place, as optimizers do.
    """

    def __init__(self, function: Function, record: Record):
        self._function = function
        self._record = record
        self._places: Tensors = ()
        self._results: Tensors = ()
        self._replay: Callable[[], None] | None = None

    def prepare(self, *arguments: Tensor | None) -> None:
        """Records the function for arguments of these shapes, unless that is done."""
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
    """Records on the current CUDA device. The first calls, in which libraries choose their kernels
    and workspaces, run on a separate stream, as torch's documentation of CUDA graphs requires. In
    versions of torch before 2.1, use of the device by other threads spoils the recording."""
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
