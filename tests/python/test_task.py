"""Tasks of one's own: galactic.Task in a VectorEnv."""

import numpy as np
import pytest

import galactic
from galactic import EpisodeEnd, Outcome, Task, VectorEnv
from tasks import ACTIONS, Approach, drawing, played


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


class HoldsNow(Approach):
    """Episodes of even envs begin with the target in the hand; measures whether it has ever been there."""

    measures = ("held",)

    def prepare(self, envs):
        super().prepare(envs)
        self.memory["held"] = np.zeros(envs.num_envs, bool)

    def place(self, envs, which, states):
        rows = np.flatnonzero(envs.numbers[which] % 2 == 0)
        states.hold(envs.world, rows=rows)
        return states

    def begin(self, envs, which):
        super().begin(envs, which)
        self.memory["held"][which] = (envs.states.held == envs.states.target)[which]

    def step(self, envs):
        self.memory["held"] |= envs.states.held == envs.states.target
        return super().step(envs)

    def measure(self, envs, which):
        return {"held": self.memory["held"][which]}


@pytest.mark.parametrize("base", ["none", "rearrange"])
@pytest.mark.parametrize("halves", [1, 2])
def test_picked(world, halves, base):
    """Whoever ends an episode, the task or what is below, and whether or not the hand has let go since."""

    class Below(HoldsNow):
        pass

    Below.base = base
    env = VectorEnv(world, 16, task=Below, halves=halves, threads=1)
    env.reset()
    draw, found = drawing(), {}
    for _ in range(80):
        infos = env.step(draw(16, ACTIONS))[4]
        if not infos:
            continue
        final, ended = infos["final_info"], infos["_final_info"]
        assert final["picked"].dtype == bool
        np.testing.assert_array_equal(final["picked"], final["held"] != 0)
        np.testing.assert_array_equal(final["_picked"], ended)
        assert not final["picked"][~ended].any()
        for ending, picked in zip(final["ending"][ended], final["picked"][ended]):
            found.setdefault(EpisodeEnd(ending), set()).add(bool(picked))
    assert found[EpisodeEnd.SUCCESS] == found[EpisodeEnd.FAILURE] == {False, True}
    assert (EpisodeEnd.WRONG_TERMINATE in found) == (base == "rearrange")


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
