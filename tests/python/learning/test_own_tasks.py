"""Tasks of one's own in the trainer: galactic.train --task, and what uses its policies."""

from __future__ import annotations

import dataclasses
import importlib
import json
import pathlib
import pickle
import sys
from typing import Any

import numpy as np
import pytest
import torch

import galactic
from galactic.learning.homes import Homes
from galactic.learning.packs.content import export_policy
from galactic.learning.playing.evaluation import Actor, Evaluator
from galactic.learning.refusals import CheckpointError, SettingsError
from galactic.learning.reports import pictures
from galactic.learning.saving import checkpoint
from galactic.learning.settings import Settings
from galactic.learning.user_code import own_code, own_tasks
from policies import untrained
from programs import HELD_OUT, SMALL, UPDATE, WORLD, call, curve, needs_worlds

TASK = '''
"""A task that a test writes to a file."""

import numpy as np
import galactic
from distances import hands

class Approach(galactic.Task):
    options = {"episode_steps": 40, "bump": True}
    parts = {"way": 1, "dice": 1}
    measures = ["way_left"]

    def __init__(self, radius=0.6, bonus=0.0):
        self.radius, self.bonus = radius, bonus

    def prepare(self, envs):
        self.memory = {"way": np.zeros(envs.num_envs, np.float32)}

    def begin(self, envs, which):
        self.memory["way"][which] = hands(envs)[which]

    def step(self, envs):
        now = hands(envs)
        paid = self.memory["way"] - now + self.bonus * envs.uniform("bonus")[:, 0]
        self.memory["way"][:] = now
        return galactic.Outcome(paid, now < self.radius, envs.uniform("end")[:, 0] < 0.01)

    def measure(self, envs, which):
        return {"way_left": self.memory["way"][which]}

    def observe(self, envs):
        return {"way": self.memory["way"][:, np.newaxis], "dice": envs.uniform("dice")}

class Ends(Approach):
    def __init__(self):
        raise SystemExit(0)

class Idle(Approach):
    base, options, parts = "pick", {}, {}

not_a_task = 3
'''
DISTANCES = """
import numpy as np

def hands(envs):
    return np.linalg.norm(envs.observations["grip_target"], axis=1)
"""


