"""What learners of both kinds do with a policy. What they learn: test_ppo.py and test_imitation.py."""

from __future__ import annotations

import dataclasses

import pytest
import torch

from galactic.learning.encoders import Inputs
from galactic.learning.policies.networks import Policy, PolicyShape, make_policy
from galactic.learning.ranks.distributed import Group
from galactic.learning.rollouts.collector import Collector, CollectorOptions
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.sums import Sums, over_ranks
from galactic.learning.updates.flat_adam import FlatAdam
from galactic.learning.updates.learner import Learner
from galactic.learning.updates.ppo import PpoLearner
from toys import Look
from trainers import SETTINGS, UPDATE, make_trainer


def test_parameters_of_any_strides_stay_what_they_are_and_apart() -> None:
    numbers = torch.arange(1.0, 65.0)
    made = {
        "sliced": numbers.view(4, 16)[:, :5],
        "expanded": numbers[:1].expand(2, 3),
        "strided": numbers[::7],
        "transposed": numbers[:12].view(3, 4).T,
        "channels_last": numbers.view(4, 4, 2, 2).to(memory_format=torch.channels_last),
        "last": numbers.view(8, 8)[:, 2:4],
    }
    module = torch.nn.ParameterDict({name: torch.nn.Parameter(one) for name, one in made.items()})
    before = {name: one.clone() for name, one in made.items()}
    optimizer = FlatAdam(module, 1e-3, 1e-5)
    places: list[int] = []
    for name, parameter in module.items():
        assert torch.equal(parameter, before[name]), name
        parameter.grad.copy_(before[name])
        numbered = torch.arange(optimizer.parameters.numel())
        places += numbered.as_strided(
            parameter.shape, parameter.stride(), parameter.storage_offset()
        ).flatten()
    assert sorted(map(int, places)) == list(range(optimizer.parameters.numel()))
    # The gradients lie as the parameters do.
    assert torch.equal(optimizer.gradients, optimizer.parameters)
    assert module["channels_last"].is_contiguous(memory_format=torch.channels_last)
    assert not module["channels_last"].is_contiguous()


@pytest.mark.parametrize("most_norm, share", [(0.0, 1.0), (2.5, 0.5), (10.0, 1.0)])
def test_longer_gradients_are_clipped_where_there_is_a_limit(
    most_norm: float, share: float
) -> None:
    module = torch.nn.ParameterList([torch.nn.Parameter(torch.zeros(2))])
    optimizer = FlatAdam(module, 1e-3, 1e-5)
    module[0].grad.copy_(torch.tensor([3.0, 4.0]))
    assert optimizer.step(most_norm).item() == 5.0
    assert optimizer.gradients.tolist() == pytest.approx([3.0 * share, 4.0 * share], rel=1e-6)
    # Adam's first step is as long as the rate, in each direction in which there is a gradient.
    assert module[0].tolist() == pytest.approx([-1e-3, -1e-3], rel=1e-4)


def test_sums_are_told_apart_by_name() -> None:
    sums = Sums()
    assert sums.by_name() == {}
    for number in (2.0**24, 1.0, 1.0):
        sums.add({"first": torch.tensor(number), "second": torch.tensor(-number)})
    found = over_ranks(Group.alone(), {**sums.by_name(), "third": 3, "is_it": True})
    # In float32, 2^24 + 1 is 2^24.
    assert found == {"first": 2.0**24 + 2, "second": -(2.0**24) - 2, "third": 3.0, "is_it": 1.0}
    with pytest.raises(AssertionError):
        sums.add({"second": torch.tensor(1.0), "first": torch.tensor(1.0)})


def validate(policy: Policy) -> EpisodeSums:
    """As validations leave a policy."""
    policy.eval()
    return EpisodeSums(episodes=1.0)


@pytest.mark.parametrize("recurrent", [False, True])
def test_a_policy_learns_in_the_mode_for_it_and_acts_in_the_other(recurrent: bool) -> None:
    settings = dataclasses.replace(
        SETTINGS, steps=3 * UPDATE, validate_every=UPDATE, recurrent=recurrent
    )
    trainer = make_trainer(None, settings, validation=validate)
    modes: list[tuple[bool, bool]] = []
    trainer.policy.register_forward_hook(
        lambda policy, *_: modes.append((torch.is_grad_enabled(), policy.training))
    )
    trainer.begin()
    trainer.train()
    updates = [is_training for has_gradients, is_training in modes if has_gradients]
    assert len(updates) == 3 * settings.epochs * settings.mini_batches and all(updates)
    assert not any(is_training for has_gradients, is_training in modes if not has_gradients)


@pytest.mark.parametrize("limit, way_out", [(-5.0, 1.0), (2.0, -1.0)])
def test_a_deviation_comes_back_from_its_limit(limit: float, way_out: float) -> None:
    shape = PolicyShape(state=4, motions=2)
    policy = make_policy("state", shape, width=8, initial_log_std=limit)
    learner = Learner(policy, SETTINGS, Group.alone())
    log_std = policy.action.log_std
    assert log_std is not None
    seen = Inputs(torch.zeros(1, 1, 4))
    starts = torch.zeros(1, 1, dtype=torch.bool)

    def push(direction: float) -> None:
        learner.optimizer.clear()
        learner._descend(-direction * policy(seen, None, starts).actions.log_std.sum())

    for _ in range(20):
        push(-way_out)
        assert log_std.tolist() == [limit, limit]
    for _ in range(20):
        push(way_out)
    # Adam remembers the way there for some steps.
    assert (way_out * (log_std - limit) > SETTINGS.learning_rate).all()
    # The optimizer's flat parameters are the same memory.
    assert log_std[0].item() in learner.optimizer.parameters.tolist()


@pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU")
@pytest.mark.parametrize("precision", ["fp32", "tf32", "bf16"])
def test_a_gpu_teaches_a_memory(precision: str) -> None:
    gpu = torch.device("cuda")
    settings = dataclasses.replace(
        SETTINGS, network="depth", image_size=Look.EDGE, recurrent=True, precision=precision
    )
    envs = Look(settings.envs, halves=2)
    shape = PolicyShape(envs.state_size, envs.motions, False, settings.normalize)
    policy = make_policy("depth", shape, image_size=Look.EDGE, recurrent=True, width=16).to(gpu)
    learner = PpoLearner(policy, settings, Group(0, 1, gpu))
    options = CollectorOptions(settings.horizon, settings.seed, settings.gamma)
    collector = Collector(envs, policy, options, learner.precision, gpu)
    collector.reset()
    before = learner.optimizer.parameters.detach().clone()
    for update in range(3):
        losses = learner.update(collector.collect(update), update, 0.0)
        assert all(abs(loss) < float("inf") for loss in losses.values()), losses
    assert not torch.equal(learner.optimizer.parameters, before)
