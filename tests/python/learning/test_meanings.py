"""Worlds whose observations are the same numbers and mean something else."""

from __future__ import annotations

import dataclasses
import pathlib
from typing import Any

import pytest

import galactic
from galactic.learning.homes import Homes
from galactic.learning.playing import validation
from galactic.learning.policies.privileges import OtherMeaning, other_meaning
from galactic.learning.presets import preset
from galactic.learning.saving import checkpoint
from policies import untrained
from programs import HELD_OUT, SMALL, UPDATE, WORLD, call, needs_worlds

pytestmark = needs_worlds


def saved_policy(file: pathlib.Path, meanings: dict[str, Any]) -> None:
    """Of the preset `quick`, trained in a world that means something by what it observes."""
    settings = preset("quick")
    homes = Homes(galactic.World(WORLD), dataclasses.replace(settings, envs=4, mini_batches=1), 1)
    made = untrained(settings, homes)
    checkpoint.save_policy(dataclasses.replace(made, meanings=meanings), file)


def test_what_is_not_known_is_no_other_meaning() -> None:
    known = {"observe_current": True, "laser_fov": 270}
    assert other_meaning(["laser"], known, {"observe_current": True}) is None
    assert other_meaning(["laser"], {}, known) is None
    assert other_meaning(["bump"], known, {**known, "laser_fov": 180}) is None
    found = other_meaning(["laser"], known, {**known, "laser_fov": 180})
    assert found == OtherMeaning("laser_fov", 270, 180)


def test_an_evaluation_refuses_a_world_that_means_something_else(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "policy.pt"
    saved_policy(file, {"observe_current": True})
    refused = call("evaluate", file, HELD_OUT, "--episodes", 2)
    assert refused.returncode == 3 and refused.stderr == (
        f"galactic.evaluate: {file} learned with observe_current=True, found False in {HELD_OUT}, where the "
        "same numbers mean something else; evaluate it on worlds whose task has the same\n"
    )
    for meanings in ({"observe_current": False}, {}):
        saved_policy(file, meanings)
        assert call("evaluate", file, HELD_OUT, "--episodes", 2).returncode == 0


def test_a_validation_refuses_a_world_that_means_something_else(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Other(Homes):
        """They observe where the target is now."""

        def __init__(self, *arguments: Any, **options: Any):
            super().__init__(*arguments, **options)
            self.meanings["observe_current"] = True

    monkeypatch.setattr(validation, "Homes", Other)
    options = [*SMALL, "--steps", UPDATE, "--validation", HELD_OUT]
    refused = call("train", WORLD, "-o", tmp_path / "run", *options)
    assert refused.returncode == 3 and refused.stderr == (
        f"galactic.train: {HELD_OUT}: found observe_current=True, expected False as in {WORLD}: the same "
        "numbers mean something else; validate in a world whose task has the same\n"
    )
    assert not (tmp_path / "run").exists()


def test_a_run_says_what_it_has_to_learn_anew(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "policy.pt"
    said = []
    for number, meanings in enumerate(({"observe_current": True}, {"observe_current": False}, {})):
        saved_policy(file, meanings)
        options = [
            *SMALL,
            "--steps",
            UPDATE,
            "--no-normalize",
            "--closeup",
            0,
            "--start-from",
            file,
        ]
        done = call("train", WORLD, "-o", tmp_path / f"run-{number}", *options)
        assert done.returncode == 0, done.stderr
        said.append(done.stderr)
    note = (
        f"{file} learned with observe_current=True, and this run has False: the same numbers mean something "
        "else, which it has to learn anew\n"
    )
    assert [note in one for one in said] == [True, False, False]
