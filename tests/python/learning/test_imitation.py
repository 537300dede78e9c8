"""Learning from demonstrations: in which order they are read, what is learned of them, and what goes on
after a checkpoint."""

from __future__ import annotations

import collections
import dataclasses
import pathlib
from collections.abc import Callable

import numpy as np
import pytest
import torch

import galactic
from galactic import demonstrations
from galactic.demonstrations import About, Demonstration, Demonstrations
from galactic.learning.encoders import Inputs
from galactic.learning.policies.fitting import Observed
from galactic.learning.policies.networks import Policy, PolicyShape
from galactic.learning.ranks.distributed import Group
from galactic.learning.refusals import CheckpointError
from galactic.learning.saving.checkpoint import new_policy
from galactic.learning.settings import Settings
from galactic.learning.updates.imitation import (
    DemonstrationSampler,
    ImitationLearner,
    require_same,
)

MOTIONS = 2
SETTINGS = Settings(
    network="state",
    precision="fp32",
    width=32,
    normalize=True,
    log_std="parameter",
    envs=8,
    mini_batches=2,
    horizon=6,
    learning_rate=1e-2,
    learning_rate_end=1e-3,
)
ABOUT = About(
    world="world.pack",
    episodes=400,
    expert="scripted",
    parts=[("way", 3)],
    options={},
    camera=None,
    meanings={"observe_current": False},
    images={},
    motions=MOTIONS,
    made_with={"settings": {}, "sha256": {}},
)
Act = Callable[[np.ndarray], np.ndarray]


def from_state(state: np.ndarray) -> np.ndarray:
    """[L, 4]: what an expert does that sees all it needs."""
    motions = np.stack([np.tanh(state[:, 0] - state[:, 1]), np.tanh(state[:, 2])], 1)
    return np.concatenate([motions, state[:, :1] > 0, state[:, 1:2] > 0.5], 1).astype(np.float32)


def from_memory(state: np.ndarray) -> np.ndarray:
    """What it does is told in the first step alone."""
    return np.repeat(from_state(state[:1]), len(state), 0)


