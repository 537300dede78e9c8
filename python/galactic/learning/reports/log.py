"""Passes rows of the curves to the user's own program, such as an experiment tracker."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Mapping
from typing import Any

from galactic.learning.user_code import own_code

TakeRow = Callable[[Mapping[str, float]], object]
"""Takes a row: the known values of the columns of reports.curves, by name."""


MakeTaker = Callable[[pathlib.Path, Mapping[str, Any]], TakeRow]
"""Makes a TakeRow for a run in this folder, with these settings."""


def maker(text: str) -> MakeTaker:
    """The function that `text` names (own_code.named()). Its file runs now; exceptions of the file
    reach the caller."""
    return own_code.factory_of(own_code.named(text, "--log-to"), "what takes a row")


class Log:
    """Passes rows on. An exception is reported, once of each type, and the run continues: a tracker
    that cannot be reached must not end the training."""

    def __init__(self, take: TakeRow, say: Callable[[str], None]):
        self._take = take
        self._say = say
        self._told: set[str] = set()

    def add(self, values: Mapping[str, float]) -> None:
        self._try(lambda: self._take(dict(values)), "the row is lost, and the run goes on")

    def close(self) -> None:
        """Signals that no more rows follow: calls close() of the taker, or finish() if it has no
        close()."""
        for name in ("close", "finish"):
            end = getattr(self._take, name, None)
            if callable(end):
                self._try(end, f"it came out of its {name}()")
                return

    def _try(self, work: Callable[[], object], outcome: str) -> None:
        try:
            work()
        except Exception as error:  # user code may raise anything
            kind = type(error).__name__
            if kind not in self._told:
                self._told.add(kind)
                self._say(f"--log-to: {kind}: {error}; {outcome}")
