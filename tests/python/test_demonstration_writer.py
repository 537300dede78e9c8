"""Demonstrations of a policy of one's own."""

import json
import pathlib

import numpy as np
import pytest

import galactic
from galactic import (
    DemonstrationWriter,
    Demonstrations,
    EpisodeEnd,
    VectorEnv,
    demonstration_writer,
)
from tasks import ACTIONS, Approach, drawing

OPTIONS = {"threads": 1, "episode_steps": 7}
CAMERA = {"width": 6, "height": 5, "backend": "soft", "depth_noise": 0.01}


def written(folder, env, steps=40, **keywords):
    """Episodes of random actions, which are returned as they were seen: lists of what each had."""
    env.reset()
    draw, seen = drawing(), env.observe()
    under_way: list[list] = [[] for _ in range(env.num_envs)]
    ended = []
    with DemonstrationWriter(folder, env, expert="chance", **keywords) as writer:
        for _ in range(steps):
            actions = 1.5 * draw(env.num_envs, ACTIONS)
            then, rewards, _, _, infos = env.step(actions)
            writer.add(seen, actions, rewards, infos)
            for row in range(env.num_envs):
                under_way[row].append((flat(seen, row), np.clip(actions[row], -1, 1), rewards[row]))
                if infos and infos["_final_info"][row]:
                    final = infos["final_info"]
                    of_episode = int(final["episode_index"][row]), int(final["ending"][row])
                    ended.append((*of_episode, under_way[row], flat(infos["final_obs"][row])))
                    under_way[row] = []
            seen = then
        assert len(writer) == len(ended)
    return ended


def flat(observations, row=...):
    if not isinstance(observations, dict):
        return observations[row]
    images = ("rgb", "depth")
    state = [part[row] for name, part in observations.items() if name not in images]
    return np.concatenate(state, axis=-1)


