"""What the episodes of a world are about, in arrays: what World.episode_table() returns."""

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
    the yaw, radians. The simulation looks for the floor at or under that height."""
    target_kind: NDArray[np.int32]
    """(n,), what is to be moved: indices into World.objects."""
    target: Poses
    """Of n targets where they begin, in the world."""
    goal: Poses
    """Of n goals: where the targets are to be, in the world."""
