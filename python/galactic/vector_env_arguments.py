"""Reads the arguments of a VectorEnv, and refuses invalid ones before anything happens."""

from __future__ import annotations

import numbers
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic import spaces
from galactic._core import ErrorCode, Renderer, Simulator
from galactic.errors import Error
from galactic.task import Task

Array = NDArray[Any]

#: Options of a Simulator that a VectorEnv does not have, and what to do instead.
_NO_OPTIONS = {
    "envs": "give num_envs",
    "auto_reset": "its envs begin the next episode by themselves, those of a Simulator need not",
    "autoreset_mode": "it is SAME_STEP; a Simulator with auto_reset=False leaves envs where episodes end",
}
_OF_THE_PAPER = 'a dictionary of "continuous" and "discrete": actions="paper"'


def require(holds: bool, name: str, found: object, wanted: str) -> None:
    """Raises ValueError for an argument that is not as expected."""
    if not holds:
        raise ValueError(f"{name} is {found!r}, expected {wanted}")


def require_envs(num_envs: Any, halves: int) -> None:
    """Raises ValueError if there cannot be this number of envs."""
    is_whole = isinstance(num_envs, numbers.Integral) and not isinstance(num_envs, bool)
    require(is_whole and num_envs > 0, "num_envs", num_envs, "a whole number above 0")
    require(num_envs % halves == 0, "num_envs", num_envs, "an even number for two halves")


def require_simulator_options(options: Mapping[str, Any]) -> None:
    """Raises TypeError for options that a VectorEnv sets itself, or takes elsewhere."""
    for name, value in options.items():
        instead = _NO_OPTIONS.get(name)
        if name in Renderer.OPTIONS:
            instead = f"give images={{{name!r}: {value!r}}}"
        if instead is not None:
            raise TypeError(f"VectorEnv has no option {name}; {instead}")


def own_task_of(task: Any) -> Callable[[], Task] | None:
    """The function that makes the task, if it is one's own; None if `task` names one of the
    simulation's."""
    if isinstance(task, Task):
        name = type(task).__name__
        raise TypeError(f"task is a {name}; give what makes one for each half, such as the class")
    return task if callable(task) else None


def progress_of(value: Any, is_evaluation: bool) -> float:
    """VectorEnv.progress as it was set. Raises ValueError for invalid values."""
    is_number = isinstance(value, numbers.Real) and not isinstance(value, bool)
    require(is_number and 0.0 <= value <= 1.0, "progress", value, "a number from 0 to 1")
    is_its_own = not is_evaluation or value == 1.0
    require(is_its_own, "progress", value, "1, as this env is an evaluation")
    return float(value)


def env_numbers(envs: Iterable[int], count: int) -> NDArray[np.int64]:
    """Numbers of some of `count` envs. Raises TypeError or IndexError for anything else."""
    found = np.asarray(envs if isinstance(envs, np.ndarray) else list(envs))
    is_list = found.ndim == 1 and (found.dtype.kind in "iu" or not found.size)
    if not is_list:
        raise TypeError(
            f"envs are {found.dtype} {found.shape}, expected numbers of envs, such as [0, 3]; "
            "numpy.flatnonzero(mask) has those of a mask"
        )
    wrong = found[(found < 0) | (found >= count)]
    if len(wrong):
        raise IndexError(f"there is no env {wrong[0]}, the last is {count - 1}")
    return found.astype(np.int64)


def distinct_envs(envs: Iterable[int], count: int) -> NDArray[np.int64]:
    """The same for envs to which something is restored. Raises Error if an env is named twice."""
    found = env_numbers(envs, count)
    numbers, times = np.unique(found, return_counts=True)
    if len(numbers) < len(found):
        twice = numbers[times > 1][0]
        raise Error(ErrorCode.INVALID_INPUT, "envs", f"has env {twice} twice, expected each once")
    return found


class Actions:
    """Actions as VectorEnv(actions=kind) takes them, for robots with `count` actions."""

    def __init__(self, kind: str, count: int) -> None:
        self._is_of_the_paper = kind == "paper"
        self._count = count

    @property
    def space(self) -> spaces.Space:
        """The action space of one env."""
        if not self._is_of_the_paper:
            return spaces.Box(-1.0, 1.0, (self._count,), np.float32)
        motions = spaces.Box(-1.0, 1.0, (self._count - 2,), np.float32)
        return spaces.Dict({"continuous": motions, "discrete": spaces.MultiDiscrete([2, 2])})

    def rows(self, given: Any, envs: int) -> NDArray[np.float32]:
        """The actions `given` for this number of envs, as the simulator takes them: (envs, count).
        Raises an exception if they have another shape or type."""
        if not self._is_of_the_paper:
            return _rows_of("actions", given, (envs, self._count))
        if not isinstance(given, Mapping):
            found = type(given).__name__
            raise TypeError(f"actions has the type {found}, expected {_OF_THE_PAPER}")
        if not {"continuous", "discrete"} <= given.keys():
            raise ValueError(f"actions has {list(given)}, expected {_OF_THE_PAPER}")
        moves = _rows_of("continuous", given["continuous"], (envs, self._count - 2))
        choices = _rows_of("discrete", given["discrete"], (envs, 2))
        fractions = choices[~(np.isfinite(choices) & (choices == np.trunc(choices)))]
        if len(fractions):
            raise TypeError(f"discrete has {fractions[0]:g}, expected whole numbers: 0 or 1")
        others = choices[(choices != 0) & (choices != 1)]
        if len(others):
            raise ValueError(f"discrete has {others[0]:g}, expected 0 or 1")
        return np.hstack([moves, choices])


