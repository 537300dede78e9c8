"""Drives a task of one's own: calls its methods in their order, and checks what they return."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from traceback import walk_tb
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic._core import EpisodeEnd, Simulator, World
from galactic.task import Outcome, Task, TaskEnvs

Array = NDArray[Any]

OF_EPISODES = ("episode", "ending", "success", "episode_index", "world_from_camera")
"""What final_info says of every episode."""


def made_by(factory: Callable[[], Task]) -> Task:
    """A task of a VectorEnv's argument. TypeError where it makes none."""
    task = factory()
    if not isinstance(task, Task):
        raise TypeError(f"task makes a {type(task).__name__}, expected a galactic.Task")
    return task


def options_of(task: Task, given: Mapping[str, Any]) -> dict[str, Any]:
    """The options of the simulation below, of which those that were given go before the task's."""
    return {**task.options, **given, "task": task.base}


def has_raised(error: BaseException) -> bool:
    """Whether it comes out of a task, or of what is said of one here, and not of the options around it."""
    return any(frame.f_code.co_filename == __file__ for frame, _ in walk_tb(error.__traceback__))


class TaskRunner:
    """A task at work in the envs of a simulator that leaves envs where their episodes end."""

    def __init__(self, task: Task, world: World, simulator: Simulator) -> None:
        self._task = task
        self._envs = TaskEnvs(world, simulator)
        self._name = type(task).__name__
        self._rewards = np.zeros(self._envs.num_envs, np.float32)
        self._endings = np.zeros(self._envs.num_envs, np.uint8)
        self.parts = _parts_of(task, self._name, simulator)
        self.measures = _measures_of(task, self._name)
        sizes = [part.stop - part.start for part in self.parts.values()]
        self._columns = np.zeros((self._envs.num_envs, sum(sizes)), np.float32)
        self.restart()

    @property
    def outcome(self) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
        """Rewards and endings, as EpisodeEnd, (n,), of the latest step: the task's, and where it ended
        nothing, the simulator's. The next step overwrites them."""
        return self._rewards, self._endings

    @property
    def size(self) -> int:
        """How many numbers the task adds to an observation."""
        return self._columns.shape[1]

    def restart(self) -> None:
        """Begins anew, with envs that have just been made or restarted with a seed."""
        simulator = self._envs.simulator
        self._envs.seed = simulator.options["seed"]
        self._envs.move_on(steps=0)
        self._envs.actions[:] = 0.0
        self._task.memory = {}
        self._task.prepare(self._envs)
        self._layout = self._memory_layout()
        everywhere = np.arange(self._envs.num_envs)
        chosen = self.choose(everywhere)
        begins = np.where(chosen < 0, Simulator.STAYS, chosen)
        if (chosen >= 0).any():
            simulator.check_episodes(begins)
            simulator.reset(begins)
        self.begin(everywhere)

    def choose(self, which: NDArray[np.int64]) -> NDArray[np.int64]:
        """The episodes that the envs `which` begin next; NEXT_EPISODE for the next of their own."""
        chosen = self._task.choose(self._envs, which)
        if chosen is None:
            return np.full(len(which), Simulator.NEXT_EPISODE, np.int64)
        episodes = np.asarray(chosen)
        if episodes.shape != which.shape or not np.issubdtype(episodes.dtype, np.integer):
            raise ValueError(self._fault("choose", "episodes", episodes, f"int {which.shape}"))
        return np.where(episodes < 0, Simulator.NEXT_EPISODE, episodes.astype(np.int64))

    def begin(self, which: NDArray[np.int64]) -> None:
        """Takes in that the envs `which` are at the start of an episode, but for idle ones."""
        self._envs.move_on(steps=self._envs.steps)
        playing = which[~self._envs.simulator.idle[which]]
        if len(playing):
            self._task.begin(self._envs, playing)
            self._require_layout()

    def step(self, actions: NDArray[np.float32], idle: NDArray[np.bool_]) -> None:
        """Takes in the simulator's latest step, before which the envs `idle` were."""
        envs = self._envs
        envs.move_on(steps=envs.steps + 1)
        np.copyto(envs.actions, actions)
        outcome = Outcome(*self._task.step(envs))
        self._require_layout()
        shape = (envs.num_envs,)
        rewards = self._checked("step", "rewards", outcome.rewards, shape)
        successes = self._flags("successes", outcome.successes)
        failures = self._flags("failures", outcome.failures)
        np.copyto(self._rewards, np.where(idle, 0.0, rewards))
        np.copyto(self._endings, envs.endings)
        self._endings[failures & ~idle] = EpisodeEnd.FAILURE
        self._endings[successes & ~idle] = EpisodeEnd.SUCCESS

    def measure(self, which: NDArray[np.int64]) -> dict[str, NDArray[np.float32]]:
        """What the task says of the episodes that have ended in the envs `which`, float32 (n,); zeros for
        the others."""
        found = self._task.measure(self._envs, which) if self.measures and len(which) else {}
        if len(which):
            self._require_names("measure", found, self.measures)
        measured = {name: np.zeros(self._envs.num_envs, np.float32) for name in self.measures}
        for name, values in found.items():
            measured[name][which] = self._checked("measure", name, values, (len(which),))
        return measured

    def observe(self) -> NDArray[np.float32]:
        """The task's columns of the observation, float32 (n, size), overwritten by the next call."""
        seen = self._task.observe(self._envs) if self.parts else {}
        self._require_names("observe", seen, self.parts)
        first = self._envs.simulator.observation_size
        for name, part in self.parts.items():
            shape = (self._envs.num_envs, part.stop - part.start)
            values = self._checked("observe", name, seen[name], shape)
            self._columns[:, part.start - first : part.stop - first] = values
        return self._columns

    def state(self) -> dict[str, Array]:
        """All that later steps depend on, of which restore() takes the same names, shapes and types."""
        memory = {f"task_memory_{name}": array for name, array in self._task.memory.items()}
        return {"task_steps": np.array(self._envs.steps, np.int64), **memory}

    def restore(self, saved: Mapping[str, Array]) -> None:
        """Goes on from what state() returned once, with the simulator of that moment."""
        self._envs.move_on(steps=int(saved["task_steps"]))
        for name, array in self._task.memory.items():
            np.copyto(array, saved[f"task_memory_{name}"])

    def _memory_layout(self) -> dict[str, tuple[Any, tuple[int, ...]]]:
        """Types and shapes of the memory. TypeError for what is no array with an axis of envs."""
        layout = {}
        for name, array in self._task.memory.items():
            fits = isinstance(array, np.ndarray) and array.shape[:1] == (self._envs.num_envs,)
            if not fits or array.dtype.hasobject:
                raise TypeError(
                    f"{self._name}.memory[{name!r}] is {_described(array)}, expected an array of numbers "
                    f"whose first axis is the {self._envs.num_envs} envs"
                )
            layout[name] = (array.dtype, array.shape)
        return layout

    def _require_layout(self) -> None:
        """TypeError where the memory is no longer what prepare() made, so that no state of it fits."""
        found = self._memory_layout()
        for name in [*self._layout, *found]:
            if found.get(name) != self._layout.get(name):
                is_now = _described(self._task.memory.get(name))
                was = " ".join(map(str, self._layout.get(name, ("nothing",))))
                raise TypeError(
                    f"{self._name}.memory[{name!r}] is {is_now}, and prepare() made {was}; write into the "
                    "array, or keep its type and shape"
                )

    def _require_names(self, method: str, found: Mapping[str, Any], wanted: Iterable[str]) -> None:
        names = sorted(wanted)
        if sorted(found) != names:
            raise ValueError(f"{self._name}.{method}() returned {sorted(found)}, expected {names}")

    def _flags(self, name: str, given: Any) -> NDArray[np.bool_]:
        shape = (self._envs.num_envs,)
        if given is None:
            return np.zeros(shape, np.bool_)
        flags = np.asarray(given)
        if flags.shape != shape or flags.dtype != np.bool_:
            raise ValueError(self._fault("step", name, flags, f"bool {shape}"))
        return flags

    def _checked(self, method: str, name: str, given: Any, shape: tuple[int, ...]) -> Array:
        """Finite numbers of that shape."""
        values = np.asarray(given)
        if values.shape != shape or values.dtype.kind not in "biuf":
            raise ValueError(self._fault(method, name, values, f"numbers {shape}"))
        finite = np.isfinite(values)
        if not finite.all():
            row = int(np.argwhere(~finite)[0, 0])
            raise ValueError(
                f"{self._name}.{method}() returned {name} of which env {row} has {values[row]}, expected "
                "finite numbers"
            )
        return values

    def _fault(self, method: str, name: str, found: Array, wanted: str) -> str:
        return f"{self._name}.{method}() returned {name} {_described(found)}, expected {wanted}"


