"""What a signal leaves of a run, and what is done of it later."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import signal
from collections.abc import Callable
from typing import Any

import pytest
import torch

from galactic.learning.policies.networks import Policy
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.saving.checkpoint import load_policy
from galactic.learning.trainer import Trainer
from galactic.learning.user_code.callbacks import Moment
from programs import HELD_OUT, SMALL, WORLD, call, needs_worlds
from programs import UPDATE as UPDATE_IN_HOMES
from trainers import SETTINGS, UPDATE, curve, make_trainer, parameters


def signaled_in_the_second_update(trainer: Trainer, *signals: signal.Signals) -> None:
    iterate = trainer._iterate

    def iterate_under_signals() -> Any:
        if trainer.updates == 1:
            for one in signals:
                os.kill(os.getpid(), one)
        return iterate()

    trainer._iterate = iterate_under_signals  # type: ignore[method-assign]


@pytest.mark.parametrize(
    "signals",
    [
        (signal.SIGINT,),
        (signal.SIGTERM,),
        (signal.SIGTERM, signal.SIGTERM, signal.SIGTERM),
        (signal.SIGINT, signal.SIGTERM),
    ],
)
def test_an_interrupted_run_saves_and_goes_on(tmp_path: pathlib.Path, signals: Any) -> None:
    trainer = make_trainer(tmp_path)
    signaled_in_the_second_update(trainer, *signals)
    trainer.begin()
    assert not trainer.train()
    assert trainer.updates == 2 and trainer.checkpoints.latest().name == f"{2 * UPDATE:012d}"
    again = make_trainer(tmp_path)
    again.resume()
    assert again.train()
    undisturbed = make_trainer(None)
    undisturbed.begin()
    undisturbed.train()
    assert torch.equal(parameters(again), parameters(undisturbed))


@pytest.mark.parametrize("first", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_in_a_run_that_stops_ends_it_without_saving(
    tmp_path: pathlib.Path, first: signal.Signals, capsys: Any
) -> None:
    trainer = make_trainer(tmp_path)
    signaled_in_the_second_update(trainer, first, signal.SIGINT)
    trainer.begin()
    with pytest.raises(KeyboardInterrupt):
        trainer.train()
    assert trainer.checkpoints.complete() == []
    said = capsys.readouterr().err
    assert "stopping after this update; Ctrl-C now stops without saving" in said


def validating(done: list[torch.Tensor]) -> Callable[[Policy], EpisodeSums]:
    """A validation that keeps which policies it has judged."""

    def validate(policy: Policy) -> EpisodeSums:
        done.append(policy.action.linear.bias.detach().clone())
        return EpisodeSums(episodes=4.0, successes=float(len(done)))

    return validate


@pytest.mark.parametrize("steps", [2 * UPDATE, 3 * UPDATE])
def test_a_validation_that_an_interrupt_puts_off_comes_first(
    tmp_path: pathlib.Path, steps: int
) -> None:
    """Be it the last one of the run."""
    settings = dataclasses.replace(SETTINGS, steps=steps, validate_every=2 * UPDATE)
    whole: list[torch.Tensor] = []
    (tmp_path / "whole").mkdir()
    undisturbed = make_trainer(tmp_path / "whole", settings, validation=validating(whole))
    undisturbed.begin()
    assert undisturbed.train() and len(whole) == steps // UPDATE - 1
    (tmp_path / "cut").mkdir()
    parts: list[torch.Tensor] = []
    cut = make_trainer(tmp_path / "cut", settings, validation=validating(parts))
    signaled_in_the_second_update(cut, signal.SIGTERM)
    cut.begin()
    assert not cut.train() and parts == [] and cut.steps == 2 * UPDATE
    report = json.loads((tmp_path / "cut" / "report.json").read_text(encoding="utf-8"))
    assert report["must_validate"] and report["validation"] == {}
    again = make_trainer(tmp_path / "cut", settings, validation=validating(parts))
    again.resume()
    assert again.train() and len(parts) == len(whole)
    assert all(torch.equal(found, wanted) for found, wanted in zip(parts, whole))
    found, wanted = curve(tmp_path / "cut"), curve(tmp_path / "whole")
    assert sorted(map(repr, found)) == sorted(map(repr, wanted))
    report = json.loads((tmp_path / "cut" / "report.json").read_text(encoding="utf-8"))
    assert not report["must_validate"] and report["validation"]["success"] == 0.25 * len(whole)
    assert load_policy(tmp_path / "cut" / "best.pt").steps == steps


def test_a_stop_that_an_interrupt_puts_off_comes_behind_its_validation(
    tmp_path: pathlib.Path,
) -> None:
    """Of which the callback hears, too; the next part of the run goes on."""
    settings = dataclasses.replace(SETTINGS, validate_every=4 * UPDATE)
    done: list[torch.Tensor] = []
    moments: list[tuple[str, float]] = []

    def look(moment: Moment) -> None:
        moments.append((moment.kind, moment.row["steps"] / UPDATE))
        if moments[-1] == ("update", 2):
            moment.stop("enough")

    def part() -> Trainer:
        trainer = make_trainer(tmp_path, settings, validation=validating(done))
        trainer.callback = look
        return trainer

    cut = part()
    signaled_in_the_second_update(cut, signal.SIGTERM)
    cut.begin()
    assert not cut.train() and done == [] and moments[-1] == ("end", 2)
    moments.clear()
    again = part()
    again.resume()
    assert again.train() and again.updates == 2 and len(done) == 1
    assert moments == [("validation", 2), ("end", 2)]
    third = part()
    third.resume()
    assert third.train() and third.steps == settings.steps


@needs_worlds
def test_a_run_is_not_complete_before_its_last_validation(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "run"
    iterate = Trainer._iterate

    def iterate_under_a_signal(trainer: Trainer) -> Any:
        if trainer.updates == 1:
            os.kill(os.getpid(), signal.SIGTERM)
        return iterate(trainer)

    monkeypatch.setattr(Trainer, "_iterate", iterate_under_a_signal)
    options = [*SMALL, "--steps", 2 * UPDATE_IN_HOMES, "--validation-episodes", "4"]
    cut = call("train", WORLD, "-o", folder, *options, "--validation", HELD_OUT)
    assert cut.returncode == 130, cut.stderr
    assert f"stopped and saved after {2 * UPDATE_IN_HOMES} steps; go on with python3" in cut.stderr
    again = call("train", "-o", folder, "--resume")
    assert again.returncode == 0 and "validation after" in again.stderr, again.stderr
    assert "report.json" in again.stderr and (folder / "best.pt").is_file()
    assert curve(folder)[-1]["validation_success"] is not None
    third = call("train", "-o", folder, "--resume")
    assert third.returncode == 0 and "is complete; give it more --steps" in third.stderr
