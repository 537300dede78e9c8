"""What the programs of the package share: exit codes, and error messages as sentences."""

from __future__ import annotations

import argparse
import pathlib
import re
import sys
import traceback
from collections.abc import Callable
from typing import Any, NoReturn

import galactic
from galactic import interrupts
from galactic.interrupts import INTERRUPTED
from galactic.learning.ranks.distributed import RankLost
from galactic.learning.refusals import CheckpointError, SettingsError, did_you_mean
from galactic.learning.user_code import own_code
from galactic.programs import UNSUPPORTED
from galactic.streams import put

# The same exit codes as all tools of the project.
OK, COMMAND_LINE, INPUT_OUTPUT, INVALID_INPUT, INTERNAL = 0, 1, 2, 3, 4
EXIT_CODES = (
    "Exit codes: 0 ok, 1 command line, 2 I/O, 3 invalid input, also an exception of your own code, 4 internal, "
    "5 unsupported, 130 interrupted"
)


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors take one line and exit with the same code as the other tools.
    Options cannot be abbreviated or repeated."""

    def __init__(self, **keywords: Any) -> None:
        super().__init__(allow_abbrev=False, **keywords)
        # Words that begin like a number are values, including -1e-3 and -0.1,0,0.2.
        self._negative_number_matcher = re.compile(r"-[0-9.]")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        words = sys.argv[1:] if args is None else list(args)
        seen: set[str] = set()
        for word in words:
            action = self._option_string_actions.get(word.partition("=")[0])
            if action is not None and action.dest in seen:
                self.error(f"argument {'/'.join(action.option_strings)}: given more than once")
            if action is not None:
                seen.add(action.dest)
        return super().parse_known_args(words, namespace)

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        found, unknown = self.parse_known_args(args, namespace)
        if unknown:
            name = unknown[0].partition("=")[0]
            hint = did_you_mean(name, self._option_string_actions)
            self.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")
        return found

    def print_help(self, file: Any = None) -> None:
        if not put(sys.stdout, self.format_help()):
            self.exit(INPUT_OUTPUT, f"{program_of(self.prog)}: {lost_output()}\n")

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        put(sys.stderr, message or "")
        sys.exit(status)

    def error(self, message: str) -> NoReturn:
        self.exit(COMMAND_LINE, f"{program_of(self.prog)}: command line: {message}; see --help\n")


def lost_output() -> galactic.Error:
    """The error to report if standard output could not be written."""
    message = "cannot be written; check that it is open and that its disk has room"
    return galactic.Error(galactic.ErrorCode.IO, "standard output", message)


def program_of(prog: str) -> str:
    """`galactic.train` of `python3 -m galactic.train`."""
    return prog.split()[-1]


def whole(least: int, most: int) -> Callable[[str], int]:
    """The argparse type of an option that takes whole numbers within a range, written in digits
    only."""

    def parse(text: str) -> int:
        if not re.fullmatch(r"-?[0-9]{1,20}", text) or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(
                f'found "{text}", expected a whole number from {least} to {most}'
            )
        return int(text)

    return parse


def named_path(text: str) -> pathlib.Path:
    """The argparse type of an option that takes a file or a folder. Rejects an empty name, which
    would mean the current folder."""
    if not text:
        raise argparse.ArgumentTypeError("is empty; name a file or a folder")
    return pathlib.Path(text)


def add_device_option(
    parser: argparse.ArgumentParser, what: str, condition: str = "there is one"
) -> None:
    """Adds --device, as ranks.distributed.device_of() takes it. `what`: what runs on the device,
    for the help text."""
    parser.add_argument(
        "--device",
        default="auto",
        choices=("auto", "cpu", "cuda"),
        help=f"{what}; auto: on a CUDA device, if {condition} (auto)",
    )


def told(
    program: str,
    work: Callable[[], int],
    may_tell: Callable[[BaseException], bool] = lambda error: True,
) -> int:
    """Calls `work` and returns its exit code. An exception becomes an exit code and a line on
    stderr, unless `may_tell` returns false. Exceptions from the user's code and unexpected ones are
    printed with their traceback."""
    try:
        with interrupts.raised():
            return work()
    except SystemExit:
        raise
    except BaseException as error:
        code, message = _told_as(error)
        if may_tell(error):
            put(sys.stderr, f"{program}: {message}\n")
        return code


_REFUSALS = (SettingsError, CheckpointError, galactic.Error, RankLost, KeyboardInterrupt)
"""Exceptions whose message is a sentence that says what is wrong, whoever raises them."""


def _is_lack_of_memory(error: BaseException) -> bool:
    """Whether memory ran out. Torch reports this only in the text of a RuntimeError."""
    words = ("allocate memory", "out of memory", "not enough memory")
    is_torch = isinstance(error, RuntimeError) and any(word in str(error) for word in words)
    return is_torch or isinstance(error, MemoryError)


def _told_as(error: BaseException) -> tuple[int, str]:
    """The exit code and the message for an exception."""
    if not isinstance(error, _REFUSALS) and not _is_lack_of_memory(error):
        lines = "".join(traceback.format_exception(error)).rstrip()
        if own_code.has_raised(error):
            return INVALID_INPUT, f"an exception of the code that was named ended it\n{lines}"
        if not isinstance(error, (OSError, ArithmeticError)):
            return INTERNAL, f"an exception that nobody has thought of ended it\n{lines}"
    if isinstance(error, SettingsError):
        return COMMAND_LINE, f"command line: {error}"
    if isinstance(error, CheckpointError):
        return INVALID_INPUT, str(error)
    if isinstance(error, galactic.Error):
        return int(error.code), str(error)
    if isinstance(error, OSError):
        return INPUT_OUTPUT, str(error)
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED, "interrupted"
    if _is_lack_of_memory(error):
        amount = re.search(r"allocate ([0-9.]+ ?(bytes|[KMGT]iB))", str(error))
        asked = f", of which {amount[1]} more were asked for" if amount else ""
        return (
            UNSUPPORTED,
            f"needs more memory than there is{asked}; take less, such as fewer --envs",
        )
    return INTERNAL, str(error)
