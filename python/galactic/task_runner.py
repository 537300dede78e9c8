"""Drives a task of one's own: calls its methods in the right order, and checks what they return."""

from __future__ import annotations

import numbers
import warnings
from collections.abc import Callable, Iterable, Mapping, Set
from traceback import walk_tb
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic._core import EpisodeEnd, Simulator, World
from galactic.cameras import Cameras, options_of_cameras
from galactic.env_states import EnvStates
from galactic.sensors import ALWAYS, SENSORS
from galactic.task import Outcome, Placements, Task
from galactic.task_envs import TaskEnvs

Array = NDArray[Any]

OF_EPISODES = ("episode", "ending", "success", "picked", "episode_index", "world_from_camera")
"""What final_info contains for every episode."""


_OF_CURVES = {"std"}
"""Names that logs cannot have: the curves' column log_std is the policy's."""
_MANY_PLACEMENTS = 20
"""If this many placements are all refused, it is not bad luck with single ones."""
_NOT_OF_TASKS = ("task", "envs", "seed", "order", "rank", "ranks", "threads", "auto_reset")


def made_by(factory: Callable[[], Task]) -> Task:
    """Makes a task with a VectorEnv's argument. Raises TypeError if that does not make a task."""
    task = factory()
    if not isinstance(task, Task):
        raise TypeError(f"task makes a {type(task).__name__}, expected a galactic.Task")
    require_options(task)
    return task


def require_options(task: Task) -> None:
    """Raises ValueError for options that a task cannot set."""
    name = type(task).__name__
    for option in task.options:
        if option in _NOT_OF_TASKS:
            instead = "say it with base" if option == "task" else "it is the VectorEnv's"
            raise ValueError(
                f"{name}.options has {option!r}, which a task does not choose; {instead}"
            )
    if not isinstance(task.base, str):
        raise ValueError(
            f"{name}.base is {task.base!r}, expected a task of the simulation, or 'none'"
        )


def options_of(task: Task, given: Mapping[str, Any]) -> dict[str, Any]:
    """The options of the simulation beneath the task. Options that were given override the
    task's."""
    seen = {} if task.images is None else {"body_transforms": True}
    return {**task.options, **given, **seen, "task": task.base}


def has_raised(error: BaseException) -> bool:
    """Whether the exception comes from a task or from the checks of a task here, and not from the
    options around it."""
    return any(frame.f_code.co_filename == __file__ for frame, _ in walk_tb(error.__traceback__))


