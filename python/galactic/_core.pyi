"""The compiled part of galactic. Its docstrings say what arrays hold; shapes stand beside types."""

import os
from collections.abc import Iterable, Mapping, Sequence
from enum import IntEnum
from typing import Any, Literal, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galactic.cast_hits import CastHits
from galactic.clearances import Clearances
from galactic.env_states import EnvStates, Poses
from galactic.episode_table import EpisodeTable
from galactic.object_boxes import ObjectBoxes

__version__: str

# A number, or a range from which each episode draws: a pair, or text such as "0.1-0.3".
_Drawn = float | tuple[float, float] | str

class ErrorCode(IntEnum):
    IO = 2
    INVALID_INPUT = 3
    INTERNAL = 4
    UNSUPPORTED = 5
    INTERRUPTED = 130

class EpisodeEnd(IntEnum):
    NONE = 0
    SUCCESS = 1
    WRONG_TERMINATE = 2
    WRONG_RELEASE = 3
    WRONG_OBJECT = 4
    TIME_OUT = 5
    FAILURE = 255

class ScriptedPhase(IntEnum):
    PICK = 0
    PLACE = 1
    FINISH = 2
    GAVE_UP = 3

class ScriptedTrouble(IntEnum):
    NONE = 0
    NO_WAY_TO_TARGET = 1
    NO_WAY_TO_GOAL = 2
    NO_GRASP = 3
    NO_PLACEMENT = 4
    NO_FOLD = 5
    STUCK = 6
    MISSED = 7

_Path = str | os.PathLike[str]

class Action:
    @property
    def name(self) -> str: ...
    @property
    def step(self) -> float | None: ...
    @property
    def unit(self) -> Literal["rad", "m"] | None: ...
    @property
    def lower(self) -> float | None: ...
    @property
    def upper(self) -> float | None: ...
    @property
    def position(self) -> int | None: ...

class World:
    def __init__(self, path: _Path | Sequence[_Path], trusted: bool = False) -> None: ...
    @property
    def scenes(self) -> tuple[str, ...]: ...
    @property
    def objects(self) -> tuple[str, ...]: ...
    @property
    def object_centers(self) -> NDArray[np.float32]: ...  # (len(objects), 3)
    @property
    def object_boxes(self) -> ObjectBoxes: ...
    @property
    def robot(self) -> str: ...
    @property
    def links(self) -> tuple[str, ...]: ...
    @property
    def joints(self) -> tuple[str, ...]: ...
    @property
    def positions(self) -> tuple[str, ...]: ...
    @property
    def limits(self) -> NDArray[np.float32]: ...  # (len(positions), 2): lower, upper
    @property
    def actions(self) -> tuple[Action, ...]: ...
    @property
    def episodes(self) -> int: ...
    def episode_table(self) -> EpisodeTable: ...
    @property
    def radii(self) -> tuple[float, ...]: ...
    @property
    def options(self) -> dict[str, Any]: ...

class Pose:
    @property
    def translation(self) -> NDArray[np.float32]: ...  # (3,)
    @property
    def rotation(self) -> NDArray[np.float32]: ...  # (4,): w, x, y, z
    @property
    def matrix(self) -> NDArray[np.float32]: ...  # (4, 4)

class EnvState:
    @property
    def scene(self) -> int: ...
    @property
    def episode(self) -> int: ...
    @property
    def step(self) -> int: ...
    @property
    def world_from_root(self) -> Pose: ...
    @property
    def joint_positions(self) -> NDArray[np.float32]: ...
    @property
    def world_from_grip(self) -> Pose: ...
    @property
    def objects(self) -> list[Pose]: ...
    @property
    def object_names(self) -> tuple[str, ...]: ...
    @property
    def held(self) -> int | None: ...
    @property
    def target(self) -> int: ...
    @property
    def goal(self) -> Pose: ...

class Statistics(TypedDict):
    steps: int
    refused: int
    slid: int
    grasps: int
    drops: int
    restored: int
    episodes: int
    successes: int
    failures: int
    picks: int
    nan_actions: int
    reward: float

