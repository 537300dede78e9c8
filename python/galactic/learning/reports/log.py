"""Rows of the curves for a program of one's own, such as an experiment tracker."""

from __future__ import annotations

import pathlib
from typing import Any, Callable, Mapping

from galactic.learning import own_code
from galactic.learning.settings import SettingsError

TakeRow = Callable[[Mapping[str, float]], object]
"""Takes a row: what is known of the columns of reports.curves, by name."""


def taker(text: str, folder: pathlib.Path, settings: Mapping[str, Any]) -> TakeRow:
    """What the function that `text` names (own_code.named()) returns for a run in this folder with these
    settings. What it raises is the caller's."""
    code = own_code.named(text, "--log-to")
    make = own_code.members_of(code).get(code.name)
    if not callable(make):
        found = f"{code.place} has no {code.name}" if make is None else f"{code} is no function"
        raise SettingsError(f"--log-to: {found}; name one that takes a folder and settings")
    with own_code.goes_on(code, "when it was called; return what takes a row"):
        take = make(folder, settings)
    if not callable(take):
        raise SettingsError(
            f"--log-to: {code} returned a {type(take).__name__}, expected what takes a row"
        )
    return take


class Log:
    """Hands rows on. What is raised then is told, once of each kind, and the run goes on without: a tracker that cannot
    be reached costs no training."""

    def __init__(self, take: TakeRow, say: Callable[[str], None]):
        self._take = take
        self._say = say
        self._told: set[str] = set()

    def add(self, values: Mapping[str, float]) -> None:
        try:
            self._take(dict(values))
        except Exception as error:  # of a stranger's code
            kind = type(error).__name__
            if kind not in self._told:
                self._told.add(kind)
                self._say(f"--log-to: {kind}: {error}; the row is lost, and the run goes on")