class TaskRunner:
    """Runs a task in the envs of a simulator that leaves envs where their episodes end."""

    def __init__(
        self,
        task: Task,
        world: World,
        simulator: Simulator,
        *,
        threads: int,
        is_evaluation: bool = False,
        taken: Iterable[str] = (),
    ) -> None:
        self._task = task
        self._name = type(task).__name__
        cameras = options_of_cameras(f"{self._name}.images", task.images)
        self._envs = TaskEnvs(world, simulator, Cameras(simulator, cameras, threads), is_evaluation)
        self._rewards = np.zeros(self._envs.num_envs, np.float32)
        self._endings = np.zeros(self._envs.num_envs, np.uint8)
        self.parts = _parts_of(task, self._name, simulator.observation_size, {*taken})
        self.measures = _names_of(task.measures, f"{self._name}.measures", {*OF_EPISODES, *taken})
        self.log_names = _names_of(task.logs, f"{self._name}.logs", _OF_CURVES)
        self.logs: dict[str, NDArray[np.float32]] = {}
        """What the task logged of the latest step, (n,), by these names; 0 for idle envs."""
        sizes = [part.stop - part.start for part in self.parts.values()]
        self._columns = np.zeros((self._envs.num_envs, sum(sizes)), np.float32)
        self.placements = Placements(0, 0)
        """Placements of the episodes that have begun since this was made."""
        self.restart()

    @property
    def outcome(self) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
        """Rewards and endings (as EpisodeEnd), (n,), of the latest step. Endings are the task's or,
        where the task ended nothing, the simulator's. The next step overwrites them."""
        return self._rewards, self._endings

    @property
    def progress(self) -> float:
        """TaskEnvs.progress."""
        return self._envs.progress

    @progress.setter
    def progress(self, value: float) -> None:
        self._envs.progress = value

    @property
    def size(self) -> int:
        """The number of elements that the task adds to an observation."""
        return self._columns.shape[1]

    def restart(self) -> None:
        """Starts again, with envs that have just been made or restarted with a seed."""
        self._begin_anew()
        simulator = self._envs.simulator
        everywhere = np.arange(self._envs.num_envs)
        chosen = self._chosen(everywhere)
        begins = np.where(chosen < 0, Simulator.STAYS, chosen)
        if (chosen >= 0).any():
            simulator.check_episodes(begins)
            simulator.reset(begins, drawn=True)
        self.begin(everywhere)

    def _begin_anew(self) -> None:
        """Resets everything to the state before the first step."""
        self._envs.steps = 0
        self._envs.take_actions(0.0)
        self._envs.draws.begin_first()
        self._envs.forget()
        self._prepare()

    def mend(self) -> None:
        """Makes the memory again if its layout is no longer what prepare() made, so that no saved
        state would fit."""
        try:
            self._require_layout()
        except TypeError:
            self._prepare()

    def _prepare(self) -> None:
        """Lets the task make its memory, for the simulator's seed."""
        self._envs.seed = self._envs.simulator.options["seed"]
        self._task.memory = {}
        self._task.prepare(self._envs)
        self._layout = self._memory_layout()

    def choose(self, which: NDArray[np.int64], named: NDArray[np.int64]) -> NDArray[np.int64]:
        """The episodes that the envs `which` begin next: those in `named` or, where that is
        negative, the task's choice; NEXT_EPISODE for an env's own next episode."""
        is_named = named >= 0
        self._envs.draws.begin_named(which[is_named], named[is_named])
        self._envs.draws.begin_next(which[~is_named])
        episodes = named.copy()
        if not is_named.all():
            episodes[~is_named] = self._chosen(which[~is_named])
        return episodes

    def _chosen(self, which: NDArray[np.int64]) -> NDArray[np.int64]:
        chosen = self._task.choose(self._envs, which)
        if chosen is None:
            return np.full(len(which), Simulator.NEXT_EPISODE, np.int64)
        episodes = np.asarray(chosen)
        if episodes.shape != which.shape or not np.issubdtype(episodes.dtype, np.integer):
            raise ValueError(self._fault("choose", "episodes", episodes, f"int {which.shape}"))
        return np.where(episodes < 0, Simulator.NEXT_EPISODE, episodes.astype(np.int64))

    def begin(self, which: NDArray[np.int64]) -> None:
        """Call when the envs `which` are at the start of an episode; idle ones are ignored. Lets
        the task place and begin these episodes."""
        playing = which[~self._envs.simulator.idle[which]]
        if len(playing) and type(self._task).place is not Task.place:
            self._envs.forget(which)
            self._place(playing)
        self._envs.forget(which)
        self._take_in(playing)

    def begin_chosen(self, which: NDArray[np.int64]) -> None:
        """Call when the envs `which` continue from states that the caller has chosen."""
        self._envs.draws.begin_next(which)
        self._envs.forget(which)
        self._take_in(which)

    def _place(self, which: NDArray[np.int64]) -> None:
        simulator = self._envs.simulator
        placed = self._task.place(self._envs, which, simulator.env_states(which))
        if placed is None:
            return
        if not isinstance(placed, EnvStates):
            raise TypeError(
                f"{self._name}.place() returned {_described(placed)}, expected EnvStates or None"
            )
        if len(placed.episode) != len(which):
            raise ValueError(
                f"{self._name}.place() returned {len(placed.episode)} states, expected {len(which)}"
            )
        simulator.check_states(placed)
        are_drawn = self._envs.draws.are_drawn[which]
        were_set = [
            simulator.set_states(placed.select(rows), which[rows], drawn=drawn)
            for drawn, rows in ((True, are_drawn), (False, ~are_drawn))
        ]
        self._count(len(which), int(np.concatenate(were_set).sum()))

    def _count(self, asked: int, were_set: int) -> None:
        """Counts placements. Issues a RuntimeWarning, once, if all of them are refused."""
        before = self.placements
        self.placements = Placements(before.asked + asked, before.refused + asked - were_set)
        now_many = before.asked < _MANY_PLACEMENTS <= self.placements.asked
        if now_many and self.placements.refused == self.placements.asked:
            warnings.warn(
                f"the first {self.placements.asked} states of {self._name}.place() were all refused, so that these "
                "episodes begin where the world has them: Simulator.set_states() says why that may be, "
                "VectorEnv.placements counts on",
                RuntimeWarning,
                stacklevel=2,
            )

    def _take_in(self, beginning: NDArray[np.int64]) -> None:
        if len(beginning):
            self._task.begin(self._envs, beginning)
            self._require_layout()

    def step(self, actions: NDArray[np.float32], idle: NDArray[np.bool_]) -> None:
        """Processes the simulator's latest step. `idle`: the envs that were idle before it."""
        envs = self._envs
        envs.steps += 1
        envs.draws.ages += 1
        envs.forget()
        envs.take_actions(actions)
        outcome = self._task.step(envs)
        if not isinstance(outcome, tuple) or not 1 <= len(outcome) <= 4:
            raise TypeError(
                f"{self._name}.step() returned {_described(outcome)}, expected an Outcome"
            )
        outcome = Outcome(*outcome)
        self._require_layout()
        shape = (envs.num_envs,)
        rewards = self._checked("step", "rewards", outcome.rewards, shape, ignored=idle)
        successes = self._flags("successes", outcome.successes)
        failures = self._flags("failures", outcome.failures)
        self.logs = self._logged(outcome.logs, idle)
        np.copyto(self._rewards, np.where(idle, 0.0, rewards))
        np.copyto(self._endings, envs.endings)
        self._endings[failures & ~idle] = EpisodeEnd.FAILURE
        self._endings[successes & ~idle] = EpisodeEnd.SUCCESS

    def _logged(self, given: Any, idle: NDArray[np.bool_]) -> dict[str, NDArray[np.float32]]:
        found = {} if given is None else given
        self._require_names("step", found, self.log_names, "logs ")
        shape = (self._envs.num_envs,)
        rows = {
            name: self._checked("step", f"logs[{name!r}]", found[name], shape, ignored=idle)
            for name in self.log_names
        }
        return {name: np.where(idle, np.float32(0), values) for name, values in rows.items()}

    def measure(self, which: NDArray[np.int64]) -> dict[str, NDArray[np.float32]]:
        """The task's measures of the episodes that have ended in the envs `which`, each float32
        (n,), with zeros for the other envs."""
        found = self._task.measure(self._envs, which) if self.measures and len(which) else {}
        if len(which):
            self._require_names("measure", found, self.measures)
        of = self._envs.numbers[which]
        measured = {name: np.zeros(self._envs.num_envs, np.float32) for name in self.measures}
        for name, values in found.items():
            measured[name][which] = self._checked("measure", name, values, (len(which),), of)
        return measured

    def observe(self) -> NDArray[np.float32]:
        """The task's columns of the observation, float32 (n, size), overwritten by the next call."""
        seen = self._task.observe(self._envs) if self.parts else {}
        self._require_names("observe", seen, self.parts)
        first, idle = self._envs.simulator.observation_size, self._envs.simulator.idle
        for name, part in self.parts.items():
            shape = (self._envs.num_envs, part.stop - part.start)
            values = self._checked("observe", name, seen[name], shape, ignored=idle)
            self._columns[:, part.start - first : part.stop - first] = values
        return self._columns

    def state(self, *, blank: bool = False) -> dict[str, Array]:
        """Everything on which later steps depend. restore() takes arrays with the same names,
        shapes and types. `blank`: the memory has the layout that prepare() made, with any content,
        even if the memory has changed since."""
        return {"task_steps": np.array(self._envs.steps, np.int64), **self._of_envs(blank=blank)}

    def _of_envs(self, *, blank: bool) -> dict[str, Array]:
        """The part of the state that each env has of its own."""
        envs, remembered = self._envs, self._task.memory
        if blank:
            remembered = {name: np.empty(shape, of) for name, (of, shape) in self._layout.items()}
        memory = {f"task_memory_{name}": array for name, array in remembered.items()}
        return {
            "task_actions": envs.actions,
            "task_begun": envs.draws.begun,
            "task_keys": envs.draws.keys,
            "task_ages": envs.draws.ages,
            **memory,
        }

    def restore(self, saved: Mapping[str, Array]) -> None:
        """Continues from what state() returned, with the simulator in the state of the same
        moment."""
        envs = self._envs
        envs.forget()
        self.mend()
        if envs.seed != envs.simulator.options["seed"]:
            self._begin_anew()
        envs.steps = int(saved["task_steps"])
        envs.take_actions(saved["task_actions"])
        np.copyto(envs.draws.begun, saved["task_begun"])
        np.copyto(envs.draws.keys, saved["task_keys"])
        np.copyto(envs.draws.ages, saved["task_ages"])
        for name, array in self._task.memory.items():
            np.copyto(array, saved[f"task_memory_{name}"])

    def state_of(self, rows: NDArray[np.int64], *, blank: bool = False) -> dict[str, Array]:
        """What later steps of the envs `rows` depend on: arrays (len(rows), ...). restore_rows()
        takes arrays with the same names, shapes and types; `blank` as in state()."""
        return {name: array[rows] for name, array in self._of_envs(blank=blank).items()}

    def restore_rows(self, saved: Mapping[str, Array], rows: NDArray[np.int64]) -> None:
        """Makes the envs `rows` continue from what state_of() returned for the same number of envs,
        with the simulator in the state of the same moment. Unless their episodes were named, the
        envs keep random numbers of their own. `steps` and `progress`, which all envs share, stay
        the same."""
        envs, draws = self._envs, self._envs.draws
        envs.forget()
        envs.take_actions(saved["task_actions"], rows)
        draws.restore(saved["task_begun"], saved["task_keys"], saved["task_ages"], rows)
        for name, array in self._task.memory.items():
            array[rows] = saved[f"task_memory_{name}"]

    def _memory_layout(self) -> dict[str, tuple[Any, tuple[int, ...]]]:
        """Types and shapes of the memory. Raises TypeError for anything that is not an array with
        an axis of envs."""
        layout = {}
        for name, array in self._task.memory.items():
            fits = isinstance(array, np.ndarray) and array.shape[:1] == (self._envs.num_envs,)
            if fits and not array.flags.writeable:
                raise TypeError(
                    f"{self._name}.memory[{name!r}] is a view that cannot be written, and shows what is now; "
                    "copy what is to be remembered"
                )
            if not fits or array.dtype.hasobject or not isinstance(name, str):
                raise TypeError(
                    f"{self._name}.memory[{name!r}] is {_described(array)}, expected an array of numbers "
                    f"whose first axis is the {self._envs.num_envs} envs"
                )
            layout[name] = (array.dtype, array.shape)
        return layout

    def _require_layout(self) -> None:
        """Raises TypeError if the memory's layout is no longer what prepare() made, so that no
        saved state would fit."""
        found = self._memory_layout()
        for name in [*self._layout, *found]:
            if found.get(name) != self._layout.get(name):
                is_now = _described(self._task.memory.get(name))
                was = " ".join(map(str, self._layout.get(name, ("nothing",))))
                raise TypeError(
                    f"{self._name}.memory[{name!r}] is {is_now}, and prepare() made {was}; write into the "
                    "array, or keep its type and shape"
                )

    def _require_names(
        self, method: str, found: Any, wanted: Iterable[str], what: str = ""
    ) -> None:
        names, says = sorted(wanted), f"{self._name}.{method}() returned {what}"
        if not isinstance(found, Mapping):
            raise TypeError(f"{says}{_described(found)}, expected {names}")
        if sorted(found) != names:
            raise ValueError(f"{says}{sorted(found)}, expected {names}")

    def _flags(self, name: str, given: Any) -> NDArray[np.bool_]:
        shape = (self._envs.num_envs,)
        if given is None:
            return np.zeros(shape, np.bool_)
        flags = np.asarray(given)
        if flags.shape != shape or flags.dtype != np.bool_:
            raise ValueError(self._fault("step", name, flags, f"bool {shape}"))
        return flags

    def _checked(
        self,
        method: str,
        name: str,
        given: Any,
        shape: tuple[int, ...],
        envs: NDArray[np.int64] | None = None,
        ignored: NDArray[np.bool_] | None = None,
    ) -> NDArray[np.float32]:
        """Checks that `given` has finite numbers of that shape, for these envs or all. Other
        numbers are replaced by 0 for the envs that are `ignored`."""
        values = np.asarray(given)
        if values.shape != shape or values.dtype.kind not in "biuf":
            raise ValueError(self._fault(method, name, values, f"numbers {shape}"))
        with np.errstate(over="ignore"):
            rows = values.astype(np.float32)
        finite = np.isfinite(rows)
        if ignored is not None and not finite.all():
            rows[ignored] = np.where(finite[ignored], rows[ignored], 0.0)
            finite = np.isfinite(rows)
        if not finite.all():
            row = int(np.argwhere(~finite)[0, 0])
            env = (self._envs.numbers if envs is None else envs)[row]
            raise ValueError(
                f"{self._name}.{method}() returned {name} of which env {env} has {values[row]}, expected "
                "finite numbers of 32 bits"
            )
        return rows

    def _fault(self, method: str, name: str, found: Array, wanted: str) -> str:
        return f"{self._name}.{method}() returned {name} {_described(found)}, expected {wanted}"