class Simulator:
    STAYS: int
    NEXT_EPISODE: int
    NOISE_OPTIONS: tuple[str, ...]  # the keywords of noise of motion and localization, and of delay
    def __init__(
        self,
        world: World,
        envs: int = 128,
        *,
        threads: int = 0,
        seed: int = 1,
        order: Literal["shuffled", "linear", "partition"] = "shuffled",
        rank: int = 0,
        ranks: int = 1,
        body_transforms: bool = False,
        auto_reset: bool = True,
        **options: Any,
    ) -> None: ...
    @property
    def num_envs(self) -> int: ...
    @property
    def action_count(self) -> int: ...
    @property
    def observation_size(self) -> int: ...
    @property
    def observation_parts(self) -> dict[str, slice]: ...
    @property
    def thread_count(self) -> int: ...
    @property
    def options(self) -> dict[str, Any]: ...
    @staticmethod
    def check_options(**options: Any) -> None: ...
    @property
    def skipped_episodes(self) -> list[int]: ...
    @property
    def memory_bytes(self) -> int: ...
    @property
    def shared_bytes(self) -> int: ...
    def step(self, actions: ArrayLike, resets: ArrayLike | None = None) -> None: ...
    def begin_step(self, actions: ArrayLike, resets: ArrayLike | None = None) -> None: ...
    def end_step(self) -> None: ...
    def reset(self, episodes: ArrayLike | None = None, *, drawn: bool = False) -> None: ...
    def check_episodes(self, episodes: ArrayLike) -> None: ...
    def restart(self, seed: int) -> None: ...
    @property
    def observations(self) -> NDArray[np.float32]: ...  # (num_envs, observation_size)
    @property
    def final_observations(self) -> NDArray[np.float32]: ...  # (num_envs, observation_size)
    @property
    def rewards(self) -> NDArray[np.float32]: ...  # (num_envs,)
    @property
    def dones(self) -> NDArray[np.bool_]: ...  # (num_envs,)
    @property
    def successes(self) -> NDArray[np.bool_]: ...  # (num_envs,)
    @property
    def endings(self) -> NDArray[np.uint8]: ...  # (num_envs,), of EpisodeEnd
    @property
    def picks(self) -> NDArray[np.bool_]: ...  # (num_envs,)
    @property
    def idle(self) -> NDArray[np.bool_]: ...  # (num_envs,)
    def episodes(self, envs: Iterable[int] | None = None) -> NDArray[np.int32]: ...
    def env_state(self, env: int) -> EnvState: ...
    def env_states(self, envs: Iterable[int] | None = None) -> EnvStates: ...
    def check_states(self, states: EnvStates) -> None: ...
    def set_states(
        self, states: EnvStates, envs: Iterable[int] | None = None, *, drawn: bool = True
    ) -> NDArray[np.bool_]: ...  # (n,)
    def save_state(self, envs: Iterable[int] | None = None) -> bytes: ...
    def restore_state(self, state: bytes, envs: Iterable[int | None] | None = None) -> None: ...
    def statistics(self, env: int | None = None) -> Statistics: ...
    def counts(self, envs: Iterable[int] | None = None) -> dict[str, NDArray[Any]]: ...  # (n,)
    def episode_noise(
        self, envs: Iterable[int] | None = None
    ) -> dict[str, NDArray[Any]]: ...  # (n,)
    def actions_under_way(
        self, env: int
    ) -> NDArray[np.float32]: ...  # (action_delay, action_count)
    def sample_phases(self, every: int) -> None: ...
    def phase_times(self) -> dict[str, float]: ...

class PlanningScene:
    def __init__(self, simulator: Simulator, env: int | EnvState = 0) -> None: ...
    def update(self, env: int | EnvState) -> None: ...
    def set_joints(self, joint_positions: ArrayLike) -> None: ...
    @property
    def base(self) -> NDArray[np.float32]: ...  # (4,): x, y, z, yaw
    @property
    def root_from_links(self) -> list[Pose]: ...
    @property
    def reach(self) -> float: ...
    def world_from_root(self, base: ArrayLike) -> Pose: ...
    def world_from_grip(self, base: ArrayLike) -> Pose: ...
    def is_free(self, base: ArrayLike) -> bool: ...
    def are_free(
        self, bases: ArrayLike, joint_positions: ArrayLike, *, threads: int = 1
    ) -> NDArray[np.bool_]: ...  # (n,)
    def motions_free(
        self,
        bases: ArrayLike,
        joint_positions: ArrayLike,
        to_bases: ArrayLike,
        to_joint_positions: ArrayLike,
        *,
        threads: int = 1,
    ) -> NDArray[np.bool_]: ...  # (n,)
    def clearances(
        self, bases: ArrayLike, joint_positions: ArrayLike, most: float, *, threads: int = 1
    ) -> Clearances: ...
    def touches_itself(self, margin: float = 0.0) -> bool: ...
    def touch_themselves(
        self, joint_positions: ArrayLike, margin: float = 0.0
    ) -> NDArray[np.bool_]: ...  # (n,)
    def world_from_links(
        self, bases: ArrayLike, joint_positions: ArrayLike
    ) -> Poses: ...  # (n, links)
    def world_from_grips(self, bases: ArrayLike, joint_positions: ArrayLike) -> Poses: ...  # (n,)
    def bases_of(self, states: EnvStates) -> NDArray[np.float32]: ...  # (n, 4)
    def floor_at(self, x: float, z: float, from_height: float) -> float | None: ...
    def floors_at(self, bases: ArrayLike) -> NDArray[np.float32]: ...  # (n,)
    def grasped_at(self, base: ArrayLike) -> int | None: ...
    def hold(self, object: int, base: ArrayLike) -> None: ...
    def put_back(self) -> None: ...
    @property
    def is_holding(self) -> bool: ...
    def ignore_penetrating(self, base: ArrayLike) -> None: ...
    def count_free(self, base: ArrayLike) -> None: ...
    def landing(self, base: ArrayLike) -> Pose | None: ...

