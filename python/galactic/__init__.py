"""Thousands of simulated homes at once, for learning.

World opens packs, Simulator steps a batch of environments, Renderer draws them, VectorEnv is
Gymnasium's vector environment over them, LearnedPolicy plays policy packs, PlanningScene answers
planners. docs/python.md has the
tour.
"""

from galactic._core import (
    EnvState,
    EpisodeEnd,
    ErrorCode,
    LearnedPolicy,
    PlanningScene,
    Pose,
    Renderer,
    Simulator,
    World,
    __version__,
)
from galactic.errors import Error
from galactic.vector_env import VectorEnv

__all__ = [
    "EnvState",
    "EpisodeEnd",
    "Error",
    "ErrorCode",
    "LearnedPolicy",
    "PlanningScene",
    "Pose",
    "Renderer",
    "Simulator",
    "VectorEnv",
    "World",
    "__version__",
]
