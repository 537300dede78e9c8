"""Tasks of one's own that are wrong, and steps that they cut off."""

import signal

import numpy as np
import pytest

import galactic
from galactic import Outcome, Task, VectorEnv
from tasks import ACTIONS, Approach, drawing, played


def test_a_step_that_was_cut_off(world):
    """Nothing goes on before all envs are reset, or a state is restored."""

    class Fails(Approach):
        def step(self, envs):
            if fails:
                raise KeyboardInterrupt
            return super().step(envs)

    fails = False
    env, whole = VectorEnv(world, 4, task=Fails), VectorEnv(world, 4, task=Fails)
    env.reset()
    whole.reset()
    state = env.save_state()
    actions = np.zeros((4, ACTIONS))
    fails = True
    with pytest.raises(KeyboardInterrupt):
        env.step(actions)
    fails = False
    some = {"reset_mask": np.array([True, False, True, True])}
    for call in (
        lambda: env.step(actions),
        env.observe,
        env.save_state,
        lambda: env.reset(options=some),
    ):
        with pytest.raises(RuntimeError, match="has cut off what this env did last; reset"):
            call()
    env.restore_state(state)
    for one, two in zip(played(env, drawing(), 9), played(whole, drawing(), 9)):
        np.testing.assert_array_equal(one, two)
    fails = True
    with pytest.raises(KeyboardInterrupt):
        env.step(actions)
    fails = False
    env.reset()
    lengths = []
    for _ in range(21):
        infos = env.step(actions)[4]
        lengths += (
            infos["final_info"]["episode"]["l"][infos["_final_info"]].tolist() if infos else []
        )
    assert lengths and max(lengths) <= 20


@pytest.mark.parametrize("halves", [1, 2])
def test_a_reset_that_was_cut_off(world, halves):
    class Fails(Approach):
        def begin(self, envs, which):
            if fails and envs.numbers[0] == 0:
                raise KeyError("begin")
            super().begin(envs, which)

    fails = False
    env = VectorEnv(world, 4, task=Fails, halves=halves)
    env.reset()
    state = env.save_state()
    fails = True
    with pytest.raises(KeyError):
        env.reset()
    fails = False
    with pytest.raises(RuntimeError, match="has cut off what this env did last"):
        env.step(np.zeros((4, ACTIONS)))
    # A state that does not fit changes nothing of that.
    with pytest.raises(galactic.Error):
        env.restore_state(VectorEnv(world, 6, task=Fails, halves=halves).save_state())
    with pytest.raises(RuntimeError, match="has cut off what this env did last"):
        env.step(np.zeros((4, ACTIONS)))
    env.restore_state(state)
    played(env, drawing(), 5)


def test_no_half_goes_on_alone(world):
    class Fails(Approach):
        def step(self, envs):
            if envs.numbers[0] == 0:
                raise KeyError("step")
            return super().step(envs)

    env = VectorEnv(world, 4, task=Fails, halves=2)
    env.reset()
    with pytest.raises(KeyError):
        env.step(np.zeros((4, ACTIONS)))
    for _ in range(3):
        with pytest.raises(RuntimeError, match="has cut off"):
            env.step(np.zeros((4, ACTIONS)))
    assert env.simulators[1].env_state(0).step == 1


def test_memory_that_fits_no_longer_is_made_anew(world):
    class Grows(Approach):
        def step(self, envs):
            outcome = super().step(envs)
            if fails:
                self.memory["gained"] = fails.pop()
            return outcome

    fails = []
    env = VectorEnv(world, 4, task=Grows)
    env.reset()
    state = env.save_state()
    ahead = played(env, drawing(), 9)
    for recover in (lambda: env.restore_state(state), lambda: env.reset(seed=1)):
        for wrong in (np.zeros((4, 2), np.float32), [1.0], None):
            fails = [wrong]
            with pytest.raises(TypeError):
                env.step(np.zeros((4, ACTIONS)))
            recover()
            for one, two in zip(played(env, drawing(), 9), ahead):
                np.testing.assert_array_equal(one, two)
    fails = [np.zeros(3)]
    with pytest.raises(TypeError):
        env.step(np.zeros((4, ACTIONS)))
    env.reset()
    played(env, drawing(), 9)


def test_a_state_that_a_task_cannot_take_changes_nothing(world):
    class Fails(Approach):
        def prepare(self, envs):
            if fails:
                raise KeyError("prepare")
            super().prepare(envs)

    fails = False
    env = VectorEnv(world, 4, task=Fails)
    env.reset(seed=5)
    other = env.save_state()
    env.reset(seed=6)
    state = env.save_state()
    fails = True
    with pytest.raises(KeyError):
        env.restore_state(other)
    with pytest.raises((KeyError, RuntimeError)):
        env.step(np.zeros((4, ACTIONS)))
    fails = False
    env.restore_state(state)
    ahead = played(env, drawing(), 5)
    env.reset(seed=6)
    for one, two in zip(played(env, drawing(), 5), ahead):
        np.testing.assert_array_equal(one, two)


