"""Keeps what is seen and done in a VectorEnv, episode by episode, as demonstrations."""

from __future__ import annotations

import os
import pathlib
import shutil
from collections.abc import Iterable, Mapping, Sequence
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic import demonstrations, files, spaces
from galactic._core import EpisodeEnd, ErrorCode, Renderer
from galactic.demonstrations import OBSERVED, About, Demonstration
from galactic.errors import Error
from galactic.batch_part import Observations
from galactic.cameras import stands_in_world
from galactic.sensors import meaning_of
from galactic.vector_env import VectorEnv
from galactic.vector_env_arguments import Actions

EPISODES_OF_PART = 256
EPISODES_WITH_IMAGES = 64
"""How many make a part: what an interrupt may cost, and what memory has to hold at a time."""

# What a VectorEnv says itself, and no option of its simulators.
_OF_VECTOR_ENV = ("envs", "seed", "order", "rank", "ranks", "auto_reset", "body_transforms")
# Options of a Renderer by which images are alike, but for their noise.
_CAMERA = (
    "color",
    "camera",
    "fov_degrees",
    "position",
    "rpy_degrees",
    "near",
    "width",
    "height",
)


class DemonstrationWriter:
    """Writes episodes that a policy of one's own plays in `env` to a folder, for galactic.Demonstrations and
    `galactic.train --demonstrations`:

        with DemonstrationWriter("mine", env, expert="my policy") as writer:
            seen, _ = env.reset()
            while len(writer) < 1000:
                actions = policy(seen)
                then, rewards, _, _, infos = env.step(actions)
                writer.add(seen, actions, rewards, infos)
                seen = then

    Episodes are kept when they end. Left out are those of which the beginning was not added, and those that env has
    broken off, by reset() or by a state that was set or restored, or goes on with since.

    Args:
        folder: where to; it holds no demonstrations yet.
        env: where they are played, without images or with those of one camera without a name.
        expert: who acts, for those who read it.
        world: the path of the world's pack, for those who read it.
    """

    def __init__(
        self,
        folder: str | os.PathLike,
        env: VectorEnv,
        *,
        expert: str,
        world: str | os.PathLike = "",
    ) -> None:
        about = _about(env, expert, os.fspath(world))
        self._folder = pathlib.Path(folder)
        files.require_folder(self._folder)
        self._folder.mkdir(parents=True, exist_ok=True)
        index = self._folder / demonstrations.INDEX
        if index.exists() or demonstrations.parts_in(self._folder):
            message = "holds demonstrations already; choose another folder"
            raise Error(ErrorCode.INVALID_INPUT, str(self._folder), message)
        text = demonstrations.text_of(about)
        files.write_atomically(index, lambda handle: handle.write(text), "w")
        self._env, self._about = env, about
        is_of_the_paper = isinstance(env.single_action_space, spaces.Dict)
        count = env.simulators[0].action_count
        self._actions = Actions("paper" if is_of_the_paper else "box", count)
        self._recorder = EpisodeRecorder(env.observation_parts)
        self._size = EPISODES_WITH_IMAGES if about.images else EPISODES_OF_PART
        self._broken_off = env.broken_off
        self._kept: list[Demonstration] = []
        self._parts = 0
        self._count = 0

    def __len__(self) -> int:
        """How many episodes there are so far."""
        return self._count

    def add(
        self,
        observations: Observations,
        actions: Any,
        rewards: NDArray[np.floating],
        infos: Mapping[str, Any],
        by_expert: NDArray[np.bool_] | None = None,
    ) -> None:
        """Takes in a step of all envs: what was seen before it, what was done, and what env.step() said of it.
        Arrays may be overwritten afterwards; of an env without copies, keep a copy of what was seen.

        Actions outside of -1 to 1 are kept clamped, as the simulation takes them. Raises TypeError for what is no
        array of numbers, and ValueError for one of another shape or with numbers that are not finite in an env that
        plays; nothing of the step is kept then.

        `by_expert`: bool (num_envs,), in which envs the expert acted; None: in all.
        """
        self._require_infos(infos)
        count = self._env.num_envs
        rows = self._actions.rows(actions, count)
        idle = np.concatenate([simulator.idle for simulator in self._env.simulators])
        # Those that were before it: an env may be idle once its last episode has ended.
        playing = ~idle | infos.get("_final_obs", False)
        seen = self._seen("observations", observations, (count,))
        with np.errstate(over="ignore"):  # what is too large is infinite, and refused
            paid = _array_of("rewards", rewards, (count,)).astype(np.float32, copy=False)
        if by_expert is not None:
            _array_of("by_expert", by_expert, (count,), np.bool_)
        for name, one in {"actions": rows, "rewards": paid}.items():
            _require_finite(name, one, playing)
        for name, one in seen.items():
            _require_finite(f"observations: {name}", one, playing)
        for env in np.flatnonzero(playing & infos.get("_final_obs", False)).tolist():
            for name, one in self._seen("final_obs", infos["final_obs"][env], ()).items():
                _require_finite(f"final_obs: {name}", one[np.newaxis], np.ones(1, np.bool_))
        broken_off = self._env.broken_off
        self._recorder.forget(np.flatnonzero(broken_off != self._broken_off))
        self._broken_off = broken_off
        self._recorder.before_step(seen, rows, by_expert, playing)
        ended = self._recorder.after_step(paid, infos)
        self._kept += ended
        self._count += len(ended)
        while len(self._kept) >= self._size:
            self._write(self._kept[: self._size])
            del self._kept[: self._size]

    def close(self) -> None:
        """Writes the episodes that have ended since the last part."""
        if self._kept:
            self._write(self._kept)
            self._kept = []

    def __enter__(self) -> DemonstrationWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _require_infos(self, infos: Any) -> None:
        """Raises where they are not those of a step."""
        if not isinstance(infos, Mapping):
            message = f"infos has the type {type(infos).__name__}, expected the dictionary that env.step() returned"
            raise TypeError(message)
        missing = {"_final_info", "final_obs", "_final_obs"} - infos.keys()
        if "final_info" in infos and missing:
            raise ValueError(
                f"infos has final_info and no {', '.join(sorted(missing))}; give it as env.step() returned it"
            )

    def _seen(self, name: str, observations: Any, envs: tuple[int, ...]) -> dict[str, NDArray[Any]]:
        """What is kept of observations, of so many envs or of one, if they have the shapes of env's."""
        wanted: dict[str, tuple[int, ...]] = {"state": (self._about.state_size,)}
        wanted.update(self._about.images)
        if isinstance(observations, Mapping):
            parts = ["state"] if "state" in observations else list(self._env.observation_parts)
            missing = [part for part in (*parts, *self._about.images) if part not in observations]
            if missing:
                raise ValueError(f"{name} has no {', '.join(missing)}; give it as env returned it")
            for part in parts if parts != ["state"] else ():
                place = self._env.observation_parts[part]
                _array_of(f"{name}: {part}", observations[part], (*envs, place.stop - place.start))
        elif self._about.images:
            found = type(observations).__name__
            raise TypeError(
                f"{name} has the type {found}, expected a dictionary with {', '.join(wanted)}"
            )
        seen = self._recorder.seen(observations)
        return {
            kind: _array_of(f"{name}: {kind}", seen[kind], (*envs, *shape))
            for kind, shape in wanted.items()
        }

    def _write(self, episodes: Sequence[Demonstration]) -> None:
        write_part(demonstrations.part_folder(self._folder, self._parts), episodes)
        self._parts += 1


