"""Starts the ranks of a run on this machine, even if there is only one, as torchrun does.

Debian 12's torchrun does not start under Python 3.11; this works everywhere. Across machines, use
torchrun: a process that finds RANK in its environment joins the others.

Even a single rank is a process of its own, because numeric libraries read their environment when
they are loaded.
"""

from __future__ import annotations

import ctypes
import os
import pathlib
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from typing import Any

import torch.distributed

import galactic
from galactic import interrupts
from galactic.interrupts import INTERRUPTED
from galactic.streams import put

LAUNCHER = "GALACTIC_LAUNCHER"
"""The environment variable with the process id of a rank's launcher."""

GRACE = 30.0
"""Seconds that the other ranks have to end after one has failed, before they are killed."""

HURRY = 10.0
"""Seconds that ranks have to end after a second Ctrl-C, which ends them without saving, before they
are killed."""

_INTERNAL = int(galactic.ErrorCode.INTERNAL)


def launch(ranks: int, command: Sequence[str]) -> int:
    """Runs `command` in `ranks` processes that find each other by torch.distributed's environment
    variables, and waits for them. Returns the exit code of the rank that failed, or 0. Interrupts
    are passed on to the ranks, which end in their own way; a terminal that closes asks them to end.
    Ranks that are stuck are killed: see _PassedOn. Ctrl-Z stops the ranks, too, until this process
    continues. Raises galactic.Error if any other signal ended a rank, which could not report that
    itself. Ranks that call follow_launcher() do not outlive this process, whatever ends it."""
    store = torch.distributed.TCPStore("127.0.0.1", 0, is_master=True, wait_for_workers=False)
    environment = {
        **os.environ,
        "MASTER_ADDR": "127.0.0.1",
        "MASTER_PORT": str(store.port),
        # This process serves the store, so no rank has to.
        "TORCHELASTIC_USE_AGENT_STORE": "True",
        "TORCHELASTIC_RESTART_COUNT": "0",
        "WORLD_SIZE": str(ranks),
        "LOCAL_WORLD_SIZE": str(ranks),
        LAUNCHER: str(os.getpid()),
        **_of_libraries(),
    }
    processes: list[subprocess.Popen[bytes]] = []
    with _PassedOn(processes) as signals:
        try:
            for rank in range(ranks):
                own = {**environment, "RANK": str(rank), "LOCAL_RANK": str(rank)}
                # Outside the terminal's process group, so that each interrupt arrives once, from
                # here.
                with interrupts.held_back():
                    processes.append(subprocess.Popen(command, env=own, start_new_session=True))
            signals.all_have_started()
            rank, code = _wait(processes, signals)
        except BaseException:
            # The ranks that have started would wait for the others.
            for process in processes:
                process.kill()
            raise
    if signals.have_killed:
        put(sys.stderr, "ranks that did not end were killed\n")
        return INTERRUPTED
    return code if code >= 0 else _ended_by(signal.Signals(-code), rank)


def follow_launcher() -> None:
    """Ends this rank when its launcher ends: a launcher that is killed cannot end its ranks itself.
    Does nothing under torchrun, which ends its own ranks."""
    launcher = os.environ.get(LAUNCHER)
    if launcher is None:
        return
    set_parent_death_signal = 1  # PR_SET_PDEATHSIG of Linux
    ctypes.CDLL(None).prctl(set_parent_death_signal, int(signal.SIGKILL), 0, 0, 0)
    if os.getppid() != int(launcher):
        # The launcher ended before the call of prctl().
        os.kill(os.getpid(), signal.SIGKILL)


