"""States of simulators and environments: saved, restored, and gone on from."""

import json

import numpy as np
import pytest
from packed_states import packed, signed, unpacked

import galactic
from galactic import Error, ErrorCode, Simulator, VectorEnv


def test_a_state_goes_on_bit_for_bit_elsewhere(world, draw_actions):
    options = {"episode_steps": 40, "laser_beams": 12, "laser_noise": 0.02}
    first = Simulator(world, envs=33, threads=1, seed=4, **options)
    for _ in range(70):
        first.step(draw_actions(33, 8))
    saved = first.save_state()
    assert isinstance(saved, bytes)
    second = Simulator(world, envs=33, threads=2, seed=9, **options)
    second.restore_state(saved)
    assert second.save_state() == saved
    assert second.options["seed"] == 4
    for _ in range(100):
        actions = draw_actions(33, 8)
        first.step(actions)
        second.step(actions)
        for name in ("observations", "rewards", "endings"):
            np.testing.assert_array_equal(getattr(second, name), getattr(first, name))
    assert second.statistics() == first.statistics()


def test_chosen_envs_are_put_into_chosen_envs(world, draw_actions):
    simulator = Simulator(world, envs=8, threads=1)
    for _ in range(10):
        simulator.step(draw_actions(8, 8))
    simulator.restore_state(simulator.save_state(envs=[6, 1]), envs=np.array([0, 3]))
    np.testing.assert_array_equal(simulator.observations[0], simulator.observations[6])
    np.testing.assert_array_equal(simulator.observations[3], simulator.observations[1])
    simulator.restore_state(simulator.save_state(envs=[6, 1]), envs=[None, 4])
    np.testing.assert_array_equal(simulator.observations[4], simulator.observations[1])
    with pytest.raises(TypeError, match="an env is a NoneType"):
        simulator.save_state(envs=[None])
    for call in (lambda: simulator.save_state(envs=[8]), lambda: simulator.save_state(envs=[-1])):
        with pytest.raises(IndexError, match="there is no env"):
            call()


def test_many_plans_begin_where_one_env_is(world, draw_actions):
    simulator = Simulator(world, envs=3, threads=1, task="pick")
    planner = Simulator(world, envs=10, threads=1, task="pick")
    for _ in range(12):
        simulator.step(draw_actions(3, 8))
    state = simulator.save_state([1])
    planner.restore_state(state, range(10))
    one_by_one = Simulator(world, envs=10, threads=1, task="pick")
    for env in range(10):
        one_by_one.restore_state(state, [env])
    assert planner.save_state(range(10)) == one_by_one.save_state(range(10))
    with pytest.raises(Error, match="has 2 envs, expected 10, or one that becomes all of them"):
        planner.restore_state(simulator.save_state([0, 1]), range(10))
    plans = draw_actions(10, 8)
    planner.step(plans)
    assert len(np.unique(planner.observations, axis=0)) > 5
    actions = draw_actions(3, 8)
    actions[1] = plans[4]
    simulator.step(actions)
    np.testing.assert_array_equal(planner.observations[4], simulator.observations[1])
    assert planner.rewards[4] == simulator.rewards[1]
    planner.restart(5)
    with pytest.raises(Error, match="saved with seed 1, and the simulator has 5; restart it with"):
        planner.restore_state(state, [0])


def test_bytes_that_are_no_state_are_refused_and_change_nothing(world, draw_actions):
    simulator = Simulator(world, envs=4, threads=1)
    simulator.step(draw_actions(4, 8))
    saved = simulator.save_state()
    for bad in (b"", b"GALSTATE", saved[:-1], saved + b"\0", saved[:100] + b"\xff" + saved[101:]):
        with pytest.raises(Error) as caught:
            simulator.restore_state(bad)
        assert caught.value.where == "saved state"
        assert caught.value.code in (ErrorCode.INVALID_INPUT, ErrorCode.UNSUPPORTED)
        assert simulator.save_state() == saved
    with pytest.raises(Error, match="has 4 envs, expected 5"):
        Simulator(world, envs=5, threads=1).restore_state(saved)
    with pytest.raises(Error, match="expected success-distance=0.2"):
        Simulator(world, envs=4, threads=1, success_distance=0.2).restore_state(saved)
    simulator.restore_state(bytearray(saved))
    simulator.restore_state(np.frombuffer(saved, np.uint8))


