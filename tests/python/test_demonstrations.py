"""Folders of demonstrations: what was written is read, and what is none is refused."""

from __future__ import annotations

import dataclasses
import json
import pathlib
import resource
import shutil

import numpy as np
import pytest

import galactic
from galactic import demonstrations
from galactic.demonstrations import About, Demonstration, Demonstrations

ABOUT = About(
    world="/worlds/world.pack",
    episodes=6,
    expert="scripted",
    parts=[("way", 2), ("is_holding", 1)],
    options={"task": "pick", "episode_steps": "200", "bump": True},
    camera={"camera": "head", "width": 5, "height": 4},
    meanings={"observe_current": False},
    images={"depth": (4, 5)},
    motions=2,
    made_with={"settings": {"seed": 1, "camera_position": (0.0, 0.5, 0.0)}, "sha256": {}},
)


def episode(number: int, length: int, ending: galactic.EpisodeEnd) -> Demonstration:
    random = np.random.default_rng(number)
    return Demonstration(
        number,
        ending,
        state=random.normal(size=(length + 1, 3)).astype(np.float32),
        actions=random.uniform(-1, 1, (length, 4)).astype(np.float32),
        by_expert=np.arange(length) >= number % 3,
        rewards=random.normal(size=length).astype(np.float32),
        depth=random.uniform(0, 10, (length + 1, 4, 5)).astype(np.float16),
    )


EPISODES = [
    episode(number, 1 + 2 * number, ending)
    for number, ending in enumerate(
        [galactic.EpisodeEnd.SUCCESS, galactic.EpisodeEnd.TIME_OUT, galactic.EpisodeEnd.SUCCESS] * 2
    )
]


def write(folder: pathlib.Path, *parts: list[Demonstration]) -> pathlib.Path:
    folder.mkdir(exist_ok=True)
    (folder / demonstrations.INDEX).write_text(demonstrations.text_of(ABOUT))
    for number, part in enumerate(parts):
        place = demonstrations.part_folder(folder, number)
        place.mkdir()
        for name, array in demonstrations.arrays_of(part):
            np.save(place / f"{name}.npy", array)
    return folder


@pytest.fixture
def folder(tmp_path: pathlib.Path) -> pathlib.Path:
    return write(tmp_path, EPISODES[:4], EPISODES[4:])


def require_equal(found: Demonstration, wanted: Demonstration) -> None:
    assert (found.episode, found.ending, len(found)) == (wanted.episode, wanted.ending, len(wanted))
    for name in ("state", "actions", "by_expert", "rewards", "depth"):
        ours, theirs = getattr(found, name), getattr(wanted, name)
        assert ours.dtype == theirs.dtype
        np.testing.assert_array_equal(ours, theirs)
    assert found.rgb is None


def test_what_was_written_is_read(folder: pathlib.Path) -> None:
    found = Demonstrations(folder)
    assert len(found) == len(EPISODES)
    for one, wanted in zip(found, EPISODES):
        require_equal(one, wanted)
    require_equal(found[-1], EPISODES[-1])
    assert [one.episode for one in found[1:3]] == [1, 2]
    assert [one.is_solved for one in found] == [True, False, True] * 2
    assert found.lengths.tolist() == [len(one) for one in EPISODES]
    assert found.about == dataclasses.replace(
        ABOUT, made_with={"settings": {"seed": 1, "camera_position": [0.0, 0.5, 0.0]}, "sha256": {}}
    )
    assert repr(found) == f"<galactic.Demonstrations of 6 episodes in {folder}>"
    with pytest.raises(IndexError):
        found[6]
    with pytest.raises(ValueError, match="read-only"):
        found[0].state[0] = 1


def test_the_numbers_of_ends_stay_as_files_have_them() -> None:
    numbers = {end.name: end.value for end in galactic.EpisodeEnd}
    # A new end is added here, with the next number; none of these changes.
    assert numbers == {
        "NONE": 0,
        "SUCCESS": 1,
        "WRONG_TERMINATE": 2,
        "WRONG_RELEASE": 3,
        "WRONG_OBJECT": 4,
        "TIME_OUT": 5,
        "FAILURE": 255,
    }


def test_a_failure_of_a_task_is_kept(tmp_path: pathlib.Path) -> None:
    failed = dataclasses.replace(EPISODES[0], ending=galactic.EpisodeEnd.FAILURE)
    folder = write(tmp_path / "failures", [failed])
    assert Demonstrations(folder)[0].ending is galactic.EpisodeEnd.FAILURE
    assert np.load(demonstrations.part_folder(folder, 0) / "endings.npy").tolist() == [255]