class _PassedOn:
    """Within this context, signals are passed on to the ranks, even signals that arrive before all
    ranks have started.

    Ranks end in their own way, and have as much time as they need to save, however often SIGTERM
    arrives: systemd and Slurm repeat it, and finally kill the processes themselves. Ctrl-C kills
    ranks that are stuck: HURRY seconds after the second one, or at once with the third.
    """

    # Ranks receive SIGTERM for SIGHUP, as they have no terminal.
    _AS = {
        signal.SIGINT: signal.SIGINT,
        signal.SIGTERM: signal.SIGTERM,
        signal.SIGHUP: signal.SIGTERM,
    }

    def __init__(self, processes: Sequence[subprocess.Popen[bytes]]):
        self._processes = processes
        self._have_started = False
        self._early: list[int] = []
        self._before: dict[int, Any] = {}
        self._was_asked = False
        self._deadline = float("inf")
        self.have_killed = False
        """Whether ranks that did not end were killed."""

    def __enter__(self) -> _PassedOn:
        for number in self._AS:
            # Under nohup, SIGHUP stays ignored.
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:
                self._before[number] = signal.signal(number, self._pass_on)
        # A shell without job control ignores SIGTSTP; it stays so.
        if signal.getsignal(signal.SIGTSTP) != signal.SIG_IGN:
            self._before[signal.SIGTSTP] = signal.signal(signal.SIGTSTP, self._pause)
        return self

    def __exit__(self, *_: object) -> None:
        for number, before in self._before.items():
            signal.signal(number, before)

    def all_have_started(self) -> None:
        self._have_started = True
        for number in self._early:
            self._send(number)

    def kill_stuck(self) -> None:
        """Kills the ranks if their time is over. To be called regularly."""
        if time.monotonic() > self._deadline and any(one.poll() is None for one in self._processes):
            self.have_killed = True
            self._signal(signal.SIGKILL)

    def _pass_on(self, number: int, _: Any) -> None:
        if number == signal.SIGINT and self._was_asked:
            is_second = self._deadline == float("inf")
            self._deadline = time.monotonic() + (HURRY if is_second else 0.0)
        self._was_asked = True
        if number == signal.SIGHUP:
            # Both the system and the shell send SIGHUP; pass on only the first one.
            signal.signal(number, signal.SIG_IGN)
        if self._have_started:
            self._send(number)
        else:
            self._early.append(number)

    def _pause(self, number: int, _: Any) -> None:
        """Stops the ranks with this process. Ctrl-Z does not reach them, as they are outside the
        terminal's process group, and they would go on using the processors."""
        self._signal(signal.SIGSTOP)
        os.kill(os.getpid(), signal.SIGSTOP)
        # This process continues here after SIGCONT, which the shell's fg and bg send.
        self._signal(signal.SIGCONT)

    def _send(self, number: int) -> None:
        self._signal(self._AS[signal.Signals(number)])
        # A rank that was stopped could not end.
        self._signal(signal.SIGCONT)

    def _signal(self, number: int) -> None:
        for process in self._processes:
            if process.poll() is None:
                process.send_signal(number)


def _ended_by(number: signal.Signals, rank: int) -> int:
    """The exit code, or the error to raise, for a rank that a signal has ended."""
    if number in (signal.SIGINT, signal.SIGTERM):
        return INTERRUPTED
    code, advice = galactic.ErrorCode.INTERNAL, "please report it"
    if number == signal.SIGKILL:
        # The same code as if the rank had reported the lack of memory itself.
        code = galactic.ErrorCode.UNSUPPORTED
        advice = "the system does that where memory is lacking: take fewer --envs or --ranks"
    raise galactic.Error(code, f"rank {rank}", f"was ended by {number.name}; {advice}")


def _of_libraries() -> dict[str, str]:
    """Environment variables for the numeric libraries and the allocator, without those that are
    already set.

    OpenBLAS 0.3.21 takes processors newer than itself for Haswell, and uses only half the width of
    their registers: on processors with AVX-512, naming a core that has it doubles the speed.
    Threads that wait for work sleep, instead of taking the processor from those that have some.
    Freed memory is kept for the next tensors: when glibc returns it to the system, it comes back
    page by page, each of them cleared, which took a third of an update with images.
    """
    chosen = {
        "OMP_WAIT_POLICY": "passive",
        "MALLOC_MMAP_MAX_": "0",
        "MALLOC_TRIM_THRESHOLD_": str(1 << 62),
    }
    information = pathlib.Path("/proc/cpuinfo")
    if information.is_file():
        words = set(information.read_text(encoding="utf-8", errors="replace").split())
        if {"avx512f", "avx512bw", "avx512dq", "avx512vl"} <= words:
            chosen["OPENBLAS_CORETYPE"] = "SKYLAKEX"
    return {name: value for name, value in chosen.items() if name not in os.environ}


def _wait(processes: Sequence[subprocess.Popen[bytes]], signals: _PassedOn) -> tuple[int, int]:
    """The rank that failed and its exit code; the code is 0 if none failed. The other ranks notice
    the failure and fail, too, perhaps even before the failed rank has ended. So this waits for all,
    and kills those that take longer than GRACE seconds."""
    killed: set[int] = set()
    deadline = float("inf")
    while True:
        codes = [process.poll() for process in processes]
        if None not in codes:
            ended = [rank for rank in range(len(processes)) if rank not in killed]
            return _failure({rank: processes[rank].returncode for rank in ended})
        if any(codes) and deadline == float("inf"):
            deadline = time.monotonic() + GRACE
        if time.monotonic() > deadline:
            killed |= {rank for rank, code in enumerate(codes) if code is None}
            for rank in killed:
                processes[rank].kill()
        signals.kill_stuck()
        time.sleep(0.05)


def _failure(codes: Mapping[int, int]) -> tuple[int, int]:
    """The rank and code that best explain a failure, among ranks that ended by themselves. A rank
    ended by a signal comes first, as the others only reacted to it. Code 4 comes last, as ranks
    that lost another one return it, too."""
    failed = [(code == _INTERNAL, code, rank) for rank, code in codes.items() if code != 0]
    _, code, rank = min(failed, default=(False, 0, 0))
    return rank, code
