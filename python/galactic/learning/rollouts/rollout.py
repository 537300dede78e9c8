"""The memory of a rollout, and the advantages of its actions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import torch
from torch import Tensor

from galactic.learning.encoders import Inputs
from galactic.learning.rollouts.environments import Observation
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.rollouts.stopwatch import Stopwatch


@dataclass
class Rollout:
    """T steps of N envs. Row t of the observations is what the policy saw before action t.

    Row T of `state`, `rgb`, `depth`, `values` and `starts` belongs to the state after the last step.
    `steps` is how many of the T steps are filled: fewer than T if the rank was cut short.
    """

    state: Tensor  # [T + 1, N, S] float32
    rgb: Tensor | None  # [T + 1, N, H, W, 3] uint8
    depth: Tensor | None  # [T + 1, N, H, W] float32, meters
    actions: Tensor  # [T, N, A] float32, as sampled: motions not clamped
    log_probs: Tensor  # [T, N]
    values: Tensor  # [T + 1, N]
    rewards: Tensor  # [T, N]; in the end with the values of what timeouts cut off
    ends: Tensor  # [T, N] bool: the episode ended with this step
    starts: Tensor  # [T + 1, N] bool: an episode starts here
    first_previous: Tensor  # [N, A] the action before step 0, zero at starts
    first_hidden: Tensor | None  # [N, H] the memory before step 0
    steps: int = 0

    @classmethod
    def empty(cls, horizon: int, envs: int, state: int, actions: int,
              images: Mapping[str, tuple[int, ...]] = {}, hidden: int = 0,
              device: torch.device = torch.device("cpu")) -> Rollout:  # fmt: skip

        def make(*shape: int, dtype: torch.dtype = torch.float32) -> Tensor:
            return torch.zeros(shape, dtype=dtype, device=device)

        rows = horizon + 1
        return cls(
            state=make(rows, envs, state),
            rgb=make(rows, envs, *images["rgb"], dtype=torch.uint8) if "rgb" in images else None,
            depth=make(rows, envs, *images["depth"]) if "depth" in images else None,
            actions=make(horizon, envs, actions),
            log_probs=make(horizon, envs),
            values=make(rows, envs),
            rewards=make(horizon, envs),
            ends=make(horizon, envs, dtype=torch.bool),
            starts=make(rows, envs, dtype=torch.bool),
            first_previous=make(envs, actions),
            first_hidden=make(envs, hidden) if hidden else None,
        )

    def row(self, step: int, envs: slice) -> Observation:
        """The rows of some envs before action `step`, for the envs to write to."""

        def part(rows: Tensor | None) -> Tensor | None:
            return None if rows is None else rows[step, envs]

        return Observation(self.state[step, envs], part(self.rgb), part(self.depth))

    def inputs(self, first: int, last: int, envs: slice | Tensor, previous: bool) -> Inputs:
        """The inputs of a policy in the steps [first, last) of some envs."""

        def part(tensor: Tensor | None) -> Tensor | None:
            return None if tensor is None else tensor[first:last, envs]

        before = None
        if previous:
            before = torch.empty(
                (last - first,) + self.first_previous[envs].shape, device=self.actions.device
            )
            start = 1 if first == 0 else 0
            if start:
                before[0] = self.first_previous[envs]
            before[start:] = self.actions[first + start - 1 : last - 1, envs].clamp(-1.0, 1.0)
            before *= (~self.starts[first:last, envs]).unsqueeze(-1)
        return Inputs(self.state[first:last, envs], part(self.rgb), part(self.depth), before)


class RolloutSource(Protocol):
    """Fills rollouts for the trainer, from a policy that acts or from demonstrations."""

    episodes: EpisodeSums
    """The sums of the episodes that ended in the latest rollout."""
    stopwatch: Stopwatch

    @property
    def PHASES(self) -> tuple[str, ...]:
        """What the stopwatch measures of a rollout."""

    @property
    def plays_episodes(self) -> bool:
        """Whether the policy plays episodes, whose results the curves can show."""

    @property
    def waiting(self) -> int:
        """How many envs have not finished an episode since reset()."""

    def reset(self) -> None:
        """Begins at the first step."""

    def collect(
        self, update: int, should_stop: Callable[[int], bool] = lambda step: False
    ) -> Rollout:
        """The next rollout, for the update with this number. A source that plays may cut it short
        when should_stop(step). The next call overwrites it."""

    def state_dict(self) -> dict[str, Tensor]:
        """Everything that the next collect() depends on, except the policy."""

    def load_state_dict(self, state: dict[str, Tensor]) -> None:
        """Continues from a state_dict(). Raises ValueError if the state does not fit this
        source."""


def advantages(rewards: Tensor, values: Tensor, ends: Tensor, gamma: float, lam: float) -> Tensor:
    """Generalized advantage estimates (Schulman et al. 2016, equation 16); [T, N].

    values [T + 1, N]; ends [T, N] bool: rewards after such a step do not count for it and the steps
    before it. The value of what a timeout cuts off must be in `rewards` already, as gamma times the
    value of the last observation.
    """
    goes_on = (~ends).to(rewards.dtype)
    delta = rewards + gamma * values[1:] * goes_on - values[:-1]
    factor = (gamma * lam) * goes_on
    result = torch.empty_like(rewards)
    following = torch.zeros_like(rewards[0])
    for step in range(len(rewards) - 1, -1, -1):
        following = torch.addcmul(delta[step], factor[step], following)
        result[step] = following
    return result
