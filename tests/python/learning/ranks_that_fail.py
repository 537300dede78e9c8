"""What each of two ranks does for the test of test_ranks.py of what is refused in one of them, before they learn and where
they save."""

from __future__ import annotations

import dataclasses
import json
import pathlib
import sys
from typing import Any

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parent))

import galactic  # noqa: E402
from galactic.learning.presets import preset  # noqa: E402
from galactic.learning.ranks import job as jobs  # noqa: E402
from galactic.learning.ranks.distributed import Group  # noqa: E402
from galactic.learning.ranks.job import Job, train_in_rank  # noqa: E402
from galactic.learning.refusals import CheckpointError, SettingsError  # noqa: E402
from galactic.learning.saving import checkpoint  # noqa: E402
from galactic.learning.saving.run_folder import CheckpointFolder  # noqa: E402
from galactic.learning.saving.runs import Run  # noqa: E402
from galactic.learning.trainer import Trainer  # noqa: E402
from programs import UPDATE, WORLD  # noqa: E402

FAULTS: dict[str, tuple[Exception, Any, str]] = {
    "parts": (SettingsError("no validation"), jobs, "validation_of"),
    "take": (OSError("disk full"), jobs, "take_folder"),
    "callback": (SettingsError("no callback"), jobs, "_begin_callback"),
    "log": (SettingsError("no log"), jobs, "_begin_log"),
    "begin": (galactic.Error(galactic.ErrorCode.IO, "run", "is full"), jobs, "begin_folder"),
    "resume": (CheckpointError("no optimizer"), checkpoint, "load"),
    "room": (OSError("no room"), CheckpointFolder, "begin"),
    "save": (galactic.Error(galactic.ErrorCode.IO, "rank.pt", "is full"), checkpoint, "save"),
    "finish": (OSError("no names"), CheckpointFolder, "finish"),
    "best": (galactic.Error(galactic.ErrorCode.IO, "best.pt", "is full"), Trainer, "_saved_policy"),
}
"""What is refused in each step, and by which function."""
OF_NEW_RUNS = [
    ("parts", 0), ("parts", 1), ("take", 0), ("callback", 0), ("callback", 1), ("log", 0), ("log", 1), ("begin", 0)
]  # fmt: skip
"""Steps of a run that is not resumed, and the rank in which they fail, of those that do something in them."""
OF_RESUMED_RUNS = [
    ("resume", 0), ("resume", 1), ("best", 0), ("room", 0), ("save", 0), ("save", 1), ("finish", 0)
]  # fmt: skip
"""The same of one that is resumed."""


def outcome(job: Job, group: Group, step: str = "", fails: bool = False) -> str:
    """How a rank ends: what it raises, or its exit code. In one that `fails`, the step is refused."""

    def refuse(*_: Any, **__: Any) -> None:
        raise FAULTS[step][0]

    with pytest.MonkeyPatch.context() as patch:
        if fails:
            patch.setattr(*FAULTS[step][1:], refuse)
        try:
            return str(train_in_rank(job, group))
        except Exception as error:
            return f"{type(error).__name__}: {error}"


def main() -> None:
    """One failure after the other in the same two ranks and the same folder, and behind them the run."""
    group, folder = Group.join("cpu"), pathlib.Path(sys.argv[1])
    steps = 2 * 2 * UPDATE
    settings = preset("quick", envs=16, horizon=8, steps=steps, ranks=2)
    new = Job(Run(WORLD, None, settings), folder / "run", pause_at=steps // 2)
    resumed = dataclasses.replace(new, resumes=True, pause_at=None)
    said = {
        f"{step} in {rank}": outcome(new, group, step, group.rank == rank)
        for step, rank in OF_NEW_RUNS
    }
    said["settings"] = str((new.folder / "settings.json").exists())
    said["run"] = outcome(new, group)
    for step, rank in OF_RESUMED_RUNS:
        said[f"{step} in {rank}"] = outcome(resumed, group, step, group.rank == rank)
    said["resumed"] = outcome(resumed, group)
    (folder / f"rank-{group.rank}.json").write_text(json.dumps(said), encoding="utf-8")
    group.leave()


if __name__ == "__main__":
    main()
