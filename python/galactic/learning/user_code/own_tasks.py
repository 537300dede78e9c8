"""User-defined tasks, and their arguments."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Mapping
from typing import Any

from galactic.learning.refusals import SettingsError
from galactic.learning.simulation_words import latest_words, simulation_keyword, word_of
from galactic.learning.user_code.own_code import CodeName, class_of, goes_on, keywords_of, mismatch
from galactic.task import Task
from galactic.task_runner import require_options

MakeTask = Callable[[], Task]


def require_use(given: Mapping[str, Any]) -> None:
    """Raises SettingsError if options for a task's class were given, but no class."""
    if "task_options" in given and not given.get("task"):
        raise SettingsError("--task-options goes with --task; name one, or leave it out")


def maker(task: CodeName, options: str, siblings: pathlib.Path | None = None) -> MakeTask:
    """A function that makes the task with these options (own_code.keywords_of()). The file of the
    task runs now: see own_code.members_of()."""
    found = class_of(task, Task, "galactic.Task", siblings)
    keywords = keywords_of(options, "--task-options")
    fault = mismatch(found, (), keywords)
    if fault:
        raise SettingsError(f"--task-options: {task} cannot be made of them: {fault}")

    def make() -> Task:
        with goes_on(task, "when it was made; raise an exception instead"):
            return found(**keywords)

    return make


def simulation_below(task: Task, preset: str, given: str) -> str:
    """The options of the simulation in the form of Settings.simulation. The task's options override
    the preset's, the given ones override both, and `task` names the task's base. Raises
    SettingsError if `given` sets `task`."""
    try:
        require_options(task)
    except ValueError as error:
        raise SettingsError(f"--task: {error}") from error
    for word in given.split():
        if simulation_keyword(word) == "task":
            raise SettingsError(
                f"--simulation: found {word} beside --task; the class says which one is below (base)"
            )
    of_task = " ".join(word_of(name, value) for name, value in task.options.items())
    return latest_words(f"{preset} {of_task} {given} task={task.base}")
