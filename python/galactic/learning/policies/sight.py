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
"""The built-in networks, and the images that each of them sees."""
OWN_SIGHT: Mapping[str, tuple[str, ...]] = {
    "none": (),
    "depth": ("depth",),
    "rgb": ("rgb",),
    "rgbd": ("rgb", "depth"),
}
"""The images that a user-defined network can see."""
OF_THE_PAPER = ("simple_cnn", "resnet9", "resnet18")
"""The networks whose layers are fixed."""
IMAGE_SIZE = 128
"""The image height and width for which the paper's networks are made, pixels."""
SMALLEST_IMAGE = 36
"""The smallest image that the network `depth` accepts, pixels."""
FARTHEST = 10.0
"""Greater depths are clamped to this, meters."""