class GeodesicFields:
    def __len__(self) -> int: ...
    @property
    def goals(self) -> NDArray[np.float32]: ...  # (k, 3)
    def distances(
        self, bases: ArrayLike, goals: ArrayLike | None = None
    ) -> NDArray[np.float32]: ...  # (n,)
    def directions(
        self, bases: ArrayLike, goals: ArrayLike | None = None
    ) -> NDArray[np.float32]: ...  # (n, 3)
    def path(self, base: ArrayLike, goal: int = 0) -> NDArray[np.float32]: ...  # (m, 3)

class PathFinder:
    cell_size: float
    def __init__(
        self,
        world: World,
        scene: int,
        start: ArrayLike,
        *,
        floor_rise: float | None = None,
        floor_drop: float | None = None,
    ) -> None: ...
    @property
    def origin(self) -> tuple[float, float]: ...
    @property
    def navigable(self) -> NDArray[np.bool_]: ...  # (cells along Z, cells along X)
    @property
    def heights(self) -> NDArray[np.float32]: ...  # (cells along Z, cells along X)
    @property
    def places(self) -> NDArray[np.float32]: ...  # (m, 3)
    def is_navigable(self, bases: ArrayLike) -> NDArray[np.bool_]: ...  # (n,)
    def snap(self, points: ArrayLike) -> NDArray[np.float32]: ...  # (n, 3)
    def fields(
        self, goals: ArrayLike, *, hand: bool = False, threads: int = 0
    ) -> GeodesicFields: ...

class CastEnd(IntEnum):
    NOTHING = 0
    SCENE = 1
    OBJECT = 2
    ROBOT = 3
    OUTSIDE = 4

class RayCaster:
    def __init__(self, world: World, scene: int) -> None: ...
    @staticmethod
    def of_env(simulator: Simulator, env: int = 0, *, robot: bool = False) -> RayCaster: ...
    def cast_rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        lengths: ArrayLike = ...,
        *,
        threads: int = 1,
    ) -> CastHits: ...
    def sweep_spheres(
        self,
        radius: float,
        origins: ArrayLike,
        directions: ArrayLike,
        lengths: ArrayLike = ...,
        *,
        threads: int = 1,
    ) -> CastHits: ...
    def spheres_free(
        self, radius: float, centers: ArrayLike, *, threads: int = 1
    ) -> NDArray[np.bool_]: ...  # (n,)
    @staticmethod
    def cast_rays_in_envs(
        simulator: Simulator,
        origins: ArrayLike,
        directions: ArrayLike,
        lengths: ArrayLike = ...,
        *,
        robot: bool = False,
        threads: int = 1,
    ) -> CastHits: ...
    @staticmethod
    def sweep_spheres_in_envs(
        simulator: Simulator,
        radius: float,
        origins: ArrayLike,
        directions: ArrayLike,
        lengths: ArrayLike = ...,
        *,
        robot: bool = False,
        threads: int = 1,
    ) -> CastHits: ...

class EpisodeTally:
    def __init__(self, simulator: Simulator) -> None: ...
    def add(
        self, rewards: ArrayLike, endings: ArrayLike
    ) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.int64]]: ...
    def take_ended(self) -> dict[str, NDArray[Any]]: ...
    def restart(self, mask: ArrayLike) -> None: ...
    def restore(self, returns: ArrayLike, lengths: ArrayLike) -> None: ...
    @property
    def returns(self) -> NDArray[np.float64]: ...  # (num_envs,)
    @property
    def lengths(self) -> NDArray[np.int64]: ...  # (num_envs,)

