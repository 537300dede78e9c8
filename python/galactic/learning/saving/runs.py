"""What defines a run: its worlds, settings, policies and code, as kept in its settings.json."""

from __future__ import annotations

import dataclasses
import json
import pathlib
from collections.abc import Sequence

import galactic
from galactic.learning.refusals import refusing, require_types
from galactic.learning.reports.curves import write_json
from galactic.learning.settings import Settings
from galactic.learning.user_code import own_code, own_networks, own_tasks


@dataclasses.dataclass
class Run:
    """What defines a run; kept in its settings.json."""

    world: pathlib.Path
    validation: pathlib.Path | None
    settings: Settings
    start_from: pathlib.Path | None = None
    teacher: pathlib.Path | None = None
    task_file: pathlib.Path | None = None
    network_file: pathlib.Path | None = None
    demonstrations: Sequence[pathlib.Path] = ()


def run_in(folder: pathlib.Path) -> Run:
    """The run in a folder. Raises Error if there is none."""
    file = folder / own_code.RUN
    if not file.is_file():
        message = f"does not exist: {folder} holds no run"
        raise galactic.Error(galactic.ErrorCode.IO, str(file), message)
    return read_run(file)


def settings_in(folder: pathlib.Path) -> Settings:
    """The settings of a run, for use in another: they name the user's code by the original files,
    not by the run's copies. Raises what run_in() raises."""
    run = run_in(folder)
    changes = {}
    for setting, file in (("task", run.task_file), ("network", run.network_file)):
        if file is not None:
            name = own_code.named(getattr(run.settings, setting), f"--{setting}").name
            changes[setting] = f"{file}:{name}"
    return dataclasses.replace(run.settings, **changes)


def read_run(file: pathlib.Path) -> Run:
    """Reads a settings.json. Raises Error if the file cannot be read, and CheckpointError if it
    does not describe a run."""
    try:
        contents = file.read_bytes()
    except OSError as error:
        message = f"cannot read the file: {error.strerror}"
        raise galactic.Error(galactic.ErrorCode.IO, str(file), message) from None
    remedy = "begin another run, which can have the weights of best.pt (--start-from)"
    with refusing(f"{file} does not say what the run is", remedy):
        run, path = json.loads(contents.decode("utf-8")), (str, type(None))
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


def write_run(run: Run, folder: pathlib.Path) -> None:
    write_json(
        folder / own_code.RUN,
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


def with_task(run: Run, simulation: str) -> Run:
    """The run with the user-defined task that its settings name, and with the simulation options
    that this task wants. `simulation`: the options of the simulation that were given on the command
    line. Creates the task, as only an instance knows its options. The process that launches the
    ranks does so, too, so that an error is reported once."""
    name = own_code.named(run.settings.task, "--task")
    task = own_tasks.maker(name, run.settings.task_options)()
    settings = dataclasses.replace(
        run.settings,
        task=str(name),
        simulation=own_tasks.simulation_below(task, run.settings.simulation, simulation),
    )
    return dataclasses.replace(
        run, settings=settings, task_file=name.file.resolve() if name.file else None
    )


def task_of(run: Run, folder: pathlib.Path | None) -> own_tasks.MakeTask | None:
    """What makes the run's task, if that is user-defined; from the copy in `folder`, if given."""
    if not run.settings.task:
        return None
    name, siblings = _code_of(run.settings.task, "--task", run.task_file, folder)
    return own_tasks.maker(name, run.settings.task_options, siblings)


def with_network(run: Run) -> Run:
    """The run with the user-defined network that its settings name. Loads its class, so that errors
    are reported early."""
    name = own_code.named(run.settings.network, "--network")
    own_networks.with_options(own_networks.network_of(name), run.settings.network_options)
    settings = dataclasses.replace(run.settings, network=str(name))
    return dataclasses.replace(
        run, settings=settings, network_file=name.file.resolve() if name.file else None
    )


def network_of(run: Run, folder: pathlib.Path | None) -> own_networks.OwnNetwork | None:
    """What makes the run's network, if that is user-defined; from the copy in `folder`, if
    given."""
    if not run.settings.has_own_network:
        return None
    name, siblings = _code_of(run.settings.network, "--network", run.network_file, folder)
    found = own_networks.network_of(name, siblings)
    return own_networks.with_options(found, run.settings.network_options)


def _code_of(
    text: str, option: str, file: pathlib.Path | None, folder: pathlib.Path | None
) -> tuple[own_code.CodeName, pathlib.Path | None]:
    """The name of the code that `text` in a run's settings refers to, in a module or a `file`, and
    the folder of the modules that the file imports."""
    name = own_code.named(text, option)
    if file is None:
        return name, None
    return name._replace(place=str(kept_code(file, option, folder))), file.parent


def kept_code(file: pathlib.Path, option: str, folder: pathlib.Path | None) -> pathlib.Path:
    """The file with the code that `option` named: `file`, or its copy in the `folder` of a resumed
    run. Raises Error if that copy is missing."""
    copy = file if folder is None else folder / own_code.COPIES[option]
    if folder is not None and not copy.is_file():
        message = f"is missing, the copy of {file} with which the run began; put it back, or begin another run"
        raise galactic.Error(galactic.ErrorCode.IO, str(copy), message)
    return copy