def test_interrupts_leave_nothing_half_done(world):
    """Wherever they come: what has been taken in is whole, or is told to be cut off. No lock stays held."""
    env = VectorEnv(world, 256, task=Approach, threads=1)
    actions = np.zeros((256, ACTIONS))
    random = np.random.default_rng(3)
    interrupted = 0
    for _ in range(60):
        env.reset(seed=1)
        try:
            signal.setitimer(signal.ITIMER_REAL, random.uniform(0.0002, 0.004))
            while True:
                env.step(actions)
        except Interrupted:
            interrupted += 1
        try:
            env.observe()
        except RuntimeError as refusal:
            assert "has cut off" in str(refusal)
        else:
            lengths = env._parts[0]._tally.lengths
            np.testing.assert_array_equal(lengths, env.simulators[0].env_states().step)
    assert interrupted == 60


class Interrupted(BaseException):
    """What a signal raises in the middle of anything, which no library takes for an error of its own."""


@pytest.fixture(autouse=True)
def signals():
    def interrupt(*_):
        raise Interrupted

    before = signal.signal(signal.SIGALRM, interrupt)
    yield
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


def test_idle_envs_may_say_anything(world):
    class Pays(Approach):
        def step(self, envs):
            idle = envs.simulator.idle
            return Outcome(np.where(idle, np.nan, 1.0), successes=envs.states.step >= 3)

        def observe(self, envs):
            nothing = np.where(envs.simulator.idle, np.nan, 2.0)[:, np.newaxis]
            return {"gained": nothing, "dice": nothing.repeat(2, axis=1)}

    env = VectorEnv(world, 6, task=Pays, order="partition", observation="dict")
    seen, _ = env.reset()
    for _ in range(9):
        idle = env.simulators[0].idle
        np.testing.assert_array_equal(seen["gained"][:, 0], np.where(idle, 0, 2))
        was_idle = idle.copy()
        seen, rewards, *_ = env.step(np.zeros((6, ACTIONS)))
        np.testing.assert_array_equal(rewards, ~was_idle)
    assert env.simulators[0].idle.all()


def test_images_have_names_of_their_own(world):
    camera = {"hand": {"camera": "head", "width": 8, "height": 8}}
    for members, message in (
        ({"parts": {"hand_rgb": 1}}, "Faulty.parts has 'hand_rgb'"),
        ({"measures": ("hand_world_from_camera",)}, "Faulty.measures has 'hand_world_from_camera'"),
    ):
        with pytest.raises(ValueError, match=message):
            VectorEnv(world, 4, task=of(**members), images=camera)


def of(**members):
    """A task with these methods and attributes over Approach's."""
    return type("Faulty", (Approach,), members)


def zeros(envs):
    return np.zeros(envs.num_envs)


def ends_all(self, envs):
    return Outcome(zeros(envs), successes=np.ones(envs.num_envs, bool))


def ends_odd(self, envs):
    return Outcome(zeros(envs), successes=envs.numbers % 2 == 1)


