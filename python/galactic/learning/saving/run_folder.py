"""The folder of a run, and the checkpoints in it. It holds

    settings.json                    what the run is
    checkpoints/000001048576/        after so many steps: the latest few
        policy.pt                    networks and settings: see checkpoint.load_policy()
        trainer.pt                   optimizer, counters, how many rows of curves.csv were there
        rank-0.pt, rank-1.pt ...     envs, memories and episodes of each rank
    best.pt                          the policy.pt that did best
    teacher.pt                       the policy.pt of the teacher, if there is one
    curves.csv, curves.html          written while it runs
    report.json                      written at its end
    task.py, network.py              copies of code of one's own
    .lock                            held by who writes here: see files.alone_in()
"""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import pathlib
import shutil
from collections.abc import Callable

from galactic import files
from galactic._core import ErrorCode
from galactic.errors import Error
from galactic.learning.refusals import CheckpointError, SettingsError
from galactic.learning.reports.curves import TABLE
from galactic.learning.saving import checkpoint
from galactic.learning.saving.checkpoint import SavedPolicy
from galactic.learning.saving.runs import Run, read_run, write_run
from galactic.learning.user_code import own_code

TEACHER = "teacher.pt"
"""The copy of the teacher in the folder of a run."""
POLICY = "policy.pt"
"""The policy of a checkpoint."""
BEST = "best.pt"
"""The policy that did best."""
_PAGE, _REPORT = "curves.html", "report.json"


def files_of(folder: pathlib.Path) -> list[pathlib.Path]:
    """All files that a run in `folder` writes, including those of its checkpoints."""
    copies = own_code.COPIES.values()
    names = (own_code.RUN, TABLE, _PAGE, _REPORT, BEST, TEACHER, ".lock", *copies)
    return [*(folder / name for name in names), *(folder / "checkpoints").rglob("*")]


def policies_in(folder: pathlib.Path) -> list[pathlib.Path]:
    """The files of all policies in the folder of a run: those of its checkpoints, the oldest first,
    then the best one. Raises Error if there are none."""
    kept = [one / POLICY for one in CheckpointFolder(folder, 1).complete()]
    best = folder / BEST
    policies = [*kept, *([best] if best.exists() else [])]
    if not policies:
        message = f"holds no {BEST} and no checkpoint; name the folder of a run that has saved one, or a {POLICY}"
        raise Error(ErrorCode.IO, str(folder), message)
    return policies


def require_no_run(folder: pathlib.Path) -> None:
    """Raises SettingsError if the folder holds a run that has learned something, or a file that a
    run would overwrite, and Error if that file cannot be read. A run that ended before its first
    checkpoint may be replaced: see begin_folder()."""
    file, checkpoints = folder / own_code.RUN, CheckpointFolder(folder, 1)
    if not file.exists():
        return
    if checkpoints.complete():
        raise SettingsError(
            f"{folder} already holds a run; continue it with --resume, or choose another folder"
        )
    if (folder / BEST).exists():
        raise SettingsError(
            f"{folder} holds the {BEST} of a run without a checkpoint; choose another folder, where a run can begin "
            f"with it (--start-from {folder / BEST})"
        )
    if checkpoints.may_have_been:
        raise SettingsError(
            f"{folder} already holds a run, whose checkpoints are elsewhere; put them back and continue it with "
            "--resume, or choose another folder"
        )
    try:
        read_run(file)
    except CheckpointError as error:
        raise SettingsError(
            f"{folder} holds a {own_code.RUN} that is no run's; choose another folder"
        ) from error


def take_folder(folder: pathlib.Path, held: contextlib.ExitStack, *, resumes: bool) -> None:
    """Keeps other runs from writing into the folder until `held` is closed. Raises Error, OSError
    or SettingsError if that is impossible."""
    if not resumes:
        files.require_folder(folder)
        folder.mkdir(parents=True, exist_ok=True)
    is_alone = held.enter_context(files.alone_in(folder))
    if not resumes:
        # Another run may have begun and ended since the first check.
        require_no_run(folder)
        if not is_alone and (folder / own_code.RUN).exists():
            raise SettingsError(
                f"{folder} already holds a run, and its disk has no locks that would tell whether that is under "
                f"way; if it is not, remove its {own_code.RUN}, or choose another folder"
            )


