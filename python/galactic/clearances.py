"""How far a robot is from what surrounds it: what PlanningScene.clearances() returns."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True, eq=False)
class Clearances:
    """Of s spheres in n poses: those of the robot, then those of what it holds."""

    distance: NDArray[np.float32]
    """(n, s), meters from surface to surface; below 0: how far a sphere has to move to be free."""
    nearest: NDArray[np.uint8]
    """(n, s), what each is near: CastEnd.SCENE, OBJECT, or NOTHING where nothing is near enough."""
    index: NDArray[np.int32]
    """(n, s), where that is an object, its index into EnvState.objects; else -1."""
    direction: NDArray[np.float32]
    """(n, s, 3), unit vectors of the world: where each sphere gets away fastest. 0 where nothing is near,
    and where the scene is penetrated too deep to say."""
    base_gradient: NDArray[np.float32]
    """(n, s, 4), how the distances change with the x, y, z of the base, meters per meter, and with its
    yaw, meters per radian."""
    joint_gradient: NDArray[np.float32]
    """(n, s, positions), how they change with the joint positions, meters per radian or meter."""
    link: NDArray[np.int32]
    """(s,), the link that carries each sphere: its index into World.links."""
