"""Checks whether a policy can act on observations from elsewhere than its own training."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from galactic.learning.policies.privileges import (
    OtherMeaning,
    of_own_tasks,
    other_meaning,
    parts_of_actor,
)
from galactic.learning.refusals import CheckpointError
from galactic.learning.saving.checkpoint import SavedPolicy


class Observed(NamedTuple):
    """What a run observes and controls: names and sizes of the parts, what their numbers mean
    (sensors.meaning_of()), and the number of motions."""

    parts: Sequence[tuple[str, int]]
    meanings: Mapping[str, Any]
    motions: int


def columns_of(saved: SavedPolicy, file: pathlib.Path, observed: Observed, remedy: str,
               hiding: str = "") -> list[int]:  # fmt: skip
    """The columns of an observed row that a policy reads; the row may have more. For messages:
    `file`, from which the policy was read, `remedy`, what to do, and `hiding`, how to keep an added
    sensor from the learner. Raises CheckpointError if something is missing or has a different
    meaning."""
    if saved.shape.motions != observed.motions:
        raise CheckpointError(
            f"{file} decides {saved.shape.motions} motions, found {observed.motions} in this run; "
            f"{remedy}, of this robot"
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
                f"{file} sees {name}, which this run does not observe; {source}{hiding}, or {remedy}"
            )
        if sizes[name] != size:
            raise CheckpointError(
                f"{file} sees {size} numbers of {name}, found {sizes[name]} in this run; give "
                f"both the same robot and options of the simulation, or {remedy}"
            )
    other = other_meaning_of(saved, observed.meanings)
    if other:
        raise CheckpointError(
            f"{file} learned with {other.option}={other.learned}, found {other.found} in this run, where "
            f"the same numbers mean something else; give both the same, or {remedy}"
        )
    columns, first = {}, 0
    for name, size in observed.parts:
        columns[name] = range(first, first + size)
        first += size
    return [column for name, _ in saved.parts for column in columns[name]]


def other_meaning_of(saved: SavedPolicy, found: Mapping[str, Any]) -> OtherMeaning | None:
    """The first option that changes the meaning of what the policy sees since its training; None if
    there is none."""
    seen = [name for name, _ in parts_of_actor(saved.settings.critic_only, saved.parts)]
    return other_meaning(seen, saved.meanings, found)
