"""What Gymnasium 1.x asks of vector environments: its own checks where it is installed, a stand-in for
them, and our spaces."""

import inspect

import numpy as np
import pytest

from galactic import VectorEnv, spaces

ENVS = 6


def made(world, **options):
    return VectorEnv(world, ENVS, threads=1, episode_steps=12, **options)


def test_with_gymnasium_it_is_one_of_its_environments(world):
    gymnasium = pytest.importorskip("gymnasium", minversion="1.0")
    env = made(world)
    assert isinstance(env, gymnasium.vector.VectorEnv)
    assert isinstance(env.observation_space, gymnasium.spaces.Space)
    wrapped = gymnasium.wrappers.vector.RecordEpisodeStatistics(env, stats_key="sums")
    wrapped.reset(seed=1)
    for _ in range(20):
        wrapped.step(wrapped.action_space.sample())


def test_it_has_what_vector_environments_have(world):
    """As gymnasium.vector.VectorEnv and the tests of its implementations have it."""
    env = made(world)
    reset = inspect.signature(env.reset).parameters
    assert {"seed", "options"} <= set(reset)
    assert all(reset[name].kind is inspect.Parameter.KEYWORD_ONLY for name in ("seed", "options"))
    for name in ("num_envs", "metadata", "spec", "render_mode", "closed", "unwrapped"):
        assert hasattr(env, name)
    for single, batch in (
        (env.single_observation_space, env.observation_space),
        (env.single_action_space, env.action_space),
    ):
        assert batch.shape == (ENVS, *single.shape)
        assert batch.dtype == single.dtype
        assert batch.contains(batch.sample())


@pytest.mark.parametrize("options", [{}, {"observation": "dict"}, {"actions": "paper"}])
def test_it_behaves_as_vector_environments_do(world, options):
    env = made(world, **options)
    env.action_space.seed(2)
    first, infos = env.reset(seed=3)
    assert isinstance(infos, dict)
    assert env.observation_space.contains(first)
    for _ in range(40):
        result = env.step(env.action_space.sample())
        assert len(result) == 5
        observations, rewards, terminations, truncations, infos = result
        assert env.observation_space.contains(observations)
        assert (rewards.shape, rewards.dtype.kind) == ((ENVS,), "f")
        for flags in (terminations, truncations):
            assert (flags.shape, flags.dtype) == ((ENVS,), np.bool_)
        for name in infos:
            assert name.startswith("_") or f"_{name}" in infos
        for env_number in np.flatnonzero(terminations | truncations):
            final = infos["final_obs"][env_number]
            assert env.single_observation_space.contains(final)
    again, _ = env.reset(seed=3)
    assert_equal(again, first)


def assert_equal(one, other):
    if isinstance(one, dict):
        assert one.keys() == other.keys()
        for name in one:
            assert_equal(one[name], other[name])
    else:
        np.testing.assert_array_equal(one, other)


def test_spaces_of_like_environments_are_equal(world):
    kinds = (
        {},
        {"observation": "dict"},
        {"actions": "paper"},
        {"images": {"width": 8, "height": 8}},
        {"images": {"width": 8, "height": 9}},
    )
    for n, options in enumerate(kinds):
        env, other = made(world, **options), made(world, **options)
        assert env.observation_space == other.observation_space
        assert env.action_space == other.action_space
        for unlike in kinds[n + 1 :]:
            third = made(world, **unlike)
            assert (env.observation_space, env.action_space) != (
                third.observation_space,
                third.action_space,
            )
    box = spaces.Box(-1.0, 1.0, (2,))
    assert box != spaces.Box(-1.0, 2.0, (2,)) and box != spaces.Box(-1.0, 1.0, (2,), np.float64)
    assert len(spaces.Dict({"a": box, "b": box})) == 2


def test_samples_lie_in_their_spaces_and_follow_the_seed():
    for space in (
        spaces.Box(-1.0, 1.0, (3, 2), np.float32),
        spaces.Box(-np.inf, np.inf, (4,), np.float32),
        spaces.Box(0, 255, (2, 2, 3), np.uint8),
        spaces.MultiDiscrete([2, 5]),
        spaces.Dict({"a": spaces.Box(0.0, 1.0, (2,)), "b": spaces.MultiDiscrete([3])}),
    ):
        batch = spaces.batch_space(space, 5)
        for one in (space, batch):
            one.seed(4)
            first = one.sample()
            assert one.contains(first)
            one.seed(4)
            assert_equal(one.sample(), first)
        assert space.contains(batch.sample()) is False
    box = spaces.Box(-1.0, 1.0, (2,), np.float32)
    assert np.zeros(2, np.float32) in box
    for outside in (np.full(2, 2, np.float32), np.zeros(3, np.float32), [0.0, 0.0], np.zeros(2)):
        assert outside not in box
