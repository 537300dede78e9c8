"""The folder of a run that ended before its first checkpoint, in which another one may begin."""

from __future__ import annotations

import os
import pathlib
import sys
from typing import Any

import pytest

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
