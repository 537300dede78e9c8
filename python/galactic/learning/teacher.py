"""A policy that another one learns from, which sees less: kickstarting (Schmitt et al. 2018), with a
teacher that knows what no robot has, such as the way (Chen et al. 2019)."""

from __future__ import annotations

import pathlib
from typing import Any, Mapping, NamedTuple, Sequence

import torch
from torch import Tensor

from galactic.learning.checkpoint import CheckpointError, SavedPolicy
from galactic.learning.distributed import Group
from galactic.learning.distributions import ActionDistribution
from galactic.learning.networks import Inputs
from galactic.learning.privileges import meaning_of, of_own_tasks, parts_of_actor
from galactic.learning.rollout import Rollout


class Observed(NamedTuple):
    """What is observed in a run: names and sizes of the parts, and what their numbers mean
    (privileges.meaning_of())."""

    parts: Sequence[tuple[str, int]]
    meanings: Mapping[str, Any]


class Teacher:
    """Says what it would do where the learner is. It never acts, and does not learn."""

    def __init__(self, saved: SavedPolicy, file: pathlib.Path, observed: Observed, motions: int,
                 group: Group):  # fmt: skip
        """`file`: where it was saved, for messages. `motions`: the learner's. All ranks make one; the first
        one's counts. Raises CheckpointError where it could not play in the run."""
        remedy = "give another --teacher"
        if saved.settings.network != "state" or saved.policy.hidden_size:
            has = "a memory" if saved.settings.network == "state" else "a camera"
            raise CheckpointError(
                f"{file} has {has}, expected a teacher of the network state without --recurrent, which "
                f"judges each observation by itself; {remedy}"
            )
        if saved.shape.motions != motions:
            raise CheckpointError(
                f"{file} decides {saved.shape.motions} motions, found {motions} in this run; {remedy}, of "
                "this robot"
            )
        sizes = dict(observed.parts)
        for name, size in saved.parts:
            if name not in sizes:
                is_own = name in of_own_tasks(saved.parts)
                source = (
                    "take the --task that gives it"
                    if is_own
                    else "turn the sensor on with --simulation"
                )
                raise CheckpointError(
                    f"{file} sees {name}, which this run does not observe; {source} and keep it from the "
                    f"policy with --critic-only, or {remedy}"
                )
            if sizes[name] != size:
                raise CheckpointError(
                    f"{file} sees {size} numbers of {name}, found {sizes[name]} in this run; give "
                    f"both the same robot and options of the simulation, or {remedy}"
                )
        seen = [name for name, _ in parts_of_actor(saved.settings.critic_only, saved.parts)]
        for option, theirs in meaning_of(seen, saved.meanings).items():
            if theirs != observed.meanings.get(option, theirs):
                raise CheckpointError(
                    f"{file} learned with {option}={theirs}, found {observed.meanings[option]} in this run, "
                    f"where the same numbers mean something else; give both the same, or {remedy}"
                )
        self._policy = saved.policy.to(group.device).eval()
        # The file may have been replaced between two ranks.
        for tensor in self._policy.state_dict().values():
            group.copy_from_first(tensor)
        self._columns = torch.tensor(_columns_of(saved.parts, observed.parts), device=group.device)

    @torch.no_grad()
    def actions(self, rollout: Rollout) -> ActionDistribution:
        """What it would have done in each step, of shape [T, N]."""
        seen = rollout.state[: rollout.steps].index_select(-1, self._columns)
        return self._policy.act(Inputs(seen), None, rollout.starts[: rollout.steps]).actions


def _columns_of(wanted: Sequence[tuple[str, int]], parts: Sequence[tuple[str, int]]) -> list[int]:
    """Where the parts `wanted` are in a row of `parts`."""
    columns, first = {}, 0
    for name, size in parts:
        columns[name] = range(first, first + size)
        first += size
    return [column for name, _ in wanted for column in columns[name]]
