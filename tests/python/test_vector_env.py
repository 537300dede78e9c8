"""VectorEnv step by step against the simulator, and what Gymnasium 1.x asks of it."""

import itertools
import multiprocessing

import numpy as np
import pytest

from galactic import EpisodeEnd, Error, Outcome, Renderer, Simulator, Task, VectorEnv, reached

ENVS = 24
OPTIONS = {"threads": 1, "seed": 11, "episode_steps": 35}
IMAGES = {"width": 24, "height": 16, "camera": "follow", "backend": "soft", "semantics": True}


class Follower:
    """The plain loop that VectorEnv stands for: a simulator, and sums kept env by env."""

    def __init__(self, world, **options):
        self.simulator = Simulator(world, envs=ENVS, **{**OPTIONS, **options})
        self.returns = [0.0] * ENVS
        self.lengths = [0] * ENVS

    def step(self, actions):
        """Of the step: what ended, with its return, its length, and which episode it was."""
        episodes = self.simulator.episodes()
        self.simulator.step(actions)
        ended = {}
        for env in range(ENVS):
            self.returns[env] += float(self.simulator.rewards[env])
            self.lengths[env] += 1
            if self.simulator.dones[env]:
                ended[env] = (self.returns[env], self.lengths[env], episodes[env])
                self.returns[env], self.lengths[env] = 0.0, 0
        return ended


@pytest.mark.parametrize("halves", [1, 2])
@pytest.mark.parametrize("task", ["rearrange", "pick"])
def test_steps_are_those_of_the_simulator(world, draw_actions, halves, task):
    env = VectorEnv(world, ENVS, halves=halves, task=task, **OPTIONS)
    plain = Follower(world, task=task)
    observations, infos = env.reset()
    assert infos == {}
    np.testing.assert_array_equal(observations, plain.simulator.observations)
    ends = {end: 0 for end in EpisodeEnd}
    for _ in range(200):
        actions = draw_actions(ENVS, 8)
        observations, rewards, terminations, truncations, infos = env.step(actions)
        ended = plain.step(actions)
        simulator = plain.simulator
        np.testing.assert_array_equal(observations, simulator.observations)
        np.testing.assert_array_equal(rewards, simulator.rewards)
        np.testing.assert_array_equal(truncations, simulator.endings == EpisodeEnd.TIME_OUT)
        np.testing.assert_array_equal(terminations | truncations, simulator.dones)
        assert not (terminations & truncations).any()
        for end in simulator.endings:
            ends[EpisodeEnd(end)] += 1
        check_infos(infos, ended, simulator)
    assert ends[EpisodeEnd.TIME_OUT] > 20
    assert ends[EpisodeEnd.NONE] > 1000
    assert 0 < plain.simulator.statistics()["picks"] < plain.simulator.statistics()["episodes"]


def check_infos(infos, ended, simulator):
    if not ended:
        assert infos == {}
        return
    mask = simulator.dones
    assert set(infos) == {"final_obs", "final_info", "episode"} | {
        "_final_obs",
        "_final_info",
        "_episode",
    }
    for name in ("_final_obs", "_final_info", "_episode"):
        np.testing.assert_array_equal(infos[name], mask)
    assert infos["final_obs"].dtype == object
    final = infos["final_info"]
    for env in range(ENVS):
        if env not in ended:
            assert infos["final_obs"][env] is None
            continue
        total, length, episode = ended[env]
        np.testing.assert_array_equal(infos["final_obs"][env], simulator.final_observations[env])
        assert infos["episode"]["r"][env] == pytest.approx(total, abs=1e-5)
        assert infos["episode"]["l"][env] == length
        assert final["episode"]["l"][env] == length
        assert final["ending"][env] == simulator.endings[env]
        assert final["success"][env] == simulator.successes[env]
        assert final["picked"][env] == simulator.picks[env]
        assert final["episode_index"][env] == episode
    for name, nothing in {"ending": 0, "success": 0, "picked": 0, "episode_index": -1}.items():
        assert (final[name][~mask] == nothing).all()


