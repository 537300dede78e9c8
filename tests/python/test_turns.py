"""Who may use a simulator, and when: steps that are begun and ended, and several threads."""

import threading

import numpy as np
import pytest

from galactic import Simulator

ENVS = 20


@pytest.fixture
def simulator(world):
    return Simulator(world, envs=ENVS, threads=1, seed=7, episode_steps=30)


def test_steps_in_halves_are_steps(world, draw_actions):
    whole = Simulator(world, envs=ENVS, threads=1)
    for threads in (1, 2):
        halved = Simulator(world, envs=ENVS, threads=threads)
        whole.restart(5)
        halved.restart(5)
        for _ in range(20):
            actions = draw_actions(ENVS, 8)
            whole.step(actions)
            halved.begin_step(actions)
            del actions
            halved.end_step()
            np.testing.assert_array_equal(halved.observations, whole.observations)


def test_calls_out_of_turn_are_refused(simulator, draw_actions):
    actions = draw_actions(ENVS, 8)
    with pytest.raises(RuntimeError, match="no step is under way"):
        simulator.end_step()
    simulator.begin_step(actions)
    for call in (
        lambda: simulator.step(actions),
        lambda: simulator.begin_step(actions),
        lambda: simulator.env_state(0),
        lambda: simulator.save_state(),
        lambda: simulator.statistics(),
        lambda: simulator.restart(1),
    ):
        with pytest.raises(RuntimeError, match="a step is under way"):
            call()
    simulator.end_step()
    assert simulator.statistics()["steps"] == ENVS


def test_a_simulator_may_go_while_a_step_is_under_way(world, draw_actions):
    for _ in range(20):
        simulator = Simulator(world, envs=500, threads=2)
        simulator.begin_step(draw_actions(500, 8))
        del simulator


def test_two_threads_cannot_use_one_simulator_at_once(world, draw_actions, refused_at_once):
    simulator = Simulator(world, envs=4096, threads=1)
    actions = draw_actions(4096, 8)
    refusals = refused_at_once(*2 * [lambda: simulator.step(actions)], times=40)
    assert set(refusals) == {
        "another thread is using this galactic.Simulator; give each thread its own"
    }
    simulator.step(actions)
    assert simulator.statistics()["steps"] == 4096 * (81 - len(refusals))


def test_other_threads_run_while_it_steps(world, draw_actions):
    simulator = Simulator(world, envs=4096, threads=1)
    actions = draw_actions(4096, 8)
    is_done = threading.Event()

    def work():
        for _ in range(10):
            simulator.step(actions)
        is_done.set()

    thread = threading.Thread(target=work)
    thread.start()
    turns = 0
    while not is_done.is_set():
        turns += 1
    thread.join()
    assert turns > 100