def _described(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape}"
    return type(value).__name__


def _measures_of(task: Task, name: str) -> tuple[str, ...]:
    """ValueError for names that cannot be."""
    for measure in task.measures:
        is_name = isinstance(measure, str) and measure.isidentifier() and measure[0] != "_"
        if isinstance(task.measures, str) or not is_name or measure in OF_EPISODES:
            raise ValueError(
                f"{name}.measures has {measure!r}, expected a name of its own, such as ways_lost"
            )
    return tuple(task.measures)


def _parts_of(task: Task, name: str, simulator: Simulator) -> dict[str, slice]:
    """Where the task's parts are in an observation. ValueError for sizes and names that cannot be."""
    parts: dict[str, slice] = {}
    first = simulator.observation_size
    taken = {*simulator.observation_parts, "state", "rgb", "depth", "semantics"}
    for part, size in task.parts.items():
        if part in taken or not isinstance(part, str) or not part.isidentifier():
            raise ValueError(
                f"{name}.parts has {part!r}, expected a name of its own, such as to_door"
            )
        if not isinstance(size, int) or size < 1:
            raise ValueError(
                f"{name}.parts[{part!r}] is {size!r}, expected how many numbers it has"
            )
        parts[part] = slice(first, first + size)
        first += size
    return parts
