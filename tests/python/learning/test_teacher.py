"""What a policy learns from another one: the divergence, whose columns are whose, and a toy that is not
learned otherwise."""

from __future__ import annotations

import contextlib
import dataclasses
import pathlib
from typing import Any

import pytest
import torch

from galactic.learning.encoders import Inputs
from galactic.learning.policies.distributions import ActionDistribution
from galactic.learning.policies.fitting import Observed
from galactic.learning.policies.networks import PolicyShape
from galactic.learning.ranks.distributed import Group
from galactic.learning.refusals import CheckpointError
from galactic.learning.rollouts.collector import Collector, CollectorOptions
from galactic.learning.rollouts.rollout import Rollout
from galactic.learning.saving.checkpoint import SavedPolicy, new_policy
from galactic.learning.settings import Settings
from galactic.learning.updates.ppo import PpoLearner
from galactic.learning.updates.schedules import teacher_weight_at
from galactic.learning.updates.teacher import Teacher
from toys import ReachAndGrasp

CPU = torch.device("cpu")
FILE = pathlib.Path("best.pt")
PARTS = [("way", 2), ("left", 1), ("noise", 1)]
SETTINGS = Settings(
    network="state",
    precision="fp32",
    width=32,
    normalize=True,
    log_std="parameter",
    envs=64,
    mini_batches=4,
    epochs=4,
    horizon=20,
    learning_rate=3e-3,
)


def distribution(seed: int, decides_terminate: bool = True) -> ActionDistribution:
    random = torch.Generator().manual_seed(seed)
    mean, log_std = (torch.randn(7, 5, 3, generator=random, dtype=torch.float64) for _ in range(2))
    logits = 2.0 * torch.randn(7, 5, 2, generator=random, dtype=torch.float64)
    return ActionDistribution(torch.tanh(mean), 0.5 * log_std, logits, decides_terminate)


def saved(parts: list[tuple[str, int]], motions: int = 2, **settings: Any) -> SavedPolicy:
    torch.manual_seed(3)
    made = dataclasses.replace(SETTINGS, normalize=False, **settings)
    shape = PolicyShape(sum(size for _, size in parts), motions, decides_terminate=False)
    return SavedPolicy(new_policy(made, shape), made, shape, parts, 0, None)


@pytest.mark.parametrize("of_teacher, of_learner", [(True, True), (True, False), (False, True)])
def test_the_divergence_is_that_of_torch(of_teacher: bool, of_learner: bool) -> None:
    from torch.distributions import Bernoulli, Normal, kl_divergence

    teacher, learner = distribution(1, of_teacher), distribution(2, of_learner)
    motions = kl_divergence(
        Normal(teacher.mean, teacher.log_std.exp()), Normal(learner.mean, learner.log_std.exp())
    ).sum(-1)
    decisions = kl_divergence(Bernoulli(logits=teacher.logits), Bernoulli(logits=learner.logits))
    both = of_teacher and of_learner
    expected = motions + (decisions.sum(-1) if both else decisions[..., 0])
    torch.testing.assert_close(teacher.divergence(learner), expected)
    assert expected.min() > 0.0
    torch.testing.assert_close(teacher.divergence(teacher), torch.zeros_like(expected))


def test_the_noise_is_the_learners_own() -> None:
    parts = [tensor.clone().requires_grad_() for tensor in distribution(2)[:3]]
    distribution(1).divergence(ActionDistribution(*parts, True)).sum().backward()
    mean, log_std, logits = parts
    assert log_std.grad is None
    assert mean.grad is not None and mean.grad.abs().min() > 0.0
    assert logits.grad is not None and logits.grad.abs().min() > 0.0


def test_a_teacher_reads_its_own_parts_of_what_is_observed() -> None:
    teacher = saved([("left", 1), ("way", 2)])
    rollout = Rollout.empty(6, 3, 4, 4)
    rollout.state.normal_()
    rollout.steps = 5
    found = Teacher(teacher, FILE, Observed(PARTS, {}, 2), Group.alone()).actions(rollout)
    own = rollout.state[:5][..., [2, 0, 1]]
    expected = teacher.policy(Inputs(own), None, rollout.starts[:5]).actions
    torch.testing.assert_close(found.mean, expected.mean)
    torch.testing.assert_close(found.logits, expected.logits)
    assert found.mean.shape == (5, 3, 2) and not found.mean.requires_grad
    some = found.of(torch.tensor([2, 0]))
    assert torch.equal(some.mean, found.mean[:, [2, 0]]) and some.logits.shape == (5, 2, 2)


@pytest.mark.parametrize(
    "parts, options, message",
    [
        (
            PARTS,
            {"recurrent": True},
            "best.pt has a memory, expected a teacher of the network state",
        ),
        (
            PARTS,
            {"network": "depth"},
            "best.pt has a camera, expected a teacher of the network state",
        ),
        (PARTS, {"motions": 3}, "best.pt decides 3 motions, found 2 in this run; give another"),
        (
            [*PARTS, ("map", 5)],
            {},
            "best.pt sees map, which this run does not observe; take the --task that gives it",
        ),
        (
            [*PARTS, ("laser", 5)],
            {},
            "best.pt sees laser, which this run does not observe; turn the sensor on",
        ),
        (
            [("way", 3)],
            {},
            "best.pt sees 3 numbers of way, found 2 in this run; give both the same",
        ),
    ],
)
def test_a_teacher_that_could_not_play_is_refused(
    parts: list[tuple[str, int]], options: dict[str, Any], message: str
) -> None:
    with pytest.raises(CheckpointError, match="give another --teacher") as refused:
        Teacher(saved(parts, **options), FILE, Observed(PARTS, {}, 2), Group.alone())
    assert str(refused.value).startswith(message)


