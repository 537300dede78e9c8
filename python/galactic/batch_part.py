"""A simulator, its cameras and the sums of its episodes. A VectorEnv has one such part, or two that
take turns."""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galactic import spaces
from galactic._core import EpisodeTally, ErrorCode, Renderer, Simulator, World
from galactic.cameras import Cameras
from galactic.env_states import EnvStates
from galactic.errors import Error
from galactic.step_events import StepEvents, masked
from galactic.task import Placements, Task
from galactic.task_runner import TaskRunner, options_of

Array = NDArray[Any]
#: An array or a dictionary of arrays, as in observation_space. Not a Union: which of them it is
#: depends on options, so a type checker would reject every use of either.
Observations = Any
#: Observations, rewards, terminations, truncations, infos.
StepResult = tuple[Observations, Array, Array, Array, dict[str, Any]]


class Piece(NamedTuple):
    """The state of a simulator's envs, and the env to which each is restored; None for none."""

    state: bytes
    places: Sequence[int | None]


class BatchPart:
    """Envs that step together, with what Gymnasium needs to know about each step. If a second
    thread calls a method while another call is running, it gets a RuntimeError and nothing happens.

    Args:
        world: the world of the envs.
        options: options of their Simulator.
        by_parts: whether the state is observed part by part.
        cameras: options of a Renderer for each camera, by the camera's name, which prefixes the
            names of its images; the images of a camera named "" have no prefix.
        copy: whether results are new arrays instead of views.
        task: a task of the caller's own, on top of the simulator's.
        is_evaluation: TaskEnvs.is_evaluation for the task.
        events: whether infos contain what happened in each step.
    """

    def __init__(
        self,
        world: World,
        options: dict[str, Any],
        *,
        by_parts: bool,
        cameras: Mapping[str, Mapping[str, Any]],
        copy: bool,
        task: Task | None = None,
        is_evaluation: bool = False,
        events: bool = False,
    ) -> None:
        if task is not None:
            options = options_of(task, options)
        # Envs wait at the end of their episodes until that state has been drawn, or examined by a
        # task.
        self._renews = bool(cameras) or task is not None
        self.simulator = Simulator(world, **options, auto_reset=not self._renews)
        self._cameras = Cameras(self.simulator, cameras, options["threads"])
        taken = [*self._cameras.shapes, *self._cameras.places_of(np.empty(0, np.int64))]
        self._task = (
            None
            if task is None
            else TaskRunner(
                task,
                world,
                self.simulator,
                threads=options["threads"],
                is_evaluation=is_evaluation,
                taken=taken,
            )
        )
        self._is_evaluation = is_evaluation
        self._progress = 1.0 if is_evaluation else 0.0
        self.observation_parts = self.simulator.observation_parts | (
            {} if self._task is None else self._task.parts
        )
        self.measures: tuple[str, ...] = () if self._task is None else self._task.measures
        self.logs: tuple[str, ...] = () if self._task is None else self._task.log_names
        self._copy = copy
        self._parts = self.observation_parts if by_parts else None
        envs = self.simulator.num_envs
        # Observations of simulator and task together, if there is a task; and what the caller sees
        # if results are not copied.
        self._rows = np.zeros((envs, self.observation_size), np.float32)
        self._seen = {"state": self._rows, "rewards": np.zeros(envs, np.float32)}
        self._tally = EpisodeTally(self.simulator)
        self._events = StepEvents(self.simulator) if events else None
        self._is_new = True
        self.is_cut_off = False
        """Whether an exception has cut off a step or a reset, so that envs, task and sums may be
        out of step."""
        self._in_use = threading.Lock()
        # When the episodes began, by a monotonic clock.
        self._began = np.full(envs, time.perf_counter())
        self._images = {} if copy else self._cameras.blank_images()

    @property
    def renderers(self) -> Mapping[str, Renderer]:
        """The renderer of each camera's images, by the camera's name."""
        return self._cameras.renderers

    @property
    def progress(self) -> float:
        """TaskEnvs.progress for the task: how much of the training is over, 0 to 1; 1 in an
        evaluation."""
        return self._progress

    @progress.setter
    def progress(self, value: float) -> None:
        self._progress = value
        if self._task is not None:
            self._task.progress = value

    @property
    def placements(self) -> Placements:
        """How many states the task's place() returned, and how many of them were refused."""
        return Placements(0, 0) if self._task is None else self._task.placements

    @property
    def observation_size(self) -> int:
        """The number of elements in an env's flat observation."""
        return self.simulator.observation_size + (0 if self._task is None else self._task.size)

    @property
    def observation_space(self) -> spaces.Space:
        """The observation space of one env."""
        size = self.observation_size
        if self._parts is None and not self._cameras.shapes:
            return _unbounded(size)
        parts = {"state": slice(0, size)} if self._parts is None else self._parts
        named = {name: _unbounded(part.stop - part.start) for name, part in parts.items()}
        images = {
            name: _image(shape, dtype) for name, (shape, dtype) in self._cameras.shapes.items()
        }
        return spaces.Dict({**named, **images})

    def landing_shapes(self) -> dict[str, tuple[tuple[int, ...], Any]]:
        """The results that step() can write to given arrays: shape, without the env's axis, and
        type."""
        return {
            "state": ((self.observation_size,), np.float32),
            **self._cameras.shapes,
            "rewards": ((), np.float32),
            "terminations": ((), np.bool_),
            "truncations": ((), np.bool_),
            "endings": ((), np.uint8),
        }

    def reset(self, seed: int | None, mask: NDArray[np.bool_], episodes: NDArray[np.int64]) -> None:
        """Begins the `episodes` in the envs where `mask` is true: see episodes_to_begin()."""
        with self._alone():
            if seed is None and not mask.all():
                self.require_whole()
            was_cut_off, self.is_cut_off = self.is_cut_off, True
            if self._task is not None and mask.all():
                self._task.mend()
            if seed is not None:
                try:
                    self.simulator.restart(seed)
                except (Error, TypeError, ValueError):  # it has refused, and nothing has happened
                    self.is_cut_off = was_cut_off
                    raise
                if self._task is not None:
                    self._task.restart()
            untouched = self._is_new or seed is not None
            self._is_new = False
            # Envs that have not been used yet already stand at the start of their next episodes.
            begins = np.flatnonzero(mask & ((episodes >= 0) | (not untouched)))
            self._begin(begins, episodes[begins])
            self._tally.restart(mask)
            self._began[mask] = time.perf_counter()
            self.is_cut_off = False

    def set_states(self, states: EnvStates, rows: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Makes the envs `rows` continue from states: see VectorEnv.set_states()."""
        with self._alone():
            self.require_whole()
            were_set = self.simulator.set_states(states, rows)
            self.is_cut_off, self._is_new = True, False
            mask = np.zeros(self.simulator.num_envs, np.bool_)
            mask[rows[were_set]] = True
            if self._task is not None:
                self._task.begin_chosen(np.flatnonzero(mask))
            self._tally.restart(mask)
            self._began[mask] = time.perf_counter()
            self.is_cut_off = False
            return were_set

    def observe(self, out: Mapping[str, Array] | None = None) -> Observations:
        """The observations of all envs now."""
        with self._alone():
            self.require_whole()
            images = self._cameras.draw({**self._images, **(out or {})})
            return self._observed(self._landed("state", self._state_rows(), out), images)

    def save_state(self) -> dict[str, Array]:
        """Arrays that restore_state() takes."""
        with self._alone():
            self.require_whole()
            own = {name: array.copy() for name, array in self._own_state().items()}
            return {"simulator": np.frombuffer(self.simulator.save_state(), np.uint8), **own}

    def restore_state(self, saved: Mapping[str, Array]) -> None:
        """Continues from a saved state. Raises Error and changes nothing if the state does not
        fit."""
        saved = {"simulator": np.empty(0, np.uint8), **saved}
        with self._alone():
            for name, mine in self._own_state(blank=True).items():
                _check_saved(name, saved.get(name), mine)
            self.is_cut_off = True
            self.simulator.restore_state(saved["simulator"].tobytes())
            self._tally.restore(saved["returns"], saved["lengths"])
            self._is_new = bool(saved["is_new"])
            if not self._is_evaluation:
                self.progress = float(saved["progress"])
            if self._task is not None:
                self._task.restore(saved)
            self.is_cut_off = False

    def _own_state(self, *, blank: bool = False) -> dict[str, Array]:
        """The state that is not in the simulator. `blank`: for a task, arrays of the same types and
        shapes with any content."""
        own = {"is_new": np.array(self._is_new), "progress": np.array(self.progress)}
        task = {} if self._task is None else self._task.state(blank=blank)
        return {"returns": self._tally.returns, "lengths": self._tally.lengths, **own, **task}

    def save_rows(self, rows: NDArray[np.int64]) -> tuple[bytes, dict[str, Array]]:
        """The state of the envs `rows` in the simulator, and everything else on which their later
        steps depend: arrays (len(rows), ...)."""
        with self._alone():
            self.require_whole()
            return self.simulator.save_state(rows), self._state_of(rows)

    def check_rows(self, saved: Mapping[str, Array], rows: NDArray[np.int64]) -> None:
        """Raises Error if `saved` is not what save_rows() returns for the same number of envs."""
        for name, mine in self._state_of(rows, blank=True).items():
            _check_saved(name, saved.get(name), mine)

    def restore_rows(
        self, pieces: Sequence[Piece], saved: Mapping[str, Array], rows: NDArray[np.int64]
    ) -> None:
        """Makes the envs `rows` continue from `saved` (check_rows()) and from those of `pieces`
        that are restored to them. Raises Error and changes nothing if the first piece does not
        fit."""
        with self._alone():
            self.require_whole()
            first, *more = pieces
            self.is_cut_off = True
            try:
                self.simulator.restore_state(first.state, first.places)
            except (Error, RuntimeError):  # it has refused, and nothing has happened
                self.is_cut_off = False
                raise
            for piece in more:
                self.simulator.restore_state(piece.state, piece.places)
            returns, lengths = self._tally.returns.copy(), self._tally.lengths.copy()
            returns[rows], lengths[rows] = saved["returns"], saved["lengths"]
            self._tally.restore(returns, lengths)
            self._is_new = False
            if self._task is not None:
                self._task.restore_rows(saved, rows)
            self.is_cut_off = False

    def _state_of(self, rows: NDArray[np.int64], *, blank: bool = False) -> dict[str, Array]:
        task = {} if self._task is None else self._task.state_of(rows, blank=blank)
        return {"returns": self._tally.returns[rows], "lengths": self._tally.lengths[rows], **task}

    def step(self, actions: NDArray[np.float32], out: Mapping[str, Array] | None) -> StepResult:
        """See VectorEnv.step, which has checked `actions` and `out`."""
        with self._alone():
            self.require_whole()
            was_idle = self.simulator.idle.copy()
            if self._events is not None:
                self._events.begin()
            self._move(actions)
            result = self._taken_in(actions, was_idle, out)
            self.is_cut_off = False
            return result

    def _move(self, actions: NDArray[np.float32]) -> None:
        """Steps the simulator. From then on, the step counts as cut off until it is processed
        completely, because Ctrl-C may come as soon as the simulator returns."""
        was_new = self._is_new
        self.is_cut_off, self._is_new = True, False
        try:
            self.simulator.step(actions)
        except (RuntimeError, TypeError, ValueError):  # it has refused, and nothing has happened
            self.is_cut_off, self._is_new = False, was_new
            raise

    def require_whole(self) -> None:
        """Raises RuntimeError if a step was cut off."""
        if self.is_cut_off:
            raise RuntimeError(
                "an exception has cut off what this env did last; reset() all envs, or restore a state"
            )

    def _alone(self) -> threading.Lock:
        """A context for each call: the simulator alone would notice a second thread too late, while
        the first is drawing. Returns the lock itself, so that no exception leaves it held."""
        if self._in_use.locked():
            raise RuntimeError(
                "another thread is using this galactic.VectorEnv; give each thread its own"
            )
        return self._in_use

    def _taken_in(
        self,
        actions: NDArray[np.float32],
        was_idle: NDArray[np.bool_],
        out: Mapping[str, Array] | None,
    ) -> StepResult:
        """The results of the step, with task, sums and images."""
        simulator, task = self.simulator, self._task
        if task is not None:
            task.step(actions, was_idle)
        paid, endings = (simulator.rewards, simulator.endings) if task is None else task.outcome
        terminated, truncated, ended = self._tally.add(paid, endings)
        terminations = self._landed("terminations", terminated, out, True)
        truncations = self._landed("truncations", truncated, out, True)
        rewards = self._landed("rewards", paid, out)
        if out is not None and "endings" in out:
            self._landed("endings", endings, out)
        images = self._cameras.draw({**self._images, **(out or {})})
        infos = self._logged(~was_idle)
        if self._events is not None:
            infos |= self._events.infos(~was_idle)
        if len(ended):
            more = {**self._measures(ended), **self._cameras.places_of(ended)}
            infos |= self._infos(ended, self._renew(ended, images), more)
        observations = self._observed(self._landed("state", self._state_rows(), out), images)
        return observations, rewards, terminations, truncations, infos

    def _state_rows(self) -> Array:
        """The flat observations of all envs, as they are now."""
        if self._task is None:
            return self.simulator.observations
        size = self.simulator.observation_size
        self._rows[:, :size] = self.simulator.observations
        self._rows[:, size:] = self._task.observe()
        return self._rows

    def _landed(
        self, name: str, values: Array, out: Mapping[str, Array] | None, is_own: bool = False
    ) -> Array:
        """The values in the array that the caller gave, or as a new array unless they already are
        one."""
        if out is not None and name in out:
            np.copyto(out[name], values, casting="no")
            return out[name]
        if is_own or self._copy:
            return values if is_own else values.copy()
        np.copyto(self._seen[name], values)
        return self._seen[name]

    def _observed(self, state: Array, images: Mapping[str, Array]) -> Observations:
        if self._parts is None:
            return {"state": state, **images} if images else state
        return {**{name: state[..., part] for name, part in self._parts.items()}, **images}

    def _renew(self, which: NDArray[np.int64], images: dict[str, Array]) -> Observations:
        """The last observations of the envs `which`, whose episodes ended. Also begins their next
        episodes, and draws these in `images`."""
        if not self._renews:
            return self._observed(self.simulator.final_observations[which], {})
        last = self._observed(
            self._state_rows()[which], {name: all[which] for name, all in images.items()}
        )
        self._begin(which, np.full(len(which), Simulator.NEXT_EPISODE))
        self._cameras.draw_again(images, which)
        return last

    def _begin(self, which: NDArray[np.int64], episodes: NDArray[np.int64]) -> None:
        """Begins episodes of the world in the envs `which`; where none is named, the one that the
        task chooses, or the env's own next one."""
        is_named = episodes >= 0
        if self._task is not None:
            episodes = self._task.choose(which, episodes)
        for drawn, chosen in ((False, is_named), (True, ~is_named)):
            begins = np.full(self.simulator.num_envs, Simulator.STAYS, np.int64)
            begins[which[chosen]] = np.where(episodes < 0, Simulator.NEXT_EPISODE, episodes)[chosen]
            if chosen.any():
                self.simulator.reset(begins, drawn=drawn)
        if self._task is not None:
            self._task.begin(which)

    def _measures(self, which: NDArray[np.int64]) -> dict[str, Array]:
        return {} if self._task is None else self._task.measure(which)

    def _logged(self, playing: NDArray[np.bool_]) -> dict[str, Any]:
        """What the task logs of the step, for the envs that are `playing`."""
        if self._task is None or not self._task.logs:
            return {}
        return masked({"log": masked(self._task.logs, playing)}, playing)

    def blank_infos(self) -> dict[str, Any]:
        """The infos of a step in which episodes ended, but none in these envs."""
        nobody = np.empty(0, np.int64)
        return self._infos(
            nobody, None, {**self._measures(nobody), **self._cameras.places_of(nobody)}
        )

    def _infos(
        self, which: NDArray[np.int64], last: Observations, more: Mapping[str, Array]
    ) -> dict[str, Any]:
        """The infos of a step in which the episodes of the envs `which` ended, with these last
        observations, and `more` in final_info. Resets the sums of these envs."""
        sums = self._tally.take_ended()
        ended = sums.pop("ended")
        final_obs = np.full(len(ended), None, object)
        for row, env in enumerate(which):
            final_obs[env] = _row(last, row)
        episode = {"r": sums.pop("r"), "l": sums.pop("l")}
        now = time.perf_counter()
        took = np.where(ended, now - self._began, 0.0)
        self._began[which] = now
        timed = {**{name: values.copy() for name, values in episode.items()}, "t": took}
        final_info: dict[str, Any] = {"episode": masked(episode, ended), **sums, **more}
        return masked(
            {
                "final_obs": final_obs,
                "final_info": masked(final_info, ended),
                "episode": masked(timed, ended),
            },
            ended,
        )


def _unbounded(size: int) -> spaces.Space:
    return spaces.Box(-np.inf, np.inf, (size,), np.float32)


def _image(shape: tuple[int, ...], dtype: Any) -> spaces.Space:
    if np.issubdtype(dtype, np.floating):
        return spaces.Box(0.0, np.inf, shape, np.float32)
    return spaces.Box(0, np.iinfo(dtype).max, shape, dtype)


def _row(observations: Observations, row: int) -> Any:
    if isinstance(observations, dict):
        return {name: values[row] for name, values in observations.items()}
    return observations[row]


def _check_saved(name: str, found: Array | None, mine: Array) -> None:
    """Refuses an array of a saved state whose type or shape is not that of this batch's array."""
    if found is None or found.shape != mine.shape or found.dtype != mine.dtype:
        there = "missing" if found is None else f"{found.dtype} {found.shape}"
        message = f"{name}: found {there}, expected {mine.dtype} {mine.shape}; give what save_state() returned"
        raise Error(ErrorCode.INVALID_INPUT, "saved state", message)