@pytest.mark.parametrize("halves", [1, 2])
def test_no_array_of_infos_is_another_one_as_well(world, draw_actions, halves):
    class Logging(Task):
        logs = ("one", "other")

        def step(self, envs):
            values = envs.observations["time"][:, 0]
            return Outcome(values.astype(np.float64), logs={"one": values, "other": values})

    def arrays_of(infos):
        for value in infos.values():
            yield from arrays_of(value) if isinstance(value, dict) else [value]

    env = VectorEnv(world, 4, threads=1, task=Logging, events=True, halves=halves, episode_steps=3)
    env.reset()
    for _ in range(3):
        infos = env.step(draw_actions(4, 8))[4]
    assert infos["_episode"].any()
    arrays = list(arrays_of(infos))
    assert len(arrays) > 30
    for one, other in itertools.combinations(arrays, 2):
        assert not np.shares_memory(one, other)


def test_results_stay_as_they_were(world, draw_actions):
    env = VectorEnv(world, ENVS, **OPTIONS)
    first = env.step(draw_actions(ENVS, 8))
    kept = [array.copy() for array in first[:4]]
    for _ in range(5):
        env.step(draw_actions(ENVS, 8))
    for array, wanted in zip(first[:4], kept):
        np.testing.assert_array_equal(array, wanted)
    view = VectorEnv(world, ENVS, copy=False, **OPTIONS)
    observations, rewards, *_ = view.step(draw_actions(ENVS, 8))
    again = view.step(draw_actions(ENVS, 8))
    assert np.shares_memory(observations, again[0]) and np.shares_memory(rewards, again[1])
    np.testing.assert_array_equal(observations, view.simulators[0].observations)
    np.testing.assert_array_equal(rewards, view.simulators[0].rewards)
    # Torch warns of arrays that cannot be written.
    assert observations.flags.writeable and rewards.flags.writeable
    assert view.observe().flags.writeable


def test_resets_by_seed_mask_and_episode(world, draw_actions):
    env = VectorEnv(world, ENVS, **OPTIONS)
    start = env.reset(seed=5)[0].copy()
    fresh = VectorEnv(world, ENVS, **{**OPTIONS, "seed": 5})
    np.testing.assert_array_equal(start, fresh.reset()[0])
    for _ in range(10):
        env.step(draw_actions(ENVS, 8))
    np.testing.assert_array_equal(env.reset(seed=5)[0], start)
    # Without a seed the next episodes begin, and without steps in between, too.
    after = env.reset()[0].copy()
    assert not np.array_equal(after, start)
    before = env.step(draw_actions(ENVS, 8))[0].copy()
    mask = np.zeros(ENVS, bool)
    mask[[2, 20]] = True
    observations, infos = env.reset(options={"reset_mask": mask})
    assert infos == {}
    np.testing.assert_array_equal(observations[~mask], before[~mask])
    steps = [env.simulators[0].env_state(n).step for n in range(ENVS)]
    assert [n for n in range(ENVS) if steps[n] == 0] == [2, 20]
    episodes = np.full(ENVS, -1)
    episodes[2] = 3
    env.reset(options={"reset_mask": mask, "episodes": episodes})
    assert env.simulators[0].episodes()[2] == 3
    env.reset(seed=5, options={"episodes": episodes})
    assert env.simulators[0].episodes()[2] == 3
    np.testing.assert_array_equal(env.observe()[3:], start[3:])


def test_a_reset_begins_the_sums_anew(world, draw_actions):
    env = VectorEnv(world, ENVS, **OPTIONS)
    mask = np.zeros(ENVS, bool)
    mask[7] = True
    for step in range(35):
        if step == 20:
            env.reset(options={"reset_mask": mask})
        actions = draw_actions(ENVS, 8)
        actions[:, -2:] = -1
        infos = env.step(actions)[4]
    assert not infos["_episode"][7]
    np.testing.assert_array_equal(infos["episode"]["l"][~mask], 35)
    for _ in range(20):
        actions = draw_actions(ENVS, 8)
        actions[:, -2:] = -1
        infos = env.step(actions)[4]
    assert infos["_episode"][7]
    assert infos["episode"]["l"][7] == 35


