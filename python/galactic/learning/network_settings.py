"""The settings of the network: what it sees and how it is built."""

from __future__ import annotations

from dataclasses import dataclass

import galactic
from galactic.learning.policies.sight import IMAGE_SIZE, OWN_SIGHT, SIGHT, SMALLEST_IMAGE
from galactic.learning.setting_fields import Drawn, setting
from galactic.learning.setting_scopes import (
    OF_CHOSEN_LAYERS,
    OF_COLORS,
    OF_IMAGES,
    OF_OWN_NETWORKS,
    OF_PARAMETERS,
    OF_PERCEPTRONS,
    OF_WIDTHS,
)

# All settings that make training images differ from those by which policies are judged.
CAMERA_NOISE = galactic.Renderer.NOISE_OPTIONS
_MOST_NOISE = galactic.Renderer.NOISE_LIMITS
# Options of galactic.Renderer, and the settings that give their values.
CAMERA = {
    "camera": "camera",
    "fov_degrees": "fov",
    "position": "camera_position",
    "rpy_degrees": "camera_rpy",
    "near": "near",
    "width": "image_size",
    "height": "image_size",
    **{name: name for name in CAMERA_NOISE},
}


@dataclass(frozen=True)
class NetworkSettings:
    """The group Network of Settings."""

    network: str = setting(
        "resnet18",
        "Network",
        "`state` sees no images, `depth` sees only depth and has few channels, the others are the paper's "
        "(table 4); or a network of your own: `FILE.py:CLASS` or `MODULE:CLASS`",
        choices=tuple(SIGHT),
        may_be_own=True,
    )
    network_options: str = setting(
        "",
        "Network",
        "arguments of the network's class, as NAME=VALUE separated by spaces",
        scope=OF_OWN_NETWORKS,
    )
    sees: str = setting(
        "none",
        "Network",
        "which images a network of your own sees; `rgbd` is `rgb` and `depth`",
        choices=tuple(OWN_SIGHT),
        scope=OF_OWN_NETWORKS,
    )
    camera: str = setting(
        "head",
        "Network",
        "the camera through which the network sees: the recipe's (`head`), `follow`, `top`, or a link",
        scope=OF_IMAGES,
    )
    fov: float = setting(
        0.0,
        "Network",
        "vertical field of view, degrees; 0: the camera's",
        low=0.0,
        high=175.0,
        scope=OF_IMAGES,
    )
    camera_position: tuple[float, float, float] = setting(
        (0.0, 0.0, 0.0),
        "Network",
        "offset from the place of that camera or link: meters ahead, to the left and up",
        low=-100.0,
        high=100.0,
        scope=OF_IMAGES,
    )
    camera_rpy: tuple[float, float, float] = setting(
        (0.0, 0.0, 0.0),
        "Network",
        "rotation of the camera there, degrees: roll, pitch (down is positive), yaw",
        low=-360.0,
        high=360.0,
        scope=OF_IMAGES,
    )
    near: float = setting(
        0.0,
        "Network",
        "distance along the camera's axis below which nothing is drawn, meters, at least 0.01; 0: the camera's",
        low=0.0,
        high=100.0,
        scope=OF_IMAGES,
    )
    image_size: int = setting(
        IMAGE_SIZE,
        "Network",
        f"height and width of the images, {SMALLEST_IMAGE} to 512 pixels; the paper's networks are made for {IMAGE_SIZE}",
        low=SMALLEST_IMAGE,
        high=512,
        scope=OF_IMAGES,
    )
    depth_noise: Drawn = setting(
        0.0,
        "Network",
        "standard deviation at 1 m of the depth that the network sees, meters; it grows with the square of depth",
        low=0.0,
        high=_MOST_NOISE["depth_noise"],
        may_be_range=True,
        scope=OF_IMAGES,
    )
    depth_dropout: Drawn = setting(
        0.0,
        "Network",
        "share of the pixels that have no depth",
        low=0.0,
        high=_MOST_NOISE["depth_dropout"],
        may_be_range=True,
        scope=OF_IMAGES,
    )
    color_noise: Drawn = setting(
        0.0,
        "Network",
        "standard deviation of each color channel, in levels of 255",
        low=0.0,
        high=_MOST_NOISE["color_noise"],
        may_be_range=True,
        scope=OF_COLORS,
    )
    light_jitter: Drawn = setting(
        0.0,
        "Network",
        "each episode multiplies its colors by a number from 1 - this to 1 + this",
        low=0.0,
        high=_MOST_NOISE["light_jitter"],
        may_be_range=True,
        scope=OF_COLORS,
    )
    camera_jitter: Drawn = setting(
        0.0,
        "Network",
        "how far an episode may shift the camera along each of its axes, meters",
        low=0.0,
        high=_MOST_NOISE["camera_jitter"],
        may_be_range=True,
        scope=OF_IMAGES,
    )
    camera_jitter_degrees: Drawn = setting(
        0.0,
        "Network",
        "how far an episode may turn the camera in roll, pitch and yaw, degrees",
        low=0.0,
        high=_MOST_NOISE["camera_jitter_degrees"],
        may_be_range=True,
        scope=OF_IMAGES,
    )
    camera_jitter_fov: Drawn = setting(
        0.0,
        "Network",
        "how far an episode may change the vertical field of view, degrees",
        low=0.0,
        high=_MOST_NOISE["camera_jitter_fov"],
        may_be_range=True,
        scope=OF_IMAGES,
    )
    recurrent: bool = setting(
        False,
        "Network",
        "put a GRU into the network `state` or `depth`, or behind a network of your own; the paper's always have one",
        scope=OF_CHOSEN_LAYERS,
    )
    width: int = setting(
        128,
        "Network",
        "units per layer of `state` and `depth`, and of the GRU behind a network of your own",
        low=1,
        high=65536,
        scope=OF_WIDTHS,
    )
    layers: int = setting(
        2,
        "Network",
        "hidden layers of `state` and `depth`",
        low=1,
        high=64,
        scope=OF_PERCEPTRONS,
    )
    activation: str = setting(
        "tanh",
        "Network",
        "activation between the layers of `state` and `depth`",
        choices=("tanh", "relu"),
        scope=OF_PERCEPTRONS,
    )
    log_std: str = setting(
        "output",
        "Network",
        "standard deviations of `state`, `depth` and networks of your own: an `output` of the network, clamped to "
        "exp(-5)..exp(2), or a `parameter`, the same everywhere",
        choices=("output", "parameter"),
        scope=OF_CHOSEN_LAYERS,
    )
    initial_log_std: float = setting(
        -0.5,
        "Network",
        "initial value of the log standard deviations, if these are a parameter",
        low=-5.0,
        high=2.0,
        scope=OF_PARAMETERS,
    )
    final_log_std: float = setting(
        2.0,
        "Network",
        "upper limit of these parameters at the end of the run; it falls from "
        "`initial_log_std` over the last four fifths of the run; 2: no limit",
        low=-5.0,
        high=2.0,
        scope=OF_PARAMETERS,
        is_of_acting=True,
    )
    odds_limit: float = setting(
        0.0,
        "Network",
        "limit of the log-odds of a decision, so that no choice is so certain that the other is "
        "never tried: with 4, it is tried at least once in 56 steps; 0: no limit",
        low=0.0,
    )
    normalize: bool = setting(
        False, "Network", "normalize observations by their running mean and variance, clamped to 10"
    )
    closeup: float = setting(
        0.0,
        "Network",
        "also show the network tanh(x / this) for each number x of the observation, so that "
        "centimeters near zero count as well as meters; 0: off",
        low=0.0,
    )
    second_closeup: float = setting(
        0.0,
        "Network",
        "the same with another divisor, in addition to `closeup` or without it; 0: off",
        low=0.0,
    )
    critic_only: str = setting(
        "",
        "Network",
        "sensors that only the critic sees, such as `geodesic`, separated by commas: they help to train "
        "the policy, which acts without them",
    )

    @property
    def has_own_network(self) -> bool:
        """Whether the network is a class that the user wrote."""
        return self.network not in SIGHT

    @property
    def sight(self) -> tuple[str, ...]:
        """Which images the network sees."""
        return OWN_SIGHT[self.sees] if self.has_own_network else SIGHT[self.network]