@pytest.mark.parametrize("halves", [1, 2])
@pytest.mark.parametrize("observation", ["flat", "dict"])
def test_what_was_played_is_read(tmp_path, world, monkeypatch, halves, observation):
    monkeypatch.setattr(demonstration_writer, "EPISODES_OF_PART", 8)
    options = {**OPTIONS, "halves": halves, "observation": observation, "task": "pick"}
    wanted = written(
        tmp_path / "mine", VectorEnv(world, 6, **options), world=pathlib.Path("w.pack")
    )
    found = Demonstrations(tmp_path / "mine")
    assert len(found) == len(wanted) > 20
    assert len(list((tmp_path / "mine").glob("part-*"))) == -(-len(wanted) // 8)
    for one, (episode, ending, steps, last) in zip(found, wanted):
        assert (one.episode, one.ending, len(one)) == (episode, ending, len(steps))
        states, actions, rewards = map(np.stack, zip(*steps))
        np.testing.assert_array_equal(one.state, [*states, last])
        np.testing.assert_array_equal(one.actions, actions)
        np.testing.assert_array_equal(one.rewards, rewards)
        assert one.by_expert.all() and one.rgb is None and one.depth is None
    about = found.about
    assert (about.world, about.expert, about.episodes) == ("w.pack", "chance", None)
    assert about.camera is None and about.options["task"] == "pick"
    # Its options give the same observations.
    again = VectorEnv(world, 6, **about.options)
    episodes = np.array([one.episode for one in found[:6]])
    seen, _ = again.reset(options={"episodes": episodes})
    np.testing.assert_array_equal(seen, [one.state[0] for one in found[:6]])


def test_images_are_kept_with_the_last_ones(tmp_path, world):
    env = VectorEnv(world, 3, images=CAMERA, **OPTIONS)
    written(tmp_path, env, 20)
    found = Demonstrations(tmp_path)
    assert found.about.camera == {
        "color": "rgb", "camera": "head", "fov_degrees": 0.0, "position": [0.0] * 3,
        "rpy_degrees": [0.0] * 3, "near": 0.0, "width": 6, "height": 5,
    }  # fmt: skip
    assert found.about.images == {"rgb": (5, 6, 3), "depth": (5, 6)}
    for one in found:
        assert len(one.rgb) == len(one.depth) == len(one) + 1


def test_tasks_of_ones_own_and_other_actions(tmp_path, world):
    env = VectorEnv(world, 4, task=Approach, actions="paper", threads=1)
    seen, _ = env.reset()
    by_expert = np.array([True, False, True, True])
    with DemonstrationWriter(tmp_path, env, expert="me") as writer:
        for _ in range(50):
            actions = env.action_space.sample()
            then, rewards, *_, infos = env.step(actions)
            writer.add(seen, actions, rewards, infos, by_expert)
            seen = then
    found = Demonstrations(tmp_path)
    assert EpisodeEnd.FAILURE in found.endings and "task" not in found.about.options
    assert dict(found.about.parts)["gained"] == 1
    assert {bool(one.by_expert.all()) for one in found} == {True, False}
    assert all(set(np.unique(one.actions[:, -2:])) <= {0, 1} for one in found)


def test_only_whole_episodes_are_kept(tmp_path, world):
    """None whose beginning was not seen, and of what was broken off nothing."""
    env = VectorEnv(world, 2, task="none", **OPTIONS)
    seen, _ = env.reset()
    actions = np.zeros((2, ACTIONS), np.float32)

    def step(writer=None):
        nonlocal seen
        then, rewards, *_, infos = env.step(actions)
        if writer is not None:
            writer.add(seen, actions, rewards, infos)
        seen = then

    step()
    with DemonstrationWriter(tmp_path, env, expert="me") as writer:
        for _ in range(6):
            step(writer)
        assert len(writer) == 0
        for _ in range(3):
            step(writer)
        seen, _ = env.reset(options={"reset_mask": np.array([True, False])})
        for _ in range(7):
            step(writer)
        assert len(writer) == 2
    found = Demonstrations(tmp_path)
    assert [len(one) for one in found] == [7, 7]
    time = dict(env.observation_parts)["time"]
    for one in found:
        assert (np.diff(one.state[:, time.start]) < 0).all()


def test_each_episode_once(tmp_path, world):
    env = VectorEnv(world, 2, task="none", order="partition", **OPTIONS)
    wanted = written(tmp_path, env, 30)
    assert sorted(one.episode for one in Demonstrations(tmp_path)) == [0, 1, 3]
    assert len(wanted) == 3


def test_what_cannot_be_written_is_refused(tmp_path, world):
    env = VectorEnv(world, 2, **OPTIONS)
    written(tmp_path / "mine", env, 10)
    with pytest.raises(galactic.Error, match="mine: holds demonstrations already; choose another"):
        DemonstrationWriter(tmp_path / "mine", env, expert="me")
    (tmp_path / "file").write_text("")
    with pytest.raises(galactic.Error, match="file: is a file, expected a folder or nothing"):
        DemonstrationWriter(tmp_path / "file", env, expert="me")
    two = VectorEnv(world, 2, images={"head": CAMERA, "top": CAMERA}, **OPTIONS)
    with pytest.raises(ValueError, match="env has the cameras head, top, expected one without a"):
        DemonstrationWriter(tmp_path / "two", two, expert="me")
    rgba = VectorEnv(world, 2, images={**CAMERA, "color": "rgba"}, **OPTIONS)
    with pytest.raises(ValueError, match="env draws 'rgba', expected images with color='rgb'"):
        DemonstrationWriter(tmp_path / "rgba", rgba, expert="me")
    assert not (tmp_path / "two").exists() and not (tmp_path / "rgba").exists()


def test_a_folder_says_that_episodes_may_be_there_often(tmp_path, world):
    env = VectorEnv(world, 6, **OPTIONS)
    written(tmp_path, env, 40)
    index = tmp_path / "demonstrations.json"
    about = json.loads(index.read_text())
    assert about["episodes"] is None
    index.write_text(json.dumps({**about, "episodes": 1000}))
    with pytest.raises(galactic.Error, match="some of them twice"):
        Demonstrations(tmp_path)


@pytest.mark.parametrize("all_envs", [True, False])
def test_episodes_that_were_broken_off_are_left_out(tmp_path, world, all_envs):
    """Nothing is made of parts of two episodes, or of steps that were taken back."""
    env = VectorEnv(world, 4, task="pick", **OPTIONS)
    draw = drawing()
    seen, _ = env.reset()
    with DemonstrationWriter(tmp_path / "mine", env, expert="chance") as writer:
        for step in range(40):
            if step == 3:
                state = env.save_state(None if all_envs else [0, 3])
            if step == 5:
                # Two steps of each episode were in vain; what was before is no beginning any more.
                env.restore_state(state, None if all_envs else [0, 3])
                seen = env.observe()
            if step == 12:
                seen, _ = env.reset(options={"reset_mask": np.array([False, True, False, True])})
            actions = draw(4, ACTIONS)
            then, rewards, _, _, infos = env.step(actions)
            writer.add(seen, actions, rewards, infos)
            seen = then
    shown = Demonstrations(tmp_path / "mine")
    lengths = [len(one.rewards) for one in shown]
    assert lengths and max(lengths) <= OPTIONS["episode_steps"]
    for one in shown:
        # Each begins where an episode of the world does.
        start = galactic.Simulator(world, 1, task="pick", **OPTIONS)
        start.reset(np.array([one.episode]))
        np.testing.assert_allclose(one.state[0], start.observations[0], atol=1e-6)
        # And goes where its own actions lead.
        for actions, state in zip(one.actions, one.state[1:]):
            start.step(actions[np.newaxis])
            if not start.endings[0]:
                np.testing.assert_allclose(start.observations[0], state, atol=1e-6)


FIVE = np.zeros((2, 5), np.float32)
WRONG_STEPS = [
    (
        0,
        lambda seen: seen[:, :3],
        ValueError,
        r"observations: state has the shape \(2, 3\), expected",
    ),
    (
        0,
        lambda seen: seen * np.nan,
        ValueError,
        r"state has numbers that are not finite .*, first in env 0",
    ),
    (0, lambda seen: "seen", TypeError, "observations: state has the type <U4, expected numbers"),
    (0, lambda seen: {"rgb": seen}, ValueError, "observations has no robot_target, .*, time; give"),
    (
        1,
        lambda actions: actions[:, :5],
        ValueError,
        r"actions has the shape \(2, 5\), expected \(2, ",
    ),
    (1, lambda actions: actions * np.nan, ValueError, "actions has numbers that are not finite"),
    (2, lambda rewards: rewards[:1], ValueError, r"rewards has the shape \(1,\), expected \(2,\)"),
    (
        2,
        lambda rewards: [0.0, np.inf],
        ValueError,
        "rewards has numbers .*, first in env 1; nothing",
    ),
    (2, lambda rewards: [0.0, 1e39], ValueError, "rewards has numbers that are not finite"),
    (
        3,
        lambda infos: [{}] * 2,
        TypeError,
        r"infos has the type list, expected the dictionary that",
    ),
    (
        3,
        lambda infos: {"final_info": {}},
        ValueError,
        "infos has final_info and no _final_info, _final_o",
    ),
    (4, lambda by_expert: FIVE, TypeError, "by_expert has the type float32, expected bool"),
]


@pytest.mark.parametrize("place, spoil, kind, message", WRONG_STEPS)
def test_a_wrong_step_is_refused_and_nothing_of_it_kept(
    tmp_path, world, place, spoil, kind, message
):
    env = VectorEnv(world, 2, task="none", **OPTIONS)
    seen, _ = env.reset()
    with DemonstrationWriter(tmp_path, env, expert="me") as writer:
        for step in range(7):
            actions = np.zeros((2, ACTIONS), np.float32)
            then, rewards, *_, infos = env.step(actions)
            given = [seen, actions, rewards, infos, np.ones(2, np.bool_)]
            if step == 3:
                with pytest.raises(kind, match=message):
                    writer.add(*(spoil(one) if n == place else one for n, one in enumerate(given)))
            writer.add(*given)
            seen = then
        assert len(writer) == 2
    assert [len(one) for one in Demonstrations(tmp_path)] == [7, 7]


def test_a_wrong_last_observation_is_refused(tmp_path, world):
    env = VectorEnv(world, 2, task="none", **OPTIONS)
    seen, _ = env.reset()
    actions = np.zeros((2, ACTIONS), np.float32)
    with DemonstrationWriter(tmp_path, env, expert="me") as writer:
        for step in range(7):
            then, rewards, *_, infos = env.step(actions)
            if step == 6:
                infos["final_obs"][1] = infos["final_obs"][1] * np.nan
                with pytest.raises(ValueError, match="final_obs: state has numbers that are not"):
                    writer.add(seen, actions, rewards, infos)
                infos["final_obs"][1] = seen[1, :3]
                with pytest.raises(ValueError, match=r"final_obs: state has the shape \(3,\)"):
                    writer.add(seen, actions, rewards, infos)
                infos["final_obs"][1] = seen[1]
            writer.add(seen, actions, rewards, infos)
            seen = then
    assert len(Demonstrations(tmp_path)) == 2


def test_images_of_a_wrong_shape_are_refused(tmp_path, world):
    env = VectorEnv(world, 2, images=CAMERA, task="none", **OPTIONS)
    seen, _ = env.reset()
    actions = np.zeros((2, ACTIONS), np.float32)
    _, rewards, *_, infos = env.step(actions)
    with DemonstrationWriter(tmp_path, env, expert="me") as writer:
        for wrong, kind, message in (
            (
                {**seen, "rgb": seen["rgb"][:, :2]},
                ValueError,
                r"rgb has the shape \(2, 2, 6, 3\), e",
            ),
            (
                {**seen, "depth": seen["depth"] * np.inf},
                ValueError,
                "depth has numbers that are not",
            ),
            ({"state": seen["state"]}, ValueError, "observations has no rgb, depth"),
            (
                seen["state"],
                TypeError,
                "observations has the type ndarray, expected a dictionary wi",
            ),
        ):
            with pytest.raises(kind, match=message):
                writer.add(wrong, actions, rewards, infos)


def test_a_reader_has_advice_for_folders_of_ones_own(tmp_path, world):
    env = VectorEnv(world, 2, **OPTIONS)
    written(tmp_path, env, 10)
    file = next(tmp_path.glob("part-*")) / "rewards.npy"
    np.save(file, np.load(file) * np.float32(np.nan))
    with pytest.raises(
        galactic.Error, match="not finite; remove the folder of this part: the others"
    ):
        Demonstrations(tmp_path)
