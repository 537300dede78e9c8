"""The base of what improves a policy with the rollouts of all ranks: see ppo.py and
imitation.py."""

from __future__ import annotations

from collections.abc import Iterator

import torch
from torch import Tensor

from galactic.learning.policies.networks import Outputs, Policy
from galactic.learning.ranks.distributed import Group
from galactic.learning.rollouts.noise import mini_batch_envs
from galactic.learning.rollouts.rollout import Rollout
from galactic.learning.settings import Settings
from galactic.learning.updates.flat_adam import FlatAdam
from galactic.learning.updates.precision import Precision
from galactic.learning.updates.schedules import PacedRate


class Learner:
    """Improves a policy with the rollouts of all ranks. All ranks have the same parameters, bit for
    bit: they start from the first rank's, and apply the same sum of gradients."""

    def __init__(self, policy: Policy, settings: Settings, group: Group):
        self.policy = policy
        self.settings = settings
        self.group = group
        self.precision = Precision(
            settings.precision, group.device, sees_images=bool(settings.sight)
        )
        self.optimizer = FlatAdam(policy, settings.learning_rate, settings.adam_epsilon)
        self.rate = PacedRate(settings.target_kl)
        self.share_policy()

    def share_policy(self) -> None:
        """Copies the first rank's policy to all ranks, so that they begin with the same one."""
        for tensor in (self.optimizer.parameters, *self.policy.buffers()):
            self.group.copy_from_first(tensor)

    def update(self, rollout: Rollout, update: int, progress: float) -> dict[str, float]:
        """One update; returns its losses. `update` counts from 0; `progress` is the share of the run
        that is done, for the schedules."""
        raise NotImplementedError

    def _mini_batches(self, rollout: Rollout, update: int) -> Iterator[Tensor]:
        """The envs of each mini-batch of each epoch."""
        settings, envs = self.settings, rollout.actions.shape[1]
        numbers = range(self.group.rank * envs, (self.group.rank + 1) * envs)
        for epoch in range(settings.epochs):
            parts = mini_batch_envs(
                settings.seed, update * settings.epochs + epoch, numbers, settings.mini_batches
            )
            for part in parts:
                yield torch.from_numpy(part).to(rollout.actions.device)

    def _outputs(self, rollout: Rollout, chosen: Tensor) -> Outputs:
        """The policy's outputs for some envs of a rollout."""
        # The policy acts in eval mode, in which cuDNN cannot compute gradients of a GRU.
        self.policy.train()
        with self.precision.autocast():
            hidden = None if rollout.first_hidden is None else rollout.first_hidden[chosen]
            inputs = rollout.inputs(0, rollout.steps, chosen, self.policy.needs_previous)
            return self.policy(inputs, hidden, rollout.starts[: rollout.steps, chosen])

    def _descend(self, loss: Tensor) -> Tensor:
        """One step of the optimizer, after optimizer.clear(). Returns the norm of the gradient over
        all ranks."""
        loss.backward()
        self.group.sum(self.optimizer.gradients)
        norm = self.optimizer.step(self.settings.max_grad_norm)
        self.policy.action.limit_log_std()
        return norm

    def _absorb_observations(self, rollout: Rollout) -> None:
        if self.policy.normalize is not None:
            seen = rollout.state[: rollout.steps]
            sums = self.policy.normalize.sums(seen, self.policy.normalize.center)
            self.policy.normalize.absorb(self.group.sum(sums))
