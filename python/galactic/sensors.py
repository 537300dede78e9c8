"""The parts of an observation, by name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

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
"""The parts of every observation."""

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
    "last_actions": ("last_actions",),
}
"""The parts that options add, and these options. All other parts belong to tasks of one's own."""

# Options that decide only how many numbers there are, or how exact they are.
_NO_MEANING = ("laser_beams", "laser_noise")


def meaning_of(names: Iterable[str], options: Mapping[str, Any]) -> dict[str, Any]:
    """The options of the simulation that decide what the numbers in the parts `names` mean."""
    asked = ["observe_current", *(option for name in names for option in SENSORS.get(name, ()))]
    return {name: options[name] for name in asked if name in options and name not in _NO_MEANING}
