"""The folder of a run, and the checkpoints in it. It holds

    settings.json                    what the run is
    checkpoints/000001048576/        after so many steps: the latest few
        policy.pt                    networks and settings: see checkpoint.load_policy()
        trainer.pt                   optimizer, counters, curves
        rank-0.pt, rank-1.pt ...     envs, memories and episodes of each rank
    best.pt                          the policy.pt that did best
    teacher.pt                       the policy.pt of the teacher, if there is one
    curves.csv, curves.html          written while it runs
    .lock                            held by who writes here: see files.alone_in()
"""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import shutil
from typing import Callable, Optional

from galactic import files
from galactic._core import ErrorCode
from galactic.errors import Error
from galactic.learning.refusals import CheckpointError, SettingsError
from galactic.learning.saving import checkpoint, older
from galactic.learning.saving.checkpoint import SavedPolicy
from galactic.learning.saving.runs import Run, read_run, write_run
from galactic.learning.user_code import own_code

TEACHER = "teacher.pt"
"""The copy of the teacher in the folder of a run."""
BEST = "best.pt"
"""The policy that did best."""
_REPORTS = ("curves.csv", "curves.html", "report.json")


def require_no_run(folder: pathlib.Path) -> None:
    """Raises SettingsError where the folder holds what a run has learned, or a file that it would write over. One that
    ended before its first checkpoint can be begun again: see begin_folder()."""
    file = folder / own_code.RUN
    if not file.exists():
        return
    if CheckpointFolder(folder, 1).complete():
        raise SettingsError(
            f"{folder} already holds a run; continue it with --resume, or choose another folder"
        )
    if (folder / BEST).exists():
        raise SettingsError(
            f"{folder} holds the {BEST} of a run without a checkpoint; choose another folder, where a run can begin "
            f"with it (--start-from {folder / BEST})"
        )
    try:
        read_run(file)
    except (CheckpointError, OSError) as error:
        raise SettingsError(
            f"{folder} holds a {own_code.RUN} that is no run's; choose another folder"
        ) from error


def _make_room(run: Run, folder: pathlib.Path) -> bool:
    """Where another run ended before its first checkpoint, removes what that has written. Returns whether there was
    one."""
    file = folder / own_code.RUN
    if not file.exists():
        return False
    before, begun = read_run(file), file.stat().st_mtime_ns
    copies = [
        folder / own_code.COPIES[option]
        for option, source in (("--task", before.task_file), ("--network", before.network_file))
        if source is not None
    ]
    # What is the source of either run is the user's, and so is a copy that was changed since.
    sources = {before.task_file, before.network_file, run.task_file, run.network_file}
    of_run = [
        copy
        for copy in copies
        if copy.is_file() and copy.resolve() not in sources and copy.stat().st_mtime_ns <= begun
    ]
    # The file that says what it was goes last, so that this can be done again.
    for old in [*of_run, *(folder / name for name in _REPORTS), file]:
        old.unlink(missing_ok=True)
    for unfinished in (folder / "checkpoints").glob(".[0-9]*.unfinished"):
        shutil.rmtree(unfinished, ignore_errors=True)
    return True


def take_folder(
    folder: pathlib.Path, held: contextlib.ExitStack, *, resumes: bool
) -> Optional[Exception]:
    """Keeps others from writing into the folder of the run, while `held` is; why that is impossible."""
    try:
        if not resumes:
            files.require_folder(folder)
            folder.mkdir(parents=True, exist_ok=True)
        held.enter_context(files.alone_in(folder))
        if not resumes:
            # Another one may have come and gone since.
            require_no_run(folder)
    except (Error, OSError, SettingsError) as error:
        return error
    return None


