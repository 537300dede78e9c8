"""The progress of a run, on one line."""

from __future__ import annotations

import os
import sys
import time
from typing import TextIO

from galactic.streams import put


def duration(seconds: float) -> str:
    """73 as 1:13, 4000 as 1:06:40."""
    whole = max(0, round(seconds))
    minutes, second = divmod(whole, 60)
    hours, minute = divmod(minutes, 60)
    return f"{hours}:{minute:02d}:{second:02d}" if hours else f"{minute}:{second:02d}"


def amount(number: float) -> str:
    """1234567 as 1.23 M."""
    if abs(number) < 999.5:
        return f"{number:.0f}"
    # Rounded first: 999 700 is 1 M, not 1000 k.
    rounded = float(f"{number:.3g}")
    for unit, size in (("G", 1e9), ("M", 1e6), ("k", 1e3)):
        if abs(rounded) >= size:
            break
    return f"{rounded / size:g} {unit}"


class ProgressLine:
    """On a terminal, a line that is overwritten; elsewhere, plain lines from time to time."""

    def __init__(self, stream: TextIO | None = None, *, quiet: bool = False,
                 plain_every: float = 15.0):  # fmt: skip
        self._stream = stream or sys.stderr
        self._quiet = quiet
        self._live = self._stream is not None and self._stream.isatty()
        self._plain_every = plain_every
        self._last = -1e9
        self._open = False

    def show(self, text: str) -> None:
        if self._quiet:
            return
        if self._live:
            put(self._stream, f"\r\x1b[K{self._cut(text)}")
            self._open = True
        elif time.monotonic() - self._last >= self._plain_every:
            self._last = time.monotonic()
            put(self._stream, f"{text}\n")

    def say(self, text: str) -> None:
        """A line that stays."""
        self.close()
        if not self._quiet:
            put(self._stream, f"{text}\n")

    def _cut(self, text: str) -> str:
        """The part of the text that fits on a line of the terminal: a longer line could not be
        overwritten."""
        try:
            columns = os.get_terminal_size(self._stream.fileno()).columns
        except OSError:
            columns = 0  # the value that terminals report if they do not know
        return text[: columns - 1] if columns else text

    def close(self) -> None:
        if self._open:
            put(self._stream, "\n")
            self._open = False