@pytest.mark.parametrize(
    "number, error, message",
    [
        (4, IndexError, "there is no episode 4; the world's last is 3"),
        (2**31, IndexError, "there is no episode 2147483648"),
        (2**33 + 3, IndexError, "there is no episode 8589934595"),
        (2**64 - 1, IndexError, "there is no episode 18446744073709551615"),
        (2, ValueError, "the robot cannot start in episode 2"),
    ],
)
@pytest.mark.parametrize("halves", [1, 2])
def test_episodes_that_cannot_begin_are_refused_before_anything_happens(
    world, draw_actions, halves, number, error, message
):
    env = VectorEnv(world, ENVS, halves=halves, **OPTIONS)
    env.reset()
    env.step(draw_actions(ENVS, 8))
    before = env.save_state()
    dtype = np.uint64 if number == 2**64 - 1 else np.int64
    episodes = np.array([0] * (ENVS - 1) + [number], dtype)
    for options in ({"episodes": episodes}, {"episodes": episodes, "reset_mask": episodes != 0}):
        with pytest.raises(error) as caught:
            env.reset(options=options)
        assert message in str(caught.value)
        assert env.save_state() == before
    with pytest.raises(error):
        env.reset(seed=7, options={"episodes": episodes})
    assert env.save_state() == before
    # What an env that stays would begin does not matter.
    env.reset(options={"episodes": episodes, "reset_mask": episodes == 0})
    begun = np.concatenate([one.episodes() for one in env.simulators])
    np.testing.assert_array_equal(begun[:-1], 0)


@pytest.mark.parametrize(
    "options, message",
    [
        ({"mask": None}, "no option 'mask'"),
        ({"reset_mask": np.ones(ENVS)}, "reset_mask is float64 (24,), expected bool (24,)"),
        ({"reset_mask": np.ones(3, bool)}, "reset_mask is bool (3,)"),
        ({"episodes": np.ones(ENVS)}, "episodes are float64 (24,), expected int (24,)"),
        ({"episodes": np.ones(3, int)}, "episodes are int64 (3,)"),
    ],
)
def test_wrong_resets_are_refused(world, options, message):
    env = VectorEnv(world, ENVS, **OPTIONS)
    with pytest.raises(ValueError) as caught:
        env.reset(options=options)
    assert message in str(caught.value)
    with pytest.raises(ValueError, match="exclude each other"):
        env.reset(seed=1, options={"reset_mask": np.ones(ENVS, bool)})


@pytest.mark.parametrize(
    "arguments",
    [
        {"observation": "parts"},
        {"actions": "discrete"},
        {"halves": 3},
        {"num_envs": 7, "halves": 2},
        {"render_mode": "human"},
    ],
)
def test_wrong_arguments_are_refused(world, arguments):
    with pytest.raises(ValueError, match="expected"):
        VectorEnv(world, **{"num_envs": ENVS, **arguments})


def test_observations_by_parts_are_the_flat_ones(world, draw_actions):
    flat = VectorEnv(world, ENVS, **OPTIONS)
    parts = VectorEnv(world, ENVS, observation="dict", **OPTIONS)
    for _ in range(40):
        actions = draw_actions(ENVS, 8)
        row = flat.step(actions)
        by_name = parts.step(actions)
        np.testing.assert_array_equal(np.concatenate(list(by_name[0].values()), 1), row[0])
        assert parts.observation_space.contains(by_name[0])
        assert flat.observation_space.contains(row[0])
        if row[4]:
            env = int(np.flatnonzero(row[4]["_final_obs"])[0])
            joined = np.concatenate(list(by_name[4]["final_obs"][env].values()))
            np.testing.assert_array_equal(joined, row[4]["final_obs"][env])


