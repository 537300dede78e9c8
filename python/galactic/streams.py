"""Printing by programs: a stream that is closed, or whose disk is full, does not end a run."""

from __future__ import annotations

import contextlib
import os
from typing import TextIO


def put(stream: TextIO | None, text: str) -> bool:
    """Writes `text` and flushes the stream. Returns whether that succeeded. `stream` may be None,
    which Python uses for a stream that was closed from the start; nothing is then written."""
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
    """Redirects the stream to nowhere. Otherwise Python tries again at exit to write what the
    stream holds, and prints an error of its own."""
    with contextlib.suppress(OSError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