def _described(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape}"
    return type(value).__name__


def _names_of(names: Any, where: str, taken: Set[str]) -> tuple[str, ...]:
    """The names of what a task measures or logs. Raises ValueError for invalid names."""
    for name in names:
        is_name = isinstance(name, str) and name.isidentifier() and name[0] != "_"
        if isinstance(names, str) or not is_name or name in taken:
            raise ValueError(f"{where} has {name!r}, expected a name of its own, such as ways_lost")
    if len(set(names)) < len(names):
        raise ValueError(f"{where} has a name twice: {list(names)}")
    return tuple(names)


def _parts_of(task: Task, name: str, first: int, taken: Set[str]) -> dict[str, slice]:
    """Where the task's parts are in an observation. Raises ValueError for invalid sizes and
    names."""
    parts: dict[str, slice] = {}
    taken = {*taken, *ALWAYS, *SENSORS, "state", "rgb", "depth", "semantics"}
    if not isinstance(task.parts, Mapping):
        raise ValueError(
            f"{name}.parts is {task.parts!r}, expected sizes by name, such as {{'to_door': 2}}"
        )
    for part, size in task.parts.items():
        if part in taken or not isinstance(part, str) or not part.isidentifier():
            raise ValueError(
                f"{name}.parts has {part!r}, expected a name of its own, such as to_door"
            )
        if not isinstance(size, numbers.Integral) or isinstance(size, bool) or size < 1:
            raise ValueError(
                f"{name}.parts[{part!r}] is {size!r}, expected how many numbers it has"
            )
        parts[part] = slice(first, first + int(size))
        first += int(size)
    return parts
