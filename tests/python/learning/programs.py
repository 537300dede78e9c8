"""The programs galactic.demonstrate, train, evaluate, export and compare as users run them, on small runs."""

from __future__ import annotations

import contextlib
import io
import os
import pathlib
import resource
import subprocess
import sys
from collections.abc import Iterator

import pytest

from galactic import compare, demonstrate, evaluate, export, train
from galactic.learning.reports.curves import read_curves

WORLDS = pathlib.Path(os.environ.get("GALACTIC_LEARNING_WORLDS", "none"))
WORLD, HELD_OUT = WORLDS / "world.pack", WORLDS / "held_out.pack"
SMALL_OF_ANY_RANKS = ["--preset", "quick", "--envs", "16", "--horizon", "8", "--log-every", "0"]
SMALL = [*SMALL_OF_ANY_RANKS, "--ranks", "1"]
UPDATE = 16 * 8
_PROGRAMS = {
    "compare": compare,
    "demonstrate": demonstrate,
    "evaluate": evaluate,
    "export": export,
    "train": train,
}

needs_worlds = pytest.mark.skipif(
    not WORLD.is_file(), reason="GALACTIC_LEARNING_WORLDS has no worlds"
)


def command(program: str, *arguments: object) -> list[str]:
    return [sys.executable, "-B", "-m", f"galactic.{program}", *map(str, arguments)]


def run(program: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    """As a user runs it: in processes of its own."""
    return subprocess.run(
        command(program, *arguments), capture_output=True, text=True, timeout=600, check=False
    )


def call(program: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    """As run(), as the only rank, in this process, which has read torch: seconds less for each."""
    words = list(map(str, arguments))
    said = io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stderr(said):
        patch.setenv("RANK", "0")
        patch.setenv("WORLD_SIZE", "1")
        try:
            code = _PROGRAMS[program].main(words)
        except SystemExit as stop:
            code = stop.code
    return subprocess.CompletedProcess(words, code, stderr=said.getvalue())


@contextlib.contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """As on a full disk: files of this process cannot grow beyond so many bytes."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def curve(folder: pathlib.Path) -> list[dict[str, float | None]]:
    rows = read_curves(folder / "curves.csv")
    return [{k: v for k, v in row.items() if k not in ("seconds", "sps")} for row in rows]
