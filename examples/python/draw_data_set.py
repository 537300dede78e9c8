"""A data set of images, with masks and boxes of the target, the matrices of the cameras, and points in the world."""

import sys

import numpy as np
import galactic

world = galactic.World(sys.argv[1])
homes = galactic.Simulator(world, 16, task="none", body_transforms=True, seed=7)
head = galactic.Renderer(homes, camera="head", width=96, height=72, semantics="objects")
room = galactic.Renderer(
    homes, world_from_camera=np.eye(4), robot=False, width=96, height=72, semantics="objects"
)
every = np.arange(homes.num_envs)


def places_to_see(targets):
    """Where cameras in the room are that look down on the targets, [envs, 4, 4], with nothing of it between them."""
    turns = random.uniform(0, 2 * np.pi, homes.num_envs)
    away = np.stack([np.cos(turns), np.full(homes.num_envs, 1.2), np.sin(turns)], axis=-1)
    away /= np.linalg.norm(away, axis=-1, keepdims=True)
    from_there = (targets + 0.3 * away)[:, np.newaxis]
    free = galactic.RayCaster.cast_rays_in_envs(homes, from_there, away[:, np.newaxis], 1.0)
    return galactic.look_at(targets + (0.3 + 0.9 * free.distance) * away, targets)


def boxes_of(eye, states):
    """Around the whole targets, also where something hides them: [envs, 4], columns and rows of two corners."""
    kinds = states.object_kinds[every, states.target]
    corners = np.pad(world.object_boxes.corners[kinds], [(0, 0), (0, 0), (0, 1)], constant_values=1)
    world_from_target = states.objects.matrix[every, states.target]
    camera_from_target = np.linalg.inv(eye.world_from_camera) @ world_from_target
    pixels = (corners @ camera_from_target.transpose(0, 2, 1))[..., :3] @ eye.intrinsics.T
    # What is not in front of the camera has no place in its image.
    pixels[(pixels[..., 2] <= 0).any(axis=1)] = np.nan
    pixels = pixels[..., :2] / pixels[..., 2:]
    return np.concatenate([pixels.min(axis=1), pixels.max(axis=1)], axis=-1)


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
    targets = states.objects.translation[every, states.target]
    room.place_camera(places_to_see(targets))
    for eye in (head, room):
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
                "target_box": boxes_of(eye, states),
                "world_from_camera": eye.world_from_camera,
                "intrinsics": np.tile(eye.intrinsics, (homes.num_envs, 1, 1)),
            }
        )
data = {name: np.concatenate([one[name] for one in shots]) for name in shots[0]}
np.savez_compressed("images.npz", **data)
with_target = data["is_target"].any(axis=(1, 2)).sum()
print(f"{len(data['rgb'])} images, {with_target} of them with the target")
print(f"points of targets are at most {farthest:.2f} m from where it is")
