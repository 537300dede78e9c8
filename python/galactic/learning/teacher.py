"""A policy that another one learns from, which sees less: kickstarting (Schmitt et al. 2018), with a
teacher that knows what no robot has, such as the way (Chen et al. 2019)."""

from __future__ import annotations

import pathlib
from typing import Optional, Sequence

import torch
from torch import Tensor

from galactic.learning.checkpoint import CheckpointError, SavedPolicy
from galactic.learning.distributed import Group
from galactic.learning.distributions import ActionDistribution
from galactic.learning.networks import Inputs
from galactic.learning.rollout import Rollout
from galactic.learning.settings import Settings, simulation_keyword

# Options of the simulation that say what the numbers of a part mean, by the part's name; those of "" count
# whatever is observed. Noise is not among them: a teacher may have learned with less.
_MEANINGS = {
    "": ["observe_current"],
    "laser": ["laser_fov", "laser_heights", "laser_range", "laser_min_range"],
}


class Teacher:
    """Says what it would do where the learner is. It never acts, and does not learn."""

    def __init__(self, saved: SavedPolicy, file: pathlib.Path, settings: Settings,
                 parts: Sequence[tuple[str, int]], motions: int, group: Group):  # fmt: skip
        """`file`: where it was saved, for messages. `settings`: of the run. `parts`: names and sizes of the
        parts of what is observed there, `motions` the learner's. All ranks make one; the first one's
        counts. Raises CheckpointError where it could not play there."""
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
        observed = dict(parts)
        for name, size in saved.parts:
            if name not in observed:
                raise CheckpointError(
                    f"{file} sees {name}, which this run does not observe; turn the sensor on with "
                    f"--simulation and keep it from the policy with --critic-only, or {remedy}"
                )
            if observed[name] != size:
                raise CheckpointError(
                    f"{file} sees {size} numbers of {name}, found {observed[name]} in this run; give "
                    f"both the same robot and options of the simulation, or {remedy}"
                )
        other = _other_meaning(saved, settings)
        if other is not None:
            raise CheckpointError(
                f"{file} learned with {other[0]}, found {other[1]} in this run, which makes other numbers "
                f"of what it sees; give both the same --simulation, or {remedy}"
            )
        self._policy = saved.policy.to(group.device).eval()
        # The file may have been replaced between two ranks.
        for tensor in self._policy.state_dict().values():
            group.copy_from_first(tensor)
        self._columns = torch.tensor(_columns_of(saved.parts, parts), device=group.device)

    @torch.no_grad()
    def actions(self, rollout: Rollout) -> ActionDistribution:
        """What it would have done in each step, of shape [T, N]."""
        seen = rollout.state[: rollout.steps].index_select(-1, self._columns)
        return self._policy.act(Inputs(seen), None, rollout.starts[: rollout.steps]).actions


def _other_meaning(saved: SavedPolicy, settings: Settings) -> Optional[tuple[str, str]]:
    """The first option by which what a policy sees means something else in a run, there and here."""
    theirs, ours = _values_of(saved.settings), _values_of(settings)
    seen = {"", *(name for name, _ in saved.parts)}
    for part, options in _MEANINGS.items():
        for option in options if part in seen else []:
            if theirs.get(option) != ours.get(option):
                return _said(option, theirs), _said(option, ours)
    return None


def _values_of(settings: Settings) -> dict[str, str | float]:
    """What Settings.simulation sets, numbers as such."""
    values: dict[str, str | float] = {}
    for word in settings.simulation.split():
        text = word.partition("=")[2] or "true"
        try:
            values[simulation_keyword(word)] = float(text)
        except ValueError:
            values[simulation_keyword(word)] = text.lower()
    return {name: value for name, value in values.items() if value not in ("false", -1.0)}


def _said(option: str, values: dict[str, str | float]) -> str:
    if option not in values:
        return f"no {option}"
    value = values[option]
    return (
        option
        if value == "true"
        else f"{option}={value:g}"
        if isinstance(value, float)
        else f"{option}={value}"
    )


def _columns_of(wanted: Sequence[tuple[str, int]], parts: Sequence[tuple[str, int]]) -> list[int]:
    """Where the parts `wanted` are in a row of `parts`."""
    columns, first = {}, 0
    for name, size in parts:
        columns[name] = range(first, first + size)
        first += size
    return [column for name, _ in wanted for column in columns[name]]