def _rows_of(name: str, given: Any, shape: tuple[int, int]) -> NDArray[np.float32]:
    rows = np.asarray(given)
    # numpy would turn these into numbers: text by parsing it, complex numbers by dropping a part,
    # None as NaN.
    if rows.dtype.kind not in "biufO":
        raise TypeError(f"{name} has the type {rows.dtype}, expected numbers, such as float32")
    if rows.dtype.kind == "O":
        for one in rows.flat:
            if not isinstance(one, (numbers.Real, np.bool_)):
                raise TypeError(f"{name} has {one!r}, expected numbers, such as float32")
    if rows.shape != shape:
        raise ValueError(f"{name} has the shape {rows.shape}, expected {shape}")
    if rows.dtype == np.float32:
        return rows
    # Numbers may be too large for 32 bits; the simulator's own limits are narrower.
    with np.errstate(over="ignore"):
        return rows.astype(np.float32)


def episodes_to_begin(
    seed: int | None, options: Mapping[str, Any] | None, envs: int
) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Which of this number of envs begin an episode in VectorEnv.reset(seed, options), and which
    episode; Simulator.NEXT_EPISODE where none is named."""
    options = options or {}
    unknown = set(options) - {"reset_mask", "episodes"}
    if unknown:
        raise ValueError(
            f"reset() has no option {unknown.pop()!r}; expected reset_mask or episodes"
        )
    mask, named = options.get("reset_mask"), options.get("episodes")
    if mask is not None and seed is not None:
        raise ValueError("seed and reset_mask exclude each other: a seed is of all envs")
    mask = np.ones(envs, np.bool_) if mask is None else np.asarray(mask)
    if mask.shape != (envs,) or mask.dtype != np.bool_:
        raise ValueError(f"reset_mask is {mask.dtype} {mask.shape}, expected bool ({envs},)")
    episodes = np.full(envs, Simulator.NEXT_EPISODE) if named is None else np.asarray(named)
    if episodes.shape != (envs,) or not np.issubdtype(episodes.dtype, np.integer):
        raise ValueError(f"episodes are {episodes.dtype} {episodes.shape}, expected int ({envs},)")
    if episodes.dtype == np.uint64:
        # Numbers that are too large for signed 64-bit integers must not become negative.
        too_large = episodes[mask & (episodes >= np.uint64(2**63))]
        if len(too_large):
            raise IndexError(f"there is no episode {too_large[0]}")
    chosen = episodes.astype(np.int64)
    return mask, np.where(mask & (chosen >= 0), chosen, Simulator.NEXT_EPISODE)


def check_places(
    out: Mapping[str, Array], known: Mapping[str, tuple[tuple[int, ...], Any]], envs: int
) -> None:
    """Refuses arrays to which results cannot be written, before anything is done."""
    if not isinstance(out, Mapping):
        raise TypeError(f"out is a {type(out).__name__}, expected a dictionary of arrays by name")
    for name, place in out.items():
        if name not in known:
            raise ValueError(f"out has no place for {name!r}; expected any of {list(known)}")
        shape, dtype = known[name]
        if not isinstance(place, np.ndarray) or place.dtype != dtype:
            found = getattr(place, "dtype", type(place).__name__)
            raise TypeError(f"{name} has the type {found}, expected {np.dtype(dtype)}")
        if place.shape != (envs, *shape):
            raise ValueError(f"{name} has the shape {place.shape}, expected {(envs, *shape)}")
        if not place.flags.c_contiguous or not place.flags.writeable:
            fault = "read-only" if place.flags.c_contiguous else "not contiguous"
            raise ValueError(f"{name} is {fault}; results are written in place")
    _check_apart(out)


def _check_apart(out: Mapping[str, Array]) -> None:
    """Refuses arrays that share memory, because one result would overwrite another."""
    spans = sorted(
        (place.__array_interface__["data"][0], place.nbytes, name) for name, place in out.items()
    )
    for (start, size, name), (next_start, next_size, other) in zip(spans, spans[1:]):
        if next_start < start + size and next_size:
            raise ValueError(f"{name} and {other} share memory; give each result its own place")
