"""Demonstrations: what an expert saw and did in episodes of a world, step by step, in a folder of arrays.

`python3 -m galactic.demonstrate` makes them, `python3 -m galactic.train --demonstrations` learns from
them, and numpy reads them:

    demonstrations.json     what they are: About
    part-000000/            some episodes, one after the other: E of them, L steps together
        episodes.npy        int32 [E]    which episode of the world each is
        lengths.npy         int32 [E]    its steps
        endings.npy         uint8 [E]    how it ended, an EpisodeEnd
        state.npy           float32 [L, S]    the row of observations before each step
        rgb.npy             uint8 [L, height, width, 3]    images before it, where there are any
        depth.npy           float16 [L, height, width]    meters
        actions.npy         float32 [L, A]    what was done then, as Simulator.step() takes it
        by_expert.npy       bool [L]    whether the expert did it; before, another one led to a place
        rewards.npy         float32 [L]    what it paid

A part appears whole or not at all.
"""

from __future__ import annotations

import dataclasses
import json
import pathlib
from collections.abc import Sequence
from typing import Any, Optional, overload

import numpy as np

from galactic._core import EpisodeEnd, ErrorCode
from galactic.errors import Error

INDEX = "demonstrations.json"
FORMAT = 1

_OF_EPISODES = {"episodes": np.int32, "lengths": np.int32, "endings": np.uint8}
_OF_STEPS = {
    "state": np.float32,
    "rgb": np.uint8,
    "depth": np.float16,
    "actions": np.float32,
    "by_expert": np.bool_,
    "rewards": np.float32,
}


@dataclasses.dataclass(frozen=True)
class Demonstration:
    """One episode of L steps. Arrays of a Demonstrations are read-only views of its files."""

    episode: int
    """Which one of the world."""
    ending: EpisodeEnd
    state: np.ndarray
    """float32 [L, S]: the row of observations before each step."""
    actions: np.ndarray
    """float32 [L, A]: what was done then, as Simulator.step() takes it."""
    by_expert: np.ndarray
    """bool [L]: whether the expert did it."""
    rewards: np.ndarray
    """float32 [L]: what it paid."""
    rgb: Optional[np.ndarray] = None
    """uint8 [L, height, width, 3], where there are color images."""
    depth: Optional[np.ndarray] = None
    """float16 [L, height, width], meters, where there are depth images."""

    def __len__(self) -> int:
        return len(self.rewards)

    @property
    def is_solved(self) -> bool:
        return self.ending == EpisodeEnd.SUCCESS


@dataclasses.dataclass(frozen=True)
class About:
    """What demonstrations are."""

    world: str
    """The world pack."""
    episodes: int
    """How many of its episodes there are to be."""
    expert: str
    """Who acts: `scripted`, or a policy's file."""
    parts: list[tuple[str, int]]
    """Names and sizes of the parts of a row of observations, in order."""
    options: dict[str, Any]
    """Keywords of galactic.VectorEnv that give the same observations."""
    camera: Optional[dict[str, Any]]
    """Its `images`, that give the same images; None where there are none."""
    meanings: dict[str, Any]
    """Options of the simulation by which numbers of these parts mean one thing or another."""
    images: dict[str, tuple[int, ...]]
    """Shapes of an env's rgb and depth, of one, or of none."""
    motions: int
    """Continuous numbers of an action; grasp and terminate are behind them."""
    made_with: dict[str, Any]
    """All else that they depend on."""

    @property
    def state_size(self) -> int:
        return sum(size for _, size in self.parts)


