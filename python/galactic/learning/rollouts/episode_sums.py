"""What episodes came to, added up: over envs, ranks and the window of the curves."""

from __future__ import annotations

import collections
import math
from dataclasses import dataclass, field
from typing import Iterable, NamedTuple, Sequence

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
    """Sums over some episodes. `picks`: in how many of them the target had been in the hand; NaN is not
    known. `measures`: of what a task of one's own says of them, by name; those that
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

    def numbers(self, names: OwnNames) -> list[float]:
        """All of them in a row, of which of() makes the same, with what is named."""
        measured = [self.measures.get(name, 0.0) for name in names.measures]
        logged = [self.logs.get(name, 0.0) for name in names.logs]
        row = [self.episodes, self.successes, self.picks, self.returns, self.lengths, *measured]
        return [*row, self.steps, *logged] if logged else row

    @classmethod
    def of(cls, numbers: Sequence[float], names: OwnNames) -> EpisodeSums:
        episodes, successes, picks, returns, lengths, *own = numbers
        measures = dict(zip(names.measures, own))
        steps, *logged = own[len(measures) :] or [0.0]
        logs = dict(zip(names.logs, logged))
        return cls(episodes, successes, picks, returns, lengths, measures, steps, logs)

    @classmethod
    def total(cls, parts: Iterable[EpisodeSums], names: OwnNames) -> EpisodeSums:
        """Of all parts together."""
        rows = [one.numbers(names) for one in (cls(), *parts)]
        return cls.of([sum(column) for column in zip(*rows)], names)

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

    def numbers(self) -> list[list[float]]:
        """Rows that take_up() takes."""
        return [sums.numbers(self._names) for sums in self._rollouts]

    def take_up(self, rows: Iterable[Sequence[float]], names: OwnNames, waiting: int) -> None:
        """Goes on from rows of what `names` name, which may be less than is named now: the rest is not known."""
        self.waiting = waiting
        self._rollouts.clear()
        for numbers in rows:
            sums = EpisodeSums.of(numbers, names)
            sums.measures = {**dict.fromkeys(self._names.measures, math.nan), **sums.measures}
            sums.logs = {**dict.fromkeys(self._names.logs, math.nan), **sums.logs}
            self._rollouts.append(sums)
