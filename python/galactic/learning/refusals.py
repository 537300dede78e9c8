"""Errors in sentences: which thing is wrong, what was found, what was expected and what to do."""

from __future__ import annotations

import contextlib
import difflib
from collections.abc import Iterable, Iterator
from typing import Any

from galactic._core import ErrorCode
from galactic.errors import Error


class SettingsError(ValueError):
    """An invalid setting. The message says which, what was found and what was expected."""


class NetworkError(SettingsError):
    """A class that is not a network, or not the one with which a policy learned. The message says
    what was found, what was expected and what to do."""


class CheckpointError(Exception):
    """A file that is not a checkpoint of this version. The message says which, what was found and
    what to do."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """The end of a message that rejects `word`: it suggests the most similar of the known words, if
    there is one."""
    near = difflib.get_close_matches(word, known, 1)
    return f"; did you mean {near[0]}?" if near else ""


@contextlib.contextmanager
def refusing(fault: str, remedy: str) -> Iterator[None]:
    """A context for loading the contents of a file: any exception, and torch's readers raise all
    kinds, becomes a CheckpointError "FAULT: what was found; REMEDY". A galactic.Error about I/O
    passes through."""
    try:
        yield
    except (CheckpointError, NetworkError):
        raise
    except Exception as error:
        if isinstance(error, Error) and error.code == ErrorCode.IO:
            raise  # an I/O error does not depend on what the file holds
        # Torch prints a line for each layer that does not fit; the first of them is enough.
        found = " ".join(line.strip() for line in str(error).splitlines()[:2])
        if isinstance(error, Error) and error.code == ErrorCode.UNSUPPORTED:
            # The file is of another version, and so would be earlier checkpoints.
            raise CheckpointError(f"{fault}: {found}") from error
        raise CheckpointError(f"{fault}: {found}; {remedy}") from error


def require_types(values: dict[str, Any], types: dict[str, Any]) -> None:
    """Raises ValueError if `values` lacks a name of `types`, or has a value of another type."""
    for name, wanted in types.items():
        if name not in values or not isinstance(values[name], wanted):
            found = repr(values[name]) if name in values else "nothing"
            names = [one.__name__ for one in (wanted if isinstance(wanted, tuple) else (wanted,))]
            raise ValueError(f"{name}: found {found}, expected {' or '.join(names)}")
