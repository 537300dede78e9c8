"""Who may use a simulator, and when: steps that are begun and ended, several threads, and Ctrl-C."""

import os
import signal
import threading

import numpy as np
import pytest

from galactic import Outcome, Simulator, Task, VectorEnv

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


@pytest.mark.parametrize("fails", [False, True])
def test_a_step_whose_wait_is_interrupted_stays_under_way(world, draw_actions, fails):
    goes_on = threading.Event()

    class Slow(Task):
        def step(self, envs):
            goes_on.wait(timeout=60)
            if fails:
                raise ValueError("of the task")
            return Outcome(envs.observations["time"][:, 0].astype(np.float64))

    env, whole = (VectorEnv(world, 8, halves=2, task=Slow, threads=1) for _ in range(2))
    env.reset()
    actions = draw_actions(4, 8)
    env.send(actions, 0)
    threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        env.recv(0)
    for call in (env.save_state, lambda: env.send(actions, 0)):
        with pytest.raises(RuntimeError, match=r"half 0 is under way; call recv\(0\) first"):
            call()
    goes_on.set()
    if fails:
        with pytest.raises(ValueError, match="of the task"):
            env.recv(0)
    else:
        whole.reset()
        whole.send(actions, 0)
        for found, wanted in zip(env.recv(0)[:4], whole.recv(0)[:4]):
            np.testing.assert_array_equal(found, wanted)
        assert env.simulators[0].statistics()["steps"] == 4
    with pytest.raises(RuntimeError, match="half 0 has nothing under way; call send"):
        env.recv(0)


def require_cut_off_until_reset(env):
    """All calls but reset() are refused; then the halves go on, step by step with each other."""
    actions = np.zeros((env.num_envs, 8), np.float32)
    for call in (lambda: env.step(actions), lambda: env.send(actions[:4], 1) or env.recv(1)):
        with pytest.raises(RuntimeError, match=r"has cut off .*; reset\(\) all envs"):
            call()
    with pytest.raises(RuntimeError, match=r"has cut off .*; reset\(\) all envs"):
        env.save_state()
    env.reset()
    for _ in range(2):
        env.step(actions)
    assert env.env_states().step.tolist() == 8 * [2]


def test_a_step_of_both_halves_whose_wait_is_interrupted_is_cut_off(world):
    goes_on = threading.Event()

    class Slow(Task):
        def step(self, envs):
            goes_on.wait(timeout=60)
            return Outcome(envs.observations["time"][:, 0].astype(np.float64))

    env = VectorEnv(world, 8, halves=2, task=Slow, threads=1)
    env.reset()
    threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
    threading.Timer(0.4, goes_on.set).start()
    with pytest.raises(KeyboardInterrupt):
        env.step(np.zeros((8, 8), np.float32))
    require_cut_off_until_reset(env)


@pytest.mark.parametrize("is_submitted", [False, True])
@pytest.mark.parametrize("half", [0, 1])
def test_a_step_that_is_interrupted_while_it_begins_leaves_no_half_ahead(
    world, monkeypatch, half, is_submitted
):
    env = VectorEnv(world, 8, halves=2, threads=1)
    env.reset()
    thread = env._turns._threads[half]
    submit = thread.submit

    def interrupted(*call):
        monkeypatch.undo()
        if is_submitted:
            submit(*call)
        raise KeyboardInterrupt

    monkeypatch.setattr(thread, "submit", interrupted)
    with pytest.raises(KeyboardInterrupt):
        env.step(np.zeros((8, 8), np.float32))
    require_cut_off_until_reset(env)


def test_a_step_that_one_half_refuses_leaves_no_half_ahead(world):
    env = VectorEnv(world, 8, halves=2, threads=1)
    env.reset()
    actions = np.zeros((8, 8), np.float32)
    env.simulators[1].begin_step(actions[:4])
    with pytest.raises(RuntimeError, match="a step is under way"):
        env.step(actions)
    env.simulators[1].end_step()
    require_cut_off_until_reset(env)


def test_two_threads_do_not_receive_one_step(world, draw_actions, refused_at_once):
    env = VectorEnv(world, 512, threads=1, task="pick")
    env.reset()
    actions = draw_actions(512, 8)
    for _ in range(20):
        env.send(actions)
        refusals = refused_at_once(env.recv, env.recv, env.recv, times=1)
        assert refusals == 2 * ["half 0 has nothing under way; call send() first"]
