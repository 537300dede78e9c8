"""A data set of images, with masks of the target, the matrices of the cameras, and points in the world."""

import sys

import numpy as np
import galactic

world = galactic.World(sys.argv[1])
homes = galactic.Simulator(world, 16, task="none", body_transforms=True, seed=7)
eyes = [
    galactic.Renderer(homes, camera=camera, width=96, height=72, semantics="objects")
    for camera in ("head", "follow")
]


def points_of(eye, depth):
    """Where in the world each pixel is, [envs, height, width, 3]; where depth is 0, the camera."""
    rows, columns = np.mgrid[: depth.shape[1], : depth.shape[2]] + 0.5
    pixels = np.stack([columns, rows, np.ones_like(rows)], axis=-1)
    in_camera = pixels @ np.linalg.inv(eye.intrinsics).T * depth[..., np.newaxis]
    rotations, origins = eye.world_from_camera[:, :3, :3], eye.world_from_camera[:, :3, 3]
    return np.einsum("nij,nyxj->nyxi", rotations, in_camera) + origins[:, np.newaxis, np.newaxis]


random = np.random.default_rng(7)
shots = []
farthest = 0.0
for shot in range(20):
    homes.step(random.uniform(-1, 1, (homes.num_envs, homes.action_count)).astype(np.float32))
    states = homes.env_states()
    targets = states.objects.translation[np.arange(homes.num_envs), states.target]
    for eye in eyes:
        seen = eye.render()
        target_ids = len(eye.semantic_names) + states.target
        is_target = seen["semantics"] == target_ids[:, np.newaxis, np.newaxis]
        from_target = points_of(eye, seen["depth"]) - targets[:, np.newaxis, np.newaxis]
        distances = np.linalg.norm(from_target, axis=-1)
        farthest = max(farthest, distances[is_target].max(initial=0))
        shots.append(
            {
                "rgb": seen["rgb"],
                "depth": seen["depth"],
                "is_target": is_target,
                "world_from_camera": eye.world_from_camera,
                "intrinsics": np.tile(eye.intrinsics, (homes.num_envs, 1, 1)),
            }
        )
data = {name: np.concatenate([one[name] for one in shots]) for name in shots[0]}
np.savez_compressed("images.npz", **data)
with_target = data["is_target"].any(axis=(1, 2)).sum()
print(f"{len(data['rgb'])} images, {with_target} of them with the target")
print(f"points of targets are at most {farthest:.2f} m from where it is")