@pytest.mark.parametrize(
    "task, error, message",
    [
        (Approach(), TypeError, "task is a Approach; give what makes one for each half"),
        (lambda: 3, TypeError, "task makes a int, expected a galactic.Task"),
        (of(parts={"time": 1}), ValueError, "Faulty.parts has 'time', expected a name of its own"),
        (of(parts=["door"]), ValueError, r"Faulty.parts is \['door'\], expected sizes by name, such as"),
        (of(parts={"to door": 1}), ValueError, "Faulty.parts has 'to door'"),
        (of(parts={"door": 0}), ValueError, r"Faulty.parts\['door'\] is 0, expected how many"),
        (of(measures=("success",)), ValueError, "Faulty.measures has 'success', expected a name of its"),
        (of(measures=("picked",)), ValueError, "Faulty.measures has 'picked', expected a name of its own"),
        (of(measures="gained"), ValueError, "Faulty.measures has 'g', expected a name of its own"),
        (of(parts={"bump": 1}), ValueError, "Faulty.parts has 'bump', expected a name of its own"),
        (of(measures=("env", "env")), ValueError, "Faulty.measures has a name twice"),
        (of(base=None), ValueError, "Faulty.base is None, expected a task of the simulation"),
        (of(options={"seed": 3}), ValueError, "Faulty.options has 'seed', which a task does not choose"),
        (of(options={"task": "pick"}), ValueError, "Faulty.options has 'task', .*; say it with base"),
        (
            of(prepare=lambda self, envs: self.memory.update(a=envs.observations["time"])),
            TypeError,
            r"Faulty.memory\['a'\] is a view that cannot be written, .*; copy what is to be remembered",
        ),
        (
            of(prepare=lambda self, envs: self.memory.update(a=envs.actions)),
            TypeError,
            r"Faulty.memory\['a'\] is a view that cannot be written",
        ),
        (
            of(prepare=lambda self, envs: self.memory.update({5: np.zeros(4)})),
            TypeError,
            r"Faulty.memory\[5\] is float64",
        ),
        (of(base="tidy"), galactic.Error, "tidy"),
        (of(options={"episode_stpes": 3}), TypeError, "did you mean episode_steps"),
        (
            of(prepare=lambda self, envs: self.memory.update(a=[0.0])),
            TypeError,
            r"Faulty.memory\['a'\] is list, expected an array of numbers whose first axis is the 4 envs",
        ),
        (
            of(choose=lambda self, envs, which: np.zeros(2, int)),
            ValueError,
            r"Faulty.choose\(\) returned episodes int64 \(2,\), expected int \(4,\)",
        ),
        (of(choose=lambda self, envs, which: which * 0 + 99), IndexError, "99"),
        (
            of(begin=lambda self, envs, which: envs.uniform("a", -1)),
            ValueError,
            "^count is -1, expected how many numbers each env draws",
        ),
        (of(begin=lambda self, envs, which: envs.uniform("a", 1.5)), ValueError, "^count is 1.5"),
    ],
)  # fmt: skip
def test_refused_at_once(world, task, error, message):
    with pytest.raises(error, match=message):
        VectorEnv(world, 4, task=task)


@pytest.mark.parametrize(
    "members, error, message",
    [
        (
            {"step": lambda self, envs: Outcome(np.zeros(3))},
            ValueError,
            r"Faulty.step\(\) returned rewards float64 \(3,\), expected numbers \(4,\)",
        ),
        (
            {"step": lambda self, envs: Outcome(np.array([0, 1, np.nan, 2]))},
            ValueError,
            r"Faulty.step\(\) returned rewards of which env 2 has nan, expected finite numbers",
        ),
        (
            {"step": lambda self, envs: Outcome(zeros(envs), successes=zeros(envs))},
            ValueError,
            r"Faulty.step\(\) returned successes float64 \(4,\), expected bool \(4,\)",
        ),
        (
            {"observe": lambda self, envs: {"gained": zeros(envs)}},
            ValueError,
            r"Faulty.observe\(\) returned \['gained'\], expected \['dice', 'gained'\]",
        ),
        (
            {"observe": lambda self, envs: {"gained": zeros(envs), "dice": zeros(envs)}},
            ValueError,
            r"Faulty.observe\(\) returned gained float64 \(4,\), expected numbers \(4, 1\)",
        ),
        (
            {"begin": lambda self, envs, which: self.memory.update(gained=zeros(envs))},
            TypeError,
            r"Faulty.memory\['gained'\] is float64 \(4,\), and prepare\(\) made float32 \(4,\)",
        ),
        (
            {"step": ends_all, "measure": lambda self, envs, which: {"env": which}},
            ValueError,
            r"Faulty.measure\(\) returned \['env'\], expected \['env', 'twice_gained'\]",
        ),
        (
            {"step": ends_all, "measure": lambda self, envs, which: dict.fromkeys(self.measures, which[1:])},
            ValueError,
            r"Faulty.measure\(\) returned .* int64 \(3,\), expected numbers \(4,\)",
        ),
        (
            {"step": lambda self, envs: Outcome(np.array([0, 1, 2, 1e300]))},
            ValueError,
            "rewards of which env 3 has 1e.300, expected finite numbers of 32 bits",
        ),
        (
            {"step": lambda self, envs: np.zeros((3, 4), bool)},
            TypeError,
            r"Faulty.step\(\) returned bool \(3, 4\), expected an Outcome",
        ),
        (
            {"observe": lambda self, envs: None},
            TypeError,
            r"Faulty.observe\(\) returned NoneType, expected \['dice', 'gained'\]",
        ),
        (
            {"step": ends_odd, "measure": lambda self, envs, which: dict.fromkeys(self.measures, which * np.nan)},
            ValueError,
            r"Faulty.measure\(\) returned .* of which env 1 has nan",
        ),
        ({"step": Task.step}, NotImplementedError, r"Faulty has no step\(\)"),
    ],
)  # fmt: skip
def test_refused_returns(world, members, error, message):
    with pytest.raises(error, match=message):
        env = VectorEnv(world, 4, task=of(**members))
        env.reset()
        env.step(np.zeros((4, ACTIONS)))