class EpisodeRecorder:
    """Makes demonstrations of what is seen and done in many envs. `parts`: VectorEnv.observation_parts."""

    def __init__(self, parts: Mapping[str, slice]) -> None:
        self._parts = parts
        # Of each env, what its steps had, by name: of the episode under way, and of what was before a reset.
        self._under_way: dict[int, dict[str, list[Any]]] = {}
        self._playing = np.zeros(0, np.int64)

    def before_step(
        self,
        observations: Observations,
        actions: NDArray[np.float32],
        by_expert: NDArray[np.bool_] | None,
        playing: NDArray[np.bool_],
    ) -> None:
        """Before a step: what is seen and about to be done, rows of all envs, of which those count that are
        `playing`."""
        self._playing = np.flatnonzero(playing)
        rows = {**self.seen(observations), "actions": _as_executed(actions)}
        rows["by_expert"] = np.ones(len(playing), np.bool_) if by_expert is None else by_expert
        for env in self._playing.tolist():
            kept = self._under_way.setdefault(env, {})
            for name, row in rows.items():
                kept.setdefault(name, []).append(row[env].copy())

    def after_step(
        self, rewards: NDArray[np.floating], infos: Mapping[str, Any]
    ) -> list[Demonstration]:
        """After it: what it paid, and VectorEnv's infos. Returns the episodes that it ended."""
        for env in self._playing.tolist():
            self._under_way[env].setdefault("rewards", []).append(rewards[env])
        if "final_info" not in infos:
            return []
        ended = np.intersect1d(np.flatnonzero(infos["_final_info"]), self._playing)
        found = [self._ended(env, infos) for env in ended.tolist()]
        return [one for one in found if one is not None]

    def forget(self, envs: Iterable[int]) -> None:
        """Drops the episodes under way in these envs."""
        for env in envs:
            self._under_way.pop(int(env), None)

    def _ended(self, env: int, infos: Mapping[str, Any]) -> Demonstration | None:
        """The episode that ended in an env; None where its beginning is not known."""
        kept, final = self._under_way.pop(env), infos["final_info"]
        length = int(final["episode"]["l"][env])
        if len(kept["rewards"]) < length:
            return None
        last = self.seen(infos["final_obs"][env])
        arrays = {
            name: np.stack([*rows[-length:], last[name]] if name in OBSERVED else rows[-length:])
            for name, rows in kept.items()
        }
        episode = int(final["episode_index"][env])
        return Demonstration(episode, EpisodeEnd(int(final["ending"][env])), **arrays)

    def seen(self, observations: Observations) -> dict[str, NDArray[Any]]:
        """What is kept of observations, of many envs or of one."""
        if not isinstance(observations, Mapping):
            return {"state": np.asarray(observations)}
        state = observations.get("state")
        if state is None:
            state = np.concatenate([observations[name] for name in self._parts], axis=-1)
        seen = {"state": state}
        if "rgb" in observations:
            seen["rgb"] = observations["rgb"]
        if "depth" in observations:
            seen["depth"] = np.asarray(observations["depth"]).astype(np.float16, copy=False)
        return seen


