"""Tasks of one's own: galactic.Task in a VectorEnv."""

import numpy as np
import pytest

import galactic
from galactic import EpisodeEnd, Outcome, Task, VectorEnv

ACTIONS = 8  # of the small home's robot


class Approach(Task):
    """Pays each meter that the hand comes nearer to the target, and observes how far it came."""

    options = {"episode_steps": 20}
    parts = {"gained": 1, "dice": 2}
    measures = ("twice_gained", "env")

    def prepare(self, envs):
        count = envs.num_envs
        self.memory = {"distance": np.zeros(count), "gained": np.zeros(count, np.float32)}

    def begin(self, envs, which):
        self.memory["distance"][which] = distances(envs)[which]
        self.memory["gained"][which] = 0

    def step(self, envs):
        now = distances(envs)
        rewards = self.memory["distance"] - now
        self.memory["distance"][:] = now
        self.memory["gained"] += rewards.astype(np.float32)
        drawn = envs.uniform("end")[:, 0]
        return Outcome(rewards, successes=drawn < 0.05, failures=drawn > 0.97)

    def observe(self, envs):
        gained = self.memory["gained"][:, np.newaxis]
        return {"dice": envs.uniform("dice", 2), "gained": gained}

    def measure(self, envs, which):
        return {"env": envs.numbers[which], "twice_gained": 2 * self.memory["gained"][which]}


def distances(envs):
    return np.linalg.norm(envs.observations["grip_target"], axis=1).astype(np.float64)


def played(env, draw_actions, steps=60):
    """Observations, rewards and endings of `steps` steps."""
    rows = []
    for _ in range(steps):
        actions = draw_actions(env.num_envs, env.action_space.shape[1])
        observations, rewards, terminations, truncations, infos = env.step(actions)
        endings = np.zeros(env.num_envs, np.uint8)
        returns = np.zeros(env.num_envs, np.float32)
        if infos:
            endings = infos["final_info"]["ending"]
            returns = infos["final_info"]["episode"]["r"]
        rows.append((observations, rewards, terminations, truncations, endings, returns))
    return [np.stack(column) for column in zip(*rows)]


def drawing(seed=3):
    generator = np.random.default_rng(seed)
    return lambda envs, count: generator.uniform(-1, 1, (envs, count)).astype(np.float32)


def test_outcomes(world):
    """What it says is what the env says: rewards, ends, returns and lengths."""
    env = VectorEnv(world, 16, task=Approach)
    env.reset()
    draw, returns, lengths = drawing(), np.zeros(16), np.zeros(16, int)
    found = set()
    for _ in range(60):
        observations, rewards, terminations, truncations, infos = env.step(draw(16, ACTIONS))
        returns += rewards
        lengths += 1
        ended = terminations | truncations
        assert ended.any() == bool(infos)
        for row in np.flatnonzero(ended):
            final = infos["final_info"]
            end = EpisodeEnd(final["ending"][row])
            found.add(end)
            assert terminations[row] == (end in (EpisodeEnd.SUCCESS, EpisodeEnd.FAILURE))
            assert truncations[row] == (end == EpisodeEnd.TIME_OUT)
            assert final["success"][row] == (end == EpisodeEnd.SUCCESS)
            assert final["episode"]["l"][row] == lengths[row] <= 20
            assert final["episode"]["r"][row] == pytest.approx(returns[row], abs=1e-5)
            assert final["twice_gained"][row] == pytest.approx(2 * returns[row], abs=1e-5)
            assert final["_env"][row] and final["env"][row] == row
            # The last observation still has what was gained; the next episode begins without.
            gained = env.observation_parts["gained"]
            assert infos["final_obs"][row][gained] == pytest.approx(returns[row], abs=1e-5)
            assert observations[row, gained] == 0
        returns[ended], lengths[ended] = 0, 0
    assert found == {EpisodeEnd.SUCCESS, EpisodeEnd.FAILURE, EpisodeEnd.TIME_OUT}


def test_observations(world):
    env = VectorEnv(world, 8, task=Approach)
    size = env.simulators[0].observation_size
    assert env.observation_parts["gained"] == slice(size, size + 1)
    assert env.observation_parts["dice"] == slice(size + 1, size + 3)
    flat, _ = env.reset()
    assert flat.shape == env.observation_space.shape == (8, size + 3)
    np.testing.assert_array_equal(flat[:, :size], env.simulators[0].observations)
    by_parts = VectorEnv(world, 8, task=Approach, observation="dict")
    seen, _ = by_parts.reset()
    assert by_parts.observation_space.contains(seen)
    for name, part in env.observation_parts.items():
        np.testing.assert_array_equal(seen[name], flat[:, part])


