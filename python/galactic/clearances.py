"""How far a robot is from what surrounds it: what PlanningScene.clearances() returns."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True, eq=False)
class Clearances:
    """Results for s spheres in n poses: the spheres of the robot, then those of what it holds."""

    distance: NDArray[np.float32]
    """(n, s), meters from surface to surface; if negative, how far a sphere has to move to be
    free."""
    nearest: NDArray[np.uint8]
    """(n, s), what is nearest: CastEnd.SCENE, OBJECT, or NOTHING if nothing is near enough."""
    index: NDArray[np.int32]
    """(n, s), if that is an object, its index into EnvState.objects; otherwise -1."""
    direction: NDArray[np.float32]
    """(n, s, 3), unit vectors in the world frame along which each sphere gets away fastest. 0 if
    nothing is near, or if the sphere penetrates the scene too deeply to tell."""
    base_gradient: NDArray[np.float32]
    """(n, s, 4), derivatives of the distances with respect to x, y and z of the base, meters per
    meter, and its yaw, meters per radian."""
    joint_gradient: NDArray[np.float32]
    """(n, s, positions), derivatives with respect to the joint positions, meters per radian or
    meter."""
    link: NDArray[np.int32]
    """(s,), the link that carries each sphere: its index into World.links."""
