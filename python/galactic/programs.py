"""Checks before a program of the package runs: which program it is, and whether Python has the
libraries that it needs and enough address space for them.

If libraries are missing, Python alone would print a traceback of their import. Without enough
address space, some of them wait for it forever.
"""

from __future__ import annotations

import importlib.util
import re
import resource
import sys

from galactic.streams import put

UNSUPPORTED = 5
"""The exit code if something that a program needs is missing."""

ADDRESS_SPACE = 1_500_000_000
"""The bytes of address space that a process needs, of which it uses a fifth. Loading torch 1.13
takes 0.96 GB, and each rank of the smallest training takes 1.6 GB if available. With 1.3 GB,
OpenBLAS asks for more without end."""

_PROGRAMS = r"galactic\.(?:train|evaluate|export|demonstrate|compare)"

_DEBIAN = {"numpy": "python3-numpy", "torch": "python3-torch"}
"""The libraries that all programs need, and the Debian packages that contain them."""


def loading() -> str | None:
    """The program that Python is about to run, such as `galactic.train` for `python3 -m
    galactic.train`; None if other code imports the package."""
    # Python has this here until it has found the module of -m.
    if sys.argv[:1] != ["-m"]:
        return None
    found = (re.fullmatch(rf"(?:-\w*m)?({_PROGRAMS})", word) for word in sys.orig_argv)
    return next((match[1] for match in found if match), None)


def running() -> bool:
    """Whether Python is running a program of the package, which it has already loaded."""
    main = getattr(sys.modules.get("__main__"), "__spec__", None)
    return main is not None and re.fullmatch(_PROGRAMS, main.name) is not None


def end_without_libraries() -> None:
    """Ends a program that is about to run if one of its libraries is missing, and prints which.
    Other code that imports the package gets Python's own exception at the import."""
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


def end_without_room() -> None:
    """Ends a program that is about to run if a limit leaves a process too little address space, and
    says so."""
    program, (limit, _) = loading(), resource.getrlimit(resource.RLIMIT_AS)
    if program and limit != resource.RLIM_INFINITY and limit < ADDRESS_SPACE:
        put(
            sys.stderr,
            f"{program}: found a limit of {limit // 10**6:,} MB on the address space of a process, expected at least "
            f"{ADDRESS_SPACE // 10**6:,} MB; raise the limit (ulimit -v), or lift it\n",
        )
        sys.exit(UNSUPPORTED)
