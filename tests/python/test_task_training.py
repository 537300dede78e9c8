"""What a task of one's own knows of the training around it, and what it says of each step."""

import numpy as np
import pytest

from galactic import Outcome, Task, VectorEnv
from tasks import ACTIONS, Approach, drawing


class Curriculum(Task):
    """Observes what it is told; pays how hard it is."""

    options = {"episode_steps": 6}
    parts = {"told": 2}

    def step(self, envs):
        return Outcome(np.full(envs.num_envs, envs.progress))

    def observe(self, envs):
        return {"told": np.tile([envs.progress, envs.is_evaluation], (envs.num_envs, 1))}


@pytest.mark.parametrize("halves", [1, 2])
def test_progress_is_what_was_set(world, halves):
    env = VectorEnv(world, 4, task=Curriculum, halves=halves, threads=1)
    assert env.reset()[0][:, -2:].tolist() == [[0, 0]] * 4 and not env.is_evaluation
    env.progress = 0.25
    assert env.step(np.zeros((4, ACTIONS)))[1].tolist() == [0.25] * 4
    env.reset(seed=3)
    assert env.progress == 0.25
    state = env.save_state()
    env.progress = np.float32(1)
    env.restore_state(state)
    assert env.progress == 0.25 and env.observe()[0, -2] == 0.25
    for wrong in (-0.1, 1.5, np.nan, "0", True, None):
        with pytest.raises(ValueError, match="progress is .*, expected a number from 0 to 1"):
            env.progress = wrong
    assert env.progress == 0.25


def test_an_evaluation_is_at_the_end(world):
    env = VectorEnv(world, 4, task=Curriculum, threads=1, is_evaluation=True)
    assert env.is_evaluation and env.reset()[0][:, -2:].tolist() == [[1, 1]] * 4
    with pytest.raises(ValueError, match="progress is 0.5, expected 1, as this env is an evaluat"):
        env.progress = 0.5
    trained = VectorEnv(world, 4, task=Curriculum, threads=1)
    trained.reset()
    env.restore_state(trained.save_state())
    assert env.progress == 1 and env.step(np.zeros((4, ACTIONS)))[1].tolist() == [1] * 4
    with pytest.raises(ValueError, match="is_evaluation is 1, expected True or False"):
        VectorEnv(world, 4, is_evaluation=1)


class Logs(Approach):
    logs = ("gain", "number")

    def step(self, envs):
        outcome = super().step(envs)
        said = {"gain": outcome.rewards, "number": envs.numbers}
        return outcome._replace(logs=said)


@pytest.mark.parametrize("halves", [1, 2])
def test_logs_are_in_the_infos_of_each_step(world, halves):
    env = VectorEnv(world, 8, task=Logs, halves=halves, threads=1)
    assert env.logs == ("gain", "number") and VectorEnv(world, 2, threads=1).logs == ()
    env.reset()
    draw, ends = drawing(), 0
    for _ in range(50):
        _, rewards, terminations, truncations, infos = env.step(draw(8, ACTIONS))
        ended = terminations | truncations
        ends += ended.any()
        assert ("final_info" in infos) == ended.any()
        assert infos["_log"].all() and infos["log"]["_gain"].all()
        assert infos["log"]["gain"].dtype == np.float32
        np.testing.assert_array_equal(infos["log"]["gain"], rewards)
        np.testing.assert_array_equal(infos["log"]["number"], np.arange(8))
        if ended.any():
            np.testing.assert_array_equal(infos["_final_info"], ended)
    assert 0 < ends < 50


def test_idle_envs_log_nothing(world):
    class Ends(Logs):
        options = {"episode_steps": 3}

        def step(self, envs):
            said = np.ones(envs.num_envs)
            return Outcome(np.zeros(envs.num_envs), logs={"gain": said, "number": said})

    env = VectorEnv(world, 2, task=Ends, order="partition", threads=1)
    env.reset()
    while not env.simulators[0].idle.all():
        was_idle = env.simulators[0].idle.copy()
        infos = env.step(np.zeros((2, ACTIONS)))[4]
        np.testing.assert_array_equal(infos["log"]["gain"], ~was_idle)
        np.testing.assert_array_equal(infos["log"]["_gain"], ~was_idle)
    assert not env.step(np.zeros((2, ACTIONS)))[4]["_log"].any()


@pytest.mark.parametrize(
    "logs, error, message",
    [
        (None, ValueError, r"step\(\) returned logs \[\], expected \['gain', 'number'\]"),
        ({"gain": np.zeros(4)}, ValueError, r"logs \['gain'\], expected \['gain', 'number'\]"),
        ([1, 2], TypeError, r"returned logs list, expected \['gain', 'number'\]"),
        (
            {"gain": np.zeros(4), "number": np.zeros(3)},
            ValueError,
            r"logs\['number'\] float64 \(3,",
        ),
        ({"gain": np.zeros(4), "number": np.full(4, np.inf)}, ValueError, "which env 0 has inf"),
        ({"gain": np.zeros(4), "number": list("abcd")}, ValueError, r"logs\['number'\] <U1"),
    ],
)
def test_logs_that_cannot_be_are_refused(world, logs, error, message):
    class Says(Logs):
        def step(self, envs):
            return Outcome(np.zeros(envs.num_envs), logs=logs)

    env = VectorEnv(world, 4, task=Says, threads=1)
    env.reset()
    with pytest.raises(error, match=message):
        env.step(np.zeros((4, ACTIONS)))


@pytest.mark.parametrize(
    "names, message",
    [
        (["_gain"], "logs has '_gain', expected a name of its own"),
        (["std"], "logs has 'std', expected a name of its own"),
        (["gain", "gain"], "logs has a name twice"),
        ("gain", "logs has 'g', expected a name of its own"),
    ],
)
def test_names_that_cannot_be_logs_are_refused(world, names, message):
    task = type("Says", (Logs,), {"logs": names})
    with pytest.raises(ValueError, match=message):
        VectorEnv(world, 4, task=task, threads=1)


def test_logs_change_nothing_else(world):
    one, two = (VectorEnv(world, 8, task=task, threads=1) for task in (Approach, Logs))
    one.reset()
    two.reset()
    for plain, logged in zip(played_with(one), played_with(two)):
        np.testing.assert_array_equal(plain, logged)


def played_with(env):
    return [env.step(actions)[1] for actions in drawing()(8 * 30, ACTIONS).reshape(30, 8, ACTIONS)]
