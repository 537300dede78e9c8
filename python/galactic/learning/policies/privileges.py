"""Parts of the observation: which the critic alone sees, as they help to judge and no robot has them, and
what the numbers of others mean."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from galactic.learning.refusals import SettingsError, did_you_mean
from galactic.sensors import ALWAYS, SENSORS, meaning_of


def names_of(critic_only: str) -> list[str]:
    """The parts that Settings.critic_only names: "geodesic,bump" names two."""
    return critic_only.replace(",", " ").replace("-", "_").split()


def require_sensors(critic_only: str, own: Sequence[str] = ()) -> None:
    """Raises SettingsError for a part that no sensor gives, and no task of one's own, which gives `own`."""
    known = [*SENSORS, *own]
    for name in names_of(critic_only):
        if name not in known:
            hint = did_you_mean(name, known) or f"; it can be of {', '.join(known)}"
            raise SettingsError(f'critic_only: "{name}" is no sensor{hint}')


def critic_columns(critic_only: str, parts: Sequence[tuple[str, int]]) -> tuple[int, ...]:
    """Columns of these parts in a row of observations, whose parts are `parts`, names and sizes in
    order. Raises SettingsError for a part that is always there, or that is not there."""
    names = names_of(critic_only)
    require_sensors(critic_only, of_own_tasks(parts))
    for name in names:
        if name not in dict(parts):
            raise SettingsError(
                f"critic_only: {name} is not observed; turn the sensor on with --simulation, or leave "
                "it out of --critic-only"
            )
    return columns_among(names, parts)


def columns_among(names: Collection[str], parts: Sequence[tuple[str, int]]) -> tuple[int, ...]:
    """Columns of the parts `names`, as far as they are there, in a row whose parts are `parts`."""
    columns: list[int] = []
    first = 0
    for name, size in parts:
        if name in names:
            columns += range(first, first + size)
        first += size
    return tuple(columns)


def of_own_tasks(parts: Sequence[tuple[str, int]]) -> list[str]:
    """Names of the parts that no simulation gives: a galactic.Task does."""
    return [name for name, _ in parts if name not in ALWAYS and name not in SENSORS]


def parts_of_actor(critic_only: str, parts: Sequence[tuple[str, int]]) -> list[tuple[str, int]]:
    """The parts without those that the critic alone sees."""
    names = names_of(critic_only)
    return [(name, size) for name, size in parts if name not in names]


def options_of_actor(critic_only: str, options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of the simulation without those of sensors that the critic alone sees."""
    left_out = {option for name in names_of(critic_only) for option in SENSORS.get(name, ())}
    return {name: value for name, value in options.items() if name not in left_out}


class OtherMeaning(NamedTuple):
    """An option by which the same numbers mean something else: its value there, and here."""

    option: str
    learned: Any
    found: Any


def other_meaning(names: Iterable[str], learned: Mapping[str, Any],
                  found: Mapping[str, Any]) -> OtherMeaning | None:  # fmt: skip
    """Where numbers of the parts `names` mean something else than where a policy has learned from them, by
    what is known of both from meaning_of(); None where they do not."""
    for option, theirs in meaning_of(names, learned).items():
        if found.get(option, theirs) != theirs:
            return OtherMeaning(option, theirs, found[option])
    return None