def begin_folder(
    run: Run,
    folder: pathlib.Path,
    teacher: Optional[tuple[SavedPolicy, pathlib.Path]],
    *,
    resumes: bool,
    say: Callable[[str], None],
) -> Optional[Exception]:
    """Writes what the run is into its folder, in the place of one that ended before its first checkpoint; why that is
    impossible."""
    try:
        if not resumes and _make_room(run, folder):
            say(f"{folder} held a run without a checkpoint; this one takes its place")
        if teacher is not None and teacher[1] != folder / TEACHER:
            checkpoint.save_policy(teacher[0], folder / TEACHER)
        for option, file in (("--task", run.task_file), ("--network", run.network_file)):
            # A run that is resumed has the copy, with which it goes on.
            if file is not None and not resumes:
                _keep_code(file, folder / own_code.COPIES[option])
        write_run(run, folder)
    except (CheckpointError, Error, OSError) as error:
        return error
    return None


def _keep_code(file: pathlib.Path, copy: pathlib.Path) -> None:
    """Copies a file of the user's, so that the run can be resumed whatever becomes of it."""
    code = file.read_bytes()
    if copy.exists() and copy.read_bytes() != code:
        message = f"is there already, and is not {file}; move it, or choose another folder"
        raise Error(ErrorCode.IO, str(copy), message)
    files.write_atomically(copy, lambda handle: handle.write(code))


def is_complete(run: Run, folder: pathlib.Path) -> bool:
    """Whether nothing is left to do: all steps are done, and the report was written after them and after
    what a signal may have put off. Of a report that is none, the run writes another."""
    done = CheckpointFolder(folder, run.settings.keep).steps
    try:
        report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
        report = older.report_values(report)
        reported, is_whole = report["steps"], not report["must_validate"]
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return False
    return done >= run.settings.steps and reported == done and is_whole


class CheckpointFolder:
    """The checkpoints of a run. Ranks write into a folder that has its name only when all are done."""

    def __init__(self, run: pathlib.Path, keep: int):
        self.run = run
        self.folder = run / "checkpoints"
        self._keep = keep

    def begin(self, steps: int) -> pathlib.Path:
        """The folder to write into, for all ranks; the first one calls this before the others write."""
        unfinished = self.unfinished(steps)
        shutil.rmtree(unfinished, ignore_errors=True)
        unfinished.mkdir(parents=True)
        return unfinished

    def unfinished(self, steps: int) -> pathlib.Path:
        """Where ranks write until all are done."""
        return self.folder / f".{steps:012d}.unfinished"

    def finish(self, steps: int) -> pathlib.Path:
        """Gives it its name and deletes the oldest; the first rank calls this when all have written."""
        final = self.folder / f"{steps:012d}"
        shutil.rmtree(final, ignore_errors=True)
        os.replace(self.unfinished(steps), final)
        files.sync(self.folder)
        for old in self.complete()[: -self._keep]:
            shutil.rmtree(old, ignore_errors=True)
        return final

    def complete(self) -> list[pathlib.Path]:
        """All that are whole, the oldest first."""
        if not self.folder.is_dir():
            return []
        return sorted(path for path in self.folder.iterdir() if path.name.isdigit())

    def latest(self) -> pathlib.Path:
        complete = self.complete()
        if not complete:
            best = self.run / BEST
            again = "leave out --resume and give its options again to begin it anew"
            weights = f"begin another run with the weights of {BEST} (--start-from {best})"
            message = f"holds no checkpoint to go on from; {weights if best.exists() else again}"
            raise Error(ErrorCode.IO, str(self.folder), message)
        return complete[-1]

    @property
    def steps(self) -> int:
        """After how many steps the latest was saved; 0 where there is none."""
        return max((int(path.name) for path in self.complete()), default=0)

    @property
    def without_latest(self) -> str:
        """What to do where the latest cannot be taken up: its files are of no use apart."""
        *earlier, latest = self.complete()
        if earlier:
            return (
                f"remove the folder {latest} to resume from {earlier[-1].name}, which is before it"
            )
        return (
            "no checkpoint is before it: begin another run, which can have the weights of best.pt "
            "(--start-from)"
        )
