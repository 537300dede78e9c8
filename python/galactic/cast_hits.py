"""How far rays and swept spheres get: what the casts of a RayCaster return."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True, eq=False)
class CastHits:
    """Of n rays or spheres, in their order, or of n in each of some envs."""

    distance: NDArray[np.float32]
    """(n,) or (envs, n), meters; 0 where one begins in what it comes to, or outside the grid."""
    end: NDArray[np.uint8]
    """(n,) or (envs, n), what each comes to: a CastEnd."""
    index: NDArray[np.int32]
    """(n,) or (envs, n), where that is an object, its index into EnvState.objects; of the robot, its
    link's into World.links; else -1."""
