"""What each of two ranks does for the tests of test_ranks.py."""

from __future__ import annotations

import dataclasses
import pathlib
import sys
import time

import numpy as np
import torch

sys.path.insert(0, str(pathlib.Path(__file__).parent))

from galactic.learning.ranks.distributed import Group  # noqa: E402
from galactic.learning.rollouts.environments import Step  # noqa: E402
from galactic.learning.trainer import Trainer  # noqa: E402
from trainers import SETTINGS  # noqa: E402
from toys import Measured, ReachAndGrasp, Uneven  # noqa: E402


def train(group: Group, folder: pathlib.Path, envs: int) -> None:
    # The epsilon keeps Adam from making much of gradients that are but rounding.
    settings = dataclasses.replace(
        SETTINGS, envs=envs, steps=8 * 32 * 10, sync_fraction=1.0, adam_epsilon=1e-2
    )
    toy = Measured(envs, halves=2, first_env=group.rank * envs)
    trainer = Trainer(settings, toy, group, folder)
    if group.size == 1:
        torch.save(trainer.learner.optimizer.parameters.detach(), folder / "start.pt")
    trainer.begin()
    trainer.train()
    parameters = trainer.learner.optimizer.parameters.detach()
    torch.save(parameters, folder / f"parameters-{group.rank}.pt")


class Slow(ReachAndGrasp):
    """Takes its time in the second rank."""

    rank = 0

    def recv(self, half: int) -> Step:
        time.sleep(0.1 * self.rank)
        return super().recv(half)


def straggle(group: Group, folder: pathlib.Path) -> None:
    settings = dataclasses.replace(
        SETTINGS, envs=16, halves=1, horizon=16, sync_fraction=0.5, checkpoint_every=0
    )
    toy = Slow(16, first_env=group.rank * 16)
    toy.rank = group.rank
    trainer = Trainer(settings, toy, group, None)
    trainer.begin()
    lengths = []
    for _ in range(3):
        trainer._iterate()
        lengths.append(trainer.source.rollout.steps)
    found = {
        "rollouts": lengths,
        "steps": trainer.steps,
        "parameters": trainer.learner.optimizer.parameters.detach(),
    }
    torch.save(found, folder / f"steps-{group.rank}.pt")


class QuickFirst(Uneven):
    """All envs of the first rank are the quick ones."""

    def is_quick(self, envs: slice) -> np.ndarray:
        return self.envs[envs] < self.count


def wait(group: Group, folder: pathlib.Path) -> None:
    settings = dataclasses.replace(SETTINGS, sync_fraction=1.0)
    toy = QuickFirst(settings.envs, first_env=group.rank * settings.envs, halves=settings.halves)
    trainer = Trainer(settings, toy, group, None)
    trainer.begin()
    has_figures = []
    for _ in range(5):
        trainer._iterate()
        has_figures.append(bool(trainer.recent.figures()))
    torch.save(has_figures, folder / f"figures-{group.rank}.pt")


def start(group: Group, folder: pathlib.Path) -> None:
    """As where somebody replaces the file between the looks of two ranks at it."""
    toy = ReachAndGrasp(SETTINGS.envs, halves=SETTINGS.halves)
    trainer = Trainer(SETTINGS, toy, group, None)
    trainer.start_from(folder / f"before-{group.rank}.pt")
    torch.save(trainer.policy.state_dict(), folder / f"after-{group.rank}.pt")


def main() -> None:
    """All of it, one after the other, in the folder that is named: processes take seconds to start."""
    group = Group.join("cpu")
    folder = pathlib.Path(sys.argv[1])
    train(group, folder, 16)
    wait(group, folder)
    start(group, folder)
    straggle(group, folder)
    group.leave()


if __name__ == "__main__":
    main()
