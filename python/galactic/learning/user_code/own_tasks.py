"""Tasks of one's own, and what they are made with."""

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
    """Raises SettingsError where settings that were given make a class that nobody named."""
    if "task_options" in given and not given.get("task"):
        raise SettingsError("--task-options goes with --task; name one, or leave it out")


def maker(task: CodeName, options: str, siblings: pathlib.Path | None = None) -> MakeTask:
    """What makes the task with these options (own_code.keywords_of()): see members_of()."""
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
    of_task = " ".join(word_of(name, value) for name, value in task.options.items())
    return latest_words(f"{preset} {of_task} {given} task={task.base}")
