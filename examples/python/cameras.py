"""Cameras: color and depth of many homes at once, as a contact sheet, and how many images a second that takes.

    python3 cameras.py world.pack cameras.png

Prints the shape of each image and the rate. In the picture, each column is a home: what the robot sees, how far that
is (the nearer, the brighter), and the robot from behind. It needs Pillow (Debian: python3-pil).
"""

import sys
import time

import numpy as np
import galactic
from PIL import Image

ENVS, STEPS, SHOWN = 64, 40, 6
CAMERAS = {
    "head": {"width": 160, "height": 120},
    "behind": {"camera": "follow", "width": 160, "height": 120, "depth": False},
}

homes = galactic.VectorEnv(sys.argv[1], ENVS, task="none", images=CAMERAS, copy=False, seed=5)
seen, _ = homes.reset()
for name, images in seen.items():
    print(f"{name}: {images.dtype} {images.shape}")

# Robots that drive ahead and move their arms.
random = np.random.default_rng(5)
actions = random.uniform(-1, 1, homes.action_space.shape).astype(np.float32)
names = [action.name for action in homes.world.actions]
actions[:, names.index("forward")] = 1
actions[:, names.index("turn")] *= 0.3
began = time.perf_counter()
for step in range(STEPS):
    seen, rewards, terminations, truncations, infos = homes.step(actions)
seconds = time.perf_counter() - began
count = STEPS * ENVS * len(CAMERAS)
print(f"{count} images in {seconds:.2f} s, steps included: {count / seconds:,.0f} a second")


def gray(depth):
    """Of meters, [..., 3] in bytes: bright is near, black is nothing or 6 m away."""
    near = np.where(depth > 0, np.clip(1 - depth / 6, 0, 1), 0)
    return np.repeat((255 * near).astype(np.uint8)[..., np.newaxis], 3, axis=-1)


rows = [seen["head_rgb"], gray(seen["head_depth"]), seen["behind_rgb"]]
framed = [
    np.pad(row[:SHOWN], ((0, 0), (2, 2), (2, 2), (0, 0)), constant_values=255) for row in rows
]
sheet = np.concatenate([np.concatenate(list(row), axis=1) for row in framed])
Image.fromarray(sheet).save(sys.argv[2])
print(f"{sys.argv[2]}: {sheet.shape[1]} x {sheet.shape[0]} pixels")
