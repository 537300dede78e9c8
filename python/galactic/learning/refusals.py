"""What is refused, as sentences: which thing, what was found, what was expected and what to do."""

from __future__ import annotations

import contextlib
import difflib
from collections.abc import Iterable, Iterator
from typing import Any

from galactic._core import ErrorCode
from galactic.errors import Error


class SettingsError(ValueError):
    """An invalid setting: says which, what was found and what was expected."""


class NetworkError(SettingsError):
    """A class that is no network, or not the one that a policy learned with: says what was found, what was
    expected and what to do."""


class CheckpointError(Exception):
    """A file that is not a checkpoint of this version: says which, what was found, what to do."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """The end of a sentence that refuses `word`: the nearest of what is known, if one is near."""
    near = difflib.get_close_matches(word, known, 1)
    return f"; did you mean {near[0]}?" if near else ""


@contextlib.contextmanager
def refusing(fault: str, remedy: str) -> Iterator[None]:
    """Around taking over what a file holds: whatever is raised, and torch raises whatever its readers
    do, becomes a CheckpointError "FAULT: what was found; REMEDY", unless it is a galactic.Error of a disk.
    """
    try:
        yield
    except (CheckpointError, NetworkError):
        raise
    except Exception as error:
        if isinstance(error, Error) and error.code == ErrorCode.IO:
            raise  # of a disk, which has nothing to do with what the file holds
        # Of layers that do not fit, torch has a line each; the first of them tells enough.
        found = " ".join(line.strip() for line in str(error).splitlines()[:2])
        if isinstance(error, Error) and error.code == ErrorCode.UNSUPPORTED:
            # Of another version: those before it are no better.
            raise CheckpointError(f"{fault}: {found}") from error
        raise CheckpointError(f"{fault}: {found}; {remedy}") from error


def require_types(values: dict[str, Any], types: dict[str, Any]) -> None:
    """Raises ValueError where `values` lacks a name of `types`, or has something of another type."""
    for name, wanted in types.items():
        if name not in values or not isinstance(values[name], wanted):
            found = repr(values[name]) if name in values else "nothing"
            names = [one.__name__ for one in (wanted if isinstance(wanted, tuple) else (wanted,))]
            raise ValueError(f"{name}: found {found}, expected {' or '.join(names)}")
