"""What simulations observe: the parts of an observation, by name."""

from __future__ import annotations

from collections.abc import Mapping

ALWAYS = (
    "robot_target",
    "grip_target",
    "robot_grip",
    "robot_goal",
    "grip_goal",
    "is_holding",
    "joints",
    "time",
)
"""Those of every observation."""

SENSORS: Mapping[str, tuple[str, ...]] = {
    "bump": ("bump",),
    "target_goal": ("target_goal",),
    "target_up": ("target_up",),
    "near_objects": ("near_objects",),
    "laser": (
        "laser_beams",
        "laser_fov",
        "laser_heights",
        "laser_range",
        "laser_min_range",
        "laser_noise",
    ),
    "geodesic": ("geodesic",),
}
"""Those that options add, and these options. All other parts are of tasks of one's own."""
