"""The states of many envs in arrays: what Simulator.env_states() and VectorEnv.env_states() return."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galactic._core import World


class Poses(NamedTuple):
    """Rigid transforms a_from_b, one for each of `...`: rotate, then translate."""

    translation: NDArray[np.float32]
    """(..., 3), meters."""
    rotation: NDArray[np.float32]
    """(..., 4), unit quaternions (w, x, y, z)."""

    @property
    def matrix(self) -> NDArray[np.float32]:
        """(..., 4, 4); a_from_b.matrix @ b_from_c.matrix are those of a_from_c."""
        w, x, y, z = np.moveaxis(self.rotation, -1, 0)
        matrix = np.zeros((*w.shape, 4, 4), np.float32)
        matrix[..., 0, 0] = 1 - 2 * (y * y + z * z)
        matrix[..., 0, 1] = 2 * (x * y - w * z)
        matrix[..., 0, 2] = 2 * (x * z + w * y)
        matrix[..., 1, 0] = 2 * (x * y + w * z)
        matrix[..., 1, 1] = 1 - 2 * (x * x + z * z)
        matrix[..., 1, 2] = 2 * (y * z - w * x)
        matrix[..., 2, 0] = 2 * (x * z - w * y)
        matrix[..., 2, 1] = 2 * (y * z + w * x)
        matrix[..., 2, 2] = 1 - 2 * (x * x + y * y)
        matrix[..., :3, 3] = self.translation
        matrix[..., 3, 3] = 1
        return matrix


class EnvStates(NamedTuple):
    """The states of n envs: copies. M is the most objects that an episode of the world has; where an
    env has fewer, its other poses are NaN. What is changed in them can be set: Simulator.set_states(), which
    says what is taken as it is, and what is refused.
    """

    scene: NDArray[np.int32]
    """(n,), indices into World.scenes."""
    episode: NDArray[np.int32]
    """(n,), indices of the world's episodes."""
    step: NDArray[np.int32]
    """(n,), steps of the episode."""
    world_from_root: Poses
    """Of n robots, upright. Where it is set, only the yaw counts, and the height where it is near a floor."""
    joint_positions: NDArray[np.float32]
    """(n, positions) of the whole robot, radians or meters: World.positions names the columns, and
    World.actions says which of them actions move. Where they are set, those that neither actions nor episodes
    move stay as they are."""
    world_from_grip: Poses
    """Of n hands: origin at the grasp point, axes of the end effector's link."""
    objects: Poses
    """Of n x M objects, in the world; the held one is where the hand has it. Where they are set, the others
    are taken as they are: they are neither laid down nor looked at for what they are in."""
    object_kinds: NDArray[np.int32]
    """(n, M), what they are: indices into World.objects, -1 for those that are not there."""
    held: NDArray[np.int32]
    """(n,), which of the env's objects is in the hand; -1 for none. hold() puts one there."""
    target: NDArray[np.int32]
    """(n,), which of them is to be moved."""
    goal: Poses
    """Of n goals: where the targets are to be, in the world."""

    def __repr__(self) -> str:
        size = " x ".join(map(str, np.shape(self.object_kinds)))
        return f"<galactic.EnvStates, envs x objects: {size}>"

    def select(self, rows: Any) -> EnvStates:
        """Copies of some of them, by their rows here: numbers, a mask, or whatever an array takes."""
        return _selected(self, np.arange(len(self.episode))[rows])

    def hold(self, world: World, objects: ArrayLike | None = None, rows: Any = slice(None)) -> None:
        """Puts objects into hands, in place: the target, or those with the numbers `objects`, one for all or
        (k,), in each of the k states `rows`. Each is turned as it is, with the middle of its box at the grasp
        point; what was in the hand before stays there in the air.

        world: whose states they are. Raises IndexError for objects that a state does not have.
        """
        chosen = np.atleast_1d(np.arange(len(self.episode))[rows])
        held = np.empty(len(chosen), np.int64)
        held[:] = self.target[chosen] if objects is None else _whole_numbers(objects)
        counts = (self.object_kinds[chosen] >= 0).sum(axis=1)
        wrong = np.flatnonzero((held < 0) | (held >= counts))
        if len(wrong):
            row = wrong[0]
            raise IndexError(
                f"state {chosen[row]} has no object {held[row]}; its last is {counts[row] - 1}"
            )
        centers = world.object_centers[self.object_kinds[chosen, held]]
        objects_there = Poses(*(part[chosen, held] for part in self.objects))
        to_centers = np.einsum("nij,nj->ni", objects_there.matrix[:, :3, :3], centers)
        grips = self.world_from_grip.translation[chosen]
        self.objects.translation[chosen, held] = grips - to_centers
        self.held[chosen] = held


def _whole_numbers(given: ArrayLike) -> NDArray[np.integer]:
    numbers = np.asarray(given)
    if not np.issubdtype(numbers.dtype, np.integer):
        raise TypeError(f"objects are {numbers.dtype}, expected whole numbers")
    return numbers


def _selected(states: Any, rows: NDArray[np.int64]) -> Any:
    if isinstance(states, np.ndarray):
        return states[rows]
    return type(states)(*(_selected(part, rows) for part in states))


def joined(parts: Sequence[Any]) -> Any:
    """States of some envs, then those of others, ..., as those of all."""
    first = parts[0]
    if isinstance(first, np.ndarray):
        return np.concatenate(parts)
    return type(first)(*(joined(values) for values in zip(*parts)))
