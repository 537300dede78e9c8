"""States that the caller has chosen: envs go on from them."""

import warnings

import numpy as np
import pytest

from galactic import EnvStates, Error, Outcome, PlanningScene, Simulator, Task, VectorEnv

ENVS = 20


@pytest.fixture
def fresh(world):
    return Simulator(world, envs=ENVS, threads=2, seed=3, task="none")


def assert_close(states: EnvStates, wanted: EnvStates):
    for name in ("scene", "episode", "step", "held", "target", "object_kinds"):
        np.testing.assert_array_equal(getattr(states, name), getattr(wanted, name), err_msg=name)
    np.testing.assert_allclose(states.joint_positions, wanted.joint_positions, atol=2e-5)
    for name in ("world_from_root", "world_from_grip", "objects", "goal"):
        found, expected = getattr(states, name), getattr(wanted, name)
        np.testing.assert_allclose(found.matrix, expected.matrix, atol=5e-5, err_msg=name)


def test_envs_go_on_where_others_are(played, fresh):
    wanted = played.env_states()
    assert (wanted.held >= 0).any() and (wanted.step > 0).any()
    were_set = fresh.set_states(wanted)
    assert were_set.dtype == bool and were_set.shape == (ENVS,) and were_set.mean() > 0.9
    rows = np.flatnonzero(were_set)
    assert_close(fresh.env_states().select(rows), wanted.select(rows))
    np.testing.assert_allclose(fresh.observations[rows], played.observations[rows], atol=1e-3)


def test_one_state_becomes_that_of_many(played, fresh):
    rows = np.zeros(5, int)
    one = played.env_states().select(rows)
    one.joint_positions[:, 0] += np.linspace(0, 0.1, 5, dtype=np.float32)
    before = fresh.env_states()
    were_set = fresh.set_states(one, [3, 1, 4, 15, 9])
    assert were_set.all()
    now = fresh.env_states([3, 1, 4, 15, 9])
    np.testing.assert_allclose(now.joint_positions, one.joint_positions, atol=1e-6)
    assert (now.episode == one.episode).all()
    others = np.setdiff1d(np.arange(ENVS), [3, 1, 4, 15, 9])
    assert_close(fresh.env_states().select(others), before.select(others))


def test_goals_and_steps_are_as_chosen(fresh):
    states = fresh.env_states()
    states.goal.translation[:] += np.float32(0.125)
    states.step[:] = np.arange(ENVS)
    assert fresh.set_states(states).all()
    now = fresh.env_states()
    np.testing.assert_array_equal(now.goal.translation, states.goal.translation)
    np.testing.assert_array_equal(now.step, np.arange(ENVS))


def test_robots_in_walls_stay_where_they_were(fresh):
    states = fresh.env_states()
    states.world_from_root.translation[::2, 0] = 50
    before = fresh.env_states()
    were_set = fresh.set_states(states)
    np.testing.assert_array_equal(were_set, np.arange(ENVS) % 2 == 1)
    assert_close(fresh.env_states(), before)


def test_planners_and_simulators_agree_on_what_is_free(fresh):
    generator = np.random.default_rng(5)
    states = fresh.env_states()
    states.world_from_root.translation[:, [0, 2]] += generator.normal(0, 0.6, (ENVS, 2))
    expected = []
    for env in range(ENVS):
        scene = PlanningScene(fresh, env)
        base = scene.base.copy()
        base[[0, 2]] = states.world_from_root.translation[env, [0, 2]]
        height = scene.floor_at(float(base[0]), float(base[2]), float(base[1]))
        if height is not None:
            base[1] = height
        expected.append(height is not None and scene.is_free(base))
    were_set = fresh.set_states(states)
    np.testing.assert_array_equal(were_set, expected)
    assert 0 < were_set.sum() < ENVS


def turned(poses, x, w):
    """The same with a rotation about X, or with none that is one."""
    rotation = np.zeros_like(poses.rotation)
    rotation[..., 1], rotation[..., 0] = x, w
    return poses._replace(rotation=rotation)


