"""How interrupts are handled: while a program of the package loads its libraries, which takes
seconds, and while it works.

While it loads, Ctrl-C ends it silently: there is nothing to save or to report yet. Python alone
would interrupt whatever is being loaded, and print a traceback. While it works, SIGTERM, which ends
jobs, and SIGHUP, which a closing terminal sends, are handled like Ctrl-C.
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
"""The exit code of a program that Ctrl-C has ended."""


def end_while_loading() -> None:
    """Called before anything else. Does nothing unless Python is about to run a program of the
    package, as in `python3 -m galactic.train`: other code that imports the package handles
    interrupts as it sees fit."""
    if programs.loading():
        # If interrupts are set to be ignored, they stay ignored.
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
"""The signals that end a loading program, and their handlers. The defaults work even if a library
hangs while it is loaded, when no handler in Python could run."""


@contextlib.contextmanager
def raised() -> Iterator[None]:
    """A context for the work of a program, in which interrupts raise KeyboardInterrupt again.
    Signals that are set to be ignored, such as SIGHUP by nohup, stay ignored. Code that calls the
    work without the program handles signals as it sees fit.
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
    """A context for work that decides itself how to end: SIGINT and SIGTERM call `handler` with
    their number."""
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
    """A context for waiting for others outside of Python, which notices no interrupts in the
    meantime: an interrupt ends the process silently."""
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
    """A context for starting programs of the package: an interrupt arrives after they have started,
    and reaches them when they have called end_while_loading()."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _restore(handlers: Mapping[signal.Signals, Any]) -> None:
    for number, handler in handlers.items():
        signal.signal(number, handler)
