"""A teacher: a policy from which another one, which sees less, learns. This is kickstarting
(Schmitt et al. 2018), with a teacher that knows what no robot can measure, such as the way to the
goal (Chen et al. 2019)."""

from __future__ import annotations

import pathlib

import torch

from galactic.learning.encoders import Inputs
from galactic.learning.policies.distributions import ActionDistribution
from galactic.learning.policies.fitting import Observed, columns_of
from galactic.learning.ranks.distributed import Group
from galactic.learning.refusals import CheckpointError
from galactic.learning.rollouts.rollout import Rollout
from galactic.learning.saving.checkpoint import SavedPolicy


class Teacher:
    """Computes what the teacher would do in the learner's place. The teacher never acts, and does
    not learn."""

    def __init__(self, saved: SavedPolicy, file: pathlib.Path, observed: Observed, group: Group):
        """`file`: the teacher's file, for messages. All ranks make a Teacher; the first rank's
        weights are used everywhere. Raises CheckpointError if the teacher could not act in the
        run."""
        remedy = "give another --teacher"
        if saved.settings.network != "state" or saved.policy.hidden_size:
            has = "a memory" if saved.settings.network == "state" else "a camera"
            raise CheckpointError(
                f"{file} has {has}, expected a teacher of the network state without --recurrent, which "
                f"judges each observation by itself; {remedy}"
            )
        hiding = " and keep it from the policy with --critic-only"
        columns = columns_of(saved, file, observed, remedy, hiding)
        self._policy = saved.policy.to(group.device).eval()
        # The file may have been replaced between the reads of two ranks.
        for tensor in self._policy.state_dict().values():
            group.copy_from_first(tensor)
        self._columns = torch.tensor(columns, device=group.device)

    @torch.no_grad()
    def actions(self, rollout: Rollout) -> ActionDistribution:
        """What the teacher would have done in each step, of shape [T, N]."""
        seen = rollout.state[: rollout.steps].index_select(-1, self._columns)
        return self._policy.act(Inputs(seen), None, rollout.starts[: rollout.steps]).actions
