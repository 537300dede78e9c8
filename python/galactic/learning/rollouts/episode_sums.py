"""What episodes came to, added up: over envs, ranks and the window of the curves."""

from __future__ import annotations

import collections
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

MEASURE = "measure_"
"""What the names of means begin with that are of a task's own measures: no other one does."""
LOG = "log_"
"""The same of what it says of each step, beside the policy's log_std."""


class OwnNames(NamedTuple):
    """What a task of one's own says of each episode, and of each step, by name."""

    measures: tuple[str, ...] = ()
    logs: tuple[str, ...] = ()

    @property
    def of_means(self) -> list[str]:
        """What their means are called."""
        return [MEASURE + name for name in self.measures] + [LOG + name for name in self.logs]


@dataclass
class EpisodeSums:
    """Sums over some episodes. `picks`: in how many of them the target had been in the hand.
    `measures`: of what a task of one's own says of them, by name; those that
    are not there are 0, and NaN is not known. `logs`: the same of what it says of each of `steps`, of these
    episodes or of others that are under way."""

    episodes: float = 0.0
    successes: float = 0.0
    picks: float = 0.0
    returns: float = 0.0
    lengths: float = 0.0
    measures: dict[str, float] = field(default_factory=dict)
    steps: float = 0.0
    logs: dict[str, float] = field(default_factory=dict)

    def by_name(self, names: OwnNames) -> dict[str, float]:
        """All of them, and of the task's own what is named; of() makes the same of it."""
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
        """Of the task's own what is named, and not known where it is not among `numbers`."""
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
        """Of all parts together."""
        rows = [one.by_name(names) for one in (cls(), *parts)]
        return cls.of({name: sum(row[name] for row in rows) for name in rows[0]}, names)

    def means(self) -> dict[str, float]:
        """Of an episode or a step, by the names that columns of the curves have; nothing where no episode was."""
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
    """The latest episodes of training, `window` or a few more: those of as few rollouts as cover it. `waiting`: envs
    of all ranks that have not finished an episode yet."""

    def __init__(self, names: OwnNames, window: int, waiting: int):
        self.waiting = waiting
        self._names = names
        self._window = window
        self._rollouts: collections.deque[EpisodeSums] = collections.deque()

    def add(self, sums: EpisodeSums, waiting: int) -> None:
        """Takes in what a rollout came to."""
        self.waiting = waiting
        self._rollouts.append(sums)
        kept = sum(one.episodes for one in self._rollouts)
        while kept - self._rollouts[0].episodes >= self._window:
            kept -= self._rollouts.popleft().episodes

    def total(self) -> EpisodeSums:
        return EpisodeSums.total(self._rollouts, self._names)

    def figures(self) -> dict[str, float]:
        """Success, picked, return, length and what the task measures, means over total(); none before every env
        has finished an episode: those that are over first are the short ones, successes most of all.
        """
        return {} if self.waiting else self.total().means()

    def rows(self) -> list[dict[str, float]]:
        """What take_up() takes: EpisodeSums.by_name() of each rollout."""
        return [sums.by_name(self._names) for sums in self._rollouts]

    def take_up(self, rows: Iterable[Mapping[str, float]], waiting: int) -> None:
        """Goes on from rows in which less may be named than the task says now: the rest is not known."""
        self.waiting = waiting
        self._rollouts.clear()
        self._rollouts.extend(EpisodeSums.of(row, self._names) for row in rows)