def test_actions_of_the_paper_are_the_box_of_all(world):
    box = VectorEnv(world, ENVS, **OPTIONS)
    paper = VectorEnv(world, ENVS, actions="paper", **OPTIONS)
    paper.action_space.seed(3)
    for _ in range(30):
        actions = paper.action_space.sample()
        assert actions["continuous"].shape == (ENVS, 6)
        assert set(np.unique(actions["discrete"])) <= {0, 1}
        rows = np.concatenate([actions["continuous"], actions["discrete"]], 1)
        np.testing.assert_array_equal(paper.step(actions)[0], box.step(rows)[0])


def test_spaces_have_what_comes_and_goes(world):
    env = VectorEnv(world, ENVS, images=IMAGES, **OPTIONS)
    single, batch = env.single_observation_space, env.observation_space
    assert single["state"].shape == (23,)
    assert batch["rgb"].shape == (ENVS, 16, 24, 3) and batch["rgb"].dtype == np.uint8
    assert batch["depth"].shape == (ENVS, 16, 24) and batch["depth"].dtype == np.float32
    assert batch["semantics"].dtype == np.int32
    assert env.single_action_space.shape == (8,)
    assert env.action_space.shape == (ENVS, 8)
    observations = env.reset()[0]
    assert batch.contains(observations)
    assert env.action_space.contains(env.action_space.sample())
    assert env.metadata["autoreset_mode"].value == "SameStep"
    assert (env.num_envs, env.spec, env.unwrapped) == (ENVS, None, env)


@pytest.mark.parametrize("images", [None, IMAGES])
@pytest.mark.parametrize("halves", [1, 2])
def test_rollouts_land_in_buffers(world, draw_actions, halves, images):
    steps = 30
    env = VectorEnv(world, ENVS, images=images, halves=halves, copy=False, **OPTIONS)
    twin = VectorEnv(world, ENVS, images=images, **OPTIONS)
    buffers = env.buffers(steps)
    seen = ["state", "rgb", "depth", "semantics"] if images else ["state"]
    assert set(buffers) == {*seen, "rewards", "terminations", "truncations", "endings"}
    env.reset()
    env.observe(out={name: buffers[name][0] for name in seen})
    twin.reset()
    for step in range(steps):
        actions = draw_actions(ENVS, 8)
        for half in range(halves):
            rows = env.rows(half)
            out = {name: buffer[step + (name in seen)][rows] for name, buffer in buffers.items()}
            env.send(actions[rows], half, out)
        for half in range(halves):
            observations, rewards, *_ = env.recv(half)
            assert np.shares_memory(rewards, buffers["rewards"])
            state = observations["state"] if images else observations
            assert np.shares_memory(state, buffers["state"])
        wanted, rewards, terminations, truncations, _ = twin.step(actions)
        for name in seen:
            one = wanted[name] if images else wanted
            np.testing.assert_array_equal(buffers[name][step + 1], one)
        np.testing.assert_array_equal(buffers["rewards"][step], rewards)
        np.testing.assert_array_equal(buffers["terminations"][step], terminations)
        np.testing.assert_array_equal(buffers["truncations"][step], truncations)
        ended = buffers["endings"][step] != 0
        np.testing.assert_array_equal(ended, terminations | truncations)


def test_wrong_buffers_are_refused(world, draw_actions):
    env = VectorEnv(world, ENVS, images=IMAGES, **OPTIONS)
    actions = draw_actions(ENVS, 8)
    with pytest.raises(ValueError, match="out has no place for 'reward'"):
        env.step(actions, out={"reward": np.zeros(ENVS, np.float32)})
    with pytest.raises(TypeError, match="rewards has the type float64, expected float32"):
        env.step(actions, out={"rewards": np.zeros(ENVS, np.float64)})
    with pytest.raises(TypeError, match="state has the type list"):
        env.step(actions, out={"state": [0.0]})
    with pytest.raises(TypeError, match="rgb has the type float32, expected uint8"):
        env.step(actions, out={"rgb": np.zeros((ENVS, 16, 24, 3), np.float32)})
    with pytest.raises(ValueError, match="depth is not contiguous"):
        env.step(actions, out={"depth": np.zeros((ENVS, 16, 48), np.float32)[:, :, ::2]})
    with pytest.raises(ValueError, match="rgb has the shape"):
        env.step(actions, out={"rgb": np.zeros((ENVS, 24, 16, 3), np.uint8)})
    with pytest.raises(
        TypeError, match="out is a ndarray, expected a dictionary of arrays by name"
    ):
        env.step(actions, actions)
    with pytest.raises(ValueError, match="state has the shape"):
        env.observe(out={"state": np.zeros((2, ENVS, 23), np.float32)})
    assert env.simulators[0].statistics()["steps"] == 0


