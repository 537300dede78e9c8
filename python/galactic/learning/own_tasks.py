"""Tasks of one's own, and what they are made with."""

from __future__ import annotations

import ast
import inspect
import json
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any, Callable, Optional

from galactic.learning.own_code import CodeName, goes_on, members_of
from galactic.learning.settings import SettingsError, did_you_mean, latest_words, simulation_keyword
from galactic.task import Task
from galactic.task_runner import require_options

MakeTask = Callable[[], Task]

COPY = "task.py"
"""The copy of the class's file in the folder of a run, beside RUN."""
RUN = "settings.json"
"""What a run is."""


def copy_beside(policy: pathlib.Path) -> Optional[pathlib.Path]:
    """The copy that belongs to a policy of a run's folder, or of one of its checkpoints."""
    parents = policy.absolute().parents
    for folder in [
        parents[0],
        *(parents[2:3] if parents[1:2] and parents[1].name == "checkpoints" else []),
    ]:
        if (folder / RUN).is_file() and (folder / COPY).is_file():
            return folder / COPY
    return None


def siblings_of(file: pathlib.Path) -> Optional[pathlib.Path]:
    """Where the modules are that a run's copy of a task imports: where it was copied from. None for a file
    that is no such copy."""
    try:
        run = json.loads((file.parent / RUN).read_text(encoding="utf-8"))
        return pathlib.Path(run["task_file"]).parent if file.name == COPY else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def require_use(given: Mapping[str, Any]) -> None:
    """Raises SettingsError where settings that were given make a class that nobody named."""
    if "task_options" in given and not given.get("task"):
        raise SettingsError("--task-options goes with --task; name one, or leave it out")


def maker(task: CodeName, options: str, siblings: Optional[pathlib.Path] = None) -> MakeTask:
    """What makes the task with these options (keywords_of()): see members_of()."""
    found = _class_of(task, siblings)
    keywords = keywords_of(options)
    try:
        inspect.signature(found).bind(**keywords)
    except TypeError as error:
        raise SettingsError(f"--task-options: {task} cannot be made of them: {error}") from error

    def make() -> Task:
        with goes_on(task, "when it was made; raise an exception instead"):
            return found(**keywords)

    return make


_WORDS = {"true": "True", "false": "False", "none": "None"}


def keywords_of(options: str) -> dict[str, Any]:
    """Settings.task_options as keywords: "radius=0.2 kind=near dense=false" is {"radius": 0.2, "kind":
    "near", "dense": False}. What reads as a number, list or other literal of Python is one, all else is
    text."""
    keywords: dict[str, Any] = {}
    for word in options.split():
        name, equals, value = word.partition("=")
        name = name.lstrip("-").replace("-", "_")
        if not equals or not name.isidentifier():
            raise SettingsError(f'--task-options: found "{word}", expected NAME=VALUE')
        try:
            keywords[name] = ast.literal_eval(_WORDS.get(value.lower(), value))
        except (ValueError, SyntaxError):
            keywords[name] = value
    return keywords


def simulation_below(task: Task, preset: str, given: str) -> str:
    """Options of the simulation as Settings.simulation has them: the preset's, over them the task's, over
    these the ones that were given; and the task below. Raises SettingsError where another one was given.
    """
    try:
        require_options(task)
    except ValueError as error:
        raise SettingsError(f"--task: {error}") from error
    for word in given.split():
        if simulation_keyword(word) == "task":
            raise SettingsError(
                f"--simulation: found {word} beside --task; the class says which one is below (base)"
            )
    of_task = " ".join(_word(name, value) for name, value in task.options.items())
    return latest_words(f"{preset} {of_task} {given} task={task.base}")


def _word(name: str, value: Any) -> str:
    """An option of the simulation as one types it."""
    name = name.replace("_", "-")
    if isinstance(value, bool):
        return name if value else f"{name}=false"
    if isinstance(value, Sequence) and not isinstance(value, str):
        parts = [
            "-".join(map(str, part)) if isinstance(part, Sequence) else str(part) for part in value
        ]
        return f"{name}={','.join(parts)}"
    return f"{name}={value}"


def _class_of(task: CodeName, siblings: Optional[pathlib.Path]) -> Callable[..., Task]:
    members = members_of(task, siblings)
    found = members.get(task.name)
    if isinstance(found, type) and issubclass(found, Task):
        return found
    if task.name in members:
        raise SettingsError(f"--task: {task} is no class that inherits from galactic.Task")
    raise SettingsError(f"--task: {task.place} has no {task.name}{_hint(task.name, members)}")


def _hint(name: str, members: Mapping[str, Any]) -> str:
    tasks = [
        known
        for known, value in members.items()
        if isinstance(value, type) and issubclass(value, Task) and value is not Task
    ]
    known = f"; it has {', '.join(tasks)}" if tasks else "; it has no galactic.Task"
    return did_you_mean(name, tasks) or known