def make(folder: pathlib.Path, act: Act = from_state, count: int = 20,
         shown: Callable[[np.ndarray], np.ndarray] | None = None) -> Demonstrations:  # fmt: skip
    """Each third episode is not solved, and does the opposite. `shown`: which steps are the expert's;
    others do the opposite, too."""
    random = np.random.default_rng(5)
    episodes = []
    for number in range(count):
        length = 3 + number % 11
        state = random.normal(size=(length, 3)).astype(np.float32)
        by_expert = np.ones(length, bool) if shown is None else shown(np.arange(length))
        is_solved = number % 3 != 1
        actions = act(state)
        wrong = np.concatenate([-actions[:, :2], 1 - actions[:, 2:]], 1)
        actions = np.where(by_expert[:, None] & is_solved, actions, wrong)
        ending = galactic.EpisodeEnd.SUCCESS if is_solved else galactic.EpisodeEnd.TIME_OUT
        rewards = np.full(length, 0.5, np.float32)
        # Of what nobody learns from.
        last = np.full((1, 3), 1e6, np.float32)
        states = np.concatenate([state, last])
        episodes.append(Demonstration(number, ending, states, actions, by_expert, rewards))
    folder.mkdir()
    (folder / demonstrations.INDEX).write_text(demonstrations.text_of(ABOUT))
    for part in (0, 1):
        place = demonstrations.part_folder(folder, part)
        place.mkdir()
        half = episodes[: count // 2] if part == 0 else episodes[count // 2 :]
        for name, array in demonstrations.arrays_of(half):
            np.save(place / f"{name}.npy", array)
    return Demonstrations(folder)


def policy_for(settings: Settings) -> Policy:
    torch.manual_seed(1)
    return new_policy(settings, PolicyShape(3, MOTIONS, True, settings.normalize))


def learn(shown: Demonstrations, settings: Settings, updates: int) -> tuple[Policy, list[float]]:
    policy = policy_for(settings)
    learner = ImitationLearner(policy, settings, Group.alone())
    sampler = DemonstrationSampler(shown, settings, policy, Group.alone())
    sampler.reset()
    losses = [
        learner.update(sampler.collect(n), n, n / updates)["policy_loss"] for n in range(updates)
    ]
    return policy, losses


def agreement(policy: Policy, act: Act) -> tuple[float, float]:
    """The largest error of motions in the mean over steps of episodes never seen, and the share of
    decisions that are the expert's."""
    policy.eval()
    errors, right = [], []
    random = np.random.default_rng(99)
    for _ in range(50):
        state = random.normal(size=(9, 3)).astype(np.float32)
        wanted = act(state)
        starts = torch.zeros(9, 1, dtype=torch.bool)
        starts[0] = True
        hidden = policy.initial_hidden(1, torch.device("cpu"))
        with torch.no_grad():
            seen = Inputs(torch.from_numpy(state)[:, None])
            done = policy(seen, hidden, starts).actions.mode()[:, 0].numpy()
        errors.append(np.abs(done[:, :2] - wanted[:, :2]).mean(0))
        right.append(done[:, 2:] == wanted[:, 2:])
    return float(np.mean(errors, 0).max()), float(np.mean(right))


@pytest.mark.parametrize("shown", [None, lambda step: step >= 2])
def test_the_expert_is_imitated_where_it_acted_and_succeeded(tmp_path: pathlib.Path, shown) -> None:
    made = make(tmp_path / "shown", shown=shown, count=120)
    policy, losses = learn(made, SETTINGS, 200)
    error, right = agreement(policy, from_state)
    assert error < 0.12 and right > 0.93
    assert np.mean(losses[-20:]) < np.mean(losses[:20]) - 2.0


def test_what_was_seen_before_the_stretch_is_remembered(tmp_path: pathlib.Path) -> None:
    made = make(tmp_path / "shown", from_memory, count=300)
    settings = dataclasses.replace(SETTINGS, recurrent=True, envs=32)
    error, right = agreement(learn(made, settings, 200)[0], from_memory)
    assert error < 0.25 and right > 0.85
    # Without a memory, it cannot be learned.
    error, right = agreement(
        learn(made, dataclasses.replace(SETTINGS, envs=32), 200)[0], from_memory
    )
    assert error > 0.35 and right < 0.8


def test_a_policy_learns_in_the_mode_for_it_whoever_acted_with_it(tmp_path: pathlib.Path) -> None:
    policy = policy_for(SETTINGS)
    sampler = DemonstrationSampler(make(tmp_path / "shown"), SETTINGS, policy, Group.alone())
    sampler.reset()
    modes: list[bool] = []
    policy.register_forward_hook(lambda *_: modes.append(policy.training))
    policy.eval()
    ImitationLearner(policy, SETTINGS, Group.alone()).update(sampler.collect(0), 0, 0.0)
    assert len(modes) == SETTINGS.epochs * SETTINGS.mini_batches and all(modes)


def test_values_are_what_episodes_pay_from_there_on(tmp_path: pathlib.Path) -> None:
    made = make(tmp_path / "shown")
    settings = dataclasses.replace(SETTINGS, gamma=0.9)
    sampler = DemonstrationSampler(made, settings, policy_for(settings), Group.alone())
    sampler.reset()
    rollout = sampler.collect(0)
    wanted = {
        tuple(one.state[step]): sum(0.5 * 0.9**n for n in range(len(one) - step))
        for one in made
        for step in range(len(one))
    }
    for step in range(settings.horizon):
        for stream in range(settings.envs):
            found = float(rollout.returns[step, stream])
            assert found == pytest.approx(wanted[tuple(rollout.state[step, stream].tolist())])


@pytest.mark.parametrize("ranks, envs", [(1, 8), (2, 4), (1, 64)])
def test_each_pass_shows_each_solved_episode_once(
    tmp_path: pathlib.Path, ranks: int, envs: int
) -> None:
    made = make(tmp_path / "shown")
    settings = dataclasses.replace(SETTINGS, envs=envs)
    firsts = {tuple(one.state[0]): one for one in made}
    begun: list[list[int]] = []
    for rank in range(ranks):
        group = Group(rank, ranks, torch.device("cpu"))
        sampler = DemonstrationSampler(made, settings, policy_for(settings), group)
        sampler.reset()
        own = []
        under_way: list[tuple[Demonstration, int] | None] = [None] * envs
        for update in range(60):
            rollout = sampler.collect(update)
            for stream in range(envs):
                for step in range(settings.horizon):
                    row = rollout.state[step, stream].numpy()
                    if rollout.starts[step, stream]:
                        one, at = firsts[tuple(row)], 0
                        own.append(one.episode)
                    else:
                        before = under_way[stream]
                        assert before is not None
                        one, at = before[0], before[1] + 1
                    np.testing.assert_array_equal(row, one.state[at])
                    np.testing.assert_array_equal(rollout.actions[step, stream], one.actions[at])
                    under_way[stream] = one, at
        begun.append(own)
    solved = {one.episode for one in made if one.is_solved}
    counts = [collections.Counter(own) for own in begun]
    assert set().union(*counts) == solved
    for own in counts:
        # As many times each, but for passes that are under way.
        assert max(own.values()) - min(own.values()) <= 1 + envs // len(own) + 1
    assert sum(len(own) for own in counts) == len(solved), "ranks have episodes in common"
    assert begun[0][: len(counts[0])] != begun[0][len(counts[0]) : 2 * len(counts[0])]


@pytest.mark.parametrize("recurrent", [False, True])
def test_a_checkpoint_goes_on_bit_for_bit(tmp_path: pathlib.Path, recurrent: bool) -> None:
    made = make(tmp_path / "shown")
    settings = dataclasses.replace(SETTINGS, recurrent=recurrent)

    def begin() -> tuple[Policy, ImitationLearner, DemonstrationSampler]:
        policy = policy_for(settings)
        learner = ImitationLearner(policy, settings, Group.alone())
        return policy, learner, DemonstrationSampler(made, settings, policy, Group.alone())

    policy, learner, sampler = begin()
    sampler.reset()
    losses = []
    for update in range(8):
        if update == 4:
            saved = [
                {name: value.clone() for name, value in state.items()}
                for state in (
                    policy.state_dict(),
                    learner.optimizer.state_dict(),
                    sampler.state_dict(),
                )
            ]
        losses.append(learner.update(sampler.collect(update), update, update / 8))
    policy, learner, sampler = begin()
    policy.load_state_dict(saved[0])
    learner.optimizer.load_state_dict(saved[1])
    sampler.load_state_dict(saved[2])
    resumed = [
        learner.update(sampler.collect(update), update, update / 8) for update in range(4, 8)
    ]
    assert resumed == losses[4:]


def test_a_checkpoint_of_other_demonstrations_is_refused(tmp_path: pathlib.Path) -> None:
    one, other = make(tmp_path / "one"), make(tmp_path / "other", from_memory)
    assert one.lengths.tolist() == other.lengths.tolist()
    policy = policy_for(SETTINGS)
    sampler = DemonstrationSampler(one, SETTINGS, policy, Group.alone())
    sampler.reset()
    sampler.collect(0)
    state = sampler.state_dict()
    with pytest.raises(ValueError, match="found other demonstrations than those with which"):
        DemonstrationSampler(other, SETTINGS, policy, Group.alone()).load_state_dict(state)
    for damaged in (
        {"at": state["at"] + 1000},
        {"at": -1 - state["at"]},
        {"begun": state["begun"] * 0},
    ):
        with pytest.raises(ValueError, match="places that are in no episode"):
            DemonstrationSampler(one, SETTINGS, policy, Group.alone()).load_state_dict(
                {**state, **damaged}
            )


def test_a_rank_without_episodes_is_refused(tmp_path: pathlib.Path) -> None:
    made = make(tmp_path / "shown", count=3)
    group = Group(0, 3, torch.device("cpu"))
    with pytest.raises(
        CheckpointError, match="found 2 solved episodes, expected 3 at least, one for each rank"
    ):
        DemonstrationSampler(made, SETTINGS, policy_for(SETTINGS), group)


@pytest.mark.parametrize(
    "parts, meanings, images, motions, message",
    [
        ([("way", 2)], {}, {}, 2, "found parts .*3.*, expected .*2"),
        (
            [("way", 3)],
            {"observe_current": True},
            {},
            2,
            "found meanings .*False.*, expected .*True",
        ),
        ([("way", 3)], {}, {"depth": (4, 4)}, 2, r"found images {}, expected .*depth.*4"),
        ([("way", 3)], {}, {}, 5, "found motions 2, expected 5"),
    ],
)
def test_a_run_that_observes_something_else_is_refused(
    tmp_path: pathlib.Path, parts, meanings, images, motions: int, message: str
) -> None:
    made = make(tmp_path / "shown")
    known = {"observe_current": False}
    require_same(made, SETTINGS, Observed([("way", 3)], known, 2), {})
    with pytest.raises(galactic.Error, match=message):
        require_same(made, SETTINGS, Observed(parts, {**known, **meanings}, motions), images)


def test_how_much_values_explain_does_not_depend_on_epochs(tmp_path: pathlib.Path) -> None:
    made = make(tmp_path / "shown")
    found = []
    for epochs in (1, 3):
        settings = dataclasses.replace(SETTINGS, epochs=epochs, learning_rate=0.0)
        policy = policy_for(settings)
        sampler = DemonstrationSampler(made, settings, policy, Group.alone())
        sampler.reset()
        rollout = sampler.collect(0)
        returns = rollout.returns[rollout.by_expert]
        with torch.no_grad():
            values = policy(Inputs(rollout.state[:-1]), None, rollout.starts[:-1]).values
        error = (values[rollout.by_expert] - returns).square().mean()
        wanted = 1.0 - float(error / returns.var(unbiased=False))
        report = ImitationLearner(policy, settings, Group.alone()).update(rollout, 0, 0.0)
        assert report["explained_variance"] == pytest.approx(wanted, rel=1e-4)
        found.append(report["explained_variance"])
    assert found[0] == pytest.approx(found[1], rel=1e-4)
