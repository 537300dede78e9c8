"""World and Simulator: what arrays are, how long they live, what is refused."""

import copy
import gc
import inspect
import pickle
import weakref

import numpy as np
import pytest

import galactic
from galactic import EpisodeEnd, Error, ErrorCode, PlanningScene, Simulator, World

ENVS = 20


@pytest.fixture
def simulator(world):
    return Simulator(world, envs=ENVS, threads=1, seed=7, episode_steps=30)


def test_world_says_what_is_in_it(world):
    assert world.scenes == ("room",) or len(world.scenes) == 1
    assert world.robot == "helper"
    assert world.joints == ("lift", "elbow", "reach", "wrist")
    assert world.positions == world.joints
    assert world.episodes == 4
    assert len(world.objects) == 2
    assert world.radii == pytest.approx((0.016, 0.05, 0.12))
    assert world.options["task"] == "rearrange"
    assert "helper" in repr(world)


def test_world_takes_a_path_a_text_or_a_list_of_them(world_path):
    for given in (str(world_path), world_path, [world_path], [str(world_path)]):
        assert World(given).episodes == 4
    assert World(world_path, trusted=True).episodes == 4


def test_errors_of_the_library_have_code_place_and_message(tmp_path):
    with pytest.raises(Error) as caught:
        World(tmp_path / "none.pack")
    error = caught.value
    assert error.code is ErrorCode.IO
    assert error.where.endswith("none.pack")
    assert "No such file" in error.message
    assert str(error) == f"{error.where}: {error.message}"
    assert isinstance(error, Exception)
    assert pickle.loads(pickle.dumps(error)).code is ErrorCode.IO
    (tmp_path / "bad.pack").write_bytes(b"nothing" * 100)
    with pytest.raises(Error) as caught:
        World(tmp_path / "bad.pack")
    assert caught.value.code is ErrorCode.INVALID_INPUT


def test_arrays_have_the_shapes_and_types_that_they_promise(simulator, draw_actions):
    assert (simulator.num_envs, simulator.action_count, simulator.observation_size) == (ENVS, 8, 23)
    simulator.step(draw_actions(ENVS, 8))
    for name, shape, dtype in (
        ("observations", (ENVS, 23), np.float32),
        ("final_observations", (ENVS, 23), np.float32),
        ("rewards", (ENVS,), np.float32),
        ("dones", (ENVS,), np.bool_),
        ("successes", (ENVS,), np.bool_),
        ("picks", (ENVS,), np.bool_),
        ("endings", (ENVS,), np.uint8),
    ):
        array = getattr(simulator, name)
        assert (array.shape, array.dtype) == (shape, dtype), name
        assert array.flags.c_contiguous
        assert not array.flags.writeable
        assert not array.flags.owndata
        with pytest.raises(ValueError):
            array[0] = 0
        with pytest.raises(ValueError):
            array.flags.writeable = True


def test_parts_of_an_observation_tile_its_row(simulator):
    parts = simulator.observation_parts
    assert list(parts) == [
        "robot_target",
        "grip_target",
        "robot_grip",
        "robot_goal",
        "grip_goal",
        "is_holding",
        "joints",
        "time",
    ]
    covered = [n for part in parts.values() for n in range(part.start, part.stop)]
    assert covered == list(range(simulator.observation_size))


def test_actions_do_what_the_world_says_of_them(world, draw_actions):
    names = [action.name for action in world.actions]
    assert names == [*world.joints, "forward", "turn", "hand", "terminate"]
    simulator = Simulator(world, envs=1, threads=1, task="none", order="linear", slide="off")
    assert len(names) == simulator.action_count
    for column, action in enumerate(world.actions[: len(world.joints)]):
        moved = clamped = 0
        for sign in [1] * 12 + [-1] * 24:
            before = simulator.env_state(0).joint_positions
            actions = np.zeros((1, simulator.action_count), np.float32)
            actions[0, column] = sign
            simulator.step(actions)
            after = simulator.env_state(0).joint_positions
            other = np.delete(np.arange(len(before)), action.position)
            np.testing.assert_array_equal(after[other], before[other])
            way = after[action.position] - before[action.position]
            at_limit = action.lower is not None and (
                after[action.position] in (np.float32(action.lower), np.float32(action.upper))
            )
            if at_limit:
                clamped += 1
            elif way != 0:  # else it was refused
                assert way == pytest.approx(sign * action.step, abs=1e-6)
                moved += 1
        assert moved > 0, action
        assert (action.lower is None) == (action.upper is None) == (action.name == "elbow")
        assert action.lower is None or clamped > 0, action
    forward, turn, hand, terminate = world.actions[-4:]
    before = simulator.env_state(0).world_from_root
    actions = np.zeros((1, simulator.action_count), np.float32)
    actions[0, -4] = -1
    simulator.step(actions)
    after = simulator.env_state(0).world_from_root
    way = np.linalg.norm(after.translation - before.translation)
    assert way == pytest.approx(forward.step, abs=1e-5)
    assert [one.unit for one in world.actions[:6]] == ["m", "rad", "m", "rad", "m", "rad"]
    assert turn.step == pytest.approx(0.05)
    for one in (hand, terminate):
        assert (one.step, one.unit, one.lower, one.upper, one.position) == (None,) * 5
    assert repr(world.actions[0]) == "<galactic.Action lift, 0.05 m a step, from 0 to 0.8>"
    assert repr(hand) == "<galactic.Action hand>"


