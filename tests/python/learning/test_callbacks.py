"""Callbacks: galactic.train --callback."""

from __future__ import annotations

import dataclasses
import pathlib
import sys

import pytest

from galactic.learning.refusals import SettingsError
from galactic.learning.reports.curves import read_curves
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.user_code import callbacks
from galactic.learning.user_code.callbacks import Moment
from programs import SMALL, UPDATE as PROGRAM_UPDATE, WORLD, call, curve, needs_worlds
from trainers import SETTINGS, UPDATE, make_trainer
from trainers import curve as curve_of

LAB = """
def counts(folder, settings):
    def call(moment):
        moment.log("count", moment.row["updates"])
        if moment.row["updates"] == 2 and moment.kind == "update":
            moment.stop("twice is enough")
    return call

def nothing(folder, settings):
    return None

def takes_none(folder, settings):
    return lambda: None

def ends(folder, settings):
    def call(moment):
        raise SystemExit(0)
    return call

def one(folder):
    pass
"""


@pytest.fixture
def lab(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    monkeypatch.setattr(sys, "path", list(sys.path))
    file = tmp_path / "lab.py"
    file.write_text(LAB, encoding="utf-8")
    return file


def test_a_callback_adds_to_the_curves_and_ends_the_run(tmp_path: pathlib.Path) -> None:
    """Validated and saved; what has been added is kept when the run goes on."""
    moments: list[Moment] = []

    def look(moment: Moment) -> None:
        moments.append(moment)
        if moment.kind == "update" and moment.row["updates"] > 1:
            moment.log("half", moment.row["updates"] / 2)
        if moment.kind == "update" and moment.row["updates"] == 3:
            moment.stop("enough")

    settings = dataclasses.replace(SETTINGS, validate_every=2 * UPDATE)
    episodes = EpisodeSums(2.0, 1.0, 1.0, 3.0, 8.0)
    trainer = make_trainer(tmp_path, settings, validation=lambda policy: episodes)
    trainer.callback = look
    trainer.begin()
    assert trainer.train() and trainer.steps == 3 * UPDATE
    assert [moment.kind for moment in moments] == [
        "update", "update", "validation", "update", "validation", "end",
    ]  # fmt: skip
    loss = curve_of(tmp_path)[0]["policy_loss"]
    assert moments[0].row["policy_loss"] == pytest.approx(loss)
    assert moments[2].row["validation_success"] == 0.5
    again = make_trainer(tmp_path, settings, validation=lambda policy: episodes)
    again.resume()
    again.train()
    rows = curve_of(tmp_path)
    found = [row["callback_half"] for row in rows]
    assert found == [None, 1.0, None, 1.5, *[None] * (len(rows) - 4)] and len(rows) > 8


def test_what_is_logged_at_the_end_has_a_row(tmp_path: pathlib.Path) -> None:
    trainer = make_trainer(tmp_path, dataclasses.replace(SETTINGS, steps=2 * UPDATE))
    trainer.callback = lambda moment: moment.kind == "end" and moment.log("last", 7.0)
    trainer.begin()
    assert trainer.train()
    rows = read_curves(tmp_path / "curves.csv")
    assert [row["callback_last"] for row in rows] == [None, None, 7.0]
    assert rows[-1]["sps"] == rows[-2]["sps"] and rows[-1]["steps"] == 2 * UPDATE


def test_what_no_row_has_yet_is_kept_in_a_checkpoint(tmp_path: pathlib.Path) -> None:
    settings = dataclasses.replace(SETTINGS, log_every=1e9, checkpoint_every=UPDATE)
    cut = make_trainer(tmp_path, settings)

    def look(moment: Moment) -> None:
        if moment.row["updates"] == 2:
            raise KeyboardInterrupt
        moment.log("first", 3.0)

    cut.callback = look
    cut.begin()
    with pytest.raises(KeyboardInterrupt):
        cut.train()
    again = make_trainer(tmp_path, settings)
    again.resume()
    again.train()
    assert [row["callback_first"] for row in curve_of(tmp_path)] == [3.0]


def test_what_is_logged_is_a_number_with_a_name() -> None:
    moment = Moment("update", {}, None)  # type: ignore[arg-type]
    for name, value, message in (
        ("a b", 1.0, "found the name 'a b', expected letters"),
        ("a", "x", "a is 'x', expected a number"),
        ("a", float("nan"), "a is nan, expected a number"),
    ):
        with pytest.raises(ValueError, match=message):
            moment.log(name, value)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "name, message",
    [
        ("none", "lab.py has no none; name one that takes a folder and settings"),
        ("one", "lab.py:one cannot be called with a folder and settings"),
        ("nothing", "lab.py:nothing returned a NoneType, expected what takes a moment of the run"),
        ("takes_none", "what lab.py:takes_none returned cannot be called with a moment of the run"),
    ],
)
def test_what_is_no_callback_is_refused(lab: pathlib.Path, name: str, message: str) -> None:
    with pytest.raises(SettingsError, match=f"^--callback: .*{message}"):
        callbacks.maker(f"{lab}:{name}")(lab.parent, {})


def test_a_callback_does_not_end_the_program(lab: pathlib.Path) -> None:
    call = callbacks.maker(f"{lab}:ends")(lab.parent, {})
    with pytest.raises(SettingsError, match="ended the program when it was called; call stop()"):
        call(Moment("update", {}, None))  # type: ignore[arg-type]


@needs_worlds
def test_the_program_calls_back(tmp_path: pathlib.Path, lab: pathlib.Path) -> None:
    run = tmp_path / "run"
    options = [*SMALL, "--steps", 5 * PROGRAM_UPDATE, "--callback", f"{lab}:counts"]
    done = call("train", WORLD, "-o", run, *options)
    assert done.returncode == 0 and "--callback: twice is enough" in done.stderr
    assert f"saved after {2 * PROGRAM_UPDATE} steps; go on" in done.stderr
    assert [row["callback_count"] for row in curve(run)] == [1.0, 2.0, 2.0]  # the last at the end