@pytest.mark.parametrize("halves", [1, 2])
def test_environments_go_on_with_their_sums(world, draw_actions, halves):
    def made():
        return VectorEnv(world, 12, halves=halves, threads=1, episode_steps=25, seed=6)

    first, second = made(), made()
    first.reset(seed=3)
    for _ in range(40):
        first.step(draw_actions(12, 8))
    saved = first.save_state()
    second.restore_state(saved)
    np.testing.assert_array_equal(second.observe(), first.observe())
    ends = picks = 0
    for _ in range(60):
        actions = draw_actions(12, 8)
        a, b = first.step(actions), second.step(actions)
        for one, other in zip(a[:4], b[:4]):
            np.testing.assert_array_equal(one, other)
        assert a[4].keys() == b[4].keys()
        if a[4]:
            ends += 1
            for name in ("r", "l"):
                np.testing.assert_array_equal(a[4]["episode"][name], b[4]["episode"][name])
            picked, other = (infos["final_info"]["picked"] for infos in (a[4], b[4]))
            np.testing.assert_array_equal(picked, other)
            picks += picked.sum()
    assert picks
    assert ends > 2
    before = second.save_state()
    for bad in (b"", b"zip", before[:-30], saved[:50] + saved[60:]):
        with pytest.raises(galactic.Error):
            second.restore_state(bad)
    np.testing.assert_array_equal(second.observe(), first.observe())


def test_other_files_are_no_states_of_environments(world, draw_actions):
    env = VectorEnv(world, 4, halves=2, threads=1)
    env.reset()
    for _ in range(3):
        env.step(draw_actions(4, 8))
    state = env.save_state()
    for _ in range(3):
        env.step(draw_actions(4, 8))
    arrays, now = unpacked(state), env.save_state()

    def listing(*parts):
        return signed(json.dumps(parts).encode(), b"12345678")

    others = VectorEnv(world, 4, threads=1).save_state()
    damaged = {**arrays, "simulator_1": arrays["simulator_1"][:-1]}
    for bad, message in (
        (b"", "found 0 bytes that do not begin as a state does; give what save_state"),
        (np.random.default_rng(3).bytes(900), "found 900 bytes that do not begin as a state"),
        (b"x" + state, "bytes that do not begin as a state does"),
        (state + b"x", "does not have the checksum that it states; it is damaged"),
        (state[:-30], "does not have the checksum"),
        (state[:200] + state[210:], "does not have the checksum"),
        (state[:10], "found 10 bytes that do not begin as a state does"),
        (signed(b"no list", b""), "cannot be read .*give what save_state"),
        (signed(b"{}", b""), "halves: found 0, expected 2"),
        (listing(["one", "<f4", [1]]), "bytes, expected .*; it is damaged"),
        (listing(["one", "<f4", [3]]), "cannot be read"),
        (listing(["one", "<f4", [-1]]), "cannot be read"),
        (listing(["one", "<f4", "two"]), "cannot be read"),
        (listing(["one", "O", [1]]), "cannot be read"),
        (listing(["one", "<f99", [1]]), "cannot be read"),
        (listing(["one", [["a", "<f4"]]]), "cannot be read"),
        (listing(["one", {}, [1]]), "bytes, expected .*; it is damaged"),
        (listing(["one", "<f4", [2**62, 2**62]]), "cannot be read"),
        (listing(["simulator_0", "<f8", [1]]), "halves: found 1, expected 2"),
        (others, "halves: found 1, expected 2"),
        (packed({**arrays, "returns_1": np.zeros(3)}), r"returns: found float64 \(3,\), expected"),
        (
            packed({**arrays, "is_new_1": np.zeros(3)}),
            r"is_new: found float64 \(3,\), expected bool",
        ),
        (packed(damaged), "saved state"),
    ):
        with pytest.raises(Error, match=message) as caught:
            env.restore_state(bad)
        assert caught.value.where == "saved state"
        assert caught.value.code == ErrorCode.INVALID_INPUT
        # Half 0 may have been restored before half 1 was found to be wrong.
        assert env.save_state() == now
    for wrong in (None, 3, "state"):
        with pytest.raises(TypeError):
            env.restore_state(wrong)
    env.restore_state(bytearray(state))
    assert env.save_state() == state


@pytest.mark.parametrize("halves", [1, 2])
def test_a_state_of_another_number_of_envs_says_so(world, halves):
    saved, env = (VectorEnv(world, envs, halves=halves, seed=3) for envs in (8, 4))
    with pytest.raises(Error, match="is of 8 envs, expected 4; restore it in an env of as many"):
        env.restore_state(saved.save_state())


@pytest.mark.parametrize("halves", [1, 2])
def test_a_state_from_before_the_first_reset_is_one_to_reset(world, halves):
    def episodes(env):
        env.reset()
        return [list(one.episodes()) for one in env.simulators]

    def made():
        return VectorEnv(world, 4, halves=halves, threads=1)

    env, other = made(), made()
    state = env.save_state()
    first, second = episodes(env), episodes(env)
    assert first != second
    other.restore_state(state)
    assert episodes(other) == first
    # One from afterwards is not.
    other.restore_state(state)
    other.reset()
    later = made()
    later.restore_state(other.save_state())
    assert episodes(later) == second
    # A state that is refused takes nothing from an env that is new.
    new = made()
    with pytest.raises(Error):
        new.restore_state(b"")
    assert episodes(new) == first