def begin_folder(
    run: Run,
    folder: pathlib.Path,
    teacher: tuple[SavedPolicy, pathlib.Path] | None,
    *,
    resumes: bool,
    say: Callable[[str], None],
) -> None:
    """Writes the files that define the run into its folder. They replace a run that ended before
    its first checkpoint. Raises CheckpointError, Error or OSError if that is impossible."""
    # A resumed run goes on with the copies that are there.
    code = {} if resumes else _code_of(run, folder)
    if not resumes:
        _make_room(run, folder, code, say)
    if teacher is not None and teacher[1] != folder / TEACHER:
        checkpoint.save_policy(teacher[0], folder / TEACHER)
    for copy, text in code.items():
        files.write_atomically(copy, lambda handle: handle.write(text))
    write_run(run, folder)


def _code_of(run: Run, folder: pathlib.Path) -> dict[pathlib.Path, bytes]:
    """Copies of the user's files, by the path to write them to. With them, the run can be resumed
    whatever happens to the originals."""
    return {
        folder / own_code.COPIES[option]: file.read_bytes()
        for option, file in _sources_of(run).items()
    }


def _sources_of(run: Run) -> dict[str, pathlib.Path]:
    """The user's files, by the options that named them."""
    named = {"--task": run.task_file, "--network": run.network_file}
    return {option: file for option, file in named.items() if file is not None}


def _make_room(
    run: Run, folder: pathlib.Path, code: dict[pathlib.Path, bytes], say: Callable[[str], None]
) -> None:
    """Removes the files of a run that ended before its first checkpoint. Files of which no other
    copy may exist are renamed instead. If one of the user's files is where `code` is to be written,
    raises Error and changes nothing."""
    file = folder / own_code.RUN
    before = read_run(file) if file.exists() else None
    replaced = _replaced_copies(run, before, folder, code)
    if before is None:
        return
    say(f"{folder} held a run without a checkpoint; this one takes its place")
    table, teacher = folder / TABLE, folder / TEACHER
    if _has_rows(table):
        replaced.append(table)
    if before.teacher is not None and teacher.is_file():
        is_named = teacher.resolve() in (run.teacher, run.start_from)
        is_copy = before.teacher.is_file() and not before.teacher.samefile(teacher)
        if is_copy and not is_named:
            teacher.unlink()
        elif not is_named:
            replaced.append(teacher)
    for old in replaced:
        aside = _name_aside(old)
        os.rename(old, aside)
        say(f"its {old.name} is {aside.name} now")
    for unfinished in CheckpointFolder(folder, 1).all_unfinished():
        shutil.rmtree(unfinished, ignore_errors=True)
    # The file that identifies the old run goes last, so that an interrupted removal can be
    # repeated.
    for old in (table, folder / _PAGE, file):
        old.unlink(missing_ok=True)


def _replaced_copies(
    run: Run, before: Run | None, folder: pathlib.Path, code: dict[pathlib.Path, bytes]
) -> list[pathlib.Path]:
    """The code copies of the run `before` that differ from this run's. Raises Error if a file of
    other origin is in the place of one of this run's copies."""
    replaced = []
    kept = _sources_of(before) if before is not None else {}
    # A file that either run names as its source is the user's, and so is a copy that was edited
    # later.
    sources = {*kept.values(), *_sources_of(run).values()}
    for option, name in own_code.COPIES.items():
        copy = folder / name
        if not copy.exists() or copy.read_bytes() == code.get(copy):
            continue
        if option in kept and copy.resolve() not in sources and not _is_newer(copy, folder):
            replaced.append(copy)
        elif copy in code:
            file = _sources_of(run)[option]
            message = f"is there already, and is not {file}; move it, or choose another folder"
            raise Error(ErrorCode.IO, str(copy), message)
    return replaced


def _is_newer(copy: pathlib.Path, folder: pathlib.Path) -> bool:
    return copy.stat().st_mtime_ns > (folder / own_code.RUN).stat().st_mtime_ns


def _has_rows(table: pathlib.Path) -> bool:
    return table.is_file() and table.read_bytes().count(b"\n") > 1


def _name_aside(file: pathlib.Path) -> pathlib.Path:
    """The first unused name of task.before.py, task.before.2.py, ..."""
    numbers = itertools.chain(("",), (f".{number}" for number in itertools.count(2)))
    asides = (file.with_name(f"{file.stem}.before{number}{file.suffix}") for number in numbers)
    return next(aside for aside in asides if not os.path.lexists(aside))