def test_folders_are_read_one_after_the_other(tmp_path: pathlib.Path) -> None:
    folders = [write(tmp_path / "one", EPISODES[:4]), write(tmp_path / "two", EPISODES[4:])]
    found = Demonstrations(*folders)
    assert len(found) == len(EPISODES) and len(found.abouts) == 2
    for one, wanted in zip(found, EPISODES):
        require_equal(one, wanted)
    rewards = np.concatenate([one.rewards for one in EPISODES])
    np.testing.assert_array_equal(found.take("rewards", np.arange(len(rewards))), rewards)
    with pytest.raises(galactic.Error, match="one: is named twice"):
        Demonstrations(*folders, tmp_path / "two" / ".." / "one")
    camera = {**(ABOUT.camera or {}), "fov_degrees": 90.0}
    for changes, message in (
        ({"meanings": {"observe_current": True}}, "two.*found meanings .*True.*, expected .*False"),
        ({"camera": camera}, "fov_degrees 90.0, expected None"),
        ({"camera": None}, "camera: camera None, expected head"),
    ):
        about = dataclasses.replace(ABOUT, **changes)
        (folders[1] / demonstrations.INDEX).write_text(demonstrations.text_of(about))
        with pytest.raises(galactic.Error, match=message):
            Demonstrations(*folders)


def test_rows_are_those_of_all_episodes_together(folder: pathlib.Path) -> None:
    found = Demonstrations(folder)
    states = np.concatenate([one.state[:-1] for one in EPISODES])
    rows = np.random.default_rng(1).integers(len(states), size=(7, 5))
    np.testing.assert_array_equal(found.take("state", rows), states[rows])
    depth = np.concatenate([one.depth[:-1] for one in EPISODES])
    np.testing.assert_array_equal(found.take("depth", rows[0]), depth[rows[0]])
    # What was observed after a step is of the same episode, also after its last one.
    later = np.concatenate([one.state[1:] for one in EPISODES])
    np.testing.assert_array_equal(found.take("state", rows, after=True), later[rows])
    depth = np.concatenate([one.depth[1:] for one in EPISODES])
    np.testing.assert_array_equal(found.take("depth", rows[0], after=True), depth[rows[0]])
    for number, one in enumerate(EPISODES):
        np.testing.assert_array_equal(
            found.take("rewards", found.first_rows[number] + np.arange(len(one))), one.rewards
        )


def test_rows_that_are_not_there_are_refused(folder: pathlib.Path) -> None:
    found = Demonstrations(folder)
    assert found.steps == sum(len(one) for one in EPISODES)
    for rows in ([-1], [0, found.steps], np.array([[found.steps]])):
        with pytest.raises(IndexError, match="of 36 steps"):
            found.take("state", rows)
    for rows in ([0.5], np.array([1.0]), [True], np.array(["1"])):
        with pytest.raises(TypeError, match="rows are .*, expected whole numbers from 0 to 35"):
            found.take("state", rows)
    assert found.take("depth", []).shape == (0, 4, 5)
    with pytest.raises(KeyError, match="expected one of state"):
        found.take("rgb", [0])
    with pytest.raises(KeyError, match="'rewards' after steps, expected one of state, rgb, depth"):
        found.take("rewards", [0], after=True)


def test_a_file_that_is_replaced_is_read_again(folder: pathlib.Path) -> None:
    before = Demonstrations(folder)[0].rewards
    file = folder / "part-000000" / "rewards.npy"
    changed = np.load(file) + 1
    file.unlink()
    np.save(file, changed)
    np.testing.assert_array_equal(Demonstrations(folder)[0].rewards, before + 1)


def test_more_parts_than_files_may_be_open_are_read(tmp_path: pathlib.Path) -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    many = [
        dataclasses.replace(EPISODES[number % 3], episode=number)
        for number in range(ABOUT.episodes * 20)
    ]
    write(tmp_path, *([one] for one in many))
    about = dataclasses.replace(ABOUT, episodes=len(many))
    (tmp_path / demonstrations.INDEX).write_text(demonstrations.text_of(about))
    resource.setrlimit(resource.RLIMIT_NOFILE, (400, hard))
    try:
        found = Demonstrations(tmp_path)
        for one, wanted in zip(found, many):
            require_equal(one, wanted)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def test_parts_that_do_not_belong_together_are_refused(folder: pathlib.Path) -> None:
    shutil.copytree(folder / "part-000001", folder / "part-000007")
    with pytest.raises(galactic.Error, match="8 episodes, some of them twice or more than the 6"):
        Demonstrations(folder)