class DeviceArray:
    @property
    def shape(self) -> tuple[int, ...]: ...
    def __dlpack__(
        self,
        *,
        stream: int | None = None,
        max_version: tuple[int, int] | None = None,
        dl_device: tuple[int, int] | None = None,
        copy: bool | None = None,
    ) -> Any: ...
    def __dlpack_device__(self) -> tuple[int, int]: ...

class Renderer:
    OPTIONS: tuple[str, ...]  # what its keywords are called
    DEFAULTS: Mapping[str, Any]  # what they are where they are left out
    NOISE_OPTIONS: tuple[str, ...]  # those of noise and jitter
    NOISE_LIMITS: Mapping[str, float]  # and the largest value of each
    def __init__(
        self,
        simulator: Simulator,
        *,
        width: int = 128,
        height: int = 128,
        color: Literal["rgb", "rgba"] | None = "rgb",
        depth: bool = True,
        semantics: bool | Literal["objects"] = False,
        camera: str = "head",
        world_from_camera: ArrayLike | None = None,
        fov_degrees: float = 0,
        position: ArrayLike = (0, 0, 0),
        rpy_degrees: ArrayLike = (0, 0, 0),
        near: float = 0,
        depth_noise: _Drawn = 0,
        depth_dropout: _Drawn = 0,
        color_noise: _Drawn = 0,
        light_jitter: _Drawn = 0,
        camera_jitter: _Drawn = 0,
        camera_jitter_degrees: _Drawn = 0,
        camera_jitter_fov: _Drawn = 0,
        robot: bool = True,
        backend: Literal["auto", "soft", "gl", "cuda"] = "auto",
        device: str | int = "",
        threads: int = 0,
    ) -> None: ...
    def render(
        self, out: dict[str, NDArray[Any]] | None = None, envs: Iterable[int] | None = None
    ) -> dict[str, NDArray[Any]]: ...
    def begin_render(
        self, out: dict[str, NDArray[Any]] | None = None, envs: Iterable[int] | None = None
    ) -> None: ...
    def end_render(self) -> dict[str, NDArray[Any]]: ...
    def render_to_device(self, stream: int = 0) -> dict[str, DeviceArray]: ...
    def place_camera(self, world_from_camera: ArrayLike) -> None: ...
    def episode_noise(self) -> dict[str, NDArray[np.float32]]: ...  # (num_envs,) each
    @property
    def shapes(self) -> dict[str, tuple[tuple[int, ...], np.dtype[Any]]]: ...
    @property
    def intrinsics(self) -> NDArray[np.float32]: ...  # (3, 3) or (num_envs, 3, 3)
    @property
    def world_from_camera(self) -> NDArray[np.float32]: ...  # (num_envs, 4, 4)
    @property
    def backend(self) -> Literal["soft", "gl", "cuda"]: ...
    @property
    def description(self) -> str: ...
    @property
    def semantic_names(self) -> tuple[str, ...]: ...
    @property
    def semantic_scenes(self) -> NDArray[np.int32]: ...  # (len(semantic_names),)

class LearnedPolicy:
    def __init__(
        self,
        path: _Path,
        envs: int,
        *,
        deterministic: bool = False,
        seed: int = 1,
        threads: int = 0,
    ) -> None: ...
    def act(
        self,
        observations: ArrayLike,
        dones: ArrayLike | None = None,
        rgb: ArrayLike | None = None,
        depth: ArrayLike | None = None,
    ) -> NDArray[np.float32]: ...  # (envs, action_count)
    def reset(self) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def robot(self) -> str: ...
    @property
    def options(self) -> dict[str, Any]: ...
    @property
    def observation(self) -> Any: ...
    @property
    def images(self) -> dict[str, Any] | None: ...
    @property
    def action_count(self) -> int: ...

class ScriptedPolicy:
    def __init__(self, simulator: Simulator, *, most_plans: int = 8) -> None: ...
    def act(
        self, mask: ArrayLike | None = None
    ) -> NDArray[np.float32]: ...  # (num_envs, action_count)
    @property
    def phases(self) -> NDArray[np.uint8]: ...  # (num_envs,), of ScriptedPhase
    @property
    def troubles(self) -> NDArray[np.uint8]: ...  # (num_envs,), of ScriptedTrouble

def look_at(eye: ArrayLike, target: ArrayLike) -> NDArray[np.float32]: ...  # (4, 4) or (n, 4, 4)
def write_policy_pack(
    path: _Path, content: Any, trained_with: Any, source_name: str, source: Any
) -> None: ...