class Demonstrations(Sequence[Demonstration]):
    """The episodes of a folder of demonstrations in the order of the world, or of several, one after the
    other.

    Raises Error where a folder holds none, or others than it says, and where folders have other
    observations or actions than the first one. Of a folder in which not all have been made yet, it has
    those that are there.
    """

    def __init__(self, *folders: "str | pathlib.Path") -> None:
        self.folders = [pathlib.Path(folder) for folder in folders]
        self.abouts = [read_about(folder) for folder in self.folders]
        """What each folder holds."""
        for folder, about in zip(self.folders[1:], self.abouts[1:]):
            _require_alike(self.abouts[0], about, folder)
        self._parts = [_Part(self.about, part) for one in self.folders for part in parts_in(one)]
        # Which part each episode is in, and as which of its episodes.
        self._places = [(part, n) for part in self._parts for n in range(len(part.lengths))]
        self._ends = np.cumsum([part.steps for part in self._parts], dtype=np.int64)
        self.lengths = _joined([part.lengths for part in self._parts])
        """int32 [episodes]: their steps."""
        self.endings = _joined([part.endings for part in self._parts])
        """uint8 [episodes]: how they ended, as numbers of EpisodeEnd."""
        self.first_rows = np.cumsum(self.lengths, dtype=np.int64) - self.lengths
        """int64 [episodes]: where the steps of each begin, in those of all of them together."""

    @property
    def about(self) -> About:
        """What observations and actions are: the same in all folders."""
        return self.abouts[0]

    def __len__(self) -> int:
        return len(self._places)

    @overload
    def __getitem__(self, index: int) -> Demonstration:
        ...

    @overload
    def __getitem__(self, index: slice) -> list[Demonstration]:
        ...

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self[number] for number in range(*index.indices(len(self)))]
        part, number = self._places[index]
        return part.episode(number)

    def take(self, name: str, rows: np.ndarray) -> np.ndarray:
        """An array of Demonstration at these steps of all of them together (first_rows): shape
        [*rows.shape, ...]. A copy."""
        flat = rows.ravel()
        parts = np.searchsorted(self._ends, flat, side="right")
        taken: Optional[np.ndarray] = None
        for number in np.unique(parts):
            part, chosen = self._parts[number], parts == number
            found = part.arrays[name][flat[chosen] - (self._ends[number] - part.steps)]
            if taken is None:
                taken = np.empty((flat.size, *found.shape[1:]), found.dtype)
            taken[chosen] = found
        assert taken is not None, "no rows"
        return taken.reshape(*rows.shape, *taken.shape[1:])

    def __repr__(self) -> str:
        places = ", ".join(map(str, self.folders))
        return f"<galactic.Demonstrations of {len(self)} episodes in {places}>"


def _require_alike(first: About, about: About, folder: pathlib.Path) -> None:
    for name in ("parts", "meanings", "images", "motions"):
        found, wanted = getattr(about, name), getattr(first, name)
        if found != wanted:
            message = (
                f"found {name} {found}, expected those of the first folder, {wanted}; make both with the same "
                "--preset and --simulation"
            )
            raise Error(ErrorCode.INVALID_INPUT, str(folder / INDEX), message)


def parts_in(folder: pathlib.Path) -> list[pathlib.Path]:
    """The parts that are whole, in order."""
    return sorted(folder.glob("part-[0-9][0-9][0-9][0-9][0-9][0-9]"))


def part_folder(folder: pathlib.Path, number: int) -> pathlib.Path:
    return folder / f"part-{number:06d}"


def arrays_of(episodes: Sequence[Demonstration]) -> dict[str, np.ndarray]:
    """The arrays of a part, by the names of their files."""
    arrays = {
        "episodes": np.array([one.episode for one in episodes]),
        "lengths": np.array([len(one) for one in episodes]),
        "endings": np.array([int(one.ending) for one in episodes]),
    }
    for name in _OF_STEPS:
        if getattr(episodes[0], name) is not None:
            arrays[name] = np.concatenate([getattr(one, name) for one in episodes])
    types: dict[str, Any] = {**_OF_EPISODES, **_OF_STEPS}
    return {name: array.astype(types[name], copy=False) for name, array in arrays.items()}


