"""What programs print: a stream that is closed, or whose disk is full, ends no run."""

from __future__ import annotations

import contextlib
import os
from typing import TextIO


def put(stream: TextIO | None, text: str) -> bool:
    """Writes `text` at once. Whether the stream has taken it; None, which Python has for a stream that
    was closed from the start, takes nothing."""
    if stream is None:
        return False
    try:
        stream.write(text)
        stream.flush()
    except OSError:
        _forget(stream)
        return False
    return True


def _forget(stream: TextIO) -> None:
    """Else Python tries again to write what the stream holds when it ends, and says so in its own way."""
    with contextlib.suppress(OSError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
