"""Recorded policies decide as they do otherwise; with a GPU, as CUDA graphs."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any
from unittest import mock

import pytest
import torch
from torch import Tensor

from galactic.learning.policies.networks import PolicyShape, make_policy
from galactic.learning.rollouts.collector import Collector, CollectorOptions
from galactic.learning.rollouts.graphs import Function, Replayed, Tensors, record_cuda
from galactic.learning.updates.precision import Precision
from toys import ReachAndGrasp


def record_here(function: Function, places: Tensors) -> tuple[Tensors, Callable[[], None]]:
    """What record_cuda does, for processors: fixed places for arguments and results."""
    results = tuple(None if one is None else one.clone() for one in function(*places))

    def replay() -> None:
        for place, one in zip(results, function(*places)):
            if place is not None:
                place.copy_(one)

    return results, replay


def rollouts(device: torch.device, recurrent: bool, record: object) -> list[dict[str, Tensor]]:
    """Two in a row, the second with other parameters, of two halves."""
    torch.manual_seed(5)
    envs = ReachAndGrasp(16, halves=2)
    shape = PolicyShape(envs.state_size, envs.motions, False, normalize=True)
    policy = make_policy("state", shape, recurrent=recurrent, width=16).to(device)
    options = CollectorOptions(horizon=12, seed=3, gamma=0.99)
    collector = Collector(envs, policy, options, Precision("fp32", device), device)
    if record is not None:
        collector._decisions = [Replayed(collector._decide, record) for _ in envs.halves]
    collector.reset()
    kept = []
    for update in range(2):
        rollout = collector.collect(update)
        names = ("actions", "log_probs", "values", "rewards", "ends")
        kept.append({name: getattr(rollout, name).clone() for name in names})
        with torch.no_grad():
            for parameter in policy.parameters():
                parameter.add_(0.05)
    return kept


def the_same(one: dict[str, Tensor], other: dict[str, Tensor], tolerance: float) -> None:
    for name, values in one.items():
        torch.testing.assert_close(values, other[name], rtol=0.0, atol=tolerance, msg=name)


@pytest.mark.parametrize("recurrent", [False, True])
def test_a_replayed_policy_decides_the_same(recurrent: bool) -> None:
    cpu = torch.device("cpu")
    plain, replayed = rollouts(cpu, recurrent, None), rollouts(cpu, recurrent, record_here)
    assert not torch.equal(plain[0]["log_probs"], plain[1]["log_probs"])
    for one, other in zip(plain, replayed):
        the_same(one, other, 0.0)


def test_graphs_are_recorded_while_no_half_is_under_way() -> None:
    done: list[str] = []

    class Listening(ReachAndGrasp):
        def send(self, *call: Any) -> None:
            done.append("sent")
            super().send(*call)

    def record(function: Function, places: Tensors) -> tuple[Tensors, Callable[[], None]]:
        done.append("recorded")
        return record_here(function, places)

    envs = Listening(16, halves=2)
    policy = make_policy("state", PolicyShape(envs.state_size, envs.motions, False), width=16)
    cpu = torch.device("cpu")
    options = CollectorOptions(horizon=3, seed=3, gamma=0.99)
    collector = Collector(envs, policy, options, Precision("fp32", cpu), cpu)
    collector._decisions = [Replayed(collector._decide, record) for _ in envs.halves]
    collector.reset()
    for update in range(2):
        collector.collect(update)
    assert done == 2 * ["recorded"] + 2 * 2 * 3 * ["sent"]


@pytest.mark.parametrize("mode", [None, "thread_local"])
def test_other_threads_may_use_the_device_while_a_graph_is_recorded(
    monkeypatch: pytest.MonkeyPatch, mode: str | None
) -> None:
    """Where torch can do it. It is a torch without a device here, of either kind."""
    captured: list[str | None] = []

    class Graph:
        def replay(self) -> None:
            pass

    @contextlib.contextmanager
    def graph(cuda_graph: Graph, capture_error_mode: str = "global") -> Iterator[None]:
        captured.append(capture_error_mode)
        yield

    @contextlib.contextmanager
    def older_graph(cuda_graph: Graph) -> Iterator[None]:
        captured.append(None)
        yield

    monkeypatch.setattr(torch.cuda, "Stream", mock.Mock())
    monkeypatch.setattr(torch.cuda, "current_stream", mock.Mock())
    monkeypatch.setattr(torch.cuda, "stream", contextlib.nullcontext)
    monkeypatch.setattr(torch.cuda, "CUDAGraph", Graph)
    monkeypatch.setattr(torch.cuda, "graph", graph if mode else older_graph)
    doubled, replay = record_cuda(lambda x: (2 * x,), (torch.ones(1),))
    replay()
    assert captured == [mode] and torch.equal(doubled[0], torch.full((1,), 2.0))


@pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU")
@pytest.mark.parametrize("recurrent", [False, True])
def test_a_graph_decides_the_same(recurrent: bool) -> None:
    gpu = torch.device("cuda")
    plain, replayed = rollouts(gpu, recurrent, None), rollouts(gpu, recurrent, record_cuda)
    for one, other in zip(plain, replayed):
        the_same(one, other, 1e-4)


def test_other_shapes_are_refused() -> None:
    doubled = Replayed(lambda x, y: (2 * x, y), record_here)
    assert doubled(torch.ones(3), None)[0].tolist() == [2.0, 2.0, 2.0]
    assert doubled(torch.full((3,), 4.0), None)[0].tolist() == [8.0, 8.0, 8.0]
    for wrong in ((torch.ones(4), None), (torch.ones(3), torch.ones(1)), (torch.ones(3),)):
        with pytest.raises(ValueError):
            doubled(*wrong)
    with pytest.raises(ValueError, match="float64"):
        doubled(torch.ones(3, dtype=torch.float64), None)
