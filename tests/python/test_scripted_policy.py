"""The scripted policy: solves what can be solved, also with another policy's steps in between."""

import pickle
import threading

import numpy as np
import pytest

from galactic import Error, ScriptedPhase, ScriptedPolicy, ScriptedTrouble, Simulator, VectorEnv

SOLVABLE = {0, 1, 3}
"""Episodes of the small home; in the other one the robot cannot start."""


@pytest.fixture
def simulator(world):
    return Simulator(world, envs=3, threads=2, order="partition")


def solved_by(expert, simulator, step=lambda actions: actions):
    """Episodes that end in success, while `step` says what is done of the expert's actions."""
    solved = set()
    for _ in range(2000):
        if simulator.idle.all():
            break
        episodes = simulator.episodes()
        simulator.step(step(expert.act()))
        solved |= set(episodes[simulator.successes].tolist())
    return solved


def test_solves_each_episode(simulator):
    expert = ScriptedPolicy(simulator)
    assert solved_by(expert, simulator) == SOLVABLE
    assert not expert.act().any()
    assert repr(expert) == "<galactic.ScriptedPolicy in 3 envs>"


def test_acts_only_where_it_is_asked_to(simulator):
    """Where another one leads, it plans nothing, and goes on from there when it is asked."""
    expert, everywhere = ScriptedPolicy(simulator), ScriptedPolicy(simulator)
    mask = np.array([True, False, True])
    wanted = everywhere.act()
    assert wanted.any(axis=1).all()
    np.testing.assert_array_equal(expert.act(mask), np.where(mask[:, np.newaxis], wanted, 0))
    assert not expert.act(np.zeros(3, np.uint8)).any()
    for _ in range(10):
        actions = expert.act(mask)
        assert not actions[1].any()
        actions[1, -3] = 0.5  # a turn
        simulator.step(actions)
    assert solved_by(expert, simulator) == SOLVABLE
    with pytest.raises(ValueError, match=r"mask.*\(2,\)"):
        expert.act(mask[:2])


def test_two_threads_cannot_use_one_policy_at_once(simulator):
    expert = ScriptedPolicy(simulator)
    is_acting = threading.Event()

    def act():
        is_acting.set()
        expert.act()

    other = threading.Thread(target=act)
    other.start()
    is_acting.wait()
    refusals = set()
    while other.is_alive():
        for look in (lambda: expert.phases, lambda: expert.troubles):
            try:
                look()
            except RuntimeError as error:
                refusals.add(str(error))
    assert refusals == {
        "another thread is using this galactic.ScriptedPolicy; give each thread its own"
    }
    assert (expert.phases == ScriptedPhase.PICK).all()


def test_plans_again_where_others_act_in_between(world, draw_actions):
    """Base and joints move at random in the first steps of all, which costs a plan each."""
    solved = {}
    for most_plans in (8, 100):
        simulator = Simulator(world, envs=3, threads=2, order="partition")
        expert = ScriptedPolicy(simulator, most_plans=most_plans)
        steps = iter(range(10_000))

        def astray(actions):
            if next(steps) < 40:
                actions[:, :-2] = draw_actions(3, actions.shape[1])[:, :-2]
            return actions

        solved[most_plans] = solved_by(expert, simulator, astray)
        gave_up = expert.phases == ScriptedPhase.GAVE_UP
        assert gave_up.all() == (most_plans == 8)
        assert (expert.troubles[gave_up] == ScriptedTrouble.STUCK).all()
    assert solved == {8: set(), 100: SOLVABLE}


def test_meets_episodes_on_their_way(world, draw_actions):
    """In each of three, one after the other, somebody else moves for ten steps first."""
    simulator = Simulator(world, envs=1, order="partition")
    expert = ScriptedPolicy(simulator)
    solved = set()
    while not simulator.idle.all():
        state = simulator.env_state(0)
        actions = draw_actions(1, simulator.action_count)
        actions[:, -2:] = 0
        simulator.step(actions if state.step < 10 else expert.act())
        if simulator.successes[0]:
            solved.add(state.episode)
    assert solved == SOLVABLE


def test_says_what_it_is_about(simulator):
    expert = ScriptedPolicy(simulator)
    actions = expert.act()
    assert actions.shape == (3, simulator.action_count) and actions.dtype == np.float32
    assert expert.phases.tolist() == [ScriptedPhase.PICK] * 3
    assert expert.troubles.tolist() == [ScriptedTrouble.NONE] * 3
    seen = set()
    while not simulator.idle.all():
        simulator.step(actions)
        actions = expert.act()
        seen |= set(expert.phases.tolist())
    assert {ScriptedPhase.PICK, ScriptedPhase.PLACE, ScriptedPhase.FINISH} <= seen


def test_same_simulator_same_actions(world):
    acted = []
    for threads in (1, 2):
        simulator = Simulator(world, envs=8, threads=threads, seed=3)
        expert = ScriptedPolicy(simulator)
        for _ in range(60):
            acted.append(expert.act())
            simulator.step(acted[-1])
    np.testing.assert_array_equal(acted[:60], acted[60:])


def test_solves_where_actions_arrive_late(world):
    ends = []
    for delay in (0, 3):
        simulator = Simulator(world, envs=3, order="partition", action_delay=delay)
        expert = ScriptedPolicy(simulator)
        while not simulator.idle.all():
            simulator.step(expert.act())
        ends.append(simulator.statistics())
    prompt, late = ends
    assert late["successes"] == prompt["successes"] >= 1


def test_refuses_what_it_cannot_solve(world, simulator):
    with pytest.raises(Error, match="task"):
        ScriptedPolicy(Simulator(world, envs=2, task="none"))
    with pytest.raises(Error, match="grasp-from is 2, so that no action .* closes the hand"):
        ScriptedPolicy(Simulator(world, envs=2, grasp_from=2))
    with pytest.raises(TypeError, match="is a VectorEnv, expected a galactic.Simulator"):
        ScriptedPolicy(VectorEnv(world, 2))
    for most_plans in (0, -1, 2.5, "many"):
        with pytest.raises(Error, match="most_plans: is .*, expected a whole number from 1"):
            ScriptedPolicy(simulator, most_plans=most_plans)
    expert = ScriptedPolicy(simulator)
    simulator.begin_step(np.zeros((3, simulator.action_count), np.float32))
    with pytest.raises(RuntimeError, match="a step is under way"):
        expert.act()
    simulator.end_step()
    with pytest.raises(TypeError, match="cannot be pickled"):
        pickle.dumps(expert)
