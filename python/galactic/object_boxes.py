"""How large objects are: what World.object_boxes is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from galactic.env_states import Poses

_SIGNS = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1], indexing="ij"), np.float32)


class ObjectBoxes(NamedTuple):
    """Of the k objects of World.objects: the oriented boxes that their packs have around them."""

    object_from_box: Poses
    """Of k boxes: the middle, which World.object_centers has, too, and the turn in the object's frame."""
    half_extents: NDArray[np.float32]
    """(k, 3), meters along the box's own axes, from its middle to its sides."""

    @property
    def corners(self) -> NDArray[np.float32]:
        """(k, 8, 3), meters, in the objects' frames: those below the middle along X first, then along Y, then Z.
        With EnvStates.objects they are in the world, and with a camera's matrices in its image."""
        in_box = _SIGNS.reshape(3, 8).T * self.half_extents[:, np.newaxis]
        rotations = self.object_from_box.matrix[:, :3, :3]
        turned = np.einsum("nij,nkj->nki", rotations, in_box)
        return np.asarray(turned + self.object_from_box.translation[:, np.newaxis], np.float32)
