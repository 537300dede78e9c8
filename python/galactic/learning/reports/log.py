"""Rows of the curves for a program of one's own, such as an experiment tracker."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Mapping
from typing import Any

from galactic.learning.user_code import own_code

TakeRow = Callable[[Mapping[str, float]], object]
"""Takes a row: what is known of the columns of reports.curves, by name."""


MakeTaker = Callable[[pathlib.Path, Mapping[str, Any]], TakeRow]
"""Makes one for a run in this folder, with these settings."""


def maker(text: str) -> MakeTaker:
    """The function that `text` names (own_code.named()). Its file runs now; what that raises is the caller's."""
    return own_code.factory_of(own_code.named(text, "--log-to"), "what takes a row")


class Log:
    """Hands rows on. What is raised then is told, once of each kind, and the run goes on without: a tracker that cannot
    be reached costs no training."""

    def __init__(self, take: TakeRow, say: Callable[[str], None]):
        self._take = take
        self._say = say
        self._told: set[str] = set()

    def add(self, values: Mapping[str, float]) -> None:
        self._try(lambda: self._take(dict(values)), "the row is lost, and the run goes on")

    def close(self) -> None:
        """Says that no more rows come: calls close() of what takes them, or else finish(), if it has any."""
        for name in ("close", "finish"):
            end = getattr(self._take, name, None)
            if callable(end):
                self._try(end, f"it came out of its {name}()")
                return

    def _try(self, work: Callable[[], object], outcome: str) -> None:
        try:
            work()
        except Exception as error:  # of a stranger's code
            kind = type(error).__name__
            if kind not in self._told:
                self._told.add(kind)
                self._say(f"--log-to: {kind}: {error}; {outcome}")
