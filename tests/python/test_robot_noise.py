"""Robots that do not do exactly what they are asked to, nor know exactly where they are."""

import numpy as np
import pytest

import galactic
from galactic import Simulator, VectorEnv

NOISE = {"motion_noise": 0.2, "motion_bias": 0.1, "localization_noise": 0.1}


def test_the_options_of_noise_are_listed() -> None:
    assert Simulator.NOISE_OPTIONS == (*NOISE, "action_delay")


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


DRAWN = {"motion_noise": (0.1, 0.6), "motion_bias": "0-0.3", "laser_noise": [0.01, 0.05]}


def test_each_episode_draws_noise_from_a_range(world) -> None:
    simulator = Simulator(world, envs=400, threads=1, laser_beams=4, task="none", **DRAWN)
    assert simulator.options["motion_noise"] == "0.1-0.6"
    first = simulator.episode_noise()
    assert list(first) == [
        "motion_noise",
        "motion_bias",
        "localization_noise",
        "action_delay",
        "laser_noise",
    ]
    for name, (least, most) in (("motion_noise", (0.1, 0.6)), ("laser_noise", (0.01, 0.05))):
        values = first[name]
        assert (values.dtype, values.shape) == (np.float32, (400,))
        assert values.min() >= np.float32(least) and values.max() <= np.float32(most)
        assert len(np.unique(values)) > 390
        assert values.mean() == pytest.approx((least + most) / 2, rel=0.1)
    assert not first["localization_noise"].any() and not first["action_delay"].any()
    # Whole numbers, which the option takes again.
    assert first["action_delay"].dtype == np.uint32
    Simulator(world, envs=1, action_delay=first["action_delay"][0])
    simulator.step(np.zeros((400, 8), np.float32))
    np.testing.assert_array_equal(simulator.episode_noise()["motion_noise"], first["motion_noise"])
    some = simulator.episode_noise(envs=[7, 3])["motion_bias"]
    np.testing.assert_array_equal(some, first["motion_bias"][[7, 3]])
    simulator.reset()
    assert (simulator.episode_noise()["motion_noise"] != first["motion_noise"]).mean() > 0.98
    again = Simulator(world, threads=1, **simulator.options)
    np.testing.assert_array_equal(again.episode_noise()["motion_noise"], first["motion_noise"])


def test_drawn_noise_does_not_depend_on_halves_and_threads(world_path) -> None:
    def made(halves: int, threads: int) -> VectorEnv:
        return VectorEnv(world_path, 24, halves=halves, threads=threads, laser_beams=4, **DRAWN)

    one, two = made(1, 1), made(2, 2)
    np.testing.assert_array_equal(play(two), play(one))
    for name, values in one.episode_noise().items():
        np.testing.assert_array_equal(two.episode_noise()[name], values)


def test_a_number_is_the_noise_of_all_episodes(world) -> None:
    noise = Simulator(world, envs=3, threads=1, **NOISE).episode_noise()
    for name, value in NOISE.items():
        np.testing.assert_array_equal(noise[name], np.full(3, value, np.float32))


def test_actions_arrive_as_late_as_each_episode_has_drawn(world, draw_actions) -> None:
    options = {"task": "none", "episode_steps": 25, "seed": 4}
    late = VectorEnv(world, 24, action_delay=(0, 3), threads=2, halves=2, **options)
    prompt = VectorEnv(world, 24, threads=1, **options)
    assert late.simulators[0].options["action_delay"] == "0-3"
    np.testing.assert_array_equal(late.reset()[0], prompt.reset()[0])
    delays = np.zeros(24, int)
    asked: list[np.ndarray] = []
    for step in range(60):
        if step % 25 == 0:
            delays = late.episode_noise()["action_delay"]
            assert set(delays) == {0, 1, 2, 3}
            asked = []
        asked.append(draw_actions(24, 8))
        arrived = np.zeros((24, 8), np.float32)
        for env, delay in enumerate(delays):
            if delay < len(asked):
                arrived[env] = asked[-1 - delay][env]
        seen = late.step(asked[-1])[0]
        np.testing.assert_array_equal(seen, prompt.step(arrived)[0])
        if step == 30:
            state, after = late.save_state(), []
        elif step > 30:
            after.append((asked[-1], seen.copy()))
    # What is under way belongs to the state.
    other = VectorEnv(world, 24, action_delay="0-3", threads=1, halves=2, **options)
    for again in (late, other):
        again.restore_state(state)
        for actions, seen in after:
            np.testing.assert_array_equal(again.step(actions)[0], seen)


def test_what_is_under_way_is_told(world, draw_actions) -> None:
    simulator = Simulator(world, envs=2, threads=1, action_delay=3)
    count = simulator.action_count
    before = np.zeros((3, count), np.float32)
    before[:, -2:] = np.nan
    np.testing.assert_array_equal(simulator.actions_under_way(1), before)
    asked = draw_actions(2, count)
    simulator.step(asked)
    under_way = simulator.actions_under_way(1)
    assert under_way.dtype == np.float32
    np.testing.assert_array_equal(under_way, [*before[1:], asked[1]])
    assert Simulator(world, envs=1).actions_under_way(0).shape == (0, count)
    with pytest.raises(IndexError, match="there is no env 2"):
        simulator.actions_under_way(2)
    simulator.begin_step(asked)
    with pytest.raises(RuntimeError, match="a step is under way"):
        simulator.actions_under_way(0)
    simulator.end_step()


@pytest.mark.parametrize(
    "value", [-1, 101, 0.5, (3, 1), (0, 101), (0, 0.5), "0-", "1-2-3", "one", 10**12]
)
def test_what_is_no_delay_is_refused(world, value) -> None:
    wanted = (
        "action_delay: is .*expected a whole number from 0 to 100, or a range of them such as 0-2"
    )
    with pytest.raises(galactic.Error, match=wanted):
        Simulator(world, envs=1, action_delay=value)


@pytest.mark.parametrize("name", NOISE)
@pytest.mark.parametrize(
    "value", [(0.5, 0.2), (-0.1, 0.2), (0.2, 1.5), (0, float("nan")), "0.1..0.2", "-0.1-0.2"]
)
def test_what_is_no_range_is_refused(world, name, value) -> None:
    with pytest.raises(galactic.Error, match="expected 0 to 1, or a range from 0 to 1 such as"):
        Simulator(world, envs=1, **{name: value})


@pytest.mark.parametrize("value", [(), (0.1,), (0.1, 0.2, 0.3), (0.1, None)])
def test_what_is_no_pair_is_refused(world, value) -> None:
    with pytest.raises(TypeError, match="the option motion_noise is a"):
        Simulator(world, envs=1, motion_noise=value)


@pytest.mark.parametrize("name", NOISE)
@pytest.mark.parametrize("value", (-0.1, 1.5, float("nan")))
def test_what_is_no_share_is_refused(world, name, value) -> None:
    with pytest.raises(galactic.Error, match=name.replace("_", ".")):
        Simulator(world, envs=1, **{name: value})
