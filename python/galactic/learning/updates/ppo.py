"""Proximal policy optimization (Schulman et al. 2017) on one rollout of every rank."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from galactic.learning.policies.distributions import ActionDistribution
from galactic.learning.policies.networks import Outputs, Policy
from galactic.learning.ranks.distributed import Group
from galactic.learning.rollouts.rollout import Rollout, advantages
from galactic.learning.settings import Settings
from galactic.learning.sums import Sums, over_ranks
from galactic.learning.updates.learner import Learner
from galactic.learning.updates.schedules import (
    entropy_at,
    learning_rate_at,
    log_std_limit_at,
    teacher_weight_at,
)
from galactic.learning.updates.teacher import Teacher


@dataclass
class Loss:
    """The loss of a mini-batch, and sums of its parts over the mini-batch's steps."""

    total: Tensor
    """The loss to minimize, already divided by the mini-batch's steps on all ranks."""
    sums: dict[str, Tensor]
    """The sums of policy_loss, value_loss, entropy, kl and clipped, and `steps`, the number of
    steps in them."""


@dataclass
class Batch:
    """The data of a mini-batch from when it was collected; all of shape [T, n] unless noted."""

    actions: Tensor  # [T, n, A]
    log_probs: Tensor
    values: Tensor
    advantages: Tensor
    returns: Tensor


def ppo_loss(outputs: Outputs, batch: Batch, settings: Settings, entropy_coefficient: float,
             steps: float) -> Loss:  # fmt: skip
    """Clipped surrogate, half the squared error of the value, and entropy, summed over a mini-batch
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
        sums = {
            "policy_loss": -surrogate.detach(),
            "value_loss": value_loss.detach(),
            "entropy": entropy.detach(),
            "kl": kl,
            "clipped": moved.float(),
            "steps": count,
        }
    return Loss(total, sums)


@dataclass
class TeacherTargets:
    """What a teacher would have done in the steps of a rollout, and the weight of its loss."""

    actions: ActionDistribution  # of shape [T, N]
    weight: float


class PpoLearner(Learner):
    """Improves a policy with the rewards of its rollouts, and with what a teacher would have done
    in them."""

    def __init__(self, policy: Policy, settings: Settings, group: Group,
                 teacher: Teacher | None = None):  # fmt: skip
        super().__init__(policy, settings, group)
        self.teacher = teacher

    def update(self, rollout: Rollout, update: int, progress: float) -> dict[str, float]:
        settings, steps = self.settings, rollout.steps
        self.optimizer.learning_rate = self.rate.share * learning_rate_at(settings, progress)
        entropy_coefficient = entropy_at(settings, progress)
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
        targets = self._teacher_targets(rollout, progress)
        sums = Sums()
        for chosen in self._mini_batches(rollout, update):
            batch = Batch(
                rollout.actions[:steps, chosen],
                rollout.log_probs[:steps, chosen],
                rollout.values[:steps, chosen],
                scaled[:, chosen],
                returns[:, chosen],
            )
            sums.add(
                self._step(rollout, chosen, batch, targets, entropy_coefficient, per_mini_batch)
            )
        self._limit_exploration(progress)
        self._absorb_observations(rollout)
        report = self._report(sums, raw, returns)
        if targets is None:
            del report["teacher_kl"]
        self.rate.follow(report["kl"])
        return report

    def _teacher_targets(self, rollout: Rollout, progress: float) -> TeacherTargets | None:
        weight = teacher_weight_at(self.settings, progress)
        if self.teacher is None or weight == 0.0:
            return None
        return TeacherTargets(self.teacher.actions(rollout), weight)

    def _step(self, rollout: Rollout, chosen: Tensor, batch: Batch,
              targets: TeacherTargets | None, entropy_coefficient: float,
              steps_of_all: float) -> dict[str, Tensor]:  # fmt: skip
        """One step of the optimizer. Returns the sums of its losses and of teacher_kl, the
        divergence from the teacher, and grad_norm, the norm of the gradient."""
        self.optimizer.clear()
        outputs = self._outputs(rollout, chosen)
        loss = ppo_loss(outputs, batch, self.settings, entropy_coefficient, steps_of_all)
        total, divergence = loss.total, torch.zeros_like(loss.total)
        if targets is not None:
            divergence = targets.actions.of(chosen).divergence(outputs.actions).sum()
            total = total + (targets.weight / steps_of_all) * divergence
        norm = self._descend(total)
        return {**loss.sums, "teacher_kl": divergence.detach(), "grad_norm": norm}

    def _normalized(self, raw: Tensor) -> tuple[Tensor, float]:
        """The advantages, normalized to mean 0 and variance 1 over all ranks if the settings ask
        for it, and the number of steps of all ranks."""
        # In double precision: if all advantages are far from zero, the variance is a small
        # difference of large sums.
        exact = raw.double()
        found = over_ranks(
            self.group,
            {"steps": raw.numel(), "first": exact.sum(), "second": exact.square().sum()},
        )
        count = found["steps"]
        if not self.settings.normalize_advantages:
            return raw, count
        mean = found["first"] / count
        deviation = max(found["second"] / count - mean * mean, 0.0) ** 0.5
        return (raw - mean) / (deviation + 1e-5), count

    def _limit_exploration(self, progress: float) -> None:
        """Lowers the limit of the log-stds. A policy that relies on its noise to the end does worse
        when it acts on its means alone; with less and less noise, the means learn to do what the
        noise did."""
        self.policy.action.limit_log_std(log_std_limit_at(self.settings, progress))

    def _report(self, sums: Sums, raw: Tensor, returns: Tensor) -> dict[str, float]:
        """Means over all ranks, mini-batches and epochs."""
        rounds = self.settings.epochs * self.settings.mini_batches
        raw, returns = raw.double(), returns.double()
        moments: dict[str, float | Tensor] = {
            "rollout_steps": raw.numel(),
            "error": raw.square().sum(),
            "first": returns.sum(),
            "second": returns.square().sum(),
        }
        found = over_ranks(self.group, {**sums.by_name(), **moments})
        of_steps = ("policy_loss", "value_loss", "entropy", "kl", "clipped", "teacher_kl")
        report = {name: found[name] / found["steps"] for name in of_steps}
        report["grad_norm"] = found["grad_norm"] / (rounds * self.group.size)
        steps = found["rollout_steps"]
        variance = found["second"] / steps - (found["first"] / steps) ** 2
        report["explained_variance"] = 1.0 - found["error"] / steps / max(variance, 1e-12)
        if self.policy.action.log_std is not None:
            report["log_std"] = float(self.policy.action.log_std.mean())
        return report
