"""Thousands of simulated homes at once, for learning.

World opens packs, Simulator steps a batch of environments, and Renderer draws them. VectorEnv makes
them a Gymnasium vector environment, in which a Task can be your own. LearnedPolicy plays policy
packs, and ScriptedPolicy is an expert to imitate. PlanningScene answers planners' questions,
PathFinder finds paths along a floor, and RayCaster casts rays and sweeps spheres. docs/python.md
gives a tour.
"""

import sys

from galactic import interrupts, programs

interrupts.end_while_loading()
programs.end_without_room()
programs.end_without_libraries()

try:
    from galactic._core import (
        Action,
        CastEnd,
        EnvState,
        EpisodeEnd,
        ErrorCode,
        GeodesicFields,
        LearnedPolicy,
        PathFinder,
        PlanningScene,
        Pose,
        RayCaster,
        Renderer,
        ScriptedPhase,
        ScriptedPolicy,
        ScriptedTrouble,
        Simulator,
        World,
        __version__,
        look_at,
    )
except ModuleNotFoundError as error:
    if error.name != "galactic._core":
        raise
    raise ModuleNotFoundError(
        f"galactic has no compiled module for Python {sys.version_info[0]}.{sys.version_info[1]}; build "
        "it: cmake --build --preset release --target galactic_python (docs/python.md)",
        name=error.name,
    ) from None
from galactic.cast_hits import CastHits
from galactic.clearances import Clearances
from galactic.demonstration_writer import DemonstrationWriter
from galactic.demonstrations import Demonstration, Demonstrations
from galactic.env_states import EnvStates, Poses
from galactic.episode_table import EpisodeTable
from galactic.errors import Error
from galactic.object_boxes import ObjectBoxes
from galactic.reached import reached
from galactic.task import Outcome, Task
from galactic.task_envs import TaskEnvs
from galactic.vector_env import VectorEnv

__all__ = [
    "Action",
    "CastEnd",
    "CastHits",
    "Clearances",
    "Demonstration",
    "DemonstrationWriter",
    "Demonstrations",
    "EnvState",
    "EnvStates",
    "EpisodeEnd",
    "EpisodeTable",
    "Error",
    "ErrorCode",
    "GeodesicFields",
    "LearnedPolicy",
    "ObjectBoxes",
    "Outcome",
    "PathFinder",
    "PlanningScene",
    "Pose",
    "Poses",
    "RayCaster",
    "Renderer",
    "ScriptedPhase",
    "ScriptedPolicy",
    "ScriptedTrouble",
    "Simulator",
    "Task",
    "TaskEnvs",
    "VectorEnv",
    "World",
    "__version__",
    "look_at",
    "reached",
]
