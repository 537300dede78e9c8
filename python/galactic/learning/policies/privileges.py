"""Parts of the observation: which only the critic sees, since they help to judge states but no
robot can measure them, and what the numbers of the parts mean."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from galactic.learning.refusals import SettingsError, did_you_mean
from galactic.sensors import ALWAYS, SENSORS, meaning_of


def names_of(critic_only: str) -> list[str]:
    """The names of parts in Settings.critic_only: "geodesic,bump" has two."""
    return critic_only.replace(",", " ").replace("-", "_").split()


def require_sensors(critic_only: str, own: Sequence[str] = ()) -> None:
    """Raises SettingsError for a part that neither a sensor provides nor the user-defined task,
    which provides `own`."""
    known = [*SENSORS, *own]
    for name in names_of(critic_only):
        if name not in known:
            hint = did_you_mean(name, known) or f"; it can be of {', '.join(known)}"
            raise SettingsError(f'critic_only: "{name}" is no sensor{hint}')


def critic_columns(critic_only: str, parts: Sequence[tuple[str, int]]) -> tuple[int, ...]:
    """The columns of the parts that `critic_only` names, in a row of observations made of `parts`,
    names and sizes in order. Raises SettingsError for a part that no optional sensor or task
    provides, or that is not observed."""
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
    """The columns of the parts `names` in a row made of `parts`; absent parts are skipped."""
    columns: list[int] = []
    first = 0
    for name, size in parts:
        if name in names:
            columns += range(first, first + size)
        first += size
    return tuple(columns)


def of_own_tasks(parts: Sequence[tuple[str, int]]) -> list[str]:
    """Names of the parts that come from a galactic.Task, not from the simulation."""
    return [name for name, _ in parts if name not in ALWAYS and name not in SENSORS]


def parts_of_actor(critic_only: str, parts: Sequence[tuple[str, int]]) -> list[tuple[str, int]]:
    """The parts without those that only the critic sees."""
    names = names_of(critic_only)
    return [(name, size) for name, size in parts if name not in names]


def options_of_actor(critic_only: str, options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of the simulation without those of sensors that only the critic sees."""
    left_out = {option for name in names_of(critic_only) for option in SENSORS.get(name, ())}
    return {name: value for name, value in options.items() if name not in left_out}


class OtherMeaning(NamedTuple):
    """An option that changes the meaning of the same numbers: its value in training, and the one
    found here."""

    option: str
    learned: Any
    found: Any


def other_meaning(names: Iterable[str], learned: Mapping[str, Any],
                  found: Mapping[str, Any]) -> OtherMeaning | None:  # fmt: skip
    """The first option that gives numbers of the parts `names` another meaning than in the policy's
    training. `learned` and `found` are results of meaning_of(). None if there is none."""
    for option, theirs in meaning_of(names, learned).items():
        if found.get(option, theirs) != theirs:
            return OtherMeaning(option, theirs, found[option])
    return None
