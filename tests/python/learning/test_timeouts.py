"""What an episode that time cuts off is worth from there on: --timeouts."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
import torch
from torch import Tensor

from galactic.learning.encoders import Inputs
from galactic.learning.rollouts.environments import Step
from galactic.learning.rollouts.rollout import Rollout
from toys import ReachAndGrasp
from trainers import SETTINGS, make_trainer

TIME = [2]
"""The column of a toy's time."""


class Timed(ReachAndGrasp):
    """The same with names for what is observed, which keeps what it says of steps."""

    parts = [("way", 2), ("time", 1), ("noise", 1)]
    measures = ()

    def __init__(self, count: int, halves: int = 1):
        super().__init__(count, halves=halves, limit=3)
        self.said: list[tuple[slice, Step]] = []

    def recv(self, half: int) -> Step:
        step = super().recv(half)
        self.said.append((self.halves[half], step))
        return step


def collected(
    timeouts: str, recurrent: bool, tunes: bool = False
) -> tuple[Rollout, Timed, list[Tensor], list[Tensor]]:
    """A rollout, its environments, and the rows whose values were asked for after it, and these. `tunes`: as on a
    GPU."""
    settings = dataclasses.replace(SETTINGS, timeouts=timeouts, recurrent=recurrent)
    trainer = make_trainer(None, settings, Timed)
    trainer.learner.precision.tunes = tunes
    policy, asked, given = trainer.policy, [], []
    value = policy.value

    def listening(inputs: Inputs, *more: Any) -> Tensor:
        asked.append(inputs.state.clone())
        given.append(value(inputs, *more))
        return given[-1]

    policy.value = listening  # type: ignore[method-assign]
    trainer.begin()
    return trainer.source.collect(0), trainer.envs, asked[1:], given[1:]


@pytest.mark.parametrize("recurrent", [False, True])
@pytest.mark.parametrize("timeouts", ["observed", "endless"])
def test_values_are_asked_for_as_the_setting_says(timeouts: str, recurrent: bool) -> None:
    rollout, envs, asked, given = collected(timeouts, recurrent)
    cut = [(part, step) for part, step in envs.said if step.timeouts is not None]
    last = torch.from_numpy(np.concatenate([step.timeouts.state for _, step in cut]))
    assert len(asked) == 1 and len(last) > 10
    rows = asked[0][0]
    others = [column for column in range(rows.shape[1]) if column not in TIME]
    assert torch.equal(rows[:, others], last[:, others])
    assert (last[:, TIME] == 0.0).all()
    assert (rows[:, TIME] == (1.0 if timeouts == "endless" else 0.0)).all()
    values, first = given[0][0], 0
    for number, (part, step) in enumerate(envs.said):
        expected = torch.from_numpy(step.rewards.copy())
        if step.timeouts is not None:
            count = len(step.timeouts.envs)
            expected[step.timeouts.envs] += SETTINGS.gamma * values[first : first + count]
            first += count
        found = rollout.rewards[number // SETTINGS.halves, part]
        torch.testing.assert_close(found, expected, rtol=0.0, atol=0.0)
    assert first == len(values)


@pytest.mark.parametrize("recurrent", [False, True])
def test_on_a_gpu_few_numbers_of_values_are_asked_for(recurrent: bool) -> None:
    """Each of them costs, because convolutions are timed for it."""
    plain, _, asked, _ = collected("observed", recurrent)
    padded, _, more, _ = collected("observed", recurrent, tunes=True)
    (few,), (many,) = asked, more
    count, size = few.shape[1], many.shape[1]
    assert count < size < 2 * count and size.bit_count() == 1
    assert torch.equal(many[:, :count], few) and not many[:, count:].any()
    torch.testing.assert_close(padded.rewards, plain.rewards, rtol=0.0, atol=1e-6)


def test_an_end_is_worth_nothing() -> None:
    rollout, envs, asked, _ = collected("ends", recurrent=True)
    assert asked == [] and any(step.timeouts is not None for _, step in envs.said)
    for number, (part, step) in enumerate(envs.said):
        found = rollout.rewards[number // SETTINGS.halves, part]
        assert torch.equal(found, torch.from_numpy(step.rewards))


def test_nothing_else_of_a_rollout_is_another() -> None:
    observed, *others = (
        collected(name, recurrent=True) for name in ("observed", "endless", "ends")
    )
    for rollout, envs, _, _ in others:
        for name in ("state", "actions", "log_probs", "values", "ends", "starts"):
            assert torch.equal(getattr(rollout, name), getattr(observed[0], name)), name
        assert not torch.equal(rollout.rewards, observed[0].rewards)
        for (_, step), (_, before) in zip(envs.said, observed[1].said):
            if step.timeouts is not None:
                np.testing.assert_array_equal(step.timeouts.state, before.timeouts.state)