def test_halves_and_ranks(world):
    """Neither changes what happens in an env."""
    actions = drawing()(32 * 60, ACTIONS).reshape(60, 32, ACTIONS)

    def rows_of(*envs):
        for env in envs:
            env.reset()
        parts = []
        first = 0
        for env in envs:
            here = iter(actions[:, first : first + env.num_envs])
            parts.append(played(env, lambda *_: next(here)))
            first += env.num_envs
        return [np.concatenate(column, axis=1) for column in zip(*parts)]

    whole = rows_of(VectorEnv(world, 32, task=Approach))
    halved = rows_of(VectorEnv(world, 32, task=Approach, halves=2))
    ranked = rows_of(*(VectorEnv(world, 16, task=Approach, rank=rank, ranks=2) for rank in (0, 1)))
    for one, two, three in zip(whole, halved, ranked):
        np.testing.assert_array_equal(one, two)
        np.testing.assert_array_equal(one, three)
    assert whole[4].any()


@pytest.mark.parametrize("halves", [1, 2])
def test_measures(world, halves):
    """Of the episodes that ended, with masks, by the same names in each step in which some did."""
    env = VectorEnv(world, 16, task=Approach, halves=halves)
    assert env.measures == ("twice_gained", "env")
    assert VectorEnv(world, 16, task="pick").measures == ()
    env.reset()
    draw, some = drawing(), 0
    for _ in range(40):
        _, _, terminations, truncations, infos = env.step(draw(16, ACTIONS))
        ended = terminations | truncations
        some += 0 < ended.sum() < 16
        if infos:
            final = infos["final_info"]
            np.testing.assert_array_equal(final["_twice_gained"], ended)
            np.testing.assert_array_equal(final["env"][ended], np.flatnonzero(ended))
            assert not final["twice_gained"][~ended].any()
    assert some > 5


@pytest.mark.parametrize("halves", [1, 2])
def test_saved_states(world, halves):
    """Another env goes on from a state, bit for bit."""
    env = VectorEnv(world, 16, task=Approach, halves=halves)
    env.reset()
    played(env, drawing(1), 25)
    state = env.save_state()
    ahead = played(env, drawing(2), 30)
    other = VectorEnv(world, 16, task=Approach, halves=halves)
    other.restore_state(state)
    for one, two in zip(ahead, played(other, drawing(2), 30)):
        np.testing.assert_array_equal(one, two)
    with pytest.raises(galactic.Error, match="task_steps: found missing"):
        env.restore_state(VectorEnv(world, 16, task="none", halves=halves).save_state())


class Remembers(Approach):
    """Observes what was done, and the seed; pays by chance."""

    parts = {"done": ACTIONS, "seeded": 1}
    measures = ()

    def prepare(self, envs):
        super().prepare(envs)
        self.seed = envs.seed

    def step(self, envs):
        return Outcome(envs.uniform("pay")[:, 0], successes=envs.uniform("end")[:, 0] < 0.1)

    def observe(self, envs):
        assert envs.seed == self.seed
        return {"done": envs.actions, "seeded": np.full((envs.num_envs, 1), self.seed)}


@pytest.mark.parametrize("halves", [1, 2])
def test_a_state_has_all_that_a_task_may_look_at(world, halves):
    """Its actions and its seed, too."""
    env = VectorEnv(world, 8, task=Remembers, halves=halves)
    env.reset(seed=7)
    played(env, drawing(1), 12)
    state, seen = env.save_state(), env.observe()
    ahead = played(env, drawing(2), 30)
    for other in (VectorEnv(world, 8, task=Remembers, halves=halves), env):
        other.reset(seed=9)
        other.restore_state(state)
        np.testing.assert_array_equal(other.observe(), seen)
        for one, two in zip(ahead, played(other, drawing(2), 30)):
            np.testing.assert_array_equal(one, two)


def test_named_episodes_draw_the_same(world):
    """Whichever env, rank and wave plays them; episodes that nobody names draw anew."""

    def rewards_of(env, episodes, rows):
        env.reset(options={"episodes": np.full(env.num_envs, episodes)})
        return played(env, drawing(5), 3)[1][:, rows]

    few, many = VectorEnv(world, 2, task=Remembers), VectorEnv(
        world, 6, task=Remembers, rank=1, ranks=2
    )
    few.reset()
    many.reset()
    first = rewards_of(few, 3, 0)
    for again in (rewards_of(few, 3, 1), rewards_of(many, 3, 4), rewards_of(few, 3, 0)):
        np.testing.assert_array_equal(first[0], again[0])
    assert rewards_of(few, 0, 0)[0] != first[0]
    drawn = []
    for _ in range(4):
        few.reset()
        drawn.append(few.step(np.zeros((2, ACTIONS)))[1])
    assert len(np.unique(drawn)) == 8


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
        with pytest.raises(RuntimeError, match="has cut off the last step of this env; reset"):
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


