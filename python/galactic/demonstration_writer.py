"""Records what is observed and done in a VectorEnv, episode by episode, as demonstrations."""

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
"""The number of episodes in a part: those that an interrupt may lose, and that memory has to hold
at a time."""

# Options that VectorEnv sets itself, and that do not belong to its simulators' options.
_OF_VECTOR_ENV = ("envs", "seed", "order", "rank", "ranks", "auto_reset", "body_transforms")
# Options of a Renderer that decide what images look like, except for their noise.
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
    """Writes episodes that your policy plays in `env` to a folder, for galactic.Demonstrations and
    `galactic.train --demonstrations`:

        with DemonstrationWriter("mine", env, expert="my policy") as writer:
            seen, _ = env.reset()
            while len(writer) < 1000:
                actions = policy(seen)
                then, rewards, _, _, infos = env.step(actions)
                writer.add(seen, actions, rewards, infos)
                seen = then

    Episodes are recorded when they end. An episode is left out if its beginning was not added, or
    if env broke it off with reset() or by setting or restoring a state. An episode that continues
    from such a state is also left out.

    Args:
        folder: where to write; it must not hold demonstrations yet.
        env: where the episodes are played, without images or with the images of one camera without
            a name.
        expert: who acts, as information for readers.
        world: the path of the world's pack, as information for readers.
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
        """The number of episodes so far."""
        return self._count

    def add(
        self,
        observations: Observations,
        actions: Any,
        rewards: NDArray[np.floating],
        infos: Mapping[str, Any],
        by_expert: NDArray[np.bool_] | None = None,
    ) -> None:
        """Adds a step of all envs: the observations before it, the actions, and what env.step()
        returned. Arrays may be overwritten afterwards. If env does not copy its results, keep a
        copy of the observations yourself.

        Actions outside of -1 to 1 are recorded clamped, as the simulation uses them. Raises
        TypeError if something is not an array of numbers, and ValueError if an array has another
        shape, or has numbers that are not finite in an env that is playing. Nothing of the step is
        then recorded.

        `by_expert`: bool (num_envs,), true for envs in which the expert acted; None: all.
        """
        self._require_infos(infos)
        count = self._env.num_envs
        rows = self._actions.rows(actions, count)
        idle = np.concatenate([simulator.idle for simulator in self._env.simulators])
        # Idle before the step: an env may have become idle because its last episode ended in it.
        playing = ~idle | infos.get("_final_obs", False)
        seen = self._seen("observations", observations, (count,))
        with np.errstate(over="ignore"):  # too large becomes infinite, and is refused
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
        """Writes the episodes that have ended since the last part was written."""
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
        """Raises an exception if these are not the infos of a step."""
        if not isinstance(infos, Mapping):
            message = f"infos has the type {type(infos).__name__}, expected the dictionary that env.step() returned"
            raise TypeError(message)
        missing = {"_final_info", "final_obs", "_final_obs"} - infos.keys()
        if "final_info" in infos and missing:
            raise ValueError(
                f"infos has final_info and no {', '.join(sorted(missing))}; give it as env.step() returned it"
            )

    def _seen(self, name: str, observations: Any, envs: tuple[int, ...]) -> dict[str, NDArray[Any]]:
        """What is recorded of the observations of so many envs, or of one. Checks that their shapes
        are those of env."""
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
    """Makes demonstrations from what is observed and done in many envs. `parts`:
    VectorEnv.observation_parts."""

    def __init__(self, parts: Mapping[str, slice]) -> None:
        self._parts = parts
        # For each env, what was recorded of its steps, by name: of the episode under way, and of
        # steps before a reset.
        self._under_way: dict[int, dict[str, list[Any]]] = {}
        self._playing = np.zeros(0, np.int64)

    def before_step(
        self,
        observations: Observations,
        actions: NDArray[np.float32],
        by_expert: NDArray[np.bool_] | None,
        playing: NDArray[np.bool_],
    ) -> None:
        """Call before a step, with the observations and the actions about to be taken: rows of all
        envs, of which only those that are `playing` count."""
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
        """Call after the step, with its rewards and VectorEnv's infos. Returns the episodes that it
        ended."""
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
        """The episode that ended in an env; None if its beginning is unknown."""
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
        """What is recorded of the observations of many envs, or of one."""
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
    """`given` as an array. Raises an exception if it has another type or shape, or is not
    numeric."""
    found = np.asarray(given)
    if found.dtype.kind not in "biuf" or (kind is not None and found.dtype != kind):
        wanted = "numbers, such as float32" if kind is None else np.dtype(kind).name
        raise TypeError(f"{name} has the type {found.dtype}, expected {wanted}")
    if found.shape != shape:
        raise ValueError(f"{name} has the shape {found.shape}, expected {shape}")
    return found


def _require_finite(name: str, rows: NDArray[Any], playing: NDArray[np.bool_]) -> None:
    """Raises ValueError if rows of envs that are playing have numbers that are not finite."""
    if rows.dtype.kind != "f":
        return
    wrong = playing & ~np.isfinite(rows).reshape(len(rows), -1).all(1)
    if wrong.any():
        raise ValueError(
            f"{name} has numbers that are not finite (NaN or infinite), first in env {int(np.argmax(wrong))}; nothing "
            "of this step was kept"
        )


def _as_executed(actions: NDArray[np.float32]) -> NDArray[np.float32]:
    """The actions as the simulation uses them: a policy's samples may be outside its limits."""
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
        del options["task"]  # VectorEnv takes the class instead
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
    """The options of a camera that are in _CAMERA, in a form for JSON."""
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
    """Writes a part atomically."""
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
    """Like numpy.save(), which does not report why a disk accepts no more data."""
    with open(file, "wb") as handle:
        header = np.lib.format.header_data_from_array_1_0(array)
        np.lib.format.write_array_header_1_0(handle, header)
        handle.write(array.view(np.uint8).data)
    files.sync(file)