def test_halves_take_turns(world, draw_actions):
    env = VectorEnv(world, ENVS, halves=2, **OPTIONS)
    actions = draw_actions(ENVS // 2, 8)
    with pytest.raises(RuntimeError, match="half 0 has nothing under way"):
        env.recv(0)
    env.send(actions, 0)
    for call in (lambda: env.send(actions, 0), env.reset, env.observe, env.save_state):
        with pytest.raises(RuntimeError, match="half 0 is under way"):
            call()
    env.send(actions, 1)
    assert env.recv(1)[0].shape == (ENVS // 2, 23)
    assert env.recv(0)[0].shape == (ENVS // 2, 23)
    # What cannot be begun is not under way.
    with pytest.raises(ValueError, match="actions has the shape"):
        env.send(actions[1:], 0)
    with pytest.raises(ValueError, match="rewards has the shape"):
        env.send(actions, 0, {"rewards": np.zeros(ENVS, np.float32)})
    for call in (lambda: env.send(actions, 2), lambda: env.recv(2), lambda: env.rows(-1)):
        with pytest.raises(IndexError, match="there is no half (2|-1); the last is 1"):
            call()
    env.reset(seed=1)
    env.close()
    env.close()


@pytest.mark.parametrize("halves", [1, 2])
def test_what_is_wrong_with_a_step_is_said_before_any_half_steps(world, draw_actions, halves):
    env = VectorEnv(world, ENVS, halves=halves, **OPTIONS)
    env.reset()
    actions = draw_actions(ENVS, 8)
    for wrong in (actions[:, 1:], actions[1:], actions[:1], actions[None], np.float32(0.0)):
        with pytest.raises(ValueError, match=r"actions has the shape .*, expected \(24, 8\)"):
            env.step(wrong)
    with pytest.raises(TypeError, match="actions has the type <U4, expected numbers"):
        env.step(np.full((ENVS, 8), "fast"))
    # Rows enough for each half, and more than there are envs.
    for rows in (ENVS - 1, ENVS + 1):
        with pytest.raises(ValueError, match="rewards has the shape"):
            env.step(actions, {"rewards": np.zeros(rows, np.float32)})
    with pytest.raises(TypeError, match="state has the type list"):
        env.step(actions, {"state": [[0.0]] * ENVS})
    assert [one.statistics()["steps"] for one in env.simulators] == [0] * halves
    env.step(actions)


def test_actions_of_the_paper_are_refused_in_other_shapes(world):
    env = VectorEnv(world, ENVS, actions="paper", **OPTIONS)
    right = {"continuous": np.zeros((ENVS, 6)), "discrete": np.zeros((ENVS, 2))}
    for name, wrong in (("continuous", np.zeros(6)), ("discrete", np.zeros((ENVS, 1)))):
        with pytest.raises(ValueError, match=f"{name} has the shape"):
            env.step({**right, name: wrong})
    wanted = 'expected a dictionary of "continuous" and "discrete": actions="paper"'
    with pytest.raises(TypeError, match=f"actions has the type ndarray, {wanted}"):
        env.step(np.zeros((ENVS, 8)))
    with pytest.raises(ValueError, match=rf"actions has \['continuous'\], {wanted}"):
        env.step({"continuous": right["continuous"]})
    env.step(right)


@pytest.mark.parametrize("halves", [1, 2])
def test_a_closed_env_says_so(world, draw_actions, halves):
    env = VectorEnv(world, ENVS, halves=halves, **OPTIONS)
    half = draw_actions(ENVS // halves, 8)
    env.send(half, 0)
    env.close()
    # What was under way is done.
    assert env.recv(0)[0].shape == (ENVS // halves, 23)
    calls = [env.reset, env.observe, env.render, env.save_state, lambda: env.send(half, 0)]
    for call in [*calls, lambda: env.step(draw_actions(ENVS, 8))]:
        with pytest.raises(RuntimeError, match="this env is closed; make another one"):
            call()


@pytest.mark.parametrize("halves", [1, 2])
def test_envs_that_have_had_their_share_are_idle(world, draw_actions, halves):
    env = VectorEnv(world, 4, halves=halves, order="partition", **OPTIONS)
    env.reset()
    # Of the four episodes, the robot cannot start in one: who would play it has no share.
    assert env.idle.dtype == np.bool_ and np.count_nonzero(env.idle) == 1
    ended = env.idle
    while not env.idle.all():
        _, _, terminations, truncations, _ = env.step(draw_actions(4, 8))
        ended |= terminations | truncations
        np.testing.assert_array_equal(env.idle, ended)
    env.send(draw_actions(4 // halves, 8), 0)
    with pytest.raises(RuntimeError, match="half 0 is under way"):
        env.idle
    env.recv(0)


def test_no_half_goes_on_alone_after_a_step_in_which_one_failed(world, draw_actions, monkeypatch):
    env = VectorEnv(world, ENVS, halves=2, **OPTIONS)

    def fail(*arguments):
        raise RuntimeError("no memory for images")

    with monkeypatch.context() as broken, pytest.raises(RuntimeError, match="no memory"):
        broken.setattr(env._parts[0], "step", fail)
        env.step(draw_actions(ENVS, 8))
    assert [one.statistics()["steps"] for one in env.simulators] == [0, ENVS // 2]
    with pytest.raises(RuntimeError, match=r"has cut off .*; reset\(\) all envs"):
        env.step(draw_actions(ENVS, 8))
    env.reset()
    env.step(draw_actions(ENVS, 8))
    assert env.env_states().step.tolist() == ENVS * [1]


@pytest.mark.parametrize(
    "options, message",
    [
        ({"num_envs": 4.5}, "num_envs is 4.5, expected a whole number above 0"),
        ({"num_envs": "8"}, "num_envs is '8', expected a whole number above 0"),
        ({"num_envs": 0}, "num_envs is 0, expected a whole number above 0"),
        ({"num_envs": True}, "num_envs is True, expected a whole number above 0"),
        ({"copy": "no"}, "copy is 'no', expected True or False"),
        ({"num_envs": 3, "halves": 2}, "num_envs is 3, expected an even number for two halves"),
        ({"images": True}, "images is True, expected options of galactic.Renderer, those of"),
        ({"images": {"hand": {}, "width": 9}}, "images['width'] is 9, expected options, as the"),
        ({"images": {"a b": {}}}, "a camera of images is 'a b', expected a name, such as hand"),
        ({"images": {"device": 1.5}}, "device: is 1.5, expected an index or a name"),
        ({"images": {"width": 128.0}}, "width: is 128.0, expected a whole number"),
    ],
)
def test_natural_mistakes_are_told_what_was_wanted(world, options, message):
    with pytest.raises((ValueError, Error)) as caught:
        VectorEnv(world, **{"num_envs": 2, "threads": 1, **options})
    assert message in str(caught.value)


def test_options_of_a_simulator_that_it_does_not_have_are_refused(world):
    with pytest.raises(TypeError, match="VectorEnv has no option envs; give num_envs"):
        VectorEnv(world, envs=4)
    with pytest.raises(TypeError, match="VectorEnv has no option auto_reset; its envs begin"):
        VectorEnv(world, 2, auto_reset=False)
    with pytest.raises(TypeError, match="no option autoreset_mode; it is SAME_STEP; a Simulator"):
        VectorEnv(world, 2, autoreset_mode="disabled")
    with pytest.raises(TypeError, match="VectorEnv has no option width; give images={'width': 64}"):
        VectorEnv(world, 2, width=64)
    with pytest.raises(ValueError, match="no option 'episode'; expected reset_mask or episodes"):
        VectorEnv(world, 2).reset(options={"episode": 1})


def test_body_transforms_let_others_draw_its_simulators(world):
    env = VectorEnv(world, 2, threads=1, body_transforms=True)
    assert Renderer(env.simulators[0], **IMAGES).render()["rgb"].shape == (2, 16, 24, 3)


def test_an_env_that_could_not_be_made_can_be_closed(world):
    """Gymnasium's class closes what goes, and would write a traceback beside the error."""
    unmade = VectorEnv.__new__(VectorEnv)
    with pytest.raises(TypeError, match="did you mean task"):
        unmade.__init__(world, 2, tusk="pick")
    assert unmade.closed
    unmade.close()


def in_a_forked_process(work):
    """What `work` returns there, or the message of what it raises."""

    def report(results):
        try:
            results.put(work())
        except RuntimeError as error:
            results.put(str(error))

    context = multiprocessing.get_context("fork")
    results = context.Queue()
    process = context.Process(target=report, args=(results,))
    process.start()
    try:
        return results.get(timeout=60)
    finally:
        process.kill()
        process.join()


def test_a_forked_process_is_told_to_make_its_own_halves(world, draw_actions):
    actions = draw_actions(ENVS, 8)
    halves = VectorEnv(world, ENVS, halves=2, **OPTIONS)
    halves.step(actions)
    for work in (lambda: halves.step(actions), lambda: halves.send(actions[:12], 1)):
        assert "in another process; make one in each" in in_a_forked_process(work)
    halves.send(actions[:12], 0)
    assert "in another process; make one in each" in in_a_forked_process(lambda: halves.recv(0))
    halves.recv(0)
    halves.step(actions)


def test_a_seed_that_is_none_begins_nothing(world, draw_actions):
    env = VectorEnv(world, ENVS, **OPTIONS)
    env.step(draw_actions(ENVS, 8))
    before = env.save_state()
    for seed in (-1, 2**64, 1.5, "one"):
        with pytest.raises(Error, match="seed: is .*, expected a whole number from 0 to"):
            env.reset(seed=seed)
        assert env.save_state() == before


@pytest.mark.parametrize("is_dict", [False, True])
def test_what_a_step_reached_where_no_episode_ended(is_dict) -> None:
    observations = np.ones((2, 3), np.float32)
    given = {"state": observations} if is_dict else observations
    infos = {"final_obs": np.full(2, None), "_final_obs": np.zeros(2, bool)}
    found = reached(given, infos)
    part = found["state"] if is_dict else found
    np.testing.assert_array_equal(part, observations)
    assert part is not observations


def test_what_a_step_reached_is_the_last_of_an_episode_that_ended(world, draw_actions) -> None:
    """And of no episode that goes on, with any number of halves and with dicts."""
    for options in ({"halves": 2}, {"observation": "dict", "copy": False}):
        env = VectorEnv(world, 12, seed=3, episode_steps=5, **options)
        simulators = env.simulators
        env.reset()
        ended = 0
        for _ in range(12):
            observations, _, terminations, truncations, infos = env.step(draw_actions(12, 8))
            done = terminations | truncations
            ended += done.sum()
            found = reached(observations, infos)
            last = np.concatenate([each.final_observations for each in simulators])
            now = np.concatenate([each.observations for each in simulators])
            wanted = np.where(done[:, None], last, now)
            if isinstance(found, dict):
                assert list(found) == list(observations)
                for name, part in found.items():
                    assert part.dtype == np.float32 and not np.shares_memory(
                        part, observations[name]
                    )
                found = np.concatenate(list(found.values()), axis=1)
            assert not np.shares_memory(found, observations)
            np.testing.assert_array_equal(found, wanted)
        assert ended >= 24
