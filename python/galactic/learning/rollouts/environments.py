"""The interface of environments that the trainer needs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from torch import Tensor


class Observation(NamedTuple):
    """Memory of a rollout into which environments write, n envs."""

    state: Tensor  # [n, S] float32
    rgb: Tensor | None = None  # [n, H, W, 3] uint8
    depth: Tensor | None = None  # [n, H, W] float32, meters


class Timeouts(NamedTuple):
    """The last observations of k episodes that were cut off by the time limit."""

    envs: np.ndarray  # [k] int64: which envs of the half
    state: np.ndarray  # [k, S] float32
    rgb: np.ndarray | None = None  # [k, H, W, 3] uint8
    depth: np.ndarray | None = None  # [k, H, W] float32


class Step(NamedTuple):
    """The results of a step, n envs."""

    rewards: np.ndarray  # [n] float32
    terminated: np.ndarray  # [n] bool: the task ended the episode, in success or failure
    truncated: np.ndarray  # [n] bool: time did
    successes: np.ndarray  # [n] bool: it ended in success
    picks: np.ndarray  # [n] bool: it ended, and the target was in the hand at some time
    timeouts: Timeouts | None = None  # None: truncated is false everywhere
    # The measures of episodes that ended: [n] each, by the names of Environments.measures.
    measures: Mapping[str, np.ndarray] = {}
    logs: Mapping[
        str, np.ndarray
    ] = {}  # what the task logs in the step: [n] each, by Environments.logs
    infos: Mapping[str, Any] = {}  # as galactic.VectorEnv has them


class Environments(Protocol):
    """`count` envs in one or two halves that can be stepped apart.

    When an episode ends, the next one begins in the same step: the observation after that step is
    the first of the next episode. Actions are rows of `motions` continuous numbers, which the
    environments clamp to [-1, 1], then hand and terminate, each 0 or 1.
    """

    count: int
    state_size: int
    motions: int
    images: Mapping[str, tuple[int, ...]]  # shapes of an env's rgb and depth, of one, or of none
    decides_terminate: bool  # whether the task asks for the terminate action
    halves: Sequence[slice]
    measures: Sequence[str]  # names of what a user-defined task measures of each episode
    logs: Sequence[str]  # names of what it logs in each step
    progress: float  # share of the training that is over, 0 to 1, for such a task

    @property
    def parts(self) -> Sequence[tuple[str, int]]:
        """Names and sizes of the parts of a row of the state, for users of the policy; may be
        empty."""

    @property
    def meanings(self) -> Mapping[str, Any]:
        """Options of the simulation that affect what the numbers of these parts mean."""

    def reset(self, into: Observation) -> None:
        """Starts all envs on their first episodes, and writes the observations of all envs."""

    def observe(self, into: Observation) -> None:
        """Writes the current observations of all envs."""

    def send(self, half: int, actions: np.ndarray, into: Observation) -> None:
        """Begins a step of a half, whose observations are then written to `into`. `actions`
        [n, motions + 2] and `into` must not be touched until recv()."""

    def recv(self, half: int) -> Step:
        """Waits for the step of a half, and returns its results."""

    def save(self) -> bytes:
        """The state of all envs, between two steps."""

    def restore(self, state: bytes) -> None:
        """Restores a state from save(); the envs then continue from it bit for bit."""

    def close(self) -> None:
        """Frees what the envs hold."""
