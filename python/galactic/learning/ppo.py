"""Proximal policy optimization (Schulman et al. 2017) on one rollout of every rank."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Optional

import torch
from torch import Tensor

from galactic.learning.distributed import Group
from galactic.learning.distributions import ActionDistribution
from galactic.learning.flat_adam import FlatAdam
from galactic.learning.networks import Outputs, Policy
from galactic.learning.noise import mini_batch_envs
from galactic.learning.precision import Precision
from galactic.learning.rollout import Rollout, advantages
from galactic.learning.settings import Settings
from galactic.learning.teacher import Teacher


@dataclass
class Loss:
    """The loss of a mini-batch, and sums of its parts over the mini-batch's steps."""

    total: Tensor
    """To be minimized; already divided by the steps of all ranks."""
    sums: Tensor
    """[6]: in the order of NAMES."""

    NAMES = ("policy_loss", "value_loss", "entropy", "kl", "clipped", "steps")


@dataclass
class Batch:
    """What a mini-batch was when it was collected; all of shape [T, n]."""

    actions: Tensor  # [T, n, A]
    log_probs: Tensor
    values: Tensor
    advantages: Tensor
    returns: Tensor


def ppo_loss(outputs: Outputs, batch: Batch, settings: Settings, entropy_coefficient: float,
             steps: float) -> Loss:  # fmt: skip
    """Clipped surrogate, half the squared error of the value, and entropy, added over a mini-batch
    and divided by `steps`, the number of steps of this mini-batch on all ranks."""
    log_ratio = outputs.actions.log_prob(batch.actions) - batch.log_probs
    ratio = log_ratio.exp()
    clipped = ratio.clamp(1.0 - settings.clip, 1.0 + settings.clip)
    surrogate = torch.minimum(ratio * batch.advantages, clipped * batch.advantages).sum()
    error = (outputs.values - batch.returns).square()
    if settings.value_clip > 0.0:
        shift = (outputs.values - batch.values).clamp(-settings.value_clip, settings.value_clip)
        error = torch.maximum(error, (batch.values + shift - batch.returns).square())
    value_loss = 0.5 * error.sum()
    entropy = outputs.actions.entropy().sum()
    total = (
        settings.value_coefficient * value_loss - surrogate - entropy_coefficient * entropy
    ) / steps
    with torch.no_grad():
        # Schulman's estimate of the divergence, which is never negative.
        kl = (ratio - 1.0 - log_ratio).sum()
        moved = (ratio != clipped).sum()
        count = torch.tensor(float(ratio.numel()), device=ratio.device)
        sums = torch.stack([-surrogate, value_loss, entropy, kl, moved.float(), count])
    return Loss(total, sums)


@dataclass
class Lesson:
    """What a teacher would have done in the steps of a rollout, and how much that counts."""

    actions: ActionDistribution  # of shape [T, N]
    weight: float


class PacedRate:
    """The share of the scheduled learning rate that keeps the divergence of an update, which grows with
    the square of the rate, at `target_kl`: PPO's adaptive penalty (Schulman et al. 2017, section 4)
    with the rate in the penalty's place. Precise policies need it most: the less noise they act with,
    the further a step of the same length leads away. The divergence of an update is the mean over its
    mini-batches of what it was before each one's step: 0 before the first."""

    FIRST = 0.01
    """Adam's first steps are the longest it makes, and may lead a trained policy far away."""
    LEAST = 1e-3

    def __init__(self, target_kl: float):
        self.target_kl = target_kl
        self.share = 1.0 if target_kl == 0.0 else self.FIRST

    def follow(self, kl: float) -> None:
        """After an update of divergence `kl`. Falls at once, rises slowly."""
        if self.target_kl == 0.0 or not math.isfinite(kl):
            return
        wanted = math.sqrt(self.target_kl / max(kl, 1e-12))
        self.share = min(max(self.share * min(max(wanted, 0.5), 1.2), self.LEAST), 1.0)


