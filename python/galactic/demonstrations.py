"""Demonstrations: what an expert observed and did in episodes of a world, step by step, in a folder
of arrays.

`python3 -m galactic.demonstrate` makes them, and a DemonstrationWriter records them from your own
policies. `python3 -m galactic.train --demonstrations` learns from them, and numpy can read them:

    demonstrations.json     their description: About
    part-000000/            E episodes, one after the other, L steps in all
        episodes.npy        int32 [E]    index of each episode in the world
        lengths.npy         int32 [E]    number of steps of each
        endings.npy         uint8 [E]    how each ended, an EpisodeEnd
        state.npy           float32 [L + E, S]    the observations before each step, and those
                                              after the last step of each episode
        rgb.npy             uint8 [L + E, height, width, 3]    color images, if there are any
        depth.npy           float16 [L + E, height, width]    depth images, if there are any, meters
        actions.npy         float32 [L, A]    the action in each step, as Simulator.step() takes it
        by_expert.npy       bool [L]    whether the expert chose it; a learner may have acted before
        rewards.npy         float32 [L]    the reward of each step

A part appears completely or not at all.
"""

from __future__ import annotations

import dataclasses
import functools
import json
import pathlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, overload

import numpy as np

from galactic._core import EpisodeEnd, ErrorCode
from galactic.errors import Error

INDEX = "demonstrations.json"
FORMAT = 2

_REMEDY = (
    "remove the folder of this part: the others are read without it, and galactic.demonstrate, if it has made them, "
    "makes what is missing"
)

_OF_EPISODES: Mapping[str, Any] = {"episodes": np.int32, "lengths": np.int32, "endings": np.uint8}
_OF_STEPS: Mapping[str, Any] = {
    "state": np.float32,
    "rgb": np.uint8,
    "depth": np.float16,
    "actions": np.float32,
    "by_expert": np.bool_,
    "rewards": np.float32,
}
# Of these arrays, an episode has one row more than it has steps.
OBSERVED = ("state", "rgb", "depth")


@dataclasses.dataclass(frozen=True, eq=False)
class Demonstration:
    """One episode of L steps. Arrays of a Demonstrations are read-only views of its files."""

    episode: int
    """Index of the episode in the world."""
    ending: EpisodeEnd
    state: np.ndarray
    """float32 [L + 1, S]: the row of observations before each step, and the one after the last
    step."""
    actions: np.ndarray
    """float32 [L, A]: the action in each step, as Simulator.step() takes it."""
    by_expert: np.ndarray
    """bool [L]: whether the expert chose the action."""
    rewards: np.ndarray
    """float32 [L]: the reward of each step."""
    rgb: np.ndarray | None = None
    """uint8 [L + 1, height, width, 3], if there are color images."""
    depth: np.ndarray | None = None
    """float16 [L + 1, height, width], meters, if there are depth images."""

    def __len__(self) -> int:
        return len(self.rewards)

    @property
    def is_solved(self) -> bool:
        """Whether the episode ended in success."""
        return self.ending == EpisodeEnd.SUCCESS


@dataclasses.dataclass(frozen=True)
class About:
    """What the demonstrations in a folder are."""

    world: str
    """The world pack."""
    episodes: int | None
    """How many of the world's episodes the folder should have, each once; None if episodes may have
    been played several times."""
    expert: str
    """Who acts: `scripted`, a policy's file, or the `expert` that was given to a
    DemonstrationWriter."""
    parts: list[tuple[str, int]]
    """Names and sizes of the parts of a row of observations, in order."""
    options: dict[str, Any]
    """Keywords of galactic.VectorEnv that give the same observations."""
    camera: dict[str, Any] | None
    """The `images` options of galactic.VectorEnv that give the same images except for noise; None
    without images."""
    meanings: dict[str, Any]
    """Options of the simulation that decide what the numbers in these parts mean."""
    images: dict[str, tuple[int, ...]]
    """Shapes of an env's rgb and depth images; either or both may be missing."""
    motions: int
    """Number of continuous elements of an action; hand and terminate follow them."""
    made_with: dict[str, Any]
    """Everything else on which the demonstrations depend."""

    @property
    def state_size(self) -> int:
        return sum(size for _, size in self.parts)

    @property
    def shapes(self) -> dict[str, tuple[int, ...]]:
        """Shapes of the arrays for each step, by name. Those in OBSERVED have one more row after
        the last step."""
        return {
            "state": (self.state_size,),
            "actions": (self.motions + 2,),
            "by_expert": (),
            "rewards": (),
            **self.images,
        }