LASER = [("laser", 4)]


@pytest.mark.parametrize(
    "parts, theirs, ours, critic_only, message",
    [
        (LASER, {"laser_fov": 270}, {"laser_fov": 270}, "", None),
        # As in files that do not say, or for a part that it does not look at.
        (LASER, {}, {"laser_fov": 270}, "", None),
        (PARTS, {"laser_fov": 270}, {"laser_fov": 180}, "", None),
        ([*PARTS, *LASER], {"laser_fov": 270}, {"laser_fov": 180}, "laser", None),
        (
            LASER,
            {"laser_beams": 8, "laser_noise": 0},
            {"laser_beams": 4, "laser_noise": 0.1},
            "",
            None,
        ),
        (LASER, {"laser_fov": 270}, {"laser_fov": 180}, "", "laser_fov=270, found 180 in"),
        (
            [*PARTS, *LASER],
            {"laser_fov": 270, "laser_heights": "robot"},
            {"laser_fov": 270, "laser_heights": "0.25"},
            "",
            "laser_heights=robot, found 0.25 in",
        ),
        (
            PARTS,
            {"observe_current": False},
            {"observe_current": True},
            "",
            "observe_current=False,",
        ),
    ],
)
def test_a_teacher_whose_numbers_mean_something_else_is_refused(
    parts: list[tuple[str, int]],
    theirs: dict[str, Any],
    ours: dict[str, Any],
    critic_only: str,
    message: str | None,
) -> None:
    made = dataclasses.replace(saved(parts, critic_only=critic_only), meanings=theirs)
    refusal = pytest.raises(CheckpointError, match=f"^best.pt learned with {message}")
    with refusal if message else contextlib.nullcontext():
        Teacher(made, FILE, Observed(parts, ours, 2), Group.alone())


class Blindfold(ReachAndGrasp):
    """The same, where nothing is paid."""

    def recv(self, half: int) -> Any:
        step = super().recv(half)
        return step._replace(rewards=0.0 * step.rewards)


def learned(teacher: Teacher | None, envs: ReachAndGrasp, settings: Settings, updates: int) -> Any:
    """The policy, and the losses and the success rate of each update."""
    torch.manual_seed(settings.seed)
    shape = PolicyShape(envs.state_size, envs.motions, False, settings.normalize)
    policy = new_policy(settings, shape)
    learner = PpoLearner(policy, settings, Group.alone(), teacher)
    options = CollectorOptions(settings.horizon, settings.seed, settings.gamma)
    collector = Collector(envs, policy, options, learner.precision, CPU)
    collector.reset()
    losses, rates = [], []
    for update in range(updates):
        rollout = collector.collect(update)
        losses.append(learner.update(rollout, update, update / updates))
        sums = collector.episodes
        rates.append(sums.successes / max(sums.episodes, 1.0))
    return policy, losses, rates


def test_a_policy_learns_what_its_teacher_would_do_where_no_reward_tells() -> None:
    policy, _, rates = learned(None, ReachAndGrasp(64, halves=2), SETTINGS, 35)
    assert sum(rates[-5:]) > 4.5
    shape = PolicyShape(4, 2, False, SETTINGS.normalize)
    made = SavedPolicy(policy, SETTINGS, shape, PARTS, 0, None)
    teacher = Teacher(made, FILE, Observed(PARTS, {}, 2), Group.alone())
    pupil = dataclasses.replace(SETTINGS, seed=2, teacher_share=0.8)
    _, losses, rates = learned(teacher, Blindfold(64, halves=2), pupil, 30)
    taught = [one["teacher_kl"] for one in losses if "teacher_kl" in one]
    # The weight is 0 in the last fifth.
    assert len(taught) == 24 and "teacher_kl" not in losses[-1]
    assert taught[-1] < 0.5 * taught[0]
    assert sum(rates[-5:]) > 3.0, rates
    _, losses, rates = learned(None, Blindfold(64, halves=2), pupil, 15)
    assert sum(rates[-5:]) < 1.5 and "teacher_kl" not in losses[0]


def test_the_weight_of_a_teacher_goes_down_to_nothing() -> None:
    settings = Settings(teacher_weight=2.0, teacher_share=0.5)
    weights = [teacher_weight_at(settings, progress) for progress in (0.0, 0.25, 0.4, 0.5, 1.0)]
    assert weights == pytest.approx([2.0, 1.0, 0.4, 0.0, 0.0])
    assert teacher_weight_at(Settings(teacher_share=0.0), 0.0) == 0.0
    assert teacher_weight_at(Settings(teacher_share=1.0), 0.75) == pytest.approx(0.25)
