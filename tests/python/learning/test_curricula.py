"""What a task of one's own is told of the training around it, and the curves of what it says of each step."""

from __future__ import annotations

import json
import pathlib

import pytest

import galactic
from galactic.learning.homes import Homes
from galactic.learning.playing.evaluation import Actor
from galactic.learning.reports import pictures
from galactic.learning.settings import Settings
from galactic.learning.user_code import own_code, own_tasks
from policies import untrained
from programs import (
    HELD_OUT,
    SMALL,
    SMALL_OF_ANY_RANKS,
    UPDATE,
    WORLD,
    call,
    curve,
    needs_worlds,
    run,
)

TASK = '''
import numpy as np
import galactic

class Told(galactic.Task):
    """Easy at first: whoever acts has solved it."""

    options = {"episode_steps": 10}
    measures = ("progress", "evaluation")
    logs = ("progress", "steps")

    def step(self, envs):
        told = np.full(envs.num_envs, envs.progress)
        ages = envs.states.step
        # Not longer than a rollout at first.
        is_over = ages >= (4 if envs.progress < 1 else 8)
        return galactic.Outcome(np.zeros(envs.num_envs), is_over, logs={"progress": told, "steps": ages})

    def measure(self, envs, which):
        ones = np.ones(len(which))
        return {"progress": ones * envs.progress, "evaluation": ones * envs.is_evaluation}


class Picks(Told):
    """Of which the scripted policy knows what is to be done."""

    base = "pick"
'''


@pytest.fixture
def task(tmp_path: pathlib.Path) -> list[object]:
    file = tmp_path / "told.py"
    file.write_text(TASK, encoding="utf-8")
    return ["--task", f"{file}:Told"]


@needs_worlds
def test_validations_and_evaluations_see_the_task_at_its_end(
    tmp_path: pathlib.Path, task: list[object]
) -> None:
    """And training as far as it is, also in a run that is resumed."""
    folder, report = tmp_path / "run", tmp_path / "report.json"
    options = [*SMALL, "--steps", 8 * UPDATE, "--window", "1", *task]
    options += ["--validation", HELD_OUT, "--validation-episodes", 4, "--validate-every", UPDATE]
    done = call("train", WORLD, "-o", folder, *options, "--pause-at", 4 * UPDATE)
    assert done.returncode == 0, done.stderr
    done = call("train", "-o", folder, "--resume")
    assert done.returncode == 0, done.stderr
    rows = curve(folder)
    validations = [row for row in rows if row["validation_length"] is not None]
    assert len(validations) == 8
    for row in validations:
        assert row["validation_measure_progress"] == row["validation_measure_evaluation"] == 1
        assert row["validation_length"] == 8 and row["validation_log_progress"] == 1
        assert row["validation_log_steps"] == pytest.approx(4.5)
    trained = [row for row in rows if row["kl"] is not None]
    assert [row["steps"] for row in trained] == [n * UPDATE for n in range(1, 9)]
    for number, row in enumerate(trained):
        assert row["measure_progress"] == row["log_progress"] == number / 8
        assert row["measure_evaluation"] == 0 and row["length"] == 4
        assert row["log_steps"] == pytest.approx(2.5)
    kept = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert kept["training"]["log_progress"] == 7 / 8 and kept["validation"]["log_progress"] == 1
    page = (folder / "curves.html").read_text(encoding="utf-8")
    assert '"title":"steps"' in page and '"title":"std"' not in page
    words = ["--episodes", 4, *task, "--report", report]
    done = call("evaluate", folder / "best.pt", HELD_OUT, *words)
    assert done.returncode == 0, done.stderr
    found = json.loads(report.read_text(encoding="utf-8"))
    assert found["length"] == 8 and found["measures"] == {"progress": 1, "evaluation": 1}
    assert found["logs"] == {"progress": 1, "steps": pytest.approx(4.5)}
    assert [one["logs"]["steps"] for one in found["each"]] == [pytest.approx(4.5)] * 4


@needs_worlds
def test_progress_is_of_all_ranks_together(tmp_path: pathlib.Path, task: list[object]) -> None:
    folder = tmp_path / "run"
    options = [*SMALL_OF_ANY_RANKS, "--ranks", 2, "--steps", 8 * UPDATE, "--window", "1", *task]
    done = run("train", WORLD, "-o", folder, *options)
    assert done.returncode == 0, done.stderr
    assert [row["log_progress"] for row in curve(folder)] == [0, 0.25, 0.5, 0.75]


@needs_worlds
def test_a_run_is_resumed_with_a_class_that_says_as_much(
    tmp_path: pathlib.Path, task: list[object]
) -> None:
    folder = tmp_path / "run"
    options = [*SMALL, "--steps", 4 * UPDATE, *task]
    done = call("train", WORLD, "-o", folder, *options, "--pause-at", 2 * UPDATE)
    assert done.returncode == 0, done.stderr
    copy = folder / "task.py"
    less = TASK.replace('logs = ("progress", "steps")', 'logs = ("progress",)')
    copy.write_text(less.replace(', "steps": ages}', "}"), encoding="utf-8")
    refused = call("train", "-o", folder, "--resume")
    assert refused.returncode == 3
    assert "is of a task that logged steps, and the task does so no longer; put" in refused.stderr
    more = TASK.replace('logs = ("progress", "steps")', 'logs = ("progress", "more", "steps")')
    copy.write_text(more.replace('"steps": ages}', '"steps": ages, "more": ages}'), "utf-8")
    resumed = call("train", "-o", folder, "--resume")
    assert resumed.returncode == 0, resumed.stderr
    *_, last = curve(folder)
    assert last["log_steps"] == pytest.approx(2.5) and last["log_more"] is None


@needs_worlds
def test_pictures_and_demonstrations_are_of_the_task_at_its_end(
    tmp_path: pathlib.Path, task: list[object]
) -> None:
    settings = Settings(envs=2, halves=1, mini_batches=1, network="state", width=16)
    name = own_code.named(str(task[1]), "--task")
    make, world = own_tasks.maker(name, ""), galactic.World(HELD_OUT)
    homes = Homes(world, settings, 1, task=make)
    actor = Actor(untrained(settings, homes).policy, deterministic=True)
    films = pictures.film(world, settings, actor, homes.playable_episodes()[:2], 1, make)
    assert [len(film.frames) for film in films] == [9, 9]
    folder = tmp_path / "demos"
    options = [
        "--preset",
        "quick",
        "--episodes",
        2,
        "--task",
        str(task[1]).replace("Told", "Picks"),
    ]
    done = call("demonstrate", WORLD, "-o", folder, *options)
    assert done.returncode == 0, done.stderr
    assert galactic.Demonstrations(folder).lengths.tolist() == [8, 8]