@pytest.mark.parametrize(
    "change, error, message",
    [
        (lambda s: s._replace(step=s.step[:3]), ValueError, r"states.step"),
        (lambda s: s._replace(step=s.step - 1), ValueError, "states.step is -1"),
        (lambda s: s._replace(held=s.held + 0.5), TypeError, "states.held"),
        (lambda s: s._replace(episode=s.episode + 99), IndexError, "there is no episode"),
        (lambda s: s._replace(held=s.held + 50), Error, "holds object 49"),
        (lambda s: s._replace(target=s.target + 50), Error, "has the target"),
        (
            lambda s: s._replace(joint_positions=s.joint_positions * np.nan),
            Error,
            r"state 0 has joint_positions\[0\] -?nan, expected a finite number",
        ),
        (
            lambda s: s._replace(world_from_root=turned(s.world_from_root, 1, 0)),
            Error,
            r"state 0 has world_from_root.rotation tilted by .* rad, expected at most 0.1",
        ),
        (
            lambda s: s._replace(objects=turned(s.objects, 0, 0)),
            Error,
            r"state 0 has objects\[0\].rotation \(0, 0, 0, 0\), expected a unit quaternion",
        ),
        (lambda s: s._replace(goal=s.goal._replace(translation=None)), ValueError, "states.goal"),
        (
            lambda s: s._replace(objects=s.objects._replace(rotation=s.goal.rotation)),
            ValueError,
            "states.objects",
        ),
        (lambda s: tuple(s), TypeError, "expected galactic.EnvStates"),
        (lambda s: None, TypeError, "expected galactic.EnvStates"),
    ],
)
def test_what_is_no_state_is_refused_and_nothing_changes(fresh, change, error, message):
    before = fresh.save_state()
    with pytest.raises(error, match=message):
        fresh.set_states(change(fresh.env_states()))
    assert fresh.save_state() == before


def test_numbers_of_envs_have_to_be_there(fresh):
    states = fresh.env_states().select([0, 1])
    with pytest.raises(IndexError, match="there is no env 20"):
        fresh.set_states(states, [0, ENVS])
    with pytest.raises(ValueError, match="states.episode"):
        fresh.set_states(states, [0])
    fresh.begin_step(np.zeros((ENVS, fresh.action_count), np.float32))
    with pytest.raises(RuntimeError):
        fresh.set_states(states, [0, 1])
    fresh.end_step()


@pytest.mark.parametrize("halves", [1, 2])
def test_an_env_that_is_named_twice_is_refused(world, fresh, halves):
    states = fresh.env_states().select([0, 1, 2])
    env = VectorEnv(world, ENVS, halves=halves, seed=3, task="none")
    env.reset()
    for one, state in ((fresh, fresh.save_state([0, 1, 2])), (env, env.save_state([0, 1, 2]))):
        before = one.save_state()
        for call in (
            lambda: one.set_states(states, [11, 4, 11]),
            lambda: one.restore_state(state, [11, 4, 11]),
        ):
            with pytest.raises(Error, match="^envs: has env 11 twice, expected each once"):
                call()
        assert one.save_state() == before


def test_what_is_held_has_to_be_in_the_hand(fresh, world):
    """Any object may be put there, and stays there."""
    states = fresh.env_states()
    states.held[:] = states.target
    assert not fresh.set_states(states).any()
    states.hold(world)
    rows = np.arange(ENVS)
    np.testing.assert_array_equal(states.held, states.target)
    centers = world.object_centers[states.object_kinds[rows, states.held]]
    in_objects = np.hstack([centers, np.ones((ENVS, 1))])
    in_world = np.einsum("nij,nj->ni", states.objects.matrix[rows, states.held], in_objects)
    np.testing.assert_allclose(in_world[:, :3], states.world_from_grip.translation, atol=1e-5)
    assert fresh.set_states(states).all()
    actions = np.zeros((ENVS, fresh.action_count), np.float32)
    actions[:, -2] = 1
    grip_from_held = None
    for _ in range(20):
        fresh.step(actions)
        actions[:, 1] = 1
        now = fresh.env_states()
        np.testing.assert_array_equal(now.held, states.target)
        found = np.linalg.inv(now.world_from_grip.matrix) @ now.objects.matrix[rows, now.held]
        if grip_from_held is not None:
            np.testing.assert_allclose(found, grip_from_held, atol=1e-4)
        grip_from_held = found


