"""The states of many envs in arrays: what Simulator.env_states() and VectorEnv.env_states() return."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


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
    env has fewer, its other poses are NaN. What is changed in them can be set: Simulator.set_states().
    """

    scene: NDArray[np.int32]
    """(n,), indices into World.scenes."""
    episode: NDArray[np.int32]
    """(n,), indices of the world's episodes."""
    step: NDArray[np.int32]
    """(n,), steps of the episode."""
    world_from_root: Poses
    """Of n robots."""
    joint_positions: NDArray[np.float32]
    """(n, joints) of the whole robot, radians or meters; World.actions says where in it the joints
    are that actions move."""
    world_from_grip: Poses
    """Of n hands: origin at the grasp point, axes of the end effector's link."""
    objects: Poses
    """Of n x M objects, in the world; the held one is where the hand has it."""
    object_kinds: NDArray[np.int32]
    """(n, M), what they are: indices into World.objects, -1 for those that are not there."""
    held: NDArray[np.int32]
    """(n,), which of the env's objects is in the hand; -1 for none."""
    target: NDArray[np.int32]
    """(n,), which of them is to be moved."""
    goal: Poses
    """Of n goals: where the targets are to be, in the world."""

    def select(self, rows: Any) -> EnvStates:
        """Copies of some of them, by their rows here: numbers, a mask, or whatever an array takes."""
        return _selected(self, np.arange(len(self.episode))[rows])


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
