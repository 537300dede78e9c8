"""Ctrl-Z stops a run with all of its ranks."""

from __future__ import annotations

import os
import pathlib
import signal
import subprocess
import sys
import time
from collections.abc import Callable

LAUNCHER = """
import sys
from galactic.learning.ranks.launch import launch
rank = "import os, pathlib, sys, time; pathlib.Path(sys.argv[1], os.environ['RANK']).write_text(str(os.getpid())); time.sleep(600)"
sys.exit(launch(2, [sys.executable, "-c", rank, sys.argv[1]]))
"""


def becomes(condition: Callable[[], bool]) -> bool:
    """Whether it does, before one gives up."""
    deadline = time.monotonic() + 120.0
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.02)
    return condition()


def is_stopped(process: int) -> bool:
    status = pathlib.Path(f"/proc/{process}/stat").read_text(encoding="utf-8")
    return status.rpartition(")")[2].split()[0] == "T"


def test_ctrl_z_stops_all_ranks_until_the_run_goes_on(tmp_path: pathlib.Path) -> None:
    command = [sys.executable, "-B", "-c", LAUNCHER, str(tmp_path)]
    # A session of its own has no terminal, in whose group there would have to be a shell.
    with subprocess.Popen(command, start_new_session=True) as launcher:
        try:
            files = [tmp_path / "0", tmp_path / "1"]
            assert becomes(lambda: all(f.exists() and f.read_text() for f in files))
            all_of_them = [launcher.pid, *(int(file.read_text()) for file in files)]
            for _ in range(2):
                os.kill(launcher.pid, signal.SIGTSTP)
                assert becomes(lambda: all(map(is_stopped, all_of_them)))
                os.kill(launcher.pid, signal.SIGCONT)
                assert becomes(lambda: not any(map(is_stopped, all_of_them)))
        finally:
            os.kill(launcher.pid, signal.SIGCONT)
            os.kill(launcher.pid, signal.SIGTERM)
    assert launcher.returncode == 130
