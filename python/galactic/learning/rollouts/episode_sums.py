"""Sums of episode results: over envs, ranks and the window of the curves."""

from __future__ import annotations

import collections
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

MEASURE = "measure_"
"""The prefix of the names of means of a task's own measures; no other mean has it."""
LOG = "log_"
"""The prefix for what a task logs in each step; of the other means, only the policy's log_std has
it."""


class OwnNames(NamedTuple):
    """The names of what a user-defined task measures of each episode, and logs in each step."""

    measures: tuple[str, ...] = ()
    logs: tuple[str, ...] = ()

    @property
    def of_means(self) -> list[str]:
        """The names of their means."""
        return [MEASURE + name for name in self.measures] + [LOG + name for name in self.logs]


@dataclass
class EpisodeSums:
    """Sums over some episodes. `picks`: in how many of them the target was in the hand. `measures`:
    sums of what a user-defined task measures, by name; missing names count as 0, and NaN means
    unknown. `logs`: sums of what it logs, over `steps` steps of these and of unfinished
    episodes."""

    episodes: float = 0.0
    successes: float = 0.0
    picks: float = 0.0
    returns: float = 0.0
    lengths: float = 0.0
    measures: dict[str, float] = field(default_factory=dict)
    steps: float = 0.0
    logs: dict[str, float] = field(default_factory=dict)

    def by_name(self, names: OwnNames) -> dict[str, float]:
        """All sums by name, with those of the task that are in `names`. The inverse of of()."""
        return {
            "episodes": self.episodes,
            "successes": self.successes,
            "picks": self.picks,
            "returns": self.returns,
            "lengths": self.lengths,
            **{MEASURE + name: self.measures.get(name, 0.0) for name in names.measures},
            "steps": self.steps,
            **{LOG + name: self.logs.get(name, 0.0) for name in names.logs},
        }

    @classmethod
    def of(cls, numbers: Mapping[str, float], names: OwnNames) -> EpisodeSums:
        """The inverse of by_name(). Sums of the task that are missing in `numbers` are unknown
        (NaN)."""
        return cls(
            numbers["episodes"],
            numbers["successes"],
            numbers["picks"],
            numbers["returns"],
            numbers["lengths"],
            {name: numbers.get(MEASURE + name, math.nan) for name in names.measures},
            numbers["steps"],
            {name: numbers.get(LOG + name, math.nan) for name in names.logs},
        )

    @classmethod
    def total(cls, parts: Iterable[EpisodeSums], names: OwnNames) -> EpisodeSums:
        """The sum of all parts."""
        rows = [one.by_name(names) for one in (cls(), *parts)]
        return cls.of({name: sum(row[name] for row in rows) for name in rows[0]}, names)

    def means(self) -> dict[str, float]:
        """Means per episode, or per step for logs, by the names of the columns of the curves; empty
        if there was no episode."""
        if not self.episodes:
            return {}
        sums = {
            "success": self.successes,
            "picked": self.picks,
            "return": self.returns,
            "length": self.lengths,
            **{MEASURE + name: total for name, total in self.measures.items()},
        }
        means = {name: total / self.episodes for name, total in sums.items()}
        means |= {LOG + name: total / max(self.steps, 1.0) for name, total in self.logs.items()}
        return {name: mean for name, mean in means.items() if not math.isnan(mean)}


class RecentEpisodes:
    """The latest episodes of training: those of the fewest rollouts that have at least `window`
    episodes. `waiting`: how many envs of all ranks have not finished an episode yet."""

    def __init__(self, names: OwnNames, window: int, waiting: int):
        self.waiting = waiting
        self._names = names
        self._window = window
        self._rollouts: collections.deque[EpisodeSums] = collections.deque()

    def add(self, sums: EpisodeSums, waiting: int) -> None:
        """Adds the episodes of a rollout."""
        self.waiting = waiting
        self._rollouts.append(sums)
        kept = sum(one.episodes for one in self._rollouts)
        while kept - self._rollouts[0].episodes >= self._window:
            kept -= self._rollouts.popleft().episodes

    def total(self) -> EpisodeSums:
        return EpisodeSums.total(self._rollouts, self._names)

    def figures(self) -> dict[str, float]:
        """Means over total(): success, picked, return, length, and what the task measures and logs.
        Empty before every env has finished an episode, because the first to end are short ones,
        mostly successes."""
        return {} if self.waiting else self.total().means()

    def rows(self) -> list[dict[str, float]]:
        """EpisodeSums.by_name() of each rollout, for take_up()."""
        return [sums.by_name(self._names) for sums in self._rollouts]

    def take_up(self, rows: Iterable[Mapping[str, float]], waiting: int) -> None:
        """Continues from the result of rows(). What the task reports now but the rows lack is
        unknown."""
        self.waiting = waiting
        self._rollouts.clear()
        self._rollouts.extend(EpisodeSums.of(row, self._names) for row in rows)
