"""Robots that do not do exactly what they are asked to, nor know exactly where they are."""

import numpy as np
import pytest

import galactic
from galactic import Simulator, VectorEnv

NOISE = {"motion_noise": 0.2, "motion_bias": 0.1, "localization_noise": 0.1}


def play(envs: VectorEnv, steps: int = 40, **reset) -> np.ndarray:
    """Observations of steps with actions of their own."""
    generator = np.random.default_rng(8)
    rows = [envs.reset(**reset)[0].copy()]
    for _ in range(steps):
        actions = generator.uniform(-1, 1, (envs.num_envs, 8)).astype(np.float32)
        actions[:, -1] = -1
        rows.append(envs.step(actions)[0].copy())
    return np.array(rows)


def test_standing_robots_stand_and_moving_ones_move_otherwise(world) -> None:
    exact = Simulator(world, envs=50, threads=1, task="none")
    noisy = Simulator(world, envs=50, threads=1, task="none", motion_noise=0.3, motion_bias=0.2)
    still = np.zeros((50, 8), np.float32)
    exact.step(still)
    noisy.step(still)
    np.testing.assert_array_equal(noisy.observations, exact.observations)
    lift = still.copy()
    lift[:, 0] = 0.5
    joint = exact.observation_parts["joints"].start
    before = exact.observations[:, joint].copy()
    exact.step(lift)
    noisy.step(lift)
    asked = exact.observations[:, joint] - before
    done = noisy.observations[:, joint] - before
    assert asked.min() > 0
    # A deviation of 36 %.
    assert 0.2 < (done / asked).std() < 0.5
    assert abs((done / asked).mean() - 1) < 0.25
    assert noisy.options["motion_noise"] == pytest.approx(0.3)


def test_noise_does_not_depend_on_halves_and_threads(world_path) -> None:
    runs = [
        play(VectorEnv(world_path, 24, halves=halves, threads=threads, seed=3, **NOISE))
        for halves, threads in ((1, 1), (2, 1), (2, 2))
    ]
    np.testing.assert_array_equal(runs[1], runs[0])
    np.testing.assert_array_equal(runs[2], runs[0])
    assert (runs[0] != play(VectorEnv(world_path, 24, seed=3))).any()


def test_a_state_goes_on_with_the_same_noise(world, draw_actions) -> None:
    first = Simulator(world, envs=12, threads=1, **NOISE)
    for _ in range(20):
        first.step(draw_actions(12, 8))
    second = Simulator(world, envs=12, threads=2, **NOISE)
    second.restore_state(first.save_state())
    np.testing.assert_array_equal(second.observations, first.observations)
    for _ in range(60):
        actions = draw_actions(12, 8)
        first.step(actions)
        second.step(actions)
        np.testing.assert_array_equal(second.observations, first.observations)


def test_a_named_episode_has_the_same_noise_wherever_it_is_played(world) -> None:
    def played(envs: int, where: int, before: int) -> list[np.ndarray]:
        simulator = Simulator(world, envs=envs, threads=1, seed=6, **NOISE)
        actions = np.zeros((envs, 8), np.float32)
        actions[:, :6] = 0.3
        for _ in range(before):
            simulator.step(actions)
        episodes = np.full(envs, Simulator.STAYS, np.int32)
        episodes[where] = 1
        simulator.reset(episodes)
        rows = [simulator.observations[where].copy()]
        for _ in range(15):
            simulator.step(actions)
            rows.append(simulator.observations[where].copy())
        return rows

    alone = played(1, 0, 0)
    np.testing.assert_array_equal(played(9, 7, 5), alone)


class Again(galactic.Task):
    """Has the same episode again and again."""

    base = "pick"
    options = {"episode_steps": 5}

    def choose(self, envs, which):
        return np.full(len(which), 1)

    def step(self, envs):
        return galactic.Outcome(envs.rewards)


def test_an_episode_that_a_task_draws_has_other_noise_each_time(world) -> None:
    """Else robots would learn the noise of episodes by heart. Those that the caller names have theirs."""
    envs = VectorEnv(world, 4, task=Again, seed=6, **NOISE)
    actions = np.zeros((4, 8), np.float32)
    actions[:, 0] = 0.5

    def moved(**reset) -> np.ndarray:
        before = envs.reset(**reset)[0].copy()
        part = envs.observation_parts["joints"].start
        return envs.step(actions)[0][:, part] - before[:, part]

    drawn = np.array([moved() for _ in range(3)]).ravel()
    assert len(np.unique(drawn)) == drawn.size
    named = {"options": {"reset_mask": np.ones(4, bool), "episodes": np.ones(4, int)}}
    assert len(np.unique([moved(**named) for _ in range(3)])) == 1


@pytest.mark.parametrize("name", NOISE)
@pytest.mark.parametrize("value", (-0.1, 1.5, float("nan")))
def test_what_is_no_share_is_refused(world, name, value) -> None:
    with pytest.raises(galactic.Error, match=name.replace("_", ".")):
        Simulator(world, envs=1, **{name: value})