def test_objects_are_put_into_some_hands(fresh, world):
    states = fresh.env_states()
    before = states.select(slice(None))
    states.hold(world, 0, rows=states.episode == states.episode[2])
    of_it = states.episode == states.episode[2]
    np.testing.assert_array_equal(states.held, np.where(of_it, 0, -1))
    moved = np.nan_to_num(states.objects.translation - before.objects.translation) != 0
    np.testing.assert_array_equal(moved.any(axis=(1, 2)), of_it)
    np.testing.assert_array_equal(states.objects.rotation, before.objects.rotation)
    states.hold(world, [1, 0], rows=[4, 3])
    assert states.held[4] == 1 and states.held[3] == 0
    states.hold(world, rows=[])
    states.hold(world, 1, rows=3)
    assert states.held[4] == 1 and states.held[3] == 1
    for wrong, error, message in (
        ([-1] * ENVS, IndexError, "state 0 has no object -1; its last is"),
        (99, IndexError, "state 0 has no object 99; its last is"),
        (0.5, TypeError, "objects are float64, expected whole numbers"),
        ([0, 1], ValueError, "could not broadcast"),
    ):
        with pytest.raises(error, match=message):
            states.hold(world, wrong)


def test_luck_is_the_envs_or_the_episodes(world):
    noisy = Simulator(world, envs=2, threads=1, task="none", motion_noise=0.3)
    states = noisy.env_states().select([0, 0])
    actions = np.ones((2, noisy.action_count), np.float32)
    actions[:, -1] = -1
    lifts = {}
    for drawn in (True, False):
        assert noisy.set_states(states, drawn=drawn).all()
        noisy.step(actions)
        lifts[drawn] = noisy.env_states().joint_positions[:, 0]
    assert lifts[True][0] != lifts[True][1]
    assert lifts[False][0] == lifts[False][1]


class Near(Task):
    """Begins two steps into episodes, with targets moved and arms lifted; counts what begins."""

    parts = {"begun": 1}

    def prepare(self, envs):
        self.memory["begun"] = np.zeros(envs.num_envs, np.float32)
        self.memory["lift"] = np.zeros(envs.num_envs, np.float32)

    def place(self, envs, which, states):
        assert len(states.episode) == len(which)
        states.joint_positions[:, 0] += 0.2 * envs.uniform("lift")[which, 0]
        states.step[:] = 2
        rows = np.arange(len(which))
        states.objects.translation[rows, states.target, 0] += 0.01
        return states

    def begin(self, envs, which):
        self.memory["begun"][which] += 1
        self.memory["lift"][which] = envs.states.joint_positions[which, 0]

    def step(self, envs):
        return Outcome(self.memory["lift"])

    def observe(self, envs):
        return {"begun": self.memory["begun"][:, None]}


@pytest.mark.parametrize("halves", [1, 2])
def test_vector_envs_go_on_from_states_as_from_starts(world, played, halves):
    env = VectorEnv(world, ENVS, halves=halves, seed=3, task="none", episode_steps=200)
    env.reset()
    actions = np.zeros(env.action_space.shape, np.float32)
    env.step(actions)
    states = played.env_states()
    rows = [17, 3, 11, 0]
    chosen = states.select(np.flatnonzero(states.held < 0)[:4])
    chosen.step[:] = 199
    were_set = env.set_states(chosen, rows)
    assert were_set.shape == (4,) and were_set.any()
    now = env.env_states().select(np.array(rows)[were_set])
    assert_close(now, chosen.select(were_set))
    observations, _, terminations, truncations, infos = env.step(actions)
    ended = np.zeros(ENVS, bool)
    ended[np.array(rows)[were_set]] = True
    np.testing.assert_array_equal(truncations, ended)
    # Of the steps since then alone.
    assert (infos["episode"]["l"][ended] == 1).all()
    with pytest.raises(ValueError, match="there are 4 states, expected 20"):
        env.set_states(chosen)
    with pytest.raises(Error, match="expected a finite number"):
        env.set_states(chosen._replace(joint_positions=chosen.joint_positions * np.nan), rows)
    env.step(actions)


@pytest.mark.parametrize("halves", [1, 2])
def test_tasks_place_robots_and_objects(world, halves):
    env = VectorEnv(world, ENVS, task=Near, halves=halves, seed=5, episode_steps=6)
    plain = Simulator(world, envs=ENVS, seed=5, threads=1, task="none")
    first, _ = env.reset()
    assert (first[:, -1] == 1).all()
    states = env.env_states()
    assert (states.step == 2).all()
    lifted = states.joint_positions[:, 0] - plain.env_states().joint_positions[:, 0]
    assert lifted.min() > -1e-6 and lifted.max() > 0.1 and len(set(lifted.tolist())) > ENVS // 2
    rows = np.arange(ENVS)
    targets, starts = (
        of.objects.translation[rows, of.target, 0] for of in (states, plain.env_states())
    )
    np.testing.assert_allclose(targets, starts + 0.01, atol=1e-6)
    way = np.linalg.norm(
        states.objects.translation[rows, states.target] - states.world_from_grip.translation, axis=1
    )
    seen = first[:, env.observation_parts["grip_target"]]
    np.testing.assert_allclose(np.linalg.norm(seen, axis=1), way, atol=1e-5)
    actions = np.zeros(env.action_space.shape, np.float32)
    for step in range(4):
        observations, rewards, _, truncations, _ = env.step(actions)
        if step < 3:
            np.testing.assert_allclose(rewards, states.joint_positions[:, 0], atol=1e-6)
        # Two of its six steps were over.
        assert truncations.all() == (step == 3)
    assert (observations[:, -1] == 2).all() and (env.env_states().step == 2).all()
    # States of the caller's count as begun, and are not placed.
    wanted = env.env_states()
    wanted.step[:] = 4
    assert env.set_states(wanted).all()
    assert (env.observe()[:, -1] == 3).all() and (env.env_states().step == 4).all()