def is_complete(run: Run, folder: pathlib.Path) -> bool:
    """Whether nothing is left to do: all steps are done, and the report was written after them and
    after anything that a signal put off. False if the report cannot be read; the run then writes
    another."""
    done = CheckpointFolder(folder, run.settings.keep).steps
    try:
        report = json.loads((folder / _REPORT).read_text(encoding="utf-8"))
        reported, is_whole = report["steps"], not report["must_validate"]
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return False
    return done >= run.settings.steps and reported == done and is_whole


class CheckpointFolder:
    """The checkpoints of a run. The folder of a checkpoint gets its final name only after all ranks
    have written to it."""

    def __init__(self, run: pathlib.Path, keep: int):
        self.run = run
        self.folder = run / "checkpoints"
        self._keep = keep

    def begin(self, steps: int) -> pathlib.Path:
        """Makes the folder into which all ranks write; the first rank calls this before the others
        write."""
        self.give_up(steps)
        unfinished = self.unfinished(steps)
        unfinished.mkdir(parents=True)
        return unfinished

    def unfinished(self, steps: int) -> pathlib.Path:
        """The folder into which ranks write until all are done."""
        return self.folder / f".{steps:012d}.unfinished"

    def give_up(self, steps: int) -> None:
        """Removes an unfinished checkpoint, which may take up disk space that others need."""
        shutil.rmtree(self.unfinished(steps), ignore_errors=True)

    def finish(self, steps: int) -> pathlib.Path:
        """Gives the checkpoint its final name and deletes the oldest ones; the first rank calls
        this when all have written.

        If a resumed run is saved before its next step, a checkpoint of that step exists already,
        with the same state except for what was reported since. Its files are replaced one by one,
        so that it stays complete at all times: it may be the only checkpoint."""
        final, unfinished = self.folder / f"{steps:012d}", self.unfinished(steps)
        if final.exists():
            for file in sorted(unfinished.iterdir()):
                os.replace(file, final / file.name)
            files.sync(final)
            unfinished.rmdir()
        else:
            os.replace(unfinished, final)
        files.sync(self.folder)
        for old in self.complete()[: -self._keep]:
            shutil.rmtree(old, ignore_errors=True)
        return final

    def complete(self) -> list[pathlib.Path]:
        """All complete checkpoints, the oldest first."""
        if not self.folder.is_dir():
            return []
        return sorted(path for path in self.folder.iterdir() if path.name.isdigit())

    def all_unfinished(self) -> list[pathlib.Path]:
        """Unfinished checkpoints left by a run that ended while writing."""
        return list(self.folder.glob(".[0-9]*.unfinished"))

    @property
    def may_have_been(self) -> bool:
        """Whether the run may have had checkpoints, even if they were moved away or their disk is
        not mounted."""
        if (self.run / _REPORT).exists():
            return True
        if not os.path.lexists(self.folder):
            return False
        is_link = self.folder.is_symlink() or not self.folder.is_dir()
        return is_link or len(list(self.folder.iterdir())) > len(self.all_unfinished())

    def latest(self) -> pathlib.Path:
        complete = self.complete()
        if not complete:
            best = self.run / BEST
            again = (
                "put its checkpoints back, or begin another run in another folder"
                if self.may_have_been
                else "leave out --resume and give its options again to begin it anew"
            )
            weights = f"begin another run with the weights of {BEST} (--start-from {best})"
            message = f"holds no checkpoint to go on from; {weights if best.exists() else again}"
            raise Error(ErrorCode.IO, str(self.folder), message)
        return complete[-1]

    @property
    def steps(self) -> int:
        """The number of steps after which the latest checkpoint was saved; 0 if there is none."""
        return max((int(path.name) for path in self.complete()), default=0)

    @property
    def without_latest(self) -> str:
        """What to do if the latest checkpoint cannot be loaded: its files are of no use without
        each other."""
        *earlier, latest = self.complete()
        if earlier:
            return (
                f"remove the folder {latest} to resume from {earlier[-1].name}, which is before it"
            )
        return (
            "no checkpoint is before it: begin another run, which can have the weights of best.pt "
            "(--start-from)"
        )
