"""What is refused, as sentences: which thing, what was found, what was expected and what to do."""

from __future__ import annotations

import difflib
from typing import Iterable


class SettingsError(ValueError):
    """An invalid setting: says which, what was found and what was expected."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """The end of a sentence that refuses `word`: the nearest of what is known, if one is near."""
    near = difflib.get_close_matches(word, known, 1)
    return f"; did you mean {near[0]}?" if near else ""