def test_actions_of_joints_that_cannot_be_simulated_have_no_unit(world_path):
    world = World(world_path.parent / "planar" / "world.pack")
    assert world.joints == ("lift", "elbow", "reach", "wrist", "")
    assert [action.unit for action in world.actions] == [
        "m",
        "rad",
        "m",
        None,
        None,
        "m",
        "rad",
        None,
        None,
    ]
    assert repr(world.actions[3]) == "<galactic.Action wrist, from -1 to 1>"
    with pytest.raises(Error, match="planar or floating, and an action or an episode moves it"):
        Simulator(world, envs=1)


def test_a_base_that_drives_sideways_has_an_action_for_it(world_path):
    world = World(world_path.parent / "sideways" / "world.pack")
    names = [action.name for action in world.actions]
    assert names == [*world.joints, "forward", "turn", "sideways", "hand", "terminate"]
    column = names.index("sideways")
    sideways = world.actions[column]
    assert repr(sideways) == "<galactic.Action sideways, 0.0625 m a step>"
    simulator = Simulator(world, envs=1, threads=1, task="none", order="linear", slide="off")
    before = simulator.env_state(0).world_from_root
    actions = np.zeros((1, simulator.action_count), np.float32)
    actions[0, column] = 1
    simulator.step(actions)
    after = simulator.env_state(0).world_from_root
    way = after.translation - before.translation
    assert np.linalg.norm(way) == pytest.approx(sideways.step, abs=1e-5)
    # To the left: -Z of the root, which looks along its +X.
    w, _, y, _ = before.rotation
    yaw = 2 * np.arctan2(y, w)
    np.testing.assert_allclose(
        way[[0, 2]], -sideways.step * np.array([np.sin(yaw), np.cos(yaw)]), atol=1e-5
    )
    homes = galactic.VectorEnv(world, 2, actions="paper")
    assert homes.single_action_space["continuous"].shape == (len(names) - 2,)


def test_links_and_objects_have_names(world):
    simulator = Simulator(world, envs=8, threads=1)
    assert len(world.links) == len(PlanningScene(simulator).root_from_links)
    assert len(set(world.links)) == len(world.links)
    seen = set()
    for env in range(8):
        state = simulator.env_state(env)
        assert len(state.object_names) == len(state.objects)
        seen |= set(state.object_names)
    assert seen == set(world.objects)
    assert repr(state) == (
        f"<galactic.EnvState of episode {state.episode} after 0 steps, nothing in the hand>"
    )
    target = state.object_names[state.target]
    alone = Simulator(world, envs=8, threads=1, no_distractors=True).env_state(7)
    assert alone.object_names == (target,)


def test_everything_has_words_that_help_shows():
    for name in galactic.__all__:
        one = getattr(galactic, name)
        if not isinstance(one, type):
            continue
        assert one.__doc__, name
        for member, value in vars(one).items():
            is_shown = inspect.isroutine(value) or isinstance(value, property)
            if is_shown and not member.startswith("_"):
                assert value.__doc__ or member in one.__doc__, f"{name}.{member}"
    for one in (galactic.Action, galactic.EnvState, galactic.Pose):
        for member, value in vars(one).items():
            if isinstance(value, property):
                assert value.__doc__, f"{one.__name__}.{member}"


