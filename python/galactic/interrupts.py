"""What interrupts come to: while a program of the package loads its libraries, which takes seconds, and
while it works.

While it loads, Ctrl-C ends it, quietly. Nothing has been done by then that there would be to save or to
tell. Python alone would interrupt whatever is being loaded, and print where.
"""

from __future__ import annotations

import contextlib
import os
import signal
import threading
from types import FrameType
from typing import Callable, Iterator, Optional

from galactic import programs

INTERRUPTED = 130
"""The exit code of what a Ctrl-C has ended."""


def end_while_loading() -> None:
    """Called first of all. Does nothing unless Python is about to run a program of the package, as in
    `python3 -m galactic.train`: whoever imports it handles interrupts as they see fit."""
    if programs.loading():
        # Where they are to be ignored, they are.
        if signal.getsignal(signal.SIGINT) == signal.default_int_handler:
            signal.signal(signal.SIGINT, _end)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})


def _end(number: int, frame: Optional[FrameType]) -> None:
    os._exit(INTERRUPTED)


@contextlib.contextmanager
def raised() -> Iterator[None]:
    """Around the work of a program: there an interrupt is a KeyboardInterrupt again."""
    if signal.getsignal(signal.SIGINT) != _end:
        yield
        return
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, _end)


@contextlib.contextmanager
def handled(handler: Callable[[int], None]) -> Iterator[None]:
    """Around work that ends as it sees fit: SIGINT and SIGTERM call `handler` with their number."""
    before = {
        number: signal.signal(number, lambda found, _: handler(found))
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield
    finally:
        for number, one in before.items():
            signal.signal(number, one)


@contextlib.contextmanager
def ended_at_once() -> Iterator[None]:
    """Around what waits for others outside of Python, which sees no interrupt meanwhile: there it ends
    the process without a word."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextlib.contextmanager
def held_back() -> Iterator[None]:
    """Around starting programs of the package: an interrupt comes when they have started, and reaches them
    when they have called end_while_loading()."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
