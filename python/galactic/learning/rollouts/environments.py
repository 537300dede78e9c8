"""What the trainer asks of environments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from torch import Tensor


class Observation(NamedTuple):
    """Rows that environments write into: memory of a rollout, n envs."""

    state: Tensor  # [n, S] float32
    rgb: Tensor | None = None  # [n, H, W, 3] uint8
    depth: Tensor | None = None  # [n, H, W] float32, meters


class Timeouts(NamedTuple):
    """The last observations of episodes that time cut off, k of them."""

    envs: np.ndarray  # [k] int64: which envs of the half
    state: np.ndarray  # [k, S] float32
    rgb: np.ndarray | None = None  # [k, H, W, 3] uint8
    depth: np.ndarray | None = None  # [k, H, W] float32


class Step(NamedTuple):
    """What came of an action, n envs."""

    rewards: np.ndarray  # [n] float32
    terminated: np.ndarray  # [n] bool: the task ended the episode, in success or failure
    truncated: np.ndarray  # [n] bool: time did
    successes: np.ndarray  # [n] bool: it ended in success
    picks: np.ndarray  # [n] bool: it ended, and the target had been in the hand at any time of it
    timeouts: Timeouts | None = None  # None: truncated is false everywhere
    # Where an episode ended, what there is to measure of it: [n] each, by the names of Environments.measures.
    measures: Mapping[str, np.ndarray] = {}
    logs: Mapping[
        str, np.ndarray
    ] = {}  # what the task says of the step: [n] each, by Environments.logs
    infos: Mapping[str, Any] = {}  # as galactic.VectorEnv has them


class Environments(Protocol):
    """`count` envs in one or two halves that can be stepped apart.

    An episode that ends is followed by the next one in the same step: the observation after it is the
    first of the next episode. Actions are rows of `motions` continuous numbers, which the environments
    clamp to [-1, 1], then hand and terminate, each 0 or 1.
    """

    count: int
    state_size: int
    motions: int
    images: Mapping[str, tuple[int, ...]]  # shapes of an env's rgb and depth, of one, or of none
    decides_terminate: bool  # whether the task asks for the terminate action
    halves: Sequence[slice]
    measures: Sequence[str]  # names of what a task of one's own says of each episode
    logs: Sequence[str]  # and of each step
    progress: float  # what it is told of how much of the training is over, 0 to 1

    @property
    def parts(self) -> Sequence[tuple[str, int]]:
        """Names and sizes of what a row of the state is made of, for those who use the policy; or none."""

    @property
    def meanings(self) -> Mapping[str, Any]:
        """Options of the simulation by which numbers of these parts mean one thing or another."""

    def reset(self, into: Observation) -> None:
        """Starts all envs on their first episodes, and writes what they see: rows of all envs."""

    def observe(self, into: Observation) -> None:
        """Writes what all envs see now."""

    def send(self, half: int, actions: np.ndarray, into: Observation) -> None:
        """Begins a step of a half, after which its envs' observations land in `into`. `actions`
        [n, motions + 2] and `into` belong to the environments until recv()."""

    def recv(self, half: int) -> Step:
        """Waits for it."""

    def save(self) -> bytes:
        """The state of all envs, between two steps."""

    def restore(self, state: bytes) -> None:
        """Takes up that state: what follows is the same, bit for bit."""

    def close(self) -> None:
        """Frees what the envs hold."""