def test_what_is_no_world_and_no_simulator_is_refused_in_our_words(world):
    with pytest.raises(TypeError, match="path is a int, expected the path of a world pack, or"):
        World(3)
    env = galactic.VectorEnv(world, 2, threads=1)
    for make in (PlanningScene, galactic.Renderer):
        with pytest.raises(
            TypeError, match="is a VectorEnv, expected a galactic.Simulator; VectorEnv.sim"
        ):
            make(env)


def test_arrays_are_views_that_follow_the_simulator(simulator, draw_actions):
    observations = simulator.observations
    before = observations.copy()
    simulator.step(draw_actions(ENVS, 8))
    assert np.shares_memory(observations, simulator.observations)
    assert not np.array_equal(observations, before)
    state = simulator.env_state(3)
    joints = simulator.observation_parts["joints"]
    np.testing.assert_array_equal(observations[3, joints], state.joint_positions)


def test_arrays_keep_the_simulator_and_its_world_alive(world_path, draw_actions):
    simulator = Simulator(World(world_path), envs=ENVS, threads=2)
    simulator.step(draw_actions(ENVS, 8))
    arrays = [simulator.observations, simulator.rewards, simulator.endings]
    copies = [array.copy() for array in arrays]
    owner = weakref.ref(simulator)
    del simulator
    gc.collect()
    assert owner() is not None
    for array, wanted in zip(arrays, copies):
        np.testing.assert_array_equal(array, wanted)
    del arrays, array
    gc.collect()
    assert owner() is None


def test_actions_are_converted_unless_they_fit_already(world, draw_actions):
    actions = draw_actions(ENVS, 8)
    results = []
    for given in (
        actions,
        actions.astype(np.float64),
        np.asfortranarray(actions),
        np.repeat(actions, 2, axis=0)[::2],
        actions.tolist(),
    ):
        simulator = Simulator(world, envs=ENVS, threads=1)
        simulator.step(given)
        results.append(simulator.observations)
    for result in results[1:]:
        np.testing.assert_array_equal(result, results[0])


@pytest.mark.parametrize(
    "actions, error, message",
    [
        (np.zeros((ENVS, 7), np.float32), ValueError, "has the shape (20, 7), expected (20, 8)"),
        (np.zeros(ENVS * 8, np.float32), ValueError, "has the shape (160,), expected (20, 8)"),
        (np.zeros((ENVS, 8, 1), np.float32), ValueError, "has the shape (20, 8, 1)"),
        ("drive", (TypeError, ValueError), "actions"),
        (None, (TypeError, ValueError), "actions"),
        (object(), TypeError, "actions is a object, expected an array of numbers"),
    ],
)
def test_wrong_actions_are_refused(simulator, actions, error, message):
    before = simulator.observations.copy()
    with pytest.raises(error) as caught:
        simulator.step(actions)
    assert message in str(caught.value)
    np.testing.assert_array_equal(simulator.observations, before)


def test_resets_begin_the_episode_that_they_name(simulator, draw_actions):
    resets = np.full(ENVS, -1, np.int32)
    resets[4] = 3
    simulator.step(draw_actions(ENVS, 8), resets)
    assert simulator.episodes()[4] == 3
    assert simulator.env_state(4).step == 0
    assert simulator.env_state(5).step == 1
    with pytest.raises(ValueError, match="resets"):
        simulator.step(draw_actions(ENVS, 8), resets[1:])
    chosen = np.full(ENVS, Simulator.STAYS, np.int32)
    chosen[0] = 1
    chosen[1] = Simulator.NEXT_EPISODE
    simulator.reset(chosen)
    assert simulator.episodes()[0] == 1
    assert [simulator.env_state(n).step for n in (0, 1, 2)] == [0, 0, 1]


@pytest.mark.parametrize(
    "number, error, message",
    [
        (4, IndexError, "there is no episode 4; the world's last is 3"),
        (99, IndexError, "there is no episode 99"),
        (-3, IndexError, "there is no episode -3"),
        (2**31, IndexError, "there is no episode 2147483648"),
        (2**33 + 3, IndexError, "there is no episode 8589934595"),
        (2**32 - 1, IndexError, "there is no episode 4294967295"),
        (2**64 - 1, IndexError, "has 18446744073709551615, expected at most 9223372036854775807"),
        (2, ValueError, "the robot cannot start in episode 2; skipped_episodes lists all such"),
        (1.0, TypeError, "float64 numbers, expected an array of whole numbers"),
        (2**70, TypeError, "object numbers, expected an array of whole numbers"),
    ],
)
def test_episodes_that_cannot_begin_are_refused_and_nothing_happens(
    simulator, draw_actions, number, error, message
):
    simulator.step(draw_actions(ENVS, 8))
    before = simulator.save_state()
    dtype = np.uint64 if number == 2**64 - 1 else None
    chosen = np.array([0] * (ENVS - 1) + [number], dtype)
    actions = draw_actions(ENVS, 8)
    for call in (
        lambda: simulator.reset(chosen),
        lambda: simulator.check_episodes(chosen),
        lambda: simulator.step(actions, chosen),
        lambda: simulator.begin_step(actions, chosen),
    ):
        with pytest.raises(error) as caught:
            call()
        assert message in str(caught.value)
        assert simulator.save_state() == before


