"""The states of many envs in arrays, as returned by Simulator.env_states() and
VectorEnv.env_states()."""

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
        """(..., 4, 4); a_from_b.matrix @ b_from_c.matrix gives the matrices of a_from_c."""
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
    """Copies of the states of n envs. M is the largest number of objects in an episode of the
    world; if an env has fewer, its other poses are NaN. You may change the arrays and set the
    states with Simulator.set_states(), which documents what is used as it is and what is refused.
    """

    scene: NDArray[np.int32]
    """(n,), indices into World.scenes."""
    episode: NDArray[np.int32]
    """(n,), indices of the episodes in the world."""
    step: NDArray[np.int32]
    """(n,), steps done in the episode."""
    world_from_root: Poses
    """Upright poses of n robots. When states are set, the rotation's yaw is used, and the height if
    it is near a floor."""
    joint_positions: NDArray[np.float32]
    """(n, positions) of the whole robot, radians or meters: World.positions names the columns, and
    World.actions tells which of them actions move. When states are set, positions that neither
    actions nor episodes move stay as they are."""
    world_from_grip: Poses
    """Poses of n hands: origin at the grasp point, axes of the end effector's link."""
    objects: Poses
    """World poses of n x M objects; a held object is where the hand has it. When states are set,
    the other objects stay exactly where they are put: they are neither settled nor checked for
    penetration."""
    object_kinds: NDArray[np.int32]
    """(n, M), the kinds of the objects: indices into World.objects, -1 for objects that are
    absent."""
    held: NDArray[np.int32]
    """(n,), index of the env's object that is in the hand; -1 for none. hold() puts an object
    there."""
    target: NDArray[np.int32]
    """(n,), index of the env's object that has to be moved."""
    goal: Poses
    """n goals: world poses to which the targets have to be brought."""

    def __repr__(self) -> str:
        size = " x ".join(map(str, np.shape(self.object_kinds)))
        return f"<galactic.EnvStates, envs x objects: {size}>"

    def select(self, rows: Any) -> EnvStates:
        """Copies of some of the states, selected by row: numbers, a mask, or any index that an
        array accepts."""
        return _selected(self, np.arange(len(self.episode))[rows])

    def hold(self, world: World, objects: ArrayLike | None = None, rows: Any = slice(None)) -> None:
        """Puts objects into hands, in place: in each of the k states `rows`, the target, or the
        object with the index `objects`, which is one for all or has the shape (k,). Each object
        keeps its rotation, and the middle of its box is put at the grasp point. What was in the
        hand before stays in the air where it is.

        world: the world that the states are from. Raises IndexError if a state does not have the
        object.
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
    """The states of several groups of envs, one group after the other."""
    first = parts[0]
    if isinstance(first, np.ndarray):
        return np.concatenate(parts)
    return type(first)(*(joined(values) for values in zip(*parts)))
