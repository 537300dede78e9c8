"""The sizes of objects: the type of World.object_boxes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from galactic.env_states import Poses

_SIGNS = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1], indexing="ij"), np.float32)


class ObjectBoxes(NamedTuple):
    """The oriented boxes of the k objects of World.objects, from their packs."""

    object_from_box: Poses
    """Poses of the k boxes in their objects' frames. The translation is the box's middle, which is
    also in World.object_centers."""
    half_extents: NDArray[np.float32]
    """(k, 3), meters along the box's own axes, from its middle to its sides."""

    @property
    def corners(self) -> NDArray[np.float32]:
        """(k, 8, 3), meters, in the objects' frames, ordered by the sign along X, then Y, then Z,
        negative first. EnvStates.objects transforms them into the world, and a camera's matrices
        project them into its image."""
        in_box = _SIGNS.reshape(3, 8).T * self.half_extents[:, np.newaxis]
        rotations = self.object_from_box.matrix[:, :3, :3]
        turned = np.einsum("nij,nkj->nki", rotations, in_box)
        return np.asarray(turned + self.object_from_box.translation[:, np.newaxis], np.float32)