class Demonstrations(Sequence[Demonstration]):
    """The episodes of a folder of demonstrations in the order of the world, or those of several
    folders, one folder after the other.

    Raises Error if a folder holds no demonstrations, or others than it declares, or if folders have
    other observations, cameras or actions than the first one. A folder in which not all episodes
    have been made yet contributes those that exist.
    """

    def __init__(self, folder: str | pathlib.Path, *more: str | pathlib.Path) -> None:
        self.folders = [pathlib.Path(one) for one in (folder, *more)]
        self.abouts = [read_about(one) for one in self.folders]
        """The description of each folder."""
        self._parts: list[_Part] = []
        for number, (one, about) in enumerate(zip(self.folders, self.abouts)):
            if one.resolve() in [other.resolve() for other in self.folders[:number]]:
                raise Error(ErrorCode.INVALID_INPUT, str(one), "is named twice; name it once")
            require_alike(self.about, about, one)
            parts = [_Part(about, part) for part in parts_in(one)]
            _require_once(parts, about, one)
            self._parts += parts
        # The part that each episode is in, and the episode's index in it.
        self._places = [(part, n) for part in self._parts for n in range(len(part.lengths))]
        self._ends = np.cumsum([part.steps for part in self._parts], dtype=np.int64)
        self.lengths = _joined([part.lengths for part in self._parts], np.int32)
        """int32 [episodes]: number of steps of each."""
        self.endings = _joined([part.endings for part in self._parts], np.uint8)
        """uint8 [episodes]: how each ended, as a number of EpisodeEnd."""
        self.first_rows = np.cumsum(self.lengths, dtype=np.int64) - self.lengths
        """int64 [episodes]: index of each episode's first step among the steps of all episodes."""

    @property
    def about(self) -> About:
        """The first folder's description; observations and actions are the same in all folders."""
        return self.abouts[0]

    @property
    def steps(self) -> int:
        """Number of steps of all episodes together."""
        return int(self.lengths.sum())

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

    def take(self, name: str, rows: Any, *, after: bool = False) -> np.ndarray:
        """Rows of an array of Demonstration, as a copy of shape [*rows.shape, ...]. `rows`: indices
        among the steps of all episodes together, from 0 to `steps` - 1 (first_rows). `after`: what
        was observed after these steps instead of before them; it belongs to the same episode."""
        wanted = np.asarray(rows)
        if wanted.size and wanted.dtype.kind not in "iu":
            raise TypeError(
                f"rows are {wanted.dtype}, expected whole numbers from 0 to {self.steps - 1}"
            )
        flat = wanted.ravel().astype(np.int64)
        if flat.size and not 0 <= flat.min() <= flat.max() < self.steps:
            raise IndexError(f"rows are from {flat.min()} to {flat.max()}, of {self.steps} steps")
        shapes = self.about.shapes
        if name not in shapes:
            raise KeyError(f"found {name!r}, expected one of {', '.join(shapes)}")
        if after and name not in OBSERVED:
            raise KeyError(f"found {name!r} after steps, expected one of {', '.join(OBSERVED)}")
        taken = np.empty((flat.size, *shapes[name]), _OF_STEPS[name])
        parts = np.searchsorted(self._ends, flat, side="right")
        for number in np.unique(parts):
            part, chosen = self._parts[number], parts == number
            steps = flat[chosen] - (self._ends[number] - part.steps)
            taken[chosen] = part.array(name)[part.places(name, steps) + after]
        if name == "depth" and not np.isfinite(taken).all():
            raise Error(
                ErrorCode.INVALID_INPUT,
                f"{', '.join(map(str, self.folders))}: depth.npy",
                f"holds numbers that are not finite; {_REMEDY}",
            )
        return taken.reshape(*wanted.shape, *shapes[name])

    def __repr__(self) -> str:
        places = ", ".join(map(str, self.folders))
        return f"<galactic.Demonstrations of {len(self)} episodes in {places}>"


