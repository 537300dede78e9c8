"""Which images networks see."""

from __future__ import annotations

from collections.abc import Mapping

SIGHT: Mapping[str, tuple[str, ...]] = {
    "state": (),
    "depth": ("depth",),
    "simple_cnn": ("rgb", "depth"),
    "resnet9": ("rgb", "depth"),
    "resnet18": ("rgb", "depth"),
}
"""The networks, and what each of them sees."""
OWN_SIGHT: Mapping[str, tuple[str, ...]] = {
    "none": (),
    "depth": ("depth",),
    "rgb": ("rgb",),
    "rgbd": ("rgb", "depth"),
}
"""What a network of one's own can see."""
OF_THE_PAPER = ("simple_cnn", "resnet9", "resnet18")
"""Those whose layers nobody chooses."""
IMAGE_SIZE = 128
"""Height and width that the paper's networks are made for, pixels."""
SMALLEST_IMAGE = 36
"""The least that `depth` can see with, pixels."""
FARTHEST = 10.0
"""Depth that counts as far away, meters."""
