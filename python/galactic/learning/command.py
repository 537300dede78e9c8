"""What the programs of the package have in common: exit codes, and errors as sentences."""

from __future__ import annotations

import argparse
import sys
from typing import Callable, NoReturn

import galactic
from galactic.learning.checkpoint import CheckpointError
from galactic.learning.distributed import RankLost
from galactic.learning.settings import SettingsError

# Those of all tools of the project.
OK, COMMAND_LINE, INPUT_OUTPUT, INVALID_INPUT, INTERNAL = 0, 1, 2, 3, 4
INTERRUPTED = 130
EXIT_CODES = "Exit codes: 0 ok, 1 command line, 2 I/O, 3 invalid input, 4 internal, 5 unsupported"


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors end with the exit code of all tools."""

    def error(self, message: str) -> NoReturn:
        self.print_usage(sys.stderr)
        self.exit(COMMAND_LINE, f"{self.prog}: {message}\n")


def told(program: str, work: Callable[[], int]) -> int:
    """Does `work` and returns its exit code; what it refuses becomes a line on stderr and a code."""
    try:
        return work()
    except SettingsError as error:
        code, message = COMMAND_LINE, str(error)
    except CheckpointError as error:
        code, message = INVALID_INPUT, str(error)
    except galactic.Error as error:
        code, message = int(error.code), str(error)
    except OSError as error:
        code, message = INPUT_OUTPUT, str(error)
    except (ArithmeticError, RankLost) as error:
        code, message = INTERNAL, str(error)
    print(f"{program}: {message}", file=sys.stderr)
    return code
