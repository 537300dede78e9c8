"""States of some envs in others: to plan from where one env is, with the task's memory and all sums."""


import numpy as np
import pytest
from packed_states import packed, unpacked

from galactic import Error, ErrorCode, Simulator, VectorEnv
from tasks import ACTIONS, Approach, drawing, played


def made(world, envs, halves=1, task=Approach, **options):
    env = VectorEnv(world, envs, task=task, halves=halves, threads=1, **{"seed": 6, **options})
    env.reset()
    return env


@pytest.mark.parametrize("halves", [1, 2])
@pytest.mark.parametrize("task", [Approach, "pick"])
def test_many_plans_begin_where_one_env_is(world, halves, task):
    real, planner = made(world, 4, task=task), made(world, 10, halves, task)
    played(real, drawing(1), 8)
    played(planner, drawing(2), 12)
    planner.restore_state(real.save_state(envs=[2]))
    seen = planner.observe()
    np.testing.assert_array_equal(seen[:, :-2], np.tile(real.observe()[2, :-2], (10, 1)))
    plans = drawing(3)(10, ACTIONS)
    plans[4] = 0
    _, rewards, *_ = planner.step(plans)
    actions = np.zeros((4, ACTIONS), np.float32)
    assert rewards[4] == real.step(actions)[1][2] and len(np.unique(rewards)) > 5
    # Returns and lengths go on, too.
    lengths = np.concatenate([part._tally.lengths for part in planner._parts])
    returns = np.concatenate([part._tally.returns for part in planner._parts])
    # 0 where the step has ended the episode.
    assert set(lengths.tolist()) <= {9, 0} and lengths[4] == 9
    assert returns[4] == real._parts[0]._tally.returns[2]


def test_plans_need_no_images_where_the_env_draws(world):
    """States go from envs that draw to envs that do not, and back."""
    images = {"width": 8, "height": 8}
    options = {"task": "pick", "seed": 6, "threads": 1}
    real = VectorEnv(world, 4, images=images, **options)
    planner = VectorEnv(world, 10, halves=2, **options)
    real.reset()
    planner.reset()
    played(real, drawing(1), 8)
    planner.restore_state(real.save_state(envs=[2]))
    np.testing.assert_array_equal(planner.observe(), np.tile(real.observe()["state"][2], (10, 1)))
    played(planner, drawing(3), 5)
    real.restore_state(planner.save_state(envs=[7, 0]), envs=[1, 3])
    np.testing.assert_array_equal(real.observe()["state"][[1, 3]], planner.observe()[[7, 0]])
    drawn = real.observe()["depth"]
    assert (drawn[1] != drawn[3]).any()


@pytest.mark.parametrize("halves", [1, 2])
def test_an_env_tries_again(world, halves):
    """Bit for bit, also over the end of its episode, while others go on."""
    env = made(world, 8, halves)
    played(env, drawing(1), 15)
    state = env.save_state(envs=np.array([5, 1]))
    first = played(env, drawing(2), 40)
    env.restore_state(state, envs=(5, 1))
    for one, two in zip(first, played(env, drawing(2), 40)):
        np.testing.assert_array_equal(one[:, [5, 1]], two[:, [5, 1]])
    assert first[4][:, [5, 1]].any()


@pytest.mark.parametrize("before, after", [(1, 1), (1, 2), (2, 1), (2, 2)])
def test_some_envs_become_others(world, before, after):
    real, other = made(world, 8, before), made(world, 12, after)
    played(real, drawing(1), 7)
    played(other, drawing(2), 3)
    untouched = other.observe()
    other.restore_state(real.save_state(envs=[7, 0, 3]), envs=[2, 11, 5])
    seen, wanted = other.observe(), real.observe()
    size = real.simulators[0].observation_size + 1  # all but the dice, which are each env's own
    np.testing.assert_array_equal(seen[[2, 11, 5], :size], wanted[[7, 0, 3], :size])
    assert not (seen[[2, 11, 5], size:] == wanted[[7, 0, 3], size:]).any()
    rest = np.delete(np.arange(12), [2, 11, 5])
    np.testing.assert_array_equal(seen[rest], untouched[rest])


