"""What happens to each env in a step, as arrays."""

import numpy as np
import pytest

import galactic
from galactic import Simulator, VectorEnv

STATISTICS = {
    "steps": np.int64,
    "refused": np.int64,
    "slid": np.int64,
    "grasps": np.int64,
    "drops": np.int64,
    "restored": np.int64,
    "episodes": np.int64,
    "successes": np.int64,
    "failures": np.int64,
    "picks": np.int64,
    "nan_actions": np.int64,
    "reward": np.float64,
}
EVENTS = ("refused", "slid", "grasped", "dropped", "restored", "touched")


def drive(draw_actions, envs: int, step: int) -> np.ndarray:
    """Robots that drive into what is there, and whose hands close and open."""
    actions = draw_actions(envs, 8)
    actions[:, -4] = 1
    actions[:, -2] = 1 if step % 30 < 20 else 0
    return actions


def test_counts_are_the_statistics_of_each_env(world, draw_actions) -> None:
    simulator = Simulator(world, envs=30, threads=1, episode_steps=40)
    for step in range(100):
        simulator.step(drive(draw_actions, 30, step))
    counts = simulator.counts()
    assert list(counts) == list(simulator.statistics()) == list(STATISTICS)
    assert {name: values.dtype for name, values in counts.items()} == STATISTICS
    assert isinstance(simulator.statistics()["slid"], int)
    for name, values in counts.items():
        assert values.shape == (30,)
        assert list(values) == [simulator.statistics(env)[name] for env in range(30)]
    assert counts["slid"].any() and counts["refused"].any() and counts["episodes"].any()
    np.testing.assert_array_equal(simulator.counts([5, 2])["slid"], counts["slid"][[5, 2]])
    with pytest.raises(IndexError):
        simulator.counts([30])


@pytest.mark.parametrize("halves", (1, 2))
def test_infos_tell_what_happened_in_each_step(world, draw_actions, halves) -> None:
    options = {"seed": 4, "episode_steps": 40, "safe_drop": True, "bump": True}
    envs = VectorEnv(world, 30, halves=halves, threads=1, events=True, **options)
    bump = envs.observation_parts["bump"].start
    sums = {name: np.zeros(30, int) for name in EVENTS}
    envs.reset()
    for step in range(100):
        observations, _, terminations, truncations, infos = envs.step(drive(draw_actions, 30, step))
        events = infos["events"]
        assert set(events) == {*EVENTS, *(f"_{name}" for name in EVENTS)}
        assert infos["_events"].all()
        for name in EVENTS:
            assert (events[name].dtype, events[name].shape) == (np.bool_, (30,))
            assert events[f"_{name}"].all()
            sums[name] += events[name]
        goes_on = ~(terminations | truncations)
        np.testing.assert_array_equal(events["refused"][goes_on], observations[goes_on, bump] == 1)
    for event, counted in (("refused", "refused"), ("slid", "slid"), ("grasped", "grasps"),
                           ("dropped", "drops"), ("restored", "restored")):  # fmt: skip
        counts = np.concatenate([one.counts()[counted] for one in envs.simulators])
        np.testing.assert_array_equal(sums[event], counts)
    assert sums["refused"].any() and sums["slid"].any()
    np.testing.assert_array_equal(sums["touched"], sums["refused"] + sums["slid"])


def test_nothing_happens_to_idle_envs_and_nobody_is_told_who_does_not_ask(world) -> None:
    actions = np.zeros((2, 8), np.float32)
    envs = VectorEnv(world, 2, threads=1, order="partition", episode_steps=1, events=True)
    for _ in range(200):
        infos = envs.step(actions)[4]
        if not infos["_events"].any():
            break
    assert not infos["_events"].any() and not infos["events"]["touched"].any()
    assert "events" not in VectorEnv(world, 2, threads=1).step(actions)[4]
    with pytest.raises(ValueError, match="events is 'all', expected True or False"):
        VectorEnv(world, 2, events="all")


def test_events_do_not_change_what_happens(world, draw_actions) -> None:
    told = VectorEnv(world, 12, threads=1, events=True)
    plain = VectorEnv(world, 12, threads=1)
    for step in range(50):
        actions = drive(draw_actions, 12, step)
        np.testing.assert_array_equal(told.step(actions)[0], plain.step(actions)[0])


class Pick(galactic.Task):
    """The simulation's, as a task of one's own."""

    base = "pick"

    def step(self, envs):
        return galactic.Outcome(envs.rewards)


def test_a_task_of_ones_own_has_them_too(world, draw_actions) -> None:
    envs = VectorEnv(world, 12, threads=1, task=Pick, events=True)
    touched = 0
    for step in range(60):
        touched += envs.step(drive(draw_actions, 12, step))[4]["events"]["touched"].sum()
    assert touched
