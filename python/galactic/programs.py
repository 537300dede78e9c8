"""Before a program of the package runs: which one it is, and whether Python has the libraries that it needs.

Without them, Python alone would print where they were to be imported.
"""

from __future__ import annotations

import importlib.util
import re
import sys
from typing import Optional

from galactic.streams import put

UNSUPPORTED = 5
"""The exit code where something is not there that a program needs."""

_PROGRAMS = r"galactic\.(?:train|evaluate|export|demonstrate|compare)"

_DEBIAN = {"numpy": "python3-numpy", "torch": "python3-torch"}
"""The libraries of all programs, and the packages that have them."""


def loading() -> Optional[str]:
    """`galactic.train` where Python is about to run it, as in `python3 -m galactic.train`; None where
    somebody else imports the package."""
    # This is what Python has there until it has found the module of -m.
    if sys.argv[:1] != ["-m"]:
        return None
    found = (re.fullmatch(rf"(?:-\w*m)?({_PROGRAMS})", word) for word in sys.orig_argv)
    return next((match[1] for match in found if match), None)


def running() -> bool:
    """Whether Python runs a program of the package, once it has loaded it."""
    main = getattr(sys.modules.get("__main__"), "__spec__", None)
    return main is not None and re.fullmatch(_PROGRAMS, main.name) is not None


def end_without_libraries() -> None:
    """Ends a program that is about to run where one of its libraries is missing, and says which. Whoever
    else imports the package gets Python's own exception where it is."""
    program = loading()
    missing = [name for name in _DEBIAN if program and importlib.util.find_spec(name) is None]
    if missing:
        packages = " ".join(_DEBIAN[name] for name in missing)
        put(
            sys.stderr,
            f"{program}: needs {' and '.join(missing)}, which {sys.executable} does not have; install "
            f"{'it' if len(missing) == 1 else 'them'} (Debian: {packages})\n",
        )
        sys.exit(UNSUPPORTED)
