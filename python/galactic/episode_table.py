"""Start, target and goal of a world's episodes, in arrays, as returned by World.episode_table()."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from galactic.env_states import Poses


class EpisodeTable(NamedTuple):
    """The n episodes of a world, as copies."""

    scene: NDArray[np.int32]
    """(n,), indices into World.scenes."""
    base: NDArray[np.float32]
    """(n, 4), where the robot starts: x, y, z of the point on the floor under its root, meters, and
    the yaw, radians. The simulation looks for the floor at that height or below."""
    target_kind: NDArray[np.int32]
    """(n,), kinds of the objects that have to be moved: indices into World.objects."""
    target: Poses
    """World poses of n targets at the start."""
    goal: Poses
    """n goals: world poses to which the targets have to be brought."""
