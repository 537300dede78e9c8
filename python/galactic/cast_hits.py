"""How far rays and swept spheres get: what the casts of a RayCaster return."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True, eq=False)
class CastHits:
    """Results for n rays or spheres, in order, or for n in each of several envs."""

    distance: NDArray[np.float32]
    """(n,) or (envs, n), meters; 0 for one that begins inside what stops it, or outside the
    grid."""
    end: NDArray[np.uint8]
    """(n,) or (envs, n), what stops each: a CastEnd."""
    index: NDArray[np.int32]
    """(n,) or (envs, n), index of what stops each: for an object, into EnvState.objects; for the
    robot, into World.links; otherwise -1."""
