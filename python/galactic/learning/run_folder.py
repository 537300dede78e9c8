"""What a run is, and its folder."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import pathlib
from typing import Optional, Sequence

import galactic
from galactic import files
from galactic.learning import checkpoint, older, own_code
from galactic.learning.checkpoint import SavedPolicy
from galactic.learning.refusals import SettingsError, refusing, require_types
from galactic.learning.reports.curves import write_json
from galactic.learning.settings import Settings

TEACHER = "teacher.pt"
"""The copy of the teacher in the folder of a run."""


@dataclasses.dataclass
class Run:
    """What a run is about: kept in its settings.json."""

    world: pathlib.Path
    validation: Optional[pathlib.Path]
    settings: Settings
    start_from: Optional[pathlib.Path] = None
    teacher: Optional[pathlib.Path] = None
    task_file: Optional[pathlib.Path] = None
    network_file: Optional[pathlib.Path] = None
    demonstrations: Sequence[pathlib.Path] = ()


def read_run(file: pathlib.Path) -> Run:
    remedy = "begin another run, which can have the weights of best.pt (--start-from)"
    with refusing(f"{file} does not say what the run is", remedy):
        run, path = older.run_values(json.loads(file.read_text(encoding="utf-8"))), (
            str,
            type(None),
        )
        require_types(
            run,
            {
                "world": str,
                "validation": path,
                "start_from": path,
                "teacher": path,
                "task_file": path,
                "network_file": path,
                "demonstrations": list,
                "settings": dict,
            },
        )
        return Run(
            pathlib.Path(run["world"]),
            pathlib.Path(run["validation"]) if run["validation"] else None,
            Settings.from_dict(run["settings"]),
            pathlib.Path(run["start_from"]) if run["start_from"] else None,
            pathlib.Path(run["teacher"]) if run["teacher"] else None,
            pathlib.Path(run["task_file"]) if run["task_file"] else None,
            pathlib.Path(run["network_file"]) if run["network_file"] else None,
            [pathlib.Path(folder) for folder in run["demonstrations"]],
        )


def require_no_run(folder: pathlib.Path) -> None:
    if (folder / "settings.json").exists():
        raise SettingsError(
            f"{folder} already holds a run; continue it with --resume, or choose another folder"
        )


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
    except (galactic.Error, OSError, SettingsError) as error:
        return error
    return None


def begin_folder(
    run: Run,
    folder: pathlib.Path,
    teacher: Optional[tuple[SavedPolicy, pathlib.Path]],
    *,
    resumes: bool,
) -> Optional[Exception]:
    """Writes what the run is into its folder; why that is impossible."""
    try:
        if teacher is not None and teacher[1] != folder / TEACHER:
            checkpoint.save_policy(teacher[0], folder / TEACHER)
        for option, file in (("--task", run.task_file), ("--network", run.network_file)):
            # A run that is resumed has the copy, with which it goes on.
            if file is not None and not resumes:
                _keep_code(file, folder / own_code.COPIES[option])
        _write_run(run, folder)
    except (galactic.Error, OSError) as error:
        return error
    return None


def kept_code(file: pathlib.Path, option: str, folder: Optional[pathlib.Path]) -> pathlib.Path:
    """Where the code is that `option` named: `file`, or the copy of it in the `folder` of a run that is resumed.
    Raises Error where that copy is missing."""
    copy = file if folder is None else folder / own_code.COPIES[option]
    if folder is not None and not copy.is_file():
        message = f"is missing, the copy of {file} with which the run began; put it back, or begin another run"
        raise galactic.Error(galactic.ErrorCode.IO, str(copy), message)
    return copy


def _keep_code(file: pathlib.Path, copy: pathlib.Path) -> None:
    """Copies a file of the user's, so that the run can be resumed whatever becomes of it."""
    code = file.read_bytes()
    if copy.exists() and copy.read_bytes() != code:
        message = f"is there already, and is not {file}; move it, or choose another folder"
        raise galactic.Error(galactic.ErrorCode.IO, str(copy), message)
    files.write_atomically(copy, lambda handle: handle.write(code))


def _write_run(run: Run, folder: pathlib.Path) -> None:
    write_json(
        folder / "settings.json",
        {
            "world": str(run.world),
            "validation": str(run.validation) if run.validation else None,
            "start_from": str(run.start_from) if run.start_from else None,
            "teacher": str(run.teacher) if run.teacher else None,
            "task_file": str(run.task_file) if run.task_file else None,
            "network_file": str(run.network_file) if run.network_file else None,
            "demonstrations": [str(folder) for folder in run.demonstrations],
            "settings": run.settings.to_dict(),
        },
    )