def test_draws_of_named_episodes_come_along(world):
    """They follow from the episode, as the simulator's noise does."""
    real, other = made(world, 2), made(world, 4)
    real.reset(options={"episodes": np.array([1, 3])})
    played(real, drawing(1), 4)
    other.restore_state(real.save_state(envs=[1]))
    np.testing.assert_array_equal(other.observe(), np.tile(real.observe()[1], (4, 1)))


def test_what_is_of_all_envs_stays(world):
    real, planner = made(world, 4), made(world, 6)
    real.progress = 0.5
    played(real, drawing(1), 8)
    planner.restore_state(real.save_state(envs=[0]))
    assert planner.progress == 0
    whole = made(world, 4)
    whole.restore_state(real.save_state())
    assert whole.progress == 0.5


def test_states_that_do_not_fit_are_refused_and_change_nothing(world):
    env = made(world, 6, halves=2)
    played(env, drawing(1), 5)
    before = env.save_state()
    some, one = env.save_state(envs=[0, 1, 5]), env.save_state(envs=[4])

    def changed(state, **changes):
        arrays = {**unpacked(state), **changes}
        return packed({name: array for name, array in arrays.items() if array is not None})

    other = made(world, 6, halves=2, seed=7)
    plain = made(world, 6, task="none", episode_steps=20)
    damaged = np.frombuffer(b"GALSTATE", np.uint8)
    for state, envs, message in (
        (some, None, "has 3 envs, expected 6, or one that becomes all of them"),
        (some, [0, 1], "has 3 envs, expected 2"),
        (before, [0], "is of all envs; leave out envs, or give what save_state"),
        (other.save_state(envs=[0]), [0], "saved with seed 7, and the simulator has 6"),
        (plain.save_state(envs=[0]), [0], "task_actions: found missing, expected float32"),
        (changed(some, simulator_1=damaged), [0, 1, 2], "saved state"),
        (changed(one, simulator_1=damaged), None, "saved state"),
        (changed(some, returns=np.zeros(2)), [0, 1, 2], "does not have as many envs as it says"),
        (changed(some, envs=np.array(4)), [0, 1, 2], "does not have as many envs as it says"),
        (changed(some, envs=np.zeros(3)), [0, 1, 2], "does not have as many envs as it says"),
        (
            changed(some, envs=np.array(10**12)),
            [0, 1, 2],
            "does not have as many envs as it says",
        ),
        (changed(some, envs=np.array("three")), [0, 1, 2], "does not have as many envs as it says"),
        (changed(some, places_1=np.zeros(1)), [0, 1, 2], "does not have as many envs as it says"),
        (changed(some, simulator_0=None), [0, 1, 2], "does not have as many envs as it says"),
        (changed(some, lengths=np.zeros(3)), [0, 1, 2], r"lengths: found float64 \(3,\), expected"),
    ):
        with pytest.raises(Error, match=message) as caught:
            env.restore_state(state, envs)
        assert caught.value.where == "saved state" and caught.value.code == ErrorCode.INVALID_INPUT
        assert env.save_state() == before
    for envs, error, message in (
        ([6], IndexError, "there is no env 6, the last is 5"),
        ([-1], IndexError, "there is no env -1"),
        (np.ones(6, bool), TypeError, r"envs are bool \(6,\), expected numbers of envs"),
        ([0.5], TypeError, "envs are float64"),
        ([[0]], TypeError, r"envs are int64 \(1, 1\)"),
    ):
        with pytest.raises(error, match=message):
            env.save_state(envs)
        with pytest.raises(error, match=message):
            env.restore_state(one, envs)
    assert env.save_state() == before
    env.restore_state(env.save_state(envs=[]), envs=[])
    env.restore_state(one, envs=[])
    assert env.save_state() == before


def test_a_new_env_has_begun_when_a_state_is_put_into_it(world):
    env, other = made(world, 3), VectorEnv(world, 3, task=Approach, threads=1, seed=6)
    played(env, drawing(1), 5)
    other.restore_state(env.save_state(envs=[0]), envs=[1])
    other.reset()
    assert (other.env_states().step == 0).all()


def test_simulators_of_halves_take_the_same(world):
    """A Simulator plans for a VectorEnv without a task of one's own."""
    real = VectorEnv(world, 4, task="pick", threads=1)
    real.reset()
    planner = Simulator(world, 5, task="pick", threads=1)
    planner.restore_state(real.simulators[0].save_state([3]))
    np.testing.assert_array_equal(planner.observations, np.tile(real.observe()[3], (5, 1)))
