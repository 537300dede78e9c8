"""The states of envs in arrays, against those of single envs; and that states can be pickled."""

import copy
import pickle

import numpy as np
import pytest

from galactic import EnvStates, Pose, Simulator, VectorEnv

ENVS = 20


def assert_same_pose(poses, at, pose: Pose):
    np.testing.assert_array_equal(poses.translation[at], pose.translation)
    np.testing.assert_array_equal(poses.rotation[at], pose.rotation)
    np.testing.assert_allclose(poses.matrix[at], pose.matrix, atol=1e-6)


def assert_same(states: EnvStates, row: int, simulator: Simulator, env: int, world):
    state = simulator.env_state(env)
    for name in ("scene", "episode", "step", "target"):
        assert getattr(states, name)[row] == getattr(state, name)
    assert states.held[row] == (-1 if state.held is None else state.held)
    for name in ("world_from_root", "world_from_grip", "goal"):
        assert_same_pose(getattr(states, name), row, getattr(state, name))
    np.testing.assert_array_equal(states.joint_positions[row], state.joint_positions)
    there = len(state.objects)
    for number, pose in enumerate(state.objects):
        assert_same_pose(states.objects, (row, number), pose)
    kinds = states.object_kinds[row]
    assert tuple(world.objects[kind] for kind in kinds[:there]) == state.object_names
    assert (kinds[there:] == -1).all()
    assert np.isnan(states.objects.translation[row, there:]).all()


def test_arrays_hold_what_single_envs_say(played, world):
    states = played.env_states()
    for env in range(ENVS):
        assert_same(states, env, played, env, world)
    assert (states.held >= 0).any() and (states.held < 0).any()
    counts = {len(played.env_state(env).objects) for env in range(ENVS)}
    assert len(counts) > 1 and states.objects.rotation.shape == (ENVS, max(counts), 4)


def test_states_are_printed_on_one_line(played):
    states = played.env_states()
    most = states.object_kinds.shape[1]
    assert repr(states) == f"<galactic.EnvStates, envs x objects: {ENVS} x {most}>"


def test_some_envs_in_any_order(played, world):
    states = played.env_states([7, 2, 7])
    for row, env in enumerate([7, 2, 7]):
        assert_same(states, row, played, env, world)
    with pytest.raises(IndexError, match="there is no env 20"):
        played.env_states([ENVS])
    with pytest.raises(TypeError):
        played.env_states(np.ones(ENVS, bool))


def test_without_distractors_there_is_the_target_alone(world):
    alone = Simulator(world, envs=4, threads=1, no_distractors=True)
    states = alone.env_states()
    assert states.object_kinds.shape == (4, 1)
    assert_same(states, 3, alone, 3, world)


def test_arrays_are_copies(played, draw_actions):
    states = played.env_states()
    before = copy.deepcopy(states)
    played.step(draw_actions(ENVS, 8))
    np.testing.assert_array_equal(states.joint_positions, before.joint_positions)
    assert (played.env_states().joint_positions != before.joint_positions).any()


@pytest.mark.parametrize("halves", [1, 2])
def test_vector_env_has_those_of_all_envs(world, draw_actions, halves):
    env = VectorEnv(world, ENVS, halves=halves, threads=1)
    env.reset()
    env.step(draw_actions(ENVS, 8))
    states = env.env_states()
    for half, simulator in enumerate(env.simulators):
        rows = env.rows(half)
        for number, row in enumerate(range(rows.start, rows.stop)):
            assert_same(states, row, simulator, number, world)
    env.send(draw_actions(ENVS // halves, 8))
    with pytest.raises(RuntimeError, match="half 0 is under way"):
        env.env_states()
    env.recv()


def test_states_can_be_pickled_and_copied(played):
    state = played.env_state(int(np.argmax(played.env_states().held)))
    for other in (pickle.loads(pickle.dumps(state)), copy.deepcopy(state)):
        assert repr(other) == repr(state)
        assert (other.held, other.target, other.scene) == (state.held, state.target, state.scene)
        assert other.object_names == state.object_names
        np.testing.assert_array_equal(other.joint_positions, state.joint_positions)
        for name in ("world_from_root", "world_from_grip", "goal"):
            np.testing.assert_array_equal(getattr(other, name).matrix, getattr(state, name).matrix)
        for one, wanted in zip(other.objects, state.objects, strict=True):
            np.testing.assert_array_equal(one.matrix, wanted.matrix)
    states = pickle.loads(pickle.dumps(played.env_states()))
    np.testing.assert_array_equal(states.goal.matrix, played.env_states().goal.matrix)


def test_what_is_no_state_does_not_become_one(played):
    kind, parts = type(played.env_state(0)), list(played.env_state(0).__getstate__())
    made = kind.__new__(kind)
    made.__setstate__(tuple(parts))
    assert repr(made) == repr(played.env_state(0))
    held, target, names = 7, 8, 10
    for place, wrong in ((held, 99), (target, 99), (names, ["mug"] * 99)):
        with pytest.raises(ValueError, match="this is no EnvState"):
            kind.__new__(kind).__setstate__((*parts[:place], wrong, *parts[place + 1 :]))