def test_seeds(world):
    """reset(seed) is as good as another env, and seeds differ."""
    fresh = VectorEnv(world, 16, task=Approach, seed=9)
    fresh.reset()
    used = VectorEnv(world, 16, task=Approach, seed=1)
    used.reset()
    first = played(used, drawing(), 25)
    used.reset(seed=9)
    again, wanted = played(used, drawing(), 25), played(fresh, drawing(), 25)
    for one, two in zip(again, wanted):
        np.testing.assert_array_equal(one, two)
    assert not np.array_equal(first[0], again[0])


def test_draws(world):
    """Uniform: each name, env and step has its own."""
    drawn = []

    class Draws(Task):
        def step(self, envs):
            drawn.append([envs.uniform("a", 4), envs.uniform("a", 4), envs.uniform("b", 4)])
            return Outcome(np.zeros(envs.num_envs))

    homes = VectorEnv(world, 500, task=Draws)
    homes.reset()
    for _ in range(2):
        homes.step(np.zeros((500, ACTIONS), np.float32))
    (one, same, other), (later, *_) = drawn
    np.testing.assert_array_equal(one, same)
    values = np.concatenate([one, other, later]).ravel()
    assert len(np.unique(values)) == len(values) == 6000
    assert 0 <= values.min() and values.max() < 1
    assert values.mean() == pytest.approx(0.5, abs=0.02)
    assert values.var() == pytest.approx(1 / 12, abs=0.005)


def test_base(world):
    """The simulation's task below: its rewards are there, its ends count, the task's word goes first."""

    class Below(Task):
        base = "rearrange"
        options = {"episode_steps": 30, "failure_penalty": 2}

        def step(self, envs):
            seen.append((envs.rewards.copy(), envs.endings.copy(), envs.actions.copy()))
            return Outcome(envs.rewards + 1)

    seen = []
    draw, plain_draw = drawing(), drawing()
    env = VectorEnv(world, 32, task=Below)
    plain = VectorEnv(world, 32, task="rearrange", episode_steps=30, failure_penalty=2)
    env.reset()
    plain.reset()
    ends = set()
    for _ in range(80):
        actions = draw(32, ACTIONS)
        _, rewards, terminations, truncations, infos = env.step(actions)
        _, below, *ended, plain_infos = plain.step(plain_draw(32, ACTIONS))
        np.testing.assert_array_equal(rewards, below + 1)
        np.testing.assert_array_equal([terminations, truncations], ended)
        np.testing.assert_array_equal(seen[-1][2], actions)
        if infos:
            endings = infos["final_info"]["ending"]
            np.testing.assert_array_equal(endings, plain_infos["final_info"]["ending"])
            np.testing.assert_array_equal(endings, seen[-1][1])
            ends |= set(endings.tolist())
    assert len(ends) > 2

    class Severe(Below):
        def step(self, envs):
            return Outcome(envs.rewards, failures=envs.endings == EpisodeEnd.WRONG_TERMINATE)

    env = VectorEnv(world, 32, task=Severe)
    env.reset()
    found = played(env, drawing(), 80)[4]
    assert EpisodeEnd.FAILURE in found and EpisodeEnd.WRONG_TERMINATE not in found


def test_options(world):
    """Those that are given go before the task's; a task is made for each half."""
    made = []

    class Limited(Approach):
        def __init__(self, most=7):
            self.options = {"episode_steps": most, "bump": True}
            made.append(self)

    env = VectorEnv(world, 4, task=Limited, halves=2)
    assert len(made) == 2
    options = env.simulators[0].options
    assert (options["task"], options["episode_steps"], options["bump"]) == ("none", 7, True)
    env = VectorEnv(world, 4, task=lambda: Limited(most=9), bump=False)
    options = env.simulators[0].options
    assert (options["episode_steps"], options["bump"]) == (9, False)


def test_choice(world):
    """Episodes of the task's choice, but where the caller of reset() chooses."""

    class Chosen(Approach):
        def choose(self, envs, which):
            asked.append(which.tolist())
            return np.where(which % 2 == 0, 3, -1)

    asked = []
    env = VectorEnv(world, 4, task=Chosen)
    assert asked == [[0, 1, 2, 3]]
    env.reset()
    (simulator,) = env.simulators
    assert simulator.episodes()[[0, 2]].tolist() == [3, 3]
    env.reset(options={"episodes": np.array([0, 0, -1, -1])})
    assert simulator.episodes()[:3].tolist() == [0, 0, 3]
    asked.clear()
    env.reset(options={"reset_mask": np.array([True, False, False, True])})
    assert asked == [[0, 3]]
    assert simulator.episodes()[:3].tolist() == [3, 0, 3]
    found = set()
    for _ in range(60):
        _, _, terminations, truncations, infos = env.step(np.zeros((4, ACTIONS)))
        for row in np.flatnonzero(terminations | truncations):
            found.add((row % 2, int(infos["final_info"]["episode_index"][row])))
    assert {episode for parity, episode in found if parity == 0} == {3}
    assert len({episode for parity, episode in found if parity == 1}) > 1