def require_alike(wanted: About, found: About, folder: pathlib.Path) -> None:
    """Raises Error if the observations, cameras or actions found in a folder are not those
    wanted."""
    for name in ("motions", "parts", "meanings", "images"):
        _require_equal(folder, name, getattr(found, name), getattr(wanted, name))
    ones, others = found.camera or {}, wanted.camera or {}
    for name in dict.fromkeys([*ones, *others]):
        _require_equal(folder, f"camera: {name}", ones.get(name), others.get(name))


def _require_equal(folder: pathlib.Path, name: str, found: Any, wanted: Any) -> None:
    # JSON knows no tuples.
    if json.dumps(found) != json.dumps(wanted):
        message = (
            f"found {name} {found}, expected {wanted}; give both the same robot, --preset, --simulation, "
            "--network and camera"
        )
        raise Error(ErrorCode.INVALID_INPUT, str(folder / INDEX), message)


def _require_once(parts: list[_Part], about: About, folder: pathlib.Path) -> None:
    """Raises Error if parts have an episode twice, or more episodes than declared."""
    episodes = _joined([part.episodes for part in parts], np.int32)
    if about.episodes is None:
        return
    if len(episodes) > about.episodes or len(set(episodes.tolist())) < len(episodes):
        message = (
            f"holds {len(episodes)} episodes, some of them twice or more than the {about.episodes} that "
            f"{INDEX} says; remove the parts that do not belong there"
        )
        raise Error(ErrorCode.INVALID_INPUT, str(folder), message)


def parts_in(folder: pathlib.Path) -> list[pathlib.Path]:
    """The parts that are complete, in order."""
    return sorted(folder.glob("part-[0-9][0-9][0-9][0-9][0-9][0-9]"))


def part_folder(folder: pathlib.Path, number: int) -> pathlib.Path:
    return folder / f"part-{number:06d}"


def arrays_of(episodes: Sequence[Demonstration]) -> Iterator[tuple[str, np.ndarray]]:
    """The arrays of a part, with the names of their files, one after the other."""
    of_episodes = {
        "episodes": [one.episode for one in episodes],
        "lengths": [len(one) for one in episodes],
        "endings": [int(one.ending) for one in episodes],
    }
    for name, numbers in of_episodes.items():
        yield name, np.array(numbers, _OF_EPISODES[name])
    for name, kind in _OF_STEPS.items():
        if getattr(episodes[0], name) is not None:
            joined = np.concatenate([getattr(one, name) for one in episodes])
            yield name, joined.astype(kind, copy=False)


class _Part:
    """The files of a part, checked. Arrays of steps are mapped into memory when they are used."""

    def __init__(self, about: About, folder: pathlib.Path) -> None:
        self._folder = folder
        self._shapes = about.shapes
        self.episodes = np.array(self._load("episodes", np.int32, (None,)))
        count = len(self.episodes)
        self.lengths = np.array(self._load("lengths", np.int32, (count,)))
        self.endings = np.array(self._load("endings", np.uint8, (count,)))
        if count == 0 or self.lengths.min() < 1:
            raise _invalid(folder / "lengths.npy", "holds episodes without steps")
        known = [int(end) for end in EpisodeEnd]
        strange = np.setdiff1d(self.endings, known)
        if len(strange) > 0:
            message = (
                f"holds {strange[0]}, expected numbers of EpisodeEnd: {', '.join(map(str, known))}"
            )
            raise _invalid(folder / "endings.npy", message)
        self._bounds = np.concatenate([[0], np.cumsum(self.lengths, dtype=np.int64)])
        self.steps = int(self._bounds[-1])
        for name in self._shapes:
            array = self.array(name)
            if name in ("state", "rewards") and not np.isfinite(array).all():
                raise _invalid(folder / f"{name}.npy", "holds numbers that are not finite")
            if name == "actions" and not (np.abs(array) <= 1).all():
                raise _invalid(folder / f"{name}.npy", "holds numbers that are not from -1 to 1")

    def array(self, name: str) -> np.ndarray:
        """The array of all steps of the part, including what was observed after each episode's last
        step."""
        rows = self.steps + (len(self.episodes) if name in OBSERVED else 0)
        return self._load(name, _OF_STEPS[name], (rows, *self._shapes[name]))

    def places(self, name: str, steps: np.ndarray) -> np.ndarray:
        """The rows of that array in which these steps of the part are."""
        if name not in OBSERVED:
            return steps
        # Before a step, there are as many last observations as earlier episodes.
        return steps + np.searchsorted(self._bounds, steps, side="right") - 1

    def episode(self, number: int) -> Demonstration:
        first, end = self._bounds[number], self._bounds[number + 1]
        arrays = {
            name: self.array(name)[first + number : end + number + 1]
            if name in OBSERVED
            else self.array(name)[first:end]
            for name in self._shapes
        }
        ending = EpisodeEnd(int(self.endings[number]))
        return Demonstration(int(self.episodes[number]), ending, **arrays)

    def _load(self, name: str, kind: Any, shape: tuple[int | None, ...]) -> np.ndarray:
        """An array of this type and shape; None stands for any size."""
        file = self._folder / f"{name}.npy"
        try:
            seen = file.stat()
        except OSError as error:
            message = f"cannot be read: {error.strerror}; {_REMEDY}"
            raise Error(ErrorCode.IO, str(file), message) from None
        array = _mapped(file, seen.st_ino, seen.st_mtime_ns)
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