def _array_of(name: str, given: Any, shape: tuple[int, ...], kind: Any = None) -> NDArray[Any]:
    """`given` as an array. Raises where it is of another type, of another shape, or of no numbers."""
    found = np.asarray(given)
    if found.dtype.kind not in "biuf" or (kind is not None and found.dtype != kind):
        wanted = "numbers, such as float32" if kind is None else np.dtype(kind).name
        raise TypeError(f"{name} has the type {found.dtype}, expected {wanted}")
    if found.shape != shape:
        raise ValueError(f"{name} has the shape {found.shape}, expected {shape}")
    return found


def _require_finite(name: str, rows: NDArray[Any], playing: NDArray[np.bool_]) -> None:
    """Raises ValueError for rows of envs that play with numbers that are none."""
    if rows.dtype.kind != "f":
        return
    wrong = playing & ~np.isfinite(rows).reshape(len(rows), -1).all(1)
    if wrong.any():
        raise ValueError(
            f"{name} has numbers that are not finite (NaN or infinite), first in env {int(np.argmax(wrong))}; nothing "
            "of this step was kept"
        )


def _as_executed(actions: NDArray[np.float32]) -> NDArray[np.float32]:
    """As the simulation takes them: samples of a policy may be outside of its limits."""
    return np.clip(np.nan_to_num(actions, nan=0.0), -1.0, 1.0)


def _about(env: VectorEnv, expert: str, world: str) -> About:
    first = env.simulators[0]
    renderer = env.renderers[0] if env.renderers else None
    if isinstance(renderer, Mapping):
        raise ValueError(
            f"env has the cameras {', '.join(renderer)}, expected one without a name: images={{...}}"
        )
    shapes = {} if renderer is None else renderer.shapes
    parts = [(name, part.stop - part.start) for name, part in env.observation_parts.items()]
    options = {name: one for name, one in first.options.items() if name not in _OF_VECTOR_ENV}
    if env.has_own_task:
        del options["task"]  # of which VectorEnv takes the class
    return About(
        world=world,
        episodes=None,
        expert=expert,
        parts=parts,
        options=options,
        camera=None if renderer is None else _camera_of(env.images or {}),
        meanings=meaning_of((name for name, _ in parts), first.options),
        images={name: shape for name, (shape, _) in shapes.items() if name in ("rgb", "depth")},
        motions=first.action_count - 2,
        made_with={"settings": {}, "sha256": {}},
    )


def _camera_of(images: Mapping[str, Any]) -> dict[str, Any]:
    """Options of a camera, those of _CAMERA, as JSON has them."""
    given = {**Renderer.DEFAULTS, **images}
    if given["color"] not in ("rgb", None):
        raise ValueError(f"env draws {given['color']!r}, expected images with color='rgb' or None")
    camera: dict[str, Any] = {}
    names = list(_CAMERA)
    if stands_in_world(given):
        place = np.asarray(given["world_from_camera"], np.float32)
        if place.ndim != 2:
            raise ValueError(
                "env has a world_from_camera for each env, expected one for all: demonstrations have one camera"
            )
        camera["world_from_camera"] = place.tolist()
        names = [name for name in _CAMERA if name not in ("camera", "position", "rpy_degrees")]
    if not given["robot"]:
        camera["robot"] = False
    for name in names:
        value, default = given[name], Renderer.DEFAULTS[name]
        if isinstance(default, tuple):
            camera[name] = [float(one) for one in value]
        else:
            camera[name] = None if value is None else type(default)(value)
    return camera


def write_part(part: pathlib.Path, episodes: Sequence[Demonstration]) -> None:
    """Writes a part, which appears whole."""
    unfinished = part.with_name(f".{part.name}.unfinished")
    try:
        shutil.rmtree(unfinished, ignore_errors=True)
        unfinished.mkdir()
        for name, array in demonstrations.arrays_of(episodes):
            _write_array(unfinished / f"{name}.npy", array)
        files.sync(unfinished)
        os.replace(unfinished, part)
        files.sync(part.parent)
    except OSError as error:
        raise files.unwritable(part, error) from None
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)


def _write_array(file: pathlib.Path, array: np.ndarray) -> None:
    """As numpy.save() does, which does not say why a disk takes no more."""
    with open(file, "wb") as handle:
        header = np.lib.format.header_data_from_array_1_0(array)
        np.lib.format.write_array_header_1_0(handle, header)
        handle.write(array.view(np.uint8).data)
    files.sync(file)
