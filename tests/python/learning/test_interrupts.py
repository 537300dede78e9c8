"""What a signal leaves of a run, and what is done of it later."""

from __future__ import annotations

import os
import pathlib
import signal
from typing import Any

import pytest
import torch

from galactic.learning.trainer import Trainer
from trainers import UPDATE, make_trainer, parameters


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