class Learner:
    """Improves a policy by the rollouts of all ranks. All ranks keep the same parameters, bit for
    bit: they start from the first rank's, and apply the same sum of gradients."""

    def __init__(self, policy: Policy, settings: Settings, group: Group,
                 teacher: Optional[Teacher] = None):  # fmt: skip
        self.policy = policy
        self.teacher = teacher
        self.settings = settings
        self.group = group
        self.precision = Precision(settings.precision, group.device)
        self.optimizer = FlatAdam(policy, settings.learning_rate, settings.adam_epsilon)
        self.rate = PacedRate(settings.target_kl)
        group.copy_from_first(self.optimizer.parameters)

    def update(self, rollout: Rollout, update: int, progress: float) -> dict[str, float]:
        """One update; returns its losses. `update` counts from 0; `progress` is the share of the run
        that is done, for the schedules."""
        settings = self.settings
        steps, envs = rollout.steps, rollout.actions.shape[1]
        self.optimizer.learning_rate = self.rate.share * settings.learning_rate_at(progress)
        entropy_coefficient = settings.entropy_at(progress)
        raw = advantages(
            rollout.rewards[:steps],
            rollout.values[: steps + 1],
            rollout.ends[:steps],
            settings.gamma,
            settings.gae_lambda,
        )
        returns = raw + rollout.values[:steps]
        scaled, all_steps = self._normalized(raw)
        per_mini_batch = all_steps / settings.mini_batches
        lesson = self._lesson(rollout, progress)
        totals = torch.zeros(len(Loss.NAMES) + 2, dtype=torch.float64, device=raw.device)
        for epoch in range(settings.epochs):
            numbers = range(self.group.rank * envs, (self.group.rank + 1) * envs)
            parts = mini_batch_envs(
                settings.seed, update * settings.epochs + epoch, numbers, settings.mini_batches
            )
            for part in parts:
                chosen = torch.from_numpy(part).to(raw.device)
                batch = Batch(
                    rollout.actions[:steps, chosen],
                    rollout.log_probs[:steps, chosen],
                    rollout.values[:steps, chosen],
                    scaled[:, chosen],
                    returns[:, chosen],
                )
                totals += self._step(
                    rollout, chosen, batch, lesson, entropy_coefficient, per_mini_batch
                )
        self._limit_exploration(progress)
        self._absorb_observations(rollout)
        report = self._report(totals, raw, returns)
        if lesson is None:
            del report["teacher_kl"]
        self.rate.follow(report["kl"])
        return report

    def _lesson(self, rollout: Rollout, progress: float) -> Optional[Lesson]:
        weight = self.settings.teacher_weight_at(progress)
        if self.teacher is None or weight == 0.0:
            return None
        return Lesson(self.teacher.actions(rollout), weight)

    def _step(self, rollout: Rollout, chosen: Tensor, batch: Batch, lesson: Optional[Lesson],
              entropy_coefficient: float, steps_of_all: float) -> Tensor:  # fmt: skip
        """One step of the optimizer; the sums of its losses, the divergence from the teacher, and the
        norm of the gradient."""
        self.optimizer.clear()
        with self.precision.autocast():
            hidden = None if rollout.first_hidden is None else rollout.first_hidden[chosen]
            inputs = rollout.inputs(0, rollout.steps, chosen, self.policy.needs_previous)
            outputs = self.policy(inputs, hidden, rollout.starts[: rollout.steps, chosen])
        loss = ppo_loss(outputs, batch, self.settings, entropy_coefficient, steps_of_all)
        total, divergence = loss.total, loss.sums.new_zeros(())
        if lesson is not None:
            divergence = lesson.actions.of(chosen).divergence(outputs.actions).sum()
            total = total + (lesson.weight / steps_of_all) * divergence
        total.backward()
        self.group.sum(self.optimizer.gradients)
        norm = self.optimizer.step(self.settings.max_grad_norm)
        return torch.cat([loss.sums, divergence.detach().reshape(1), norm.reshape(1)]).double()

    def _normalized(self, raw: Tensor) -> tuple[Tensor, float]:
        """Advantages of mean 0 and variance 1 over all ranks, and the steps of all ranks."""
        sums = torch.stack([torch.ones_like(raw).sum(), raw.sum(), raw.square().sum()]).double()
        count, first, second = self.group.sum(sums).tolist()
        if not self.settings.normalize_advantages:
            return raw, count
        mean = first / count
        deviation = max(second / count - mean * mean, 0.0) ** 0.5
        return (raw - mean) / (deviation + 1e-5), count

    def _limit_exploration(self, progress: float) -> None:
        """Noise that a policy may lean on to the end is missing when it acts by its means: less and
        less of it lets the means learn what the noise did."""
        log_std = self.policy.action.log_std
        if log_std is not None:
            with torch.no_grad():
                log_std.clamp_(max=self.settings.log_std_limit_at(progress))

    def _absorb_observations(self, rollout: Rollout) -> None:
        if self.policy.normalize is not None:
            seen = rollout.state[: rollout.steps]
            sums = self.policy.normalize.sums(seen, self.policy.normalize.center)
            self.policy.normalize.absorb(self.group.sum(sums))

    def _report(self, totals: Tensor, raw: Tensor, returns: Tensor) -> dict[str, float]:
        """Means over all ranks, mini-batches and epochs."""
        rounds = self.settings.epochs * self.settings.mini_batches
        moments = [raw.square(), torch.ones_like(raw), returns, returns.square()]
        spread = torch.stack([moment.sum() for moment in moments]).double()
        *sums, error, steps, first, second = self.group.sum(torch.cat([totals, spread])).tolist()
        count = sums[Loss.NAMES.index("steps")]
        report = {name: sums[i] / count for i, name in enumerate(Loss.NAMES[:-1])}
        report["teacher_kl"] = sums[-2] / count
        report["grad_norm"] = sums[-1] / (rounds * self.group.size)
        variance = second / steps - (first / steps) ** 2
        report["explained_variance"] = 1.0 - error / steps / max(variance, 1e-12)
        if self.policy.action.log_std is not None:
            report["log_std"] = float(self.policy.action.log_std.mean())
        return report