class _Part:
    """The files of a part, mapped into memory and checked."""

    def __init__(self, about: About, folder: pathlib.Path) -> None:
        self._folder = folder
        self._episodes = self._load("episodes", np.int32, (None,))
        count = len(self._episodes)
        self.lengths = self._load("lengths", np.int32, (count,))
        self.endings = self._load("endings", np.uint8, (count,))
        if count == 0 or self.lengths.min() < 1:
            raise _invalid(folder / "lengths.npy", "holds episodes without steps")
        if not np.isin(self.endings, [int(end) for end in EpisodeEnd.__members__.values()]).all():
            raise _invalid(folder / "endings.npy", "holds numbers that are no EpisodeEnd")
        self._bounds = np.concatenate([[0], np.cumsum(self.lengths, dtype=np.int64)])
        self.steps = steps = int(self._bounds[-1])
        shapes: dict[str, tuple[Optional[int], ...]] = {
            "state": (steps, about.state_size),
            "actions": (steps, about.motions + 2),
            "by_expert": (steps,),
            "rewards": (steps,),
            **{name: (steps, *shape) for name, shape in about.images.items()},
        }
        self.arrays = {name: self._load(name, _OF_STEPS[name], shapes[name]) for name in shapes}
        for name in ("state", "actions", "rewards"):
            if not np.isfinite(self.arrays[name]).all():
                raise _invalid(folder / f"{name}.npy", "holds numbers that are not finite")

    def episode(self, number: int) -> Demonstration:
        rows = slice(self._bounds[number], self._bounds[number + 1])
        arrays = {name: steps[rows] for name, steps in self.arrays.items()}
        return Demonstration(
            int(self._episodes[number]), EpisodeEnd(int(self.endings[number])), **arrays
        )

    def _load(self, name: str, kind: Any, shape: tuple[Optional[int], ...]) -> np.ndarray:
        """An array of this type and shape; None stands for any size."""
        file = self._folder / f"{name}.npy"
        try:
            array = np.load(file, mmap_mode="r", allow_pickle=False)
        except OSError as error:
            raise Error(
                ErrorCode.IO, str(file), f"cannot be read: {error.strerror or error}"
            ) from None
        except Exception as error:  # numpy raises whatever its readers do
            raise _invalid(file, f"is no array of numpy: {error}") from None
        fits = isinstance(array, np.ndarray) and array.dtype == kind and array.ndim == len(shape)
        if not fits or any(w is not None and w != f for w, f in zip(shape, array.shape)):
            found = (
                f"{array.dtype} {list(array.shape)}" if isinstance(array, np.ndarray) else "others"
            )
            wanted = (
                f"{np.dtype(kind)} [{', '.join('any' if w is None else str(w) for w in shape)}]"
            )
            raise _invalid(file, f"found {found}, expected {wanted}")
        return array


def read_about(folder: pathlib.Path) -> About:
    """What the folder holds. Raises Error where it does not say so."""
    file = folder / INDEX
    try:
        text = file.read_text(encoding="utf-8")
    except OSError as error:
        message = (
            f"cannot be read: {error.strerror}; name a folder that galactic.demonstrate has made"
        )
        raise Error(ErrorCode.IO, str(file), message) from None
    except UnicodeDecodeError:
        text = ""
    return about_of(text, file)


def about_of(text: str, file: pathlib.Path) -> About:
    """What text_of() wrote; `file` is for messages."""
    try:
        values = json.loads(text)
        if values.pop("format") != FORMAT:
            raise ValueError(f"expected format {FORMAT}")
        about = About(**values)
        if not isinstance(about.options, dict) or not isinstance(about.camera, (dict, type(None))):
            raise ValueError("options or camera are no keywords")
        if not set(about.images) <= {"rgb", "depth"}:
            raise ValueError(f"found images {', '.join(about.images)}, expected rgb and depth")
        return dataclasses.replace(
            about,
            parts=[(str(name), _size(size)) for name, size in about.parts],
            images={name: tuple(map(_size, shape)) for name, shape in about.images.items()},
            motions=_size(about.motions),
            episodes=_size(about.episodes),
        )
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        message = f"does not say what the demonstrations are: {error}; make them again, elsewhere"
        raise Error(ErrorCode.INVALID_INPUT, str(file), message) from None


def text_of(about: About) -> str:
    """What read_about() reads."""
    return json.dumps({"format": FORMAT, **dataclasses.asdict(about)}, indent=2) + "\n"


def _size(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 1 << 31:
        raise ValueError(f"found {value!r}, expected a number of something")
    return value


def _invalid(file: pathlib.Path, fault: str) -> Error:
    message = (
        f"{fault}; remove its folder, and run galactic.demonstrate again to make what is missing"
    )
    return Error(ErrorCode.INVALID_INPUT, str(file), message)


def _joined(arrays: list[np.ndarray]) -> np.ndarray:
    return np.concatenate(arrays) if arrays else np.zeros(0, np.int32)
