"""The contents of a trainer.pt besides the optimizer: how far a run is, and what it has reported so
far."""

from __future__ import annotations

import pathlib
from dataclasses import dataclass
from typing import Any

from galactic.learning.refusals import CheckpointError, require_types
from galactic.learning.rollouts.episode_sums import EpisodeSums, OwnNames


@dataclass
class TrainerState:
    """The state of a Trainer. `row_count`: the number of rows in curves.csv at this point.
    `added_columns`: the columns that a callback has added. `added`: what the callback has logged
    since the latest row. `measures`, `logs`: names of what the task measures and logs. `window`:
    EpisodeSums.by_name() of recent rollouts. `stopwatch`: seconds by name."""

    ranks: int
    updates: int
    rate_share: float
    must_validate: bool
    must_end: bool
    row_count: int
    added_columns: list[str]
    added: dict[str, float]
    waiting: int
    measures: list[str]
    logs: list[str]
    window: list[dict[str, float]]
    seconds: float
    processor_seconds: float
    stopwatch: dict[str, float]

    @property
    def names(self) -> OwnNames:
        return OwnNames(tuple(self.measures), tuple(self.logs))

    def to_values(self) -> dict[str, Any]:
        return dict(vars(self))


def state_of(values: dict[str, Any], ranks: int, names: OwnNames, folder: pathlib.Path) -> TrainerState:  # fmt: skip
    """The state in the values of a trainer.pt in `folder`, for a run with `ranks` ranks whose task
    reports what `names` lists. Raises CheckpointError if the values belong to a different run,
    ValueError if they are malformed."""
    require_types(values, _TYPES)
    state = TrainerState(**{name: values[name] for name in _TYPES})
    if state.ranks != ranks:
        raise CheckpointError(f"{folder} is of {state.ranks} ranks, not {ranks}; start as many")
    for said, known, found in (
        ("measured", names.measures, state.measures),
        ("logged", names.logs, state.logs),
    ):
        lost = [name for name in found if name not in known]
        if lost:
            raise CheckpointError(
                f"{folder} is of a task that {said} {lost[0]}, and the task does so no longer; put "
                "its class back as it was, or begin another run"
            )
    for number, row in enumerate(state.window):
        with_name = {f"window[{number}]": row}
        require_types(with_name, dict.fromkeys(with_name, dict))
        require_types(row, dict.fromkeys(EpisodeSums().by_name(state.names), (float, int)))
    for numbers in (state.added, state.stopwatch):
        require_types(numbers, dict.fromkeys(numbers, (float, int)))
    return state


# The JSON types of the fields of a TrainerState.
_TYPES = {
    "ranks": int,
    "updates": int,
    "rate_share": (float, int),
    "must_validate": bool,
    "must_end": bool,
    "row_count": int,
    "added_columns": list,
    "added": dict,
    "waiting": int,
    "measures": list,
    "logs": list,
    "window": list,
    "seconds": (float, int),
    "processor_seconds": (float, int),
    "stopwatch": dict,
}