MASK = np.array([False, True] * (ENVS // 2))


@pytest.mark.parametrize(
    "env, error, message",
    [
        (ENVS, IndexError, "there is no env 20, the last is 19"),
        (-1, IndexError, "there is no env -1, the last is 19"),
        (2**70, IndexError, f"there is no env {2**70}, the last is 19"),
        (1.5, TypeError, "an env is a float, expected its number"),
        (True, TypeError, "an env is a bool, expected its number"),
        (MASK[0], TypeError, "an env is a bool_, expected its number; numpy.flatnonzero(mask) has"),
    ],
)
def test_what_is_no_number_of_an_env_is_refused_wherever_one_is_asked_for(
    simulator, env, error, message
):
    state = simulator.save_state([0, 1])
    planning = PlanningScene(simulator)
    for call in (
        lambda: simulator.env_state(env),
        lambda: simulator.statistics(env),
        lambda: simulator.episodes([env]),
        lambda: simulator.save_state(envs=[0, env]),
        lambda: simulator.restore_state(state, envs=[0, env]),
        lambda: planning.update(env),
        lambda: PlanningScene(simulator, env),
    ):
        with pytest.raises(error) as caught:
            call()
        assert message in str(caught.value)


def test_envs_are_numbers_and_no_mask(simulator):
    state = simulator.save_state(range(ENVS))
    for call in (
        simulator.episodes,
        simulator.save_state,
        lambda e: simulator.restore_state(state, e),
    ):
        with pytest.raises(TypeError, match="an env is a bool_, expected its number"):
            call(MASK)
        with pytest.raises(TypeError, match="envs is a int, expected numbers of envs"):
            call(3)
    chosen = np.flatnonzero(MASK)
    for envs in (chosen, chosen.tolist(), chosen.astype(np.uint8), iter(chosen)):
        np.testing.assert_array_equal(simulator.episodes(envs), simulator.episodes()[MASK])
    assert len(simulator.episodes([])) == 0


def test_the_next_episode_is_none_that_a_step_begins(simulator, draw_actions):
    nexts = np.full(ENVS, Simulator.NEXT_EPISODE)
    simulator.check_episodes(nexts)
    with pytest.raises(IndexError, match=r"^resets has NEXT_EPISODE, which is for reset\(\); exp"):
        simulator.step(draw_actions(ENVS, 8), nexts)
    simulator.reset(nexts.astype(np.int8))
    assert [simulator.env_state(n).step for n in range(ENVS)] == [0] * ENVS


def test_a_reset_of_nothing_in_particular_begins_the_next_episodes(simulator, world):
    twin = Simulator(world, envs=ENVS, threads=1, seed=7, episode_steps=30)
    for one in (simulator, twin):
        one.step(np.zeros((ENVS, 8), np.float32))
    simulator.reset()
    twin.reset(np.full(ENVS, Simulator.NEXT_EPISODE))
    np.testing.assert_array_equal(simulator.episodes(), twin.episodes())
    np.testing.assert_array_equal(simulator.observations, twin.observations)
    assert [simulator.env_state(n).step for n in range(ENVS)] == [0] * ENVS


def test_calls_that_fit_nothing_are_told_what_is_taken_and_what_was_found(world, simulator):
    renderer = galactic.Renderer(Simulator(world, envs=1, body_transforms=True), backend="soft")
    rows = np.zeros((ENVS, 8), np.float32)
    for call, message in (
        (World, "galactic.World() takes (path, trusted: bool=False), found nothing"),
        (lambda: World("a.pack", "no"), "takes (path, trusted: bool=False), found (str, str)"),
        (lambda: Simulator(world, 3, 4), "galactic.Simulator() takes (world, envs=None, **kwargs), "
         "found (World, int, int)"),
        (simulator.step, "Simulator.step() takes (actions, resets=None), found nothing"),
        (lambda: simulator.step(rows, reset=1), "found (ndarray, reset=int)"),
        (lambda: simulator.reset(seed=3), "Simulator.reset() takes (episodes=None, *, drawn: bool=False), found (seed=int)"),
        (lambda: simulator.end_step(3), "Simulator.end_step() takes nothing, found (int)"),
        (lambda: galactic.LearnedPolicy("a.pack"), "galactic.LearnedPolicy() takes (path: "),
        (lambda: renderer.render(3), "out is a int, expected a dictionary of arrays by name"),
    ):  # fmt: skip
        with pytest.raises(TypeError) as caught:
            call()
        assert message in str(caught.value) and "\n" not in str(caught.value)
    with pytest.raises(Error, match="every: is -1, expected a whole number from 0"):
        simulator.sample_phases(-1)
    with pytest.raises(Error, match="stream: is -1, expected a whole number from 0"):
        renderer.render_to_device(-1)
    # What is converted still is, and what help() shows is what there was.
    scene = PlanningScene(simulator)
    assert scene.floor_at(1, np.float32(1), 1) == scene.floor_at(1.0, 1.0, 1.0)
    assert Simulator.end_step.__doc__ == (
        "end_step(self: galactic._core.Simulator) -> None\n\n"
        "The second half of step(): helps the threads, and waits for its end.\n"
    )


def test_wrong_arguments_are_refused_in_our_words(world):
    assert Simulator(world, 3).num_envs == 3
    assert Simulator(world, envs=np.int64(2)).num_envs == 2
    for make, error, message in (
        (lambda: Simulator("home.pack", 3), TypeError, "world is a str, expected a galactic.World"),
        (lambda: Simulator(world, 3.5), Error, "envs: is 3.5, expected"),
        (lambda: Simulator(world, 3, auto_reset="no"), Error,
         "auto_reset: is 'no', expected True or False"),
        (lambda: Simulator(world, 3, threads=2**70), Error,
         f"threads: is {2**70}, expected 0 to 4096"),
        (lambda: Simulator(world, 3).restart(-1), Error,
         "seed: is -1, expected a whole number from 0 to 18446744073709551615"),
        (lambda: Simulator(world, 3).restart(1.5), Error, "seed: is 1.5, expected"),
    ):  # fmt: skip
        with pytest.raises(error) as caught:
            make()
        assert message in str(caught.value)


@pytest.mark.parametrize("action", [pickle.dumps, copy.copy, copy.deepcopy])
def test_nothing_is_pickled_or_copied(world, simulator, action):
    for one in (world, simulator):
        with pytest.raises(TypeError, match="cannot be pickled or copied: "):
            action(one)


def test_endings_agree_with_dones_and_successes(world, draw_actions):
    simulator = Simulator(world, envs=64, threads=2, task="pick", episode_steps=40, seed=2)
    seen = set()
    for _ in range(300):
        simulator.step(draw_actions(64, 8))
        endings = simulator.endings
        np.testing.assert_array_equal(simulator.dones, endings != EpisodeEnd.NONE)
        np.testing.assert_array_equal(simulator.successes, endings == EpisodeEnd.SUCCESS)
        seen |= set(endings.tolist())
    assert {EpisodeEnd.NONE, EpisodeEnd.TIME_OUT} <= seen
    figures = simulator.statistics()
    assert figures["steps"] == 64 * 300
    assert figures["episodes"] >= 64 * 7


@pytest.mark.parametrize("task", ["rearrange", "none"])
def test_picks_are_of_episodes_in_which_the_hand_had_the_target(world, draw_actions, task):
    """Also where it has let go of it since, and the next episode has begun."""
    options = {"safe_drop": task != "none", "episode_steps": 50, "seed": 2}
    staying, renewing = (
        Simulator(world, envs=64, threads=2, task=task, auto_reset=renews, **options)
        for renews in (False, True)
    )
    states = staying.env_states()
    states.hold(world, rows=slice(16))
    given = staying.set_states(states)
    np.testing.assert_array_equal(renewing.set_states(states), given)
    held = given & (np.arange(64) < 16)
    lost = 0
    for _ in range(200):
        actions = draw_actions(64, 8)
        staying.step(actions)
        renewing.step(actions)
        states, dones = staying.env_states(), staying.dones
        held |= states.held == states.target
        np.testing.assert_array_equal(staying.picks, dones & held)
        np.testing.assert_array_equal(renewing.picks, dones & held)
        lost += (held & dones & (states.held != states.target)).sum()
        held &= ~dones
        staying.reset(np.where(dones, Simulator.NEXT_EPISODE, Simulator.STAYS))
    figures = renewing.statistics()
    assert 10 < figures["picks"] < figures["episodes"] - 10 and lost > 2
    assert figures["picks"] == staying.statistics()["picks"]
    assert renewing.counts()["picks"].sum() == figures["picks"]


def test_states_have_frames_and_objects(simulator):
    state = simulator.env_state(0)
    assert state.world_from_root.translation.shape == (3,)
    assert np.linalg.norm(state.world_from_root.rotation) == pytest.approx(1, abs=1e-5)
    assert 0 <= state.target < len(state.objects)
    assert state.held is None
    assert state.step == 0
    assert "Pose(translation=" in repr(state.goal)
    with pytest.raises(IndexError, match="there is no env 20, the last is 19"):
        simulator.env_state(ENVS)


def test_phases_are_measured_on_demand(simulator, draw_actions):
    simulator.sample_phases(1)
    for _ in range(5):
        simulator.step(draw_actions(ENVS, 8))
    times = simulator.phase_times()
    assert list(times)[:2] == ["actions", "propose"]
    assert sum(times.values()) > 0


def test_skipped_episodes_are_listed(simulator):
    assert simulator.skipped_episodes == [2]
    assert simulator.memory_bytes > 0
    assert simulator.shared_bytes > 0
    assert simulator.thread_count == 1


def test_a_partition_plays_each_episode_once_and_then_idles(world, draw_actions):
    envs = 2
    simulator = galactic.Simulator(world, envs=envs, order="partition", episode_steps=20, threads=1)
    assert simulator.idle.dtype == np.bool_ and not simulator.idle.all()
    played = []
    while not simulator.idle.all():
        episodes = simulator.episodes()
        simulator.step(draw_actions(envs, simulator.action_count))
        played += episodes[simulator.dones].tolist()
    assert sorted(played) == sorted(set(played)) and len(played) > 0
    assert simulator.statistics()["episodes"] == len(played)
    seen = simulator.observations.copy()
    simulator.step(draw_actions(envs, simulator.action_count))
    assert np.array_equal(seen, simulator.observations)


def test_envs_that_ended_wait_for_a_reset(world, draw_actions):
    simulator = galactic.Simulator(world, envs=2, episode_steps=3, auto_reset=False, threads=1)
    for _ in range(8):
        simulator.step(draw_actions(2, simulator.action_count))
    assert simulator.idle.all() and not simulator.dones.any() and not simulator.rewards.any()
    assert simulator.statistics()["episodes"] == 2
    simulator.reset(np.array([simulator.NEXT_EPISODE, simulator.STAYS]))
    assert simulator.idle.tolist() == [False, True]


def test_names_that_are_no_utf8_have_other_characters_in_their_place(world_path):
    world = galactic.World(world_path.parent / "strange" / "world.pack")
    replaced = "\N{REPLACEMENT CHARACTER}"
    assert world.objects == ("bowl", f"mug {3 * replaced}")
    assert world.links[3] == f"arm {replaced}"
    assert world.joints[-1] == world.actions[3].name == f"wrist {4 * replaced}"
    assert replaced in repr(world.actions[3])
    simulator = galactic.Simulator(world, envs=2, threads=1, body_transforms=True)
    state = simulator.env_state(0)
    assert f"mug {3 * replaced}" in state.object_names
    assert pickle.loads(pickle.dumps(state)).object_names == state.object_names
    renderer = galactic.Renderer(simulator, width=8, height=8, backend="soft")
    assert any(f"thing {3 * replaced}" in name for name in renderer.semantic_names)


def test_the_version_is_that_of_the_project():
    assert galactic.__version__.count(".") == 2


def test_options_that_no_world_takes_are_told_without_one():
    galactic.Simulator.check_options(task="pick", episode_steps="200", laser_beams=8, bump=True)
    with pytest.raises(TypeError, match="no option epsiode_steps; did you mean episode_steps"):
        galactic.Simulator.check_options(epsiode_steps=5)
    with pytest.raises(galactic.Error, match="task: is nope, expected rearrange, pick or none"):
        galactic.Simulator.check_options(task="nope")
