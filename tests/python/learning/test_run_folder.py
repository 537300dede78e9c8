"""The folder of a run that ended before its first checkpoint, in which another one may begin."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import json
import os
import pathlib
import sys
from typing import Any

import pytest

from galactic.learning.presets import preset
from galactic.learning.refusals import SettingsError
from galactic.learning.saving import run_folder
from galactic.learning.saving.runs import Run
from programs import SMALL, UPDATE, WORLD, call, curve, needs_worlds

TASK = """
import galactic
import numpy as np

class Wait(galactic.Task):
    def step(self, envs):
        return galactic.Outcome(np.zeros(envs.num_envs) - FAULT)
"""
FAULTY, MENDED = TASK.replace(" - FAULT", " / envs.none"), TASK.replace(" - FAULT", "")
CALLBACK = """
def raises(folder, settings):
    def call(moment):
        return 1 / 0
    return call

def stops(folder, settings):
    return lambda moment: moment.stop("enough")
"""


@pytest.fixture
def lab(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    monkeypatch.setattr(sys, "path", list(sys.path))
    (tmp_path / "lab.py").write_text(CALLBACK, encoding="utf-8")
    (tmp_path / "wait.py").write_text(FAULTY, encoding="utf-8")
    return tmp_path


def train(lab: pathlib.Path, *words: Any) -> Any:
    return call("train", WORLD, "-o", lab / "run", *SMALL, "--steps", 2 * UPDATE, *words)


@needs_worlds
def test_a_run_that_failed_in_its_first_step_is_begun_again(lab: pathlib.Path) -> None:
    run, task = lab / "run", ["--task", f"{lab / 'wait.py'}:Wait"]
    failed = train(lab, *task)
    assert failed.returncode == 3 and f'File "{lab / "wait.py"}", line ' in failed.stderr
    assert "has no attribute 'none'" in failed.stderr
    resumed = call("train", "-o", run, "--resume")
    assert resumed.returncode == 2
    assert "holds no checkpoint to go on from; leave out --resume and give" in resumed.stderr
    # What the user keeps there is left alone.
    (run / "notes.txt").write_text("mine", encoding="utf-8")
    (run / "curves.csv").write_text("steps\n1\n", encoding="utf-8")
    (lab / "wait.py").write_text(MENDED, encoding="utf-8")
    again = train(lab, *task)
    assert again.returncode == 0, again.stderr
    assert f"{run} held a run without a checkpoint; this one takes its place\n" in again.stderr
    assert (run / "task.py").read_text("utf-8") == MENDED and len(curve(run)) == 2
    assert (run / "notes.txt").read_text("utf-8") == "mine"
    assert (run / "task.before.py").read_text("utf-8") == FAULTY
    assert (run / "curves.before.csv").read_text("utf-8") == "steps\n1\n"
    assert "its task.py is task.before.py now\n" in again.stderr
    # Now something has been learned.
    third = train(lab, *task)
    assert third.returncode == 1 and "already holds a run; continue it" in third.stderr


@needs_worlds
def test_a_copy_that_was_changed_is_the_users(lab: pathlib.Path) -> None:
    run, copy = lab / "run", lab / "run" / "task.py"
    assert train(lab, "--task", f"{lab / 'wait.py'}:Wait").returncode == 3
    copy.write_text(MENDED, encoding="utf-8")
    later = (run / "settings.json").stat().st_mtime_ns + 10**9
    os.utime(copy, ns=(later, later))
    refused = train(lab, "--task", f"{lab / 'wait.py'}:Wait")
    assert refused.returncode == 2 and f"{copy}: is there already, and is not" in refused.stderr
    assert copy.read_text("utf-8") == MENDED
    # It may be the new run's.
    again = train(lab, "--task", f"{copy}:Wait")
    assert again.returncode == 0 and copy.read_text("utf-8") == MENDED, again.stderr


@needs_worlds
def test_an_unchanged_copy_that_is_named_stays(lab: pathlib.Path) -> None:
    copy = lab / "run" / "task.py"
    assert train(lab, "--task", f"{lab / 'wait.py'}:Wait").returncode == 3
    assert train(lab, "--task", f"{copy}:Wait").returncode == 3
    assert copy.read_text("utf-8") == FAULTY
    # Which it is to the next one, too: it is named, and so it is somebody's.
    assert train(lab, "--task", f"{lab / 'wait.py'}:Wait").returncode == 3
    assert copy.read_text("utf-8") == FAULTY


@needs_worlds
def test_what_a_callback_raises_is_told_with_its_lines(lab: pathlib.Path) -> None:
    failed = train(lab, "--callback", f"{lab / 'lab.py'}:raises")
    assert failed.returncode == 3, failed.stderr
    said = "galactic.train: an exception of the code that was named ended it\nTraceback"
    assert said in failed.stderr and failed.stderr.endswith("ZeroDivisionError: division by zero\n")
    assert f'File "{lab / "lab.py"}", line 4' in failed.stderr
    assert train(lab, "--callback", f"{lab / 'lab.py'}:stops").returncode == 0


@needs_worlds
def test_what_was_learned_or_is_no_runs_is_not_replaced(lab: pathlib.Path) -> None:
    run = lab / "run"
    assert train(lab, "--callback", f"{lab / 'lab.py'}:raises").returncode == 3
    (run / "best.pt").write_bytes(b"weights")
    refused = train(lab)
    assert refused.returncode == 1 and f"(--start-from {run / 'best.pt'})" in refused.stderr
    resumed = call("train", "-o", run, "--resume")
    assert resumed.returncode == 2 and "with the weights of best.pt (--start-" in resumed.stderr
    (run / "best.pt").unlink()
    (run / "settings.json").write_text("{}", encoding="utf-8")
    refused = train(lab)
    assert refused.returncode == 1
    assert f"{run} holds a settings.json that is no run's; choose another folder" in refused.stderr
    assert (run / "settings.json").read_text("utf-8") == "{}"


def a_run(**files: Any) -> Run:
    return Run(pathlib.Path("/homes.pack"), None, preset("quick"), **files)


def begin(run: Run, folder: pathlib.Path) -> Exception | None:
    """As a training does where it is not resumed; why it is refused."""
    try:
        run_folder.require_no_run(folder)
        with contextlib.ExitStack() as held:
            run_folder.take_folder(folder, held, resumes=False)
            run_folder.begin_folder(run, folder, None, resumes=False, say=lambda line: None)
    except Exception as refusal:
        return refusal
    return None


def contents(folder: pathlib.Path) -> dict[str, bytes]:
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in folder.rglob("*")
        if file.is_file() and file.name != ".lock"
    }


def finished(folder: pathlib.Path) -> None:
    (folder / "report.json").write_text(json.dumps({"steps": 1}), encoding="utf-8")


def off_disk(folder: pathlib.Path) -> None:
    (folder / "checkpoints").symlink_to("/nonexistent/scratch")


def put_aside(folder: pathlib.Path) -> None:
    (folder / "checkpoints" / "old-000000001024").mkdir(parents=True)


@pytest.mark.parametrize("leave", [finished, off_disk, put_aside])
def test_a_run_whose_checkpoints_are_elsewhere_is_not_replaced(
    tmp_path: pathlib.Path, leave: Any
) -> None:
    folder = tmp_path / "run"
    assert begin(a_run(), folder) is None
    (folder / "curves.csv").write_text("steps\n1\n", encoding="utf-8")
    leave(folder)
    before = contents(folder)
    refused = begin(a_run(), folder)
    assert isinstance(refused, SettingsError) and "already holds a run, whose check" in str(refused)
    assert contents(folder) == before


def test_checkpoints_that_were_not_finished_are_nothing_learned(tmp_path: pathlib.Path) -> None:
    folder = tmp_path / "run"
    assert begin(a_run(), folder) is None
    run_folder.CheckpointFolder(folder, 1).begin(1024)
    assert begin(a_run(), folder) is None
    assert list((folder / "checkpoints").iterdir()) == []


def test_a_source_in_a_folder_that_was_moved_gets_another_name(tmp_path: pathlib.Path) -> None:
    folder, moved = tmp_path / "run", tmp_path / "moved"
    folder.mkdir()
    source = folder / "task.py"
    for number, aside in enumerate(["task.before.py", "task.before.2.py", "task.before.3.py"]):
        source.write_text(f"mine = {number}\n", encoding="utf-8")
        assert begin(a_run(task_file=source), folder) is None
        folder.rename(moved)
        assert begin(a_run(), moved) is None
        assert (moved / aside).read_text("utf-8") == f"mine = {number}\n"
        assert not (moved / "task.py").exists()
        moved.rename(folder)


def test_the_teacher_of_a_run_that_is_replaced_is_not_the_next_ones(tmp_path: pathlib.Path) -> None:
    folder, teacher = tmp_path / "run", tmp_path / "best.pt"
    teacher.write_bytes(b"weights")
    for is_there in (True, False):
        assert begin(a_run(teacher=teacher), folder) is None
        (folder / "teacher.pt").write_bytes(b"weights")
        if not is_there:
            teacher.unlink()
        assert begin(a_run(), folder) is None
        assert not (folder / "teacher.pt").exists()
        # The only one is not lost.
        assert (folder / "teacher.before.pt").exists() != is_there
    # Without a teacher, the file is the user's.
    (folder / "teacher.pt").write_bytes(b"mine")
    assert begin(a_run(), folder) is None and (folder / "teacher.pt").read_bytes() == b"mine"


def test_what_is_refused_changes_nothing(tmp_path: pathlib.Path) -> None:
    folder, task, network = tmp_path / "run", tmp_path / "wait.py", tmp_path / "net.py"
    for file in (task, network):
        file.write_text("a = 1\n", encoding="utf-8")
    assert begin(a_run(task_file=task, network_file=network), folder) is None
    (folder / "curves.csv").write_text("steps\n1\n", encoding="utf-8")
    copy = folder / "network.py"
    copy.write_text("edited = 1\n", encoding="utf-8")
    later = (folder / "settings.json").stat().st_mtime_ns + 10**9
    os.utime(copy, ns=(later, later))
    task.write_text("a = 2\n", encoding="utf-8")
    before = contents(folder)
    refused = begin(a_run(task_file=task, network_file=network), folder)
    assert f"{copy}: is there already, and is not {network}; move it" in str(refused)
    assert contents(folder) == before
    task.unlink()
    assert isinstance(begin(a_run(task_file=task), folder), FileNotFoundError)
    assert contents(folder) == before


def test_without_locks_no_run_is_replaced(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_locks(*_: Any) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", no_locks)
    folder = tmp_path / "run"
    assert begin(a_run(), folder) is None
    run_folder.CheckpointFolder(folder, 1).begin(1024)
    refused = begin(a_run(), folder)
    assert isinstance(refused, SettingsError)
    assert "already holds a run, and its disk has no locks that would tell" in str(refused)
    assert (folder / "settings.json").is_file()
    assert len(list((folder / "checkpoints").iterdir())) == 1


def test_settings_that_cannot_be_read_are_told_so(tmp_path: pathlib.Path) -> None:
    (tmp_path / "settings.json").mkdir()
    refused = begin(a_run(), tmp_path)
    assert str(refused) == f"{tmp_path / 'settings.json'}: cannot read the file: Is a directory"
