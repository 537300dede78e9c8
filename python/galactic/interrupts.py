"""What interrupts come to: while a program of the package loads its libraries, which takes seconds, and
while it works.

While it loads, Ctrl-C ends it, quietly. Nothing has been done by then that there would be to save or to
tell. Python alone would interrupt whatever is being loaded, and print where. While it works, SIGTERM, which ends
jobs, and SIGHUP, of a terminal that closes, are what Ctrl-C is.
"""

from __future__ import annotations

import contextlib
import os
import signal
import threading
from collections.abc import Callable, Iterator, Mapping
from types import FrameType
from typing import Any

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


def _end(number: int, frame: FrameType | None) -> None:
    os._exit(INTERRUPTED)


_WHILE_LOADING = {
    signal.SIGINT: _end,
    signal.SIGTERM: signal.SIG_DFL,
    signal.SIGHUP: signal.SIG_DFL,
}
"""What ends a program that loads, by which handler: libraries that hang while they are loaded let no other one run."""


@contextlib.contextmanager
def raised() -> Iterator[None]:
    """Around the work of a program: there an interrupt is a KeyboardInterrupt again. What is to be ignored, as nohup has
    it with SIGHUP, is. Whoever calls the work without the program handles signals as they see fit.
    """
    before = {
        number: handler
        for number, handler in _WHILE_LOADING.items()
        if programs.running() and signal.getsignal(number) == handler
    }
    for number in before:
        signal.signal(number, signal.default_int_handler)
    try:
        yield
    finally:
        _restore(before)


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
        _restore(before)


@contextlib.contextmanager
def ended_at_once() -> Iterator[None]:
    """Around what waits for others outside of Python, which sees no interrupt meanwhile: there it ends
    the process without a word."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    found = {number: signal.getsignal(number) for number in _WHILE_LOADING}
    before = {number: one for number, one in found.items() if one != signal.SIG_IGN}
    for number in before:
        signal.signal(number, signal.SIG_DFL)
    try:
        yield
    finally:
        _restore(before)


@contextlib.contextmanager
def held_back() -> Iterator[None]:
    """Around starting programs of the package: an interrupt comes when they have started, and reaches them
    when they have called end_while_loading()."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _restore(handlers: Mapping[signal.Signals, Any]) -> None:
    for number, handler in handlers.items():
        signal.signal(number, handler)