# A mapped file is an open file, of which a process may have about a thousand.
@functools.lru_cache(maxsize=256)
def _mapped(file: pathlib.Path, inode: int, changed: int) -> Any:
    """The content of a file, unless it has been replaced since."""
    try:
        return np.load(file, mmap_mode="r", allow_pickle=False)
    except OSError as error:
        message = f"cannot be read: {error.strerror or error}; {_REMEDY}"
        raise Error(ErrorCode.IO, str(file), message) from None
    except Exception as error:  # numpy raises whatever its readers do
        raise _invalid(file, f"is no array of numpy: {error}") from None


def read_about(folder: pathlib.Path) -> About:
    """The description of a folder. Raises Error if it has none."""
    file = folder / INDEX
    try:
        text = file.read_text(encoding="utf-8")
    except OSError as error:
        message = (
            f"cannot be read: {error.strerror}; name a folder that galactic.demonstrate has made, or a "
            "DemonstrationWriter"
        )
        raise Error(ErrorCode.IO, str(file), message) from None
    except UnicodeDecodeError:
        text = ""
    return about_of(text, file)


def about_of(text: str, file: pathlib.Path) -> About:
    """Reads what text_of() wrote; `file` is for messages."""
    try:
        values = json.loads(text)
        _require_types(values, {"format": int, **_ABOUT})
        form = values.pop("format")
        if form != FORMAT:
            raise ValueError(
                f"has format {form}, expected {FORMAT}, in which each episode has its last observation"
            )
        _require_types(values["made_with"], {"settings": dict, "sha256": dict})
        about = About(**values)
        if not set(about.images) <= {"rgb", "depth"}:
            raise ValueError(f"found images {', '.join(about.images)}, expected rgb and depth")
        return dataclasses.replace(
            about,
            parts=[(str(name), _size(size)) for name, size in about.parts],
            images={name: tuple(map(_size, shape)) for name, shape in about.images.items()},
            motions=_size(about.motions),
            episodes=None if about.episodes is None else _size(about.episodes),
        )
    except (ValueError, TypeError, RecursionError) as error:
        message = f"does not say what the demonstrations are: {error}; make them again, elsewhere"
        raise Error(ErrorCode.INVALID_INPUT, str(file), message) from None


# The JSON types of About's fields.
_ABOUT = {
    "world": str,
    "episodes": (int, type(None)),
    "expert": str,
    "parts": list,
    "options": dict,
    "camera": (dict, type(None)),
    "meanings": dict,
    "images": dict,
    "motions": int,
    "made_with": dict,
}


def _require_types(values: Any, types: Mapping[str, Any]) -> None:
    for name, kind in types.items():
        found = values.get(name, "nothing") if isinstance(values, dict) else "nothing"
        if not isinstance(found, kind) or isinstance(found, bool):
            raise ValueError(f"{name}: found {found!r}, which is of another type")


def text_of(about: About) -> str:
    """The text that read_about() reads."""
    return json.dumps({"format": FORMAT, **dataclasses.asdict(about)}, indent=2) + "\n"


def _size(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 1 << 31:
        raise ValueError(f"found {value!r}, expected a number of something")
    return value


def _invalid(file: pathlib.Path, fault: str) -> Error:
    return Error(ErrorCode.INVALID_INPUT, str(file), f"{fault}; {_REMEDY}")


def _joined(arrays: list[np.ndarray], kind: Any) -> np.ndarray:
    return np.concatenate(arrays) if arrays else np.zeros(0, kind)
