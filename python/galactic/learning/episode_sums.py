"""What episodes came to, added up: over envs, ranks and the window of the curves."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Iterable, Sequence

MEASURE = "measure_"
"""What the names of means begin with that are of a task's own measures: no other one does."""


@dataclass
class EpisodeSums:
    """Sums over some episodes. `measures`: of what a task of one's own says of them, by name; those that
    are not there are 0, and NaN is not known."""

    episodes: float = 0.0
    successes: float = 0.0
    returns: float = 0.0
    lengths: float = 0.0
    measures: dict[str, float] = field(default_factory=dict)

    def numbers(self, measures: Sequence[str]) -> list[float]:
        """All of them in a row, of which of() makes the same, with these measures."""
        measured = [self.measures.get(name, 0.0) for name in measures]
        return [self.episodes, self.successes, self.returns, self.lengths, *measured]

    @classmethod
    def of(cls, numbers: Sequence[float], measures: Sequence[str]) -> EpisodeSums:
        episodes, successes, returns, lengths, *measured = numbers
        return cls(episodes, successes, returns, lengths, dict(zip(measures, measured)))

    @classmethod
    def total(cls, parts: Iterable[EpisodeSums], measures: Sequence[str]) -> EpisodeSums:
        """Of all parts together."""
        rows = [one.numbers(measures) for one in (cls(), *parts)]
        return cls.of([sum(column) for column in zip(*rows)], measures)

    def means(self) -> dict[str, float]:
        """Of an episode, by the names that columns of the curves have; nothing where there was none."""
        if not self.episodes:
            return {}
        sums = {
            "success": self.successes,
            "return": self.returns,
            "length": self.lengths,
            **{MEASURE + name: total for name, total in self.measures.items()},
        }
        return {
            name: total / self.episodes for name, total in sums.items() if not math.isnan(total)
        }