def test_states_are_of_now(world):
    """What a task has looked at is not what it sees after the next step."""

    class Looks(Task):
        options = {"episode_steps": 10}

        def begin(self, envs, which):
            starts = envs.states.world_from_root.translation[which]
            expected = envs.simulator.env_states().world_from_root.translation[which]
            np.testing.assert_array_equal(starts, expected)
            assert (envs.states.step[which] == 0).all()

        def step(self, envs):
            np.testing.assert_array_equal(envs.states.step, envs.simulator.env_states().step)
            return Outcome(envs.states.world_from_grip.translation[:, 0])

    env = VectorEnv(world, 8, task=Looks)
    env.reset()
    rewards = played(env, drawing(), 25)[1]
    assert (np.diff(rewards, axis=0) != 0).any(axis=0).all()


def test_each_episode_once(world):
    """Envs that have had their share are idle, whatever the task says."""

    class Pays(Task):
        options = {"episode_steps": 5}

        def step(self, envs):
            everywhere = np.ones(envs.num_envs)
            return Outcome(everywhere, successes=envs.states.step >= 3)

    env = VectorEnv(world, 2, task=Pays, order="partition")
    env.reset()
    ended = []
    for _ in range(12):
        idle = env.simulators[0].idle.copy()
        _, rewards, terminations, _, infos = env.step(np.zeros((2, ACTIONS)))
        np.testing.assert_array_equal(rewards, ~idle)
        ended += [
            int(infos["final_info"]["episode_index"][row]) for row in np.flatnonzero(terminations)
        ]
    assert env.simulators[0].idle.all()
    assert sorted(ended) == [0, 1, 3]


def test_images(world):
    """Images and parts of the same moment: before the next episode begins, and after."""
    camera = {"width": 8, "height": 8, "color": None}
    env = VectorEnv(world, 8, task=Approach, images=camera, observation="dict")
    env.reset()
    draw, ends = drawing(), 0
    for _ in range(30):
        observations, _, terminations, truncations, infos = env.step(draw(8, ACTIONS))
        again = env.renderers[0].render()["depth"]
        np.testing.assert_array_equal(observations["depth"], again)
        for row in np.flatnonzero(terminations | truncations):
            ends += 1
            assert infos["final_obs"][row]["gained"] == pytest.approx(
                infos["final_info"]["episode"]["r"][row], abs=1e-5
            )
            assert observations["gained"][row] == 0
    assert ends


def test_images_have_names_of_their_own(world):
    camera = {"hand": {"camera": "head", "width": 8, "height": 8}}
    for members, message in (
        ({"parts": {"hand_rgb": 1}}, "Faulty.parts has 'hand_rgb'"),
        ({"measures": ("hand_world_from_camera",)}, "Faulty.measures has 'hand_world_from_camera'"),
    ):
        with pytest.raises(ValueError, match=message):
            VectorEnv(world, 4, task=of(**members), images=camera)


def test_landing(world):
    """Results in the caller's arrays are those of a step that returns its own."""
    one, two = (VectorEnv(world, 8, task=Approach, copy=copy) for copy in (True, False))
    rollout = two.buffers(30)
    assert rollout["state"].shape[2] == one.observation_space.shape[1]
    one.reset()
    two.reset()
    draw = drawing()
    for step in range(30):
        actions = draw(8, ACTIONS)
        observations, rewards, terminations, truncations, infos = one.step(actions)
        row = {name: rows[step] for name, rows in rollout.items() if name != "state"}
        two.step(actions, out={**row, "state": rollout["state"][step + 1]})
        np.testing.assert_array_equal(rollout["state"][step + 1], observations)
        np.testing.assert_array_equal(rollout["rewards"][step], rewards)
        np.testing.assert_array_equal(rollout["terminations"][step], terminations)
        endings = infos["final_info"]["ending"] if infos else np.zeros(8)
        np.testing.assert_array_equal(rollout["endings"][step], endings)


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
        (of(parts={"to door": 1}), ValueError, "Faulty.parts has 'to door'"),
        (of(parts={"door": 0}), ValueError, r"Faulty.parts\['door'\] is 0, expected how many"),
        (of(measures=("success",)), ValueError, "Faulty.measures has 'success', expected a name of its"),
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