class Carry(Task):
    """Bring the target, which is in the hand, to the goal."""

    base = "rearrange"

    def place(self, envs, which, states):
        states.hold(envs.world)
        return states

    def step(self, envs):
        return Outcome(envs.rewards)


@pytest.mark.parametrize("halves", [1, 2])
def test_tasks_begin_with_targets_in_hands(world, halves):
    env = VectorEnv(world, ENVS, task=Carry, halves=halves, seed=5, episode_steps=4)
    env.reset()
    states = env.env_states()
    np.testing.assert_array_equal(states.held, states.target)
    assert env.placements.refused == 0
    actions = np.zeros(env.action_space.shape, np.float32)
    actions[:, -2] = 1
    for step in range(4):
        _, _, terminations, truncations, _ = env.step(actions)
        assert not terminations.any() and truncations.all() == (step == 3)
    # The next episodes, too.
    states = env.env_states()
    assert (states.step == 0).all()
    np.testing.assert_array_equal(states.held, states.target)


def test_named_episodes_are_placed_alike_in_any_env(world):
    env = VectorEnv(world, ENVS, task=Near, seed=5)
    plain = Simulator(world, envs=1, task="none")
    episode = int(np.setdiff1d(np.arange(3), plain.skipped_episodes)[0])
    env.reset(options={"episodes": np.full(ENVS, episode)})
    lifts = env.env_states().joint_positions[:, 0]
    assert len(set(lifts.tolist())) == 1


def test_what_tasks_place_is_checked(world):
    class Wrong(Near):
        def place(self, envs, which, states):
            return states.joint_positions

    with pytest.raises(TypeError, match=r"Wrong.place\(\) returned float32 .*, expected EnvStates"):
        VectorEnv(world, 4, task=Wrong)

    class Few(Near):
        def place(self, envs, which, states):
            return states.select([0])

    with pytest.raises(ValueError, match=r"Few.place\(\) returned 1 states, expected 4"):
        VectorEnv(world, 4, task=Few)

    class Lost(Near):
        def place(self, envs, which, states):
            states.goal.translation[:] = np.inf
            return states

    with pytest.raises(Error, match="has goal.translation .*, expected finite numbers"):
        VectorEnv(world, 4, task=Lost)


class Refused(Near):
    """Every other state is of a robot outside of its home."""

    share = 0.5

    def place(self, envs, which, states):
        states.world_from_root.translation[envs.uniform("where")[which, 0] < self.share, 0] = 50
        return states


@pytest.mark.parametrize("halves", [1, 2])
def test_placements_that_are_refused_are_counted(world, halves):
    env = VectorEnv(world, ENVS, task=Refused, halves=halves, seed=5, episode_steps=6)
    drawn = VectorEnv(world, ENVS, task=Refused, seed=5, episode_steps=6)._parts[0]._task._envs
    outside = int((drawn.uniform("where")[:, 0] < 0.5).sum())
    assert env.placements == (ENVS, outside) and 0 < outside < ENVS
    env.reset()
    assert env.placements.asked == ENVS
    env.reset()
    assert env.placements.asked == 2 * ENVS > env.placements.refused > outside
    assert VectorEnv(world, 4).placements == (0, 0)


def test_a_task_of_which_all_placements_are_refused_is_told(world):
    class Outside(Refused):
        share = 1.0

    with pytest.warns(
        RuntimeWarning, match=r"first 20 states of Outside.place\(\) were all refused"
    ):
        VectorEnv(world, ENVS, task=Outside)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        VectorEnv(world, ENVS, task=Refused)
        VectorEnv(world, 4, task=Outside)
