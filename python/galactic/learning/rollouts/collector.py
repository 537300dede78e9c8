"""Fills rollouts: the policy acts and the environments step, one half of the batch after the
other."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from galactic.learning.encoders import Inputs
from galactic.learning.policies.networks import Policy
from galactic.learning.refusals import require_types
from galactic.learning.rollouts.environments import Environments, Step, Timeouts
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.rollouts.graphs import Function, Replayed, Tensors, record_cuda
from galactic.learning.rollouts.noise import action_noise
from galactic.learning.rollouts.rollout import Rollout
from galactic.learning.rollouts.stopwatch import Stopwatch
from galactic.learning.saving.checkpoint import require_tensors
from galactic.learning.updates.precision import Precision


@dataclass(frozen=True)
class CollectorOptions:
    """`first_env`: the number of this rank's first env among those of all ranks. `cuda_graphs`:
    whether a GPU replays the policy's launches as a graph. `bootstraps`: whether an episode cut off
    by the time limit gets the value of its last observation. `time_columns`: the columns of that
    observation to be set as if there were no time limit."""

    horizon: int
    seed: int
    gamma: float
    first_env: int = 0
    cuda_graphs: bool = False
    bootstraps: bool = True
    time_columns: tuple[int, ...] = ()


class Collector:
    """Steps `envs` with `policy`. Keeps one rollout, which every collect() fills anew, and what has
    to outlive it: memories, previous actions, and the sums of the current episodes."""

    PHASES = ("inference", "sending", "simulation", "post-processing")
    """What the stopwatch measures of a rollout; "simulation" is the time spent waiting for the
    simulation."""
    plays_episodes = True

    def __init__(self, envs: Environments, policy: Policy, options: CollectorOptions,
                 precision: Precision, device: torch.device):  # fmt: skip
        self.envs = envs
        self.policy = policy
        self.options = options
        self.precision = precision
        self.device = device
        self.episodes = EpisodeSums()
        """The sums of the episodes that ended in the latest rollout."""
        self.stopwatch = Stopwatch()
        self.rollout = Rollout.empty(
            options.horizon,
            envs.count,
            envs.state_size,
            envs.motions + 2,
            envs.images,
            policy.hidden_size,
            device,
        )
        self._hidden = policy.initial_hidden(envs.count, device)
        self._returns = np.zeros(envs.count, np.float64)
        self._lengths = np.zeros(envs.count, np.int64)
        # Envs that have not finished an episode yet.
        self._waits = np.ones(envs.count, np.bool_)
        self._timeouts: list[_Timeout] = []
        self._decisions: list[Function] = [self._decide for _ in envs.halves]
        if options.cuda_graphs and device.type == "cuda":
            self._decisions = [Replayed(self._decide, record_cuda) for _ in envs.halves]

    @property
    def waiting(self) -> int:
        """How many envs have not finished an episode since reset()."""
        return int(self._waits.sum())

    def reset(self) -> None:
        """Starts all envs on their first episodes."""
        self.envs.reset(self.rollout.row(0, slice(None)))
        self.rollout.starts[0] = True
        self._waits[:] = True

    def collect(
        self, update: int, should_stop: Callable[[int], bool] = lambda step: False
    ) -> Rollout:
        """Continues from the end of the last rollout, for `horizon` steps or until
        should_stop(step), but for at least one step, as an empty rollout teaches nothing. `update`
        counts from 0 and selects the random numbers. The rollout is ready for the learner; the next
        call overwrites it."""
        options, rollout = self.options, self.rollout
        if rollout.steps:
            self._begin_again()
        self.episodes = EpisodeSums()
        self._timeouts.clear()
        with self.stopwatch.time("post-processing"):
            noise = self._noise(update)
        self.policy.eval()
        with torch.inference_mode():
            self._prepare(noise)
            step = 0
            while step == 0 or (step < options.horizon and not should_stop(step)):
                for half, envs in enumerate(self.envs.halves):
                    if step > 0:
                        self._receive(half, envs, step - 1)
                    self._act(half, envs, step, noise[step, envs])
                step += 1
            rollout.steps = step
            for half, envs in enumerate(self.envs.halves):
                self._receive(half, envs, step - 1)
            with self.stopwatch.time("inference"):
                self._fill_values()
                self._bootstrap_timeouts()
        return rollout

    def state_dict(self) -> dict[str, Tensor]:
        """Everything that the next collect() depends on, except the policy."""
        envs = torch.from_numpy(np.frombuffer(self.envs.save(), np.uint8).copy())
        return {"envs": envs, **self._beside_envs()}

    def _beside_envs(self) -> dict[str, Tensor]:
        """The part of the state whose size does not depend on the saved envs."""
        last = self.rollout.steps
        hidden = {} if self._hidden is None else {"hidden": self._hidden.cpu()}
        return {
            **hidden,
            "previous": self._previous_after(last).cpu(),
            "starts": self.rollout.starts[last].cpu(),
            "returns": torch.from_numpy(self._returns.copy()),
            "lengths": torch.from_numpy(self._lengths.copy()),
            "waits": torch.from_numpy(self._waits.copy()),
        }

    def load_state_dict(self, state: dict[str, Tensor]) -> None:
        """Raises ValueError unless `state` fits the number of envs and this policy, and whatever
        the envs raise."""
        require_types(state, {"envs": Tensor})
        require_tensors(state, self._beside_envs())
        self.envs.restore(state["envs"].numpy().tobytes())
        self.envs.observe(self.rollout.row(0, slice(None)))
        if self._hidden is not None:
            self._hidden.copy_(state["hidden"])
            assert self.rollout.first_hidden is not None
            self.rollout.first_hidden.copy_(state["hidden"])
        self.rollout.first_previous.copy_(state["previous"])
        self.rollout.starts[0].copy_(state["starts"])
        self.rollout.steps = 0
        self._returns[:] = state["returns"].numpy()
        self._lengths[:] = state["lengths"].numpy()
        self._waits[:] = state["waits"].numpy()

    def _begin_again(self) -> None:
        """Moves the state after the last step to row 0."""
        rollout, last = self.rollout, self.rollout.steps
        rollout.first_previous.copy_(self._previous_after(last))
        for rows in (rollout.state, rollout.rgb, rollout.depth, rollout.starts):
            if rows is not None:
                rows[0].copy_(rows[last])
        if self._hidden is not None:
            assert rollout.first_hidden is not None
            rollout.first_hidden.copy_(self._hidden)
        rollout.steps = 0

    def _previous_after(self, steps: int) -> Tensor:
        """[N, A]: the action before the next step, zero where an episode starts."""
        if steps == 0:
            return self.rollout.first_previous
        before = self.rollout.actions[steps - 1].clamp(-1.0, 1.0)
        return before * (~self.rollout.starts[steps]).unsqueeze(-1)

    def _noise(self, update: int) -> Tensor:
        first, horizon = self.options.first_env, self.options.horizon
        envs = range(first, first + self.envs.count)
        steps = range(update * horizon, (update + 1) * horizon)
        noise = action_noise(self.options.seed, envs, steps, self.envs.motions)
        return torch.from_numpy(noise).to(self.device)

    def _prepare(self, noise: Tensor) -> None:
        """Records graphs before a half is sent, since the envs' threads use the device, too."""
        with self.stopwatch.time("inference"):
            for envs, decide in zip(self.envs.halves, self._decisions):
                if isinstance(decide, Replayed):
                    decide.prepare(*self._asked(envs, 0, noise[0, envs]))

    def _asked(self, envs: slice, step: int, noise: Tensor) -> Tensors:
        """The inputs of the policy: arguments of _decide()."""
        inputs = self.rollout.inputs(step, step + 1, envs, self.policy.needs_previous)
        memory = None if self._hidden is None else self._hidden[envs]
        starts = self.rollout.starts[step : step + 1, envs]
        return (*inputs, memory, starts, noise.unsqueeze(0))

    def _act(self, half: int, envs: slice, step: int, noise: Tensor) -> None:
        rollout = self.rollout
        with self.stopwatch.time("inference"):
            asked = self._asked(envs, step, noise)
            actions, log_probs, values, hidden = self._decisions[half](*asked)
            assert actions is not None and log_probs is not None and values is not None
            rollout.actions[step, envs] = actions[0]
            rollout.log_probs[step, envs] = log_probs[0]
            rollout.values[step, envs] = values[0]
            if self._hidden is not None and hidden is not None:
                self._hidden[envs] = hidden
            executed = actions[0].cpu().numpy()
        with self.stopwatch.time("sending"):
            self.envs.send(half, executed, self.rollout.row(step + 1, envs))

    def _decide(self, state: Tensor, rgb: Tensor | None, depth: Tensor | None,
                previous: Tensor | None, hidden: Tensor | None, starts: Tensor,
                noise: Tensor) -> Tensors:  # fmt: skip
        """Actions, their log-probabilities, values, and the memory after the step."""
        with self.precision.autocast():
            outputs = self.policy.act(Inputs(state, rgb, depth, previous), hidden, starts)
            actions = outputs.actions.sample(noise)
            return actions, outputs.actions.log_prob(actions), outputs.values, outputs.hidden

    def _receive(self, half: int, envs: slice, step: int) -> None:
        rollout = self.rollout
        with self.stopwatch.time("simulation"):
            result = self.envs.recv(half)
        with self.stopwatch.time("post-processing"):
            ended = result.terminated | result.truncated
            rollout.rewards[step, envs] = torch.from_numpy(result.rewards).to(self.device)
            ends = torch.from_numpy(ended).to(self.device)
            rollout.ends[step, envs] = ends
            rollout.starts[step + 1, envs] = ends
            self._returns[envs] += result.rewards
            self._lengths[envs] += 1
            self._log(result.logs, len(ended))
            if ended.any():
                self._count(envs, ended, result)
            if result.timeouts is not None and self.options.bootstraps:
                self._timeouts.append(self._timeout(envs, step, result.timeouts))

    def _count(self, envs: slice, ended: np.ndarray, result: Step) -> None:
        returns, lengths, sums = self._returns[envs], self._lengths[envs], self.episodes
        sums.episodes += float(ended.sum())
        sums.successes += float(result.successes[ended].sum())
        sums.picks += float(result.picks[ended].sum())
        sums.returns += float(returns[ended].sum())
        sums.lengths += float(lengths[ended].sum())
        for name, values in result.measures.items():
            measured = float(values[ended].sum(dtype=np.float64))
            sums.measures[name] = sums.measures.get(name, 0.0) + measured
        returns[ended] = 0.0
        lengths[ended] = 0
        self._waits[envs][ended] = False

    def _log(self, logs: Mapping[str, np.ndarray], steps: int) -> None:
        self.episodes.steps += float(steps) if logs else 0.0
        for name, values in logs.items():
            logged = float(values.sum(dtype=np.float64))
            self.episodes.logs[name] = self.episodes.logs.get(name, 0.0) + logged

    def _timeout(self, envs: slice, step: int, timeouts: Timeouts) -> _Timeout:
        """Keeps the inputs for the values of cut-off episodes. They are all computed in one pass at
        the end of the rollout. The memory is the one after the last action."""
        index = torch.from_numpy(timeouts.envs).to(self.device) + (envs.start or 0)

        def part(rows: np.ndarray | None) -> Tensor | None:
            return None if rows is None else torch.from_numpy(rows.copy()).to(self.device)

        state = part(timeouts.state)
        assert state is not None
        # As in the observations of a simulation without a time limit.
        state[:, list(self.options.time_columns)] = 1.0
        return _Timeout(
            step,
            index,
            Inputs(
                state,
                part(timeouts.rgb),
                part(timeouts.depth),
                self.rollout.actions[step, index].clamp(-1.0, 1.0),
            ),
            None if self._hidden is None else self._hidden[index],
        )

    def _fill_values(self) -> None:
        """Fills in the value after the last step, or all values if the policy computes them
        separately."""
        rollout, last = self.rollout, self.rollout.steps
        first = 0 if self.policy.values_apart else last
        inputs = rollout.inputs(first, last + 1, slice(None), self.policy.needs_previous)
        with self.precision.autocast():
            values = self.policy.value(inputs, self._hidden, rollout.starts[first : last + 1])
        rollout.values[first : last + 1] = values

    def _bootstrap_timeouts(self) -> None:
        """Adds gamma times the value of the last observation to the reward of episodes that only
        time cut off (partial-episode bootstrapping: Pardo et al. 2018). With `time_columns`, that
        is what they would have earned if they had continued. Without, the observation says that no
        time is left, as no other row of a rollout does (docs/learning.md)."""
        if not self._timeouts:
            return
        kept = self._timeouts
        count = sum(len(timeout.envs) for timeout in kept)
        # The count differs from rollout to rollout; rounding it up keeps the number of sizes to
        # tune small.
        size = 1 << (count - 1).bit_length() if self.precision.tunes else count
        seen = [timeout.inputs for timeout in kept]
        state = _joined([one.state for one in seen], size)
        assert state is not None
        inputs = Inputs(
            state=state,
            rgb=_joined([one.rgb for one in seen], size),
            depth=_joined([one.depth for one in seen], size),
            previous=_joined([one.previous for one in seen], size),
        )
        hidden = _joined([timeout.hidden for timeout in kept], size)
        hidden = None if hidden is None else hidden[0]
        starts = torch.zeros(1, size, dtype=torch.bool, device=self.device)
        with self.precision.autocast():
            values = self.policy.value(inputs, hidden, starts)[0, :count]
        step = torch.cat([torch.full_like(t.envs, t.step) for t in kept])
        envs = torch.cat([t.envs for t in kept])
        self.rollout.rewards[step, envs] += self.options.gamma * values


@dataclass
class _Timeout:
    """The last observations of k episodes that time cut off in one step."""

    step: int
    envs: Tensor  # [k]
    inputs: Inputs  # [k, ...]
    hidden: Tensor | None  # [k, H]


def _joined(parts: list[Tensor | None], size: int) -> Tensor | None:
    """Joins parts of [k_i, ...], none or all of which are None, to [1, size, ...], padded with
    zeros."""
    there = [part for part in parts if part is not None]
    if not there:
        return None
    count = sum(len(part) for part in there)
    if count < size:
        there.append(there[0].new_zeros(size - count, *there[0].shape[1:]))
    return torch.cat(there).unsqueeze(0)