@pytest.fixture
def task_file(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """TASK in a file, beside a module that it imports."""
    folder = tmp_path / "lab"
    folder.mkdir()
    (folder / "distances.py").write_text(DISTANCES, encoding="utf-8")
    file = folder / "approach.py"
    file.write_text(TASK, encoding="utf-8")
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.delitem(sys.modules, "distances", raising=False)
    return file


@needs_worlds
def test_a_run_goes_on_with_the_task_that_it_began_with(
    tmp_path: pathlib.Path, task_file: pathlib.Path
) -> None:
    """Bit for bit, whatever has become of the file; halves take turns."""
    options = [
        WORLD,
        *SMALL,
        "--halves",
        "2",
        "--steps",
        12 * UPDATE,
        "--task",
        f"{task_file}:Approach",
    ]
    options += ["--task-options", "radius=0.7 bonus=0.1"]
    options += ["--validation", HELD_OUT, "--validation-episodes", "4"]
    whole, paused = tmp_path / "whole", tmp_path / "paused"
    done = call("train", "-o", whole, *options)
    assert done.returncode == 0, done.stderr
    assert call("train", "-o", paused, *options, "--pause-at", 7 * UPDATE).returncode == 0
    assert (paused / "task.py").read_text(encoding="utf-8") == TASK
    task_file.write_text(TASK.replace("self.bonus *", "9 *"), encoding="utf-8")
    resumed = call("train", "-o", paused, "--resume")
    assert resumed.returncode == 0, resumed.stderr
    # The row of the pause has its validation, which the other run has not.
    assert [row for row in curve(paused) if row["kl"] is not None] == [
        row for row in curve(whole) if row["kl"] is not None
    ]
    final = f"checkpoints/{12 * UPDATE:012d}/policy.pt"
    one, two = (checkpoint.load_policy(folder / final) for folder in (whole, paused))
    weights = two.policy.state_dict()
    assert all(torch.equal(value, weights[name]) for name, value in one.policy.state_dict().items())
    assert one.settings.task == "approach.py:Approach"
    assert dict(one.parts)["way"] == 1 and one.parts[-2:] == [("way", 1), ("dice", 1)]
    # The preset's options, over them the task's, and the task below.
    words = one.settings.simulation.split()
    assert {"task=none", "episode-steps=40", "bump", "geodesic"} <= set(words)


@needs_worlds
def test_the_curves_tell_what_a_task_measures(
    tmp_path: pathlib.Path, task_file: pathlib.Path
) -> None:
    """And whoever else takes them. A validation measures what an evaluation does."""
    run, report, lines = tmp_path / "run", tmp_path / "report.json", tmp_path / "rows.jsonl"
    (tmp_path / "lab.py").write_text(
        "import json\n"
        "def to_lines(folder, settings):\n"
        f"    file = open({str(lines)!r}, 'w')\n"
        "    return lambda row: print(json.dumps(row), file=file, flush=True)\n",
        encoding="utf-8",
    )
    task = ["--task", f"{task_file}:Approach"]
    options = [*SMALL, "--steps", 12 * UPDATE, *task, "--log-to", f"{tmp_path / 'lab.py'}:to_lines"]
    options += ["--validation", HELD_OUT, "--validation-episodes", 8]
    done = call("train", WORLD, "-o", run, *options)
    assert done.returncode == 0, done.stderr
    rows = [json.loads(line) for line in lines.read_text(encoding="utf-8").splitlines()]
    *_, validated, trained = rows
    assert 0.6 < trained["measure_way_left"] < 10.0
    for given, row in zip(rows, curve(run)):
        for name in ("measure_way_left", "validation_measure_way_left"):
            assert row[name] == (pytest.approx(given[name]) if name in given else None)
    kept = json.loads((run / "report.json").read_text(encoding="utf-8"))
    assert kept["training"]["measure_way_left"] == trained["measure_way_left"]
    left = validated["validation_measure_way_left"]
    assert kept["validation"]["measure_way_left"] == left
    assert f", way_left {left:.3g}\n" in done.stderr
    assert '"title":"way_left"' in (run / "curves.html").read_text(encoding="utf-8")
    policy = next(run.glob("checkpoints/*/policy.pt"))
    done = call("evaluate", policy, HELD_OUT, "--episodes", 8, *task, "--report", report)
    assert done.returncode == 0, done.stderr
    found = json.loads(report.read_text(encoding="utf-8"))["measures"]["way_left"]
    assert found == pytest.approx(left, abs=1e-3)


@needs_worlds
def test_an_evaluation_runs_a_task_only_when_told(
    tmp_path: pathlib.Path, task_file: pathlib.Path
) -> None:
    run, report = tmp_path / "run", tmp_path / "report.json"
    options = [*SMALL, "--steps", UPDATE, "--task", f"{task_file}:Approach"]
    assert call("train", WORLD, "-o", run, *options).returncode == 0
    policy = run / "best.pt"
    refused = call("evaluate", policy, HELD_OUT)
    assert refused.returncode == 1
    assert refused.stderr == (
        f"galactic.evaluate: command line: {policy} was trained with a task of its own; if you trust it, "
        f"add --task {run / 'task.py'}:Approach\n"
    )
    inner = next(run.glob("checkpoints/*/policy.pt"))
    assert f"add --task {run / 'task.py'}:Approach" in call("evaluate", inner, HELD_OUT).stderr
    words = ["--task", f"{task_file}:Approach", "--task-options", "radius=99", "--report", report]
    done = call("evaluate", policy, HELD_OUT, *words)
    assert done.returncode == 0, done.stderr
    found = json.loads(report.read_text(encoding="utf-8"))
    assert found["success"] == 1.0 and found["endings"] == {"success": 100}
    assert found["success_interval"] == pytest.approx([0.963, 1.0], abs=1e-4)
    assert {one["length"] for one in found["each"]} == {1}
    left = [one["measures"]["way_left"] for one in found["each"]]
    assert len(set(left)) > 50 and min(left) > 0
    assert found["measures"] == {"way_left": pytest.approx(sum(left) / 100)}
    assert found["task"] == f"{task_file}:Approach"
    # Nothing is written over what it is judged by.
    written = task_file.read_bytes()
    words[-1] = task_file
    refused = call("evaluate", policy, HELD_OUT, *words)
    assert refused.returncode == 3 and f"{task_file}: is also an input" in refused.stderr
    assert task_file.read_bytes() == written
    # Neither a file of another folder nor what a stranger calls the task is recommended.
    stranger = checkpoint.load_policy(policy)
    stranger.settings = dataclasses.replace(
        stranger.settings, task="x.py; rm -r \x1b[31m.py:Approach"
    )
    checkpoint.save_policy(stranger, tmp_path / "stranger.pt")
    (tmp_path / "task.py").write_text(TASK, encoding="utf-8")
    assert (
        "add --task FILE.py:CLASS\n" in call("evaluate", tmp_path / "stranger.pt", HELD_OUT).stderr
    )
    # Another task, which does not give what the policy observes.
    done = call("evaluate", policy, HELD_OUT, "--task", f"{task_file}:Idle")
    assert done.returncode == 3 and "way (1), dice (1)" in done.stderr


@needs_worlds
def test_any_policy_can_be_judged_by_a_task(
    tmp_path: pathlib.Path, task_file: pathlib.Path
) -> None:
    assert call("train", WORLD, "-o", tmp_path / "run", *SMALL, "--steps", UPDATE).returncode == 0
    report = tmp_path / "report.json"
    judge = ["--task", f"{task_file}:Idle", "--task-options", "radius=0.5", "--report", report]
    done = call("evaluate", tmp_path / "run" / "best.pt", HELD_OUT, *judge)
    assert done.returncode == 0, done.stderr
    endings = json.loads(report.read_text(encoding="utf-8"))["endings"]
    assert endings["success"] > 0 and endings["failure"] > 0


@needs_worlds
def test_a_pack_has_what_the_simulation_gives(
    tmp_path: pathlib.Path, task_file: pathlib.Path
) -> None:
    options = [*SMALL, "--steps", UPDATE, "--task", f"{task_file}:Approach"]
    for name, private in (
        ("seen", ["--critic-only", "dice"]),
        ("unseen", ["--critic-only", "way,dice"]),
    ):
        done = call("train", WORLD, "-o", tmp_path / name, *options, *private)
        assert done.returncode == 0, done.stderr
    pack = tmp_path / "policy.pack"
    with pytest.raises(CheckpointError, match="observes way, which its task approach.py:App"):
        export_policy(tmp_path / "seen" / "best.pt", pack)
    assert not pack.exists()
    export_policy(tmp_path / "unseen" / "best.pt", pack)
    played = galactic.LearnedPolicy(pack, 4)
    assert played.options["task"] == "none" and played.options["episode_steps"] == 40


@needs_worlds
@pytest.mark.parametrize("network", ["state", "depth"])
def test_what_is_filmed_is_what_was_played(task_file: pathlib.Path, network: str) -> None:
    """With the task's ends, and its columns in what the policy sees."""
    sees = {"image_size": 36} if network == "depth" else {}
    settings = Settings(
        envs=6, halves=1, mini_batches=1, network=network, width=16, simulation="episode-steps=12", **sees
    )  # fmt: skip
    world = galactic.World(HELD_OUT)
    starts = galactic.Simulator(world, envs=6, order="linear")
    episodes = starts.episodes().tolist()
    # Half of the targets are as near from the beginning.
    ways = np.linalg.norm(starts.observations[:, starts.observation_parts["grip_target"]], axis=1)
    name = own_code.named(f"{task_file}:Approach", "--task")
    task = own_tasks.maker(name, f"radius={np.median(ways) + 0.1} bonus=0.1")
    homes = Homes(world, settings, 1, task=task)
    actor = Actor(untrained(settings, homes).policy, deterministic=False)
    played = Evaluator(homes, actor).play(episodes)
    films = pictures.film(world, settings, actor, episodes, 1, task)
    for one, film in zip(played, films):
        assert galactic.EpisodeEnd(film.ending).name.lower() == one.ending
        assert film.reward == pytest.approx(one.reward, abs=1e-3)
        assert len(film.frames) == one.length + 1
        assert not np.array_equal(film.frames[0], film.frames[-1])
    assert {one.ending for one in played} >= {"success", "time_out"}
    # With the same luck, in fewer envs, and another one first.
    fewer = Homes(world, dataclasses.replace(settings, envs=2), 1, task=task, rank=1, ranks=2)
    again = Evaluator(fewer, actor).play(episodes[::-1])[::-1]
    assert [one.ending for one in again] == [one.ending for one in played]
    np.testing.assert_allclose(
        [one.reward for one in again], [one.reward for one in played], atol=1e-3
    )


@needs_worlds
@pytest.mark.parametrize(
    "words, message",
    [
        (["--task", "approach"], 'found "approach", expected FILE.py:NAME or MODULE:NAME'),
        (["--task", "a-b:Approach"], 'found "a-b:Approach", expected FILE.py:NAME or MODULE:NAME'),
        (["--task", "{lab}/none.py:Approach"], "/none.py is no file; name the one that Approach is in"),
        (["--task", "no_such.module:Approach"], "there is no module no_such.module; install it"),
        (["--task", "{lab}/approach.py:Aproach"], "has no Aproach; did you mean Approach?"),
        (["--task", "{lab}/approach.py:nothing"], "has no nothing; it has Approach, Ends, Idle"),
        (["--task", "{lab}/approach.py:Ends"], "approach.py:Ends ended the program when it was made"),
        (["--task", "{lab}/approach.py:not_a_task"], "is no class that inherits from galactic.Task"),
        (["--task", "{lab}/approach.py:Approach", "--task-options", "radios=2"],
         "approach.py:Approach cannot be made of them: got an unexpected keyword argument 'radios'"),
        (["--task", "{lab}/approach.py:Approach", "--task-options", "radius"],
         'found "radius", expected NAME=VALUE'),
        (["--task", "{lab}/approach.py:Approach", "--simulation", "task=pick"],
         "found task=pick beside --task; the class says which one is below (base)"),
        (["--task-options", "radius=2"], "--task-options goes with --task; name one, or leave it out"),
        (["--task", "{lab}/approach.py:Approach", "--critic-only", "wya"], 'did you mean way?'),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_a_sentence(
    tmp_path: pathlib.Path, task_file: pathlib.Path, words: list[str], message: str
) -> None:
    given = [word.format(lab=task_file.parent) for word in words]
    done = call("train", WORLD, "-o", tmp_path / "run", *SMALL, "--steps", UPDATE, *given)
    assert done.returncode == 1
    assert done.stderr.startswith("galactic.train: command line: ") and message in done.stderr
    assert not (tmp_path / "run").exists()


@needs_worlds
def test_what_a_task_raises_comes_out_as_it_is(
    tmp_path: pathlib.Path, task_file: pathlib.Path
) -> None:
    """With the lines of the class, where somebody has to look."""
    task_file.write_text(
        TASK.replace("def prepare(self, envs):", "def prepare(self, env):"), "utf-8"
    )
    done = call("train", WORLD, "-o", tmp_path / "a", *SMALL, "--task", f"{task_file}:Approach")
    assert done.returncode == 3 and "NameError: name 'envs' is not defined" in done.stderr
    assert f'File "{task_file}", line ' in done.stderr
    task_file.write_text(TASK.replace('return {"way"', 'return {"road"'), "utf-8")
    done = call("train", WORLD, "-o", tmp_path / "b", *SMALL, "--task", f"{task_file}:Approach")
    assert done.returncode == 3
    assert "ValueError: Approach.observe() returned ['dice', 'road']" in done.stderr
    # Options around it are the command line's.
    done = call("train", WORLD, "-o", tmp_path / "c", *SMALL, "--task", f"{task_file}:Approach",
                "--simulation", "episode-stpes=3")  # fmt: skip
    assert (
        done.returncode == 1 and "--simulation: " in done.stderr and "did you mean" in done.stderr
    )


@needs_worlds
def test_a_file_that_ends_the_program_is_refused(tmp_path: pathlib.Path) -> None:
    (tmp_path / "ends.py").write_text("import sys\nsys.exit()\n", encoding="utf-8")
    name = f"{tmp_path / 'ends.py'}:Approach"
    said = "ended the program when it was imported; put what a program does behind: if __name__"
    for option in ("--task", "--log-to"):
        done = call("train", WORLD, "-o", tmp_path / "run", *SMALL, option, name)
        assert done.returncode == 1 and f"{option}: ends.py:Approach {said}" in done.stderr


@needs_worlds
def test_no_file_of_the_user_is_written_over(
    tmp_path: pathlib.Path, task_file: pathlib.Path
) -> None:
    mine = tmp_path / "run" / "task.py"
    mine.parent.mkdir()
    mine.write_text("mine", encoding="utf-8")
    options = [*SMALL, "--steps", UPDATE, "--task", f"{task_file}:Approach"]
    done = call("train", WORLD, "-o", mine.parent, *options)
    assert (
        done.returncode == 2 and f"{mine}: is there already, and is not {task_file}" in done.stderr
    )
    assert mine.read_text(encoding="utf-8") == "mine"


def test_files_of_one_name_are_two_modules(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each finds itself by the name of its module: there dataclasses look for types, and pickle for classes."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    found = {}
    for lab in ("a", "b"):
        file = tmp_path / lab / "run.py"
        file.parent.mkdir()
        file.write_text(f"class Home:\n    lab = {lab!r}\n", encoding="utf-8")
        found[lab] = own_code.members_of(own_code.named(f"{file}:Home", "--task"))["Home"]
    for lab, home in found.items():
        assert home.lab == lab and pickle.loads(pickle.dumps(home)) is home
    # The same file is the same module, until it says something else.
    again = own_code.members_of(own_code.named(f"{file}:Home", "--log-to"))["Home"]
    assert again is found["b"]
    file.write_text("class Home:\n    lab = 'c'\n", encoding="utf-8")
    assert own_code.members_of(own_code.named(f"{file}:Home", "--task"))["Home"].lab == "c"


def test_a_file_that_is_called_like_a_library_does_not_hide_it(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "path", list(sys.path))
    for name in ("json", "torch", "colorsys"):
        file = tmp_path / f"{name}.py"
        file.write_text("import json\nmine = json.dumps([1])\n", encoding="utf-8")
        members = own_code.members_of(own_code.named(f"{file}:mine", "--log-to"))
        assert members["mine"] == "[1]"
    monkeypatch.delitem(sys.modules, "colorsys", raising=False)
    for name in ("colorsys", "torch"):
        assert not hasattr(importlib.import_module(name), "mine")


def test_options_become_keywords() -> None:
    words = "radius=0.2 --kind=near most=3 places=[1,2] far-too=True dense=false no=None empty="
    assert own_code.keywords_of(words, "--task-options") == {
        "radius": 0.2, "kind": "near", "most": 3, "places": [1, 2], "far_too": True, "dense": False,
        "no": None, "empty": "",
    }  # fmt: skip
    with pytest.raises(SettingsError, match='found "=3", expected NAME=VALUE'):
        own_code.keywords_of("=3", "--task-options")


@pytest.mark.parametrize(
    "options, words",
    [
        ({"episode_steps": 9}, "episode-steps=9"),
        ({"bump": True, "geodesic": False}, "bump geodesic=false"),
        ({"laser_heights": [0.25, (0.4, 0.8)]}, "laser-heights=0.25,0.4-0.8"),
        ({"slide": "published"}, "slide=published"),
        ({"action_delay": (0, 2)}, "action-delay=0-2"),
        ({"motion_noise": [0.1, 0.3]}, "motion-noise=0.1-0.3"),
    ],
)
def test_options_of_a_class_are_typed_as_a_user_types_them(
    options: dict[str, Any], words: str
) -> None:
    task = type("Some", (galactic.Task,), {"options": options, "base": "pick"})()
    found = own_tasks.simulation_below(task, "task=rearrange bump-penalty=1", "laser-beams=8")
    assert found == f"task=pick bump-penalty=1 {words} laser-beams=8"
    # What was given goes first.
    given = words.split("=")[0].split()[0]
    assert f"{given}=1" in own_tasks.simulation_below(task, "", f"{given}=1").split()
