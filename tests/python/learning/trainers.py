"""Trainers of toys, for tests of the training loop and of its curves."""

from __future__ import annotations

import dataclasses
import pathlib
from typing import Any

import torch

from galactic.learning.ranks.distributed import Group
from galactic.learning.reports.curves import read_curves
from galactic.learning.settings import Settings
from galactic.learning.trainer import Trainer
from toys import ReachAndGrasp

UPDATE = 16 * 10
SETTINGS = Settings(
    envs=16,
    horizon=10,
    steps=8 * UPDATE,
    network="state",
    width=16,
    normalize=True,
    log_std="parameter",
    mini_batches=2,
    epochs=2,
    learning_rate=3e-3,
    entropy_end=0.0,
    checkpoint_every=3 * UPDATE,
    validate_every=0,
    log_every=0.0,
    window=20,
)
# Columns that are measured, and differ from run to run.
MEASURED = ("seconds", "sps")


def make_trainer(folder: pathlib.Path | None, settings: Settings = SETTINGS, toy: Any = ReachAndGrasp,
                 **options: Any) -> Trainer:  # fmt: skip
    envs = toy(settings.envs, halves=settings.halves)
    return Trainer(settings, envs, Group.alone(), folder, **options)


def parameters(trainer: Trainer) -> torch.Tensor:
    return trainer.learner.optimizer.parameters.detach().clone()


def curve(folder: pathlib.Path) -> list[dict[str, float | None]]:
    rows = read_curves(folder / "curves.csv")
    return [{key: row[key] for key in row if key not in MEASURED} for row in rows]


def saved_run(folder: pathlib.Path, **changes: Any) -> Trainer:
    """A run with two checkpoints."""
    settings = dataclasses.replace(SETTINGS, checkpoint_every=UPDATE, **changes)
    trainer = make_trainer(folder, dataclasses.replace(settings, steps=2 * UPDATE))
    trainer.begin()
    trainer.train()
    return make_trainer(folder, settings)
