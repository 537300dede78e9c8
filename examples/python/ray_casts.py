"""Rays: a home from above, and a lidar of one's own.

    python3 ray_casts.py world.pack rays.png

Casts a ray down to each pixel of a map, and those of a spinning lidar with 32 rings that the robot would carry.
Prints what they came to, and how many were cast a second. In the picture, the home is the brighter the higher, its
objects are blue, the robot is orange, and each ray of the lidar leaves a dot where it ends: yellow on the home, red
on an object. It needs Pillow (Debian: python3-pil).
"""

import os
import sys
import time

import numpy as np
import galactic
from PIL import Image

PIXEL, MARGIN, ABOVE = 0.02, 1.0, 2.2  # meters
RINGS, BEAMS, LIDAR_HEIGHT, LIDAR_RANGE = 32, 720, 1.3, 8.0

world = galactic.World(sys.argv[1])
homes = galactic.Simulator(world, 1, task="none", seed=3)
states = homes.env_states()
robot = states.world_from_root
place = robot.translation[0]


def cast(caster, origins, directions, length):
    """Casts the rays on all processors, and says what they came to."""
    began = time.perf_counter()
    hits = caster.cast_rays(origins, directions, length, threads=os.cpu_count() or 1)
    rate = len(origins) / (time.perf_counter() - began)
    ends, counts = np.unique(hits.end, return_counts=True)
    found = ", ".join(f"{galactic.CastEnd(end).name} {n}" for end, n in zip(ends, counts))
    print(f"{len(origins)} rays, {rate:,.0f} a second: {found}")
    return hits


# From a plane over the floor that the robot can reach, straight down.
finder = galactic.PathFinder(world, states.scene[0], place)
low = np.array(finder.origin) - MARGIN
high = np.array(finder.origin) + MARGIN + finder.cell_size * np.array(finder.navigable.shape[::-1])
width, height = ((high - low) / PIXEL).astype(int)
column, row = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
origins = np.zeros((height * width, 3))
origins[:, 0] = low[0] + PIXEL * column.ravel()
origins[:, 1] = place[1] + ABOVE
origins[:, 2] = low[1] + PIXEL * row.ravel()
down = np.broadcast_to([0, -1, 0], origins.shape)
with_robot = galactic.RayCaster.of_env(homes, 0, robot=True)
seen = cast(with_robot, origins, down, ABOVE + 0.1)

heights = np.clip(1 - seen.distance / ABOVE, 0, 1)
picture = np.repeat(40 + 200 * heights[:, np.newaxis], 3, axis=1)
picture[seen.end == galactic.CastEnd.OBJECT] = 60, 140, 250
picture[seen.end == galactic.CastEnd.ROBOT] = 250, 140, 40
picture[np.isin(seen.end, (galactic.CastEnd.OUTSIDE, galactic.CastEnd.NOTHING))] = 15
picture = picture.reshape(height, width, 3).astype(np.uint8)

# The lidar looks through its robot, which the second caster does not have.
up, around = np.meshgrid(
    np.radians(np.linspace(-45, 15, RINGS)),
    np.linspace(-np.pi, np.pi, BEAMS, endpoint=False),
    indexing="ij",
)
beams = np.stack([np.cos(up) * np.cos(around), np.sin(up), np.cos(up) * np.sin(around)], axis=-1)
beams = beams.reshape(-1, 3) @ robot.matrix[0, :3, :3].T
eye = place + [0, LIDAR_HEIGHT, 0]
without_robot = galactic.RayCaster.of_env(homes, 0)
scan = cast(without_robot, np.broadcast_to(eye, beams.shape), beams, LIDAR_RANGE)

points = eye + scan.distance[:, np.newaxis] * beams
across, along = ((points[:, [0, 2]] - low) / PIXEL).astype(int).T
inside = (across >= 0) & (across < width) & (along >= 0) & (along < height)
for end, color in (
    (galactic.CastEnd.SCENE, (240, 210, 60)),
    (galactic.CastEnd.OBJECT, (240, 50, 50)),
):
    shown = inside & (scan.end == end)
    picture[along[shown], across[shown]] = color
Image.fromarray(picture).save(sys.argv[2])
ranges = np.where(scan.end == galactic.CastEnd.SCENE, scan.distance, np.nan).reshape(RINGS, BEAMS)
print(f"the nearest wall or piece of furniture is {np.nanmin(ranges):.2f} m from the lidar")
