"""Pictures of policies at play: what is on them, and what is refused."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import shutil
from typing import Any

import numpy as np
import pytest

import galactic
from galactic import evaluate
from galactic.learning.homes import Homes
from galactic.learning.playing.evaluation import Actor, EpisodeResult, Evaluator
from galactic.learning.reports import pictures
from galactic.learning.saving import checkpoint
from galactic.learning.settings import Settings
from policies import untrained

WORLD = pathlib.Path(os.environ.get("GALACTIC_LEARNING_WORLDS", "none")) / "held_out.pack"
SIMULATION = "task=pick episode-steps=12"

needs_world = pytest.mark.skipif(
    not WORLD.is_file(), reason="GALACTIC_LEARNING_WORLDS has no worlds"
)


def result(episode: int, success: bool) -> EpisodeResult:
    return EpisodeResult(episode, success, success, "", 0.0, 1, 0.0, 0.0, 0, 0)


def policy_of(network: str, **more: Any) -> tuple[Settings, Homes, checkpoint.SavedPolicy]:
    """An untrained policy, and the homes that it is for."""
    sizes = {"envs": 6, "halves": 1, "mini_batches": 1, "width": 16}
    settings = Settings.effective({**sizes, "network": network, "simulation": SIMULATION, **more})
    homes = Homes(galactic.World(WORLD), settings, 1)
    return settings, homes, untrained(settings, homes)


@pytest.mark.parametrize(
    "successes, failures, shown",
    [(9, 9, 3), (9, 1, 5), (1, 9, 1), (0, 9, 0), (9, 0, 6), (2, 1, 2)],
)
def test_half_of_the_episodes_shown_are_successes(
    successes: int, failures: int, shown: int
) -> None:
    results = [result(episode, episode % 2 == 0) for episode in range(40)]
    good = [one for one in results if one.success][:successes]
    bad = [one for one in results if not one.success][:failures]
    chosen = pictures.choose(sorted(good + bad, key=lambda one: one.episode), 6)
    assert len(chosen) == len(set(chosen)) == min(6, successes + failures)
    assert [episode % 2 for episode in chosen] == [0] * shown + [1] * (len(chosen) - shown)


@needs_world
@pytest.mark.parametrize(
    "network, more",
    [
        ("state", {}),
        ("simple_cnn", {}),
        ("simple_cnn", {"camera": "follow", "fov": 90.0}),
        ("resnet9", {}),
    ],
)
def test_what_is_filmed_is_what_was_played(network: str, more: dict[str, Any]) -> None:
    settings, homes, saved = policy_of(network, **more)
    actor = Actor(saved.policy, deterministic=False)
    episodes = homes.playable_episodes()[:6]
    played = Evaluator(homes, actor).play(episodes)
    films = pictures.film(homes.env.world, settings, actor, episodes, 1)
    for one, film in zip(played, films):
        assert film.episode == one.episode
        world = homes.env.world
        kind = world.episode_table().target_kind[one.episode]
        assert film.target == world.objects[kind]
        assert film.label.endswith(f" {one.length} steps, {film.target}")
        assert galactic.EpisodeEnd(film.ending).name.lower() == one.ending
        assert film.reward == pytest.approx(one.reward, abs=1e-3)
        # What it began with, and what each step led to, the last one, too.
        assert len(film.frames) == one.length + 1
        assert film.frames[0].shape == (pictures.HEIGHT, pictures.WIDTH, 3)
        assert not np.array_equal(film.frames[0], film.frames[-1])
    # They are told apart by what they were paid.
    assert len({round(one.reward, 3) for one in played}) == len(played)


@needs_world
def test_a_network_sees_through_the_camera_of_its_settings() -> None:
    _, homes, _ = policy_of("simple_cnn", camera="follow", fov=90.0)
    drawn = homes.env.reset()[0]["rgb"]
    wanted = galactic.Renderer(homes.env.simulators[0], camera="follow", fov_degrees=90)
    np.testing.assert_array_equal(drawn, wanted.render()["rgb"])
    for wrong, message in (
        ({"camera": "nose"}, '^--camera: found no link "nose"'),
        ({"near": 0.001}, "^--near: found 0.001 m, expected 0.01 to 100"),
        ({"fov": 0.5}, "^--fov: found a vertical field of view of 0.5 degrees"),
    ):
        with pytest.raises(galactic.Error, match=message):
            policy_of("simple_cnn", **wrong)


@needs_world
def test_an_evaluation_draws_a_contact_sheet_and_a_video(tmp_path: pathlib.Path) -> None:
    image = pytest.importorskip("PIL.Image")
    _, _, saved = policy_of("state")
    checkpoint.save_policy(saved, tmp_path / "policy.pt")
    command = [str(tmp_path / "policy.pt"), str(WORLD), "--episodes", "5", "--shown", "3"]
    report = tmp_path / "report.json"
    sheet_command = [*command, "--contact-sheet", str(tmp_path / "sheet.png")]
    assert evaluate.main([*sheet_command, "--report", str(report)]) == 0
    world = galactic.World(WORLD)
    table = world.episode_table()
    for one in json.loads(report.read_text(encoding="utf-8"))["each"]:
        assert one["target"] == world.objects[table.target_kind[one["episode"]]]
        assert one["scene"] == world.scenes[table.scene[one["episode"]]]
    sheet = np.asarray(image.open(tmp_path / "sheet.png"))
    row = pictures.HEIGHT + 16
    assert sheet.shape == (3 * row, pictures.MOMENTS * pictures.WIDTH, 3)
    for top in range(0, 3 * row, row):
        # The strip says how the episode ended, in red as none of them is a success.
        assert tuple(sheet[top, -1]) == pictures._RED
        assert sheet[top : top + 16].max() == 255 and sheet[top + 16 : top + row].std() > 10
    if not shutil.which("ffmpeg"):
        return
    assert evaluate.main([*command, "--video", str(tmp_path / "film.mp4")]) == 0
    assert b"ftyp" in (tmp_path / "film.mp4").read_bytes()[:16]
    assert evaluate.main([*command, "--video", str(tmp_path / "film.none")]) == 2


@needs_world
def test_pictures_that_cannot_be_written_are_refused_before_anything_is_played(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("PIL")
    command = ["none.pt", str(WORLD)]
    for name in ("sheet.jpg", "sheet", "sheet.png.txt"):
        file = tmp_path / name
        assert evaluate.main([*command, "--contact-sheet", str(file)]) == 5
        wanted = f"galactic.evaluate: {file}: pictures are PNG files; end the name with .png\n"
        assert capsys.readouterr().err == wanted
    tool = tmp_path / "bin" / "ffmpeg"
    tool.parent.mkdir()
    tool.write_text("#!/bin/sh\necho which format >&2; exit 1\n", encoding="utf-8")
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", str(tool.parent), prepend=":")
    file = tmp_path / "film.none"
    assert evaluate.main([*command, "--video", str(file)]) == 2
    wanted = f"galactic.evaluate: {file}: ffmpeg did not write it: which format\n"
    assert capsys.readouterr().err == wanted
    assert list(tmp_path.iterdir()) == [tool.parent]


def test_an_evaluation_replaces_none_of_its_inputs_and_outputs(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("PIL")
    policy, world = tmp_path / "best.pt", tmp_path / "world.pack"
    for file in (policy, world):
        file.write_text("precious", encoding="utf-8")
        assert evaluate.main([str(policy), str(world), "--report", str(file)]) == 3
        wanted = f"galactic.evaluate: {file}: is also an input; write to another file\n"
        assert capsys.readouterr().err == wanted
        assert file.read_text(encoding="utf-8") == "precious"
    both = ["--report", str(tmp_path / "a.png"), "--contact-sheet", str(tmp_path / "a.png")]
    assert evaluate.main([str(policy), str(world), *both]) == 3
    said = capsys.readouterr().err
    assert said.endswith(
        "would be written twice: by --report and by --contact-sheet; give each its own name\n"
    )


@needs_world
@pytest.mark.parametrize(
    "changes, code, fault",
    [
        ({"simulation": "hover=3"}, 3, "--simulation: there is no option hover; did you mean"),
        ({"simulation": "envs=3"}, 3, "envs is not for --simulation"),
        ({"simulation": "task=pick episode-steps=0"}, 3, "was trained in episodes without a limit"),
        ({"simulation": "task=cook"}, 3, "in {world}: --simulation: task: is cook, expected"),
        (
            {"network": "simple_cnn", "camera": "nose"},
            3,
            'in {world}: --camera: found no link "nose"',
        ),
    ],
)
def test_a_policy_of_other_options_is_named(
    tmp_path: pathlib.Path,
    capsys: pytest.CaptureFixture[str],
    changes: dict[str, Any],
    code: int,
    fault: str,
) -> None:
    _, _, saved = policy_of(str(changes.get("network", "state")))
    saved.settings = dataclasses.replace(saved.settings, **changes)
    file = tmp_path / "policy.pt"
    checkpoint.save_policy(saved, file)
    assert evaluate.main([str(file), str(WORLD)]) == code
    said = capsys.readouterr().err
    assert said.startswith(f"galactic.evaluate: {file} ") and said.count("\n") == 1
    assert fault.format(world=WORLD) in said


def test_a_video_appears_whole_or_not_at_all(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("PIL")
    tool = tmp_path / "bin" / "ffmpeg"
    tool.parent.mkdir()
    monkeypatch.setenv("PATH", str(tool.parent), prepend=":")
    (tmp_path / "runs").mkdir()
    file = tmp_path / "runs" / "film.mp4"
    frame = np.zeros((pictures.HEIGHT, pictures.WIDTH, 3), np.uint8)
    films = [pictures.Film(0, "mug", [frame, frame])]

    def write_with(script: str) -> None:
        tool.write_text(f"#!/bin/sh\nfor last; do :; done\n{script}\n", encoding="utf-8")
        tool.chmod(0o755)
        pictures.write_video(films, file)

    write_with('case "$last" in *.mp4) cat > "$last";; esac')
    whole = file.read_bytes()
    assert len(whole) == 2 * (pictures.HEIGHT + 16) * pictures.WIDTH * 3
    with pytest.raises(galactic.Error, match=f"{file}: ffmpeg did not write it: disk full"):
        write_with('echo half > "$last"; echo disk full >&2; exit 1')
    assert file.read_bytes() == whole
    assert list(file.parent.iterdir()) == [file]


@needs_world
def test_tools_that_are_missing_are_named(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("PIL")
    monkeypatch.setenv("PATH", str(tmp_path))
    assert evaluate.main(["none.pt", str(WORLD), "--video", str(tmp_path / "film.mp4")]) == 5
    assert "pictures: need ffmpeg on the PATH, which is not here" in capsys.readouterr().err
    with pytest.raises(SystemExit) as ended:
        evaluate.main(["none.pt", str(WORLD), "--contact-sheet", "sheet.png", "--shown", "0"])
    assert ended.value.code == 1
    assert '--shown: found "0"' in capsys.readouterr().err