def test_a_folder_without_parts_holds_no_episode(tmp_path: pathlib.Path) -> None:
    found = Demonstrations(write(tmp_path))
    assert len(found) == 0 and found.lengths.shape == (0,)
    # Nor do parts that are being written count.
    (tmp_path / ".part-000000.unfinished").mkdir()
    assert len(Demonstrations(tmp_path)) == 0


def resaved(name: str, change) -> object:
    def damage(folder: pathlib.Path) -> None:
        file = folder / "part-000001" / f"{name}.npy"
        np.save(file, change(np.load(file)))

    return damage


def truncate(folder: pathlib.Path) -> None:
    file = folder / "part-000001" / "state.npy"
    file.write_bytes(file.read_bytes()[:-1])


def pickled(folder: pathlib.Path) -> None:
    np.save(folder / "part-000001" / "state.npy", np.array([{}], dtype=object), allow_pickle=True)


def archived(folder: pathlib.Path) -> None:
    file = folder / "part-000001" / "state.npy"
    with open(file, "wb") as handle:
        np.savez(handle, state=np.zeros(3))


def reindexed(**changes: object) -> object:
    def damage(folder: pathlib.Path) -> None:
        file = folder / demonstrations.INDEX
        values = {**json.loads(file.read_text()), **changes}
        file.write_text(json.dumps({name: v for name, v in values.items() if v is not None}))

    return damage


@pytest.mark.parametrize(
    "damage, message",
    [
        (lambda folder: (folder / demonstrations.INDEX).unlink(), "galactic.demonstrate has made"),
        (lambda folder: (folder / demonstrations.INDEX).write_text("{"), "does not say what"),
        (lambda folder: (folder / demonstrations.INDEX).write_text("[]"), "does not say what"),
        (lambda folder: (folder / demonstrations.INDEX).write_bytes(b"\xff"), "does not say what"),
        (reindexed(format=1), "has format 1, expected 2"),
        (reindexed(format=None), "format: found 'nothing'"),
        (reindexed(motions=-1), "found -1"),
        (reindexed(motions=True), "found True"),
        (reindexed(parts=[["way", 1 << 40]]), f"found {1 << 40}"),
        (reindexed(parts=7), "parts: found 7"),
        (reindexed(parts=[7]), "unpack"),
        (reindexed(images={"depth": "large"}), "found 'l'"),
        (reindexed(images={"heat": [4, 5]}), "heat"),
        (reindexed(episodes=None), "episodes"),
        (reindexed(options=[1]), r"options: found \[1\]"),
        (reindexed(camera="head"), "camera: found 'head'"),
        (reindexed(meanings=[]), r"meanings: found \[\]"),
        (reindexed(made_with="x"), "made_with: found 'x'"),
        (reindexed(made_with={"settings": 5}), "settings: found 5"),
        (reindexed(format=True), "format: found True"),
        (lambda f: (f / demonstrations.INDEX).write_text("[" * 100_000), "does not say what"),
        (reindexed(more=1), "more"),
        (reindexed(motions=3), r"actions.npy: found float32 \[16, 4\], expected float32 \[16, 5\]"),
        (
            lambda f: (f / "part-000001" / "rewards.npy").unlink(),
            "rewards.npy: cannot be read.*; remove the folder of this part",
        ),
        (truncate, "state.npy: is no array of numpy"),
        (pickled, "state.npy: is no array of numpy"),
        (archived, "state.npy: found others"),
        (
            resaved("state", lambda rows: rows[:-1]),
            r"state.npy: found float32 \[21, 3\], expected float32 \[22, 3\]",
        ),
        (resaved("state", lambda rows: rows.astype(float)), r"found float64 \[22, 3\]"),
        (resaved("depth", lambda rows: rows[..., 0]), r"depth.npy: found float16 \[22, 4\]"),
        (resaved("lengths", lambda rows: rows - 9), "episodes without steps"),
        (resaved("lengths", lambda rows: rows[:1]), r"lengths.npy: found int32 \[1\], expected"),
        (
            resaved("endings", lambda rows: rows + 77),
            "endings.npy: holds 78, expected numbers of Ep",
        ),
        (resaved("episodes", lambda rows: rows[:0]), "lengths.npy: found"),
        (resaved("rewards", lambda rows: rows * np.nan), "rewards.npy: holds numbers that are not"),
        (resaved("actions", lambda rows: rows + np.inf), "actions.npy: holds .* not from -1 to 1"),
        (resaved("actions", lambda rows: rows * 100), "actions.npy: holds .* not from -1 to 1"),
    ],
)
def test_other_contents_are_refused(folder: pathlib.Path, damage, message: str) -> None:
    damage(folder)
    with pytest.raises(galactic.Error, match=message):
        Demonstrations(folder)
