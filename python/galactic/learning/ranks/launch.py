"""Starts the ranks of a run on this machine, be it one: what torchrun does, for one machine.

Debian 12's torchrun does not start under Python 3.11; this does, everywhere. Across machines, torchrun
is the way: a process that finds RANK in its environment joins the others.

A rank is a process of its own even when it is alone, because the libraries that multiply read their
environment when they are loaded.
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
"""The environment variable with the process id of who launched a rank."""

GRACE = 30.0
"""Seconds that the other ranks have when one has failed, before they are killed."""

HURRY = 10.0
"""Seconds that ranks have after a second Ctrl-C, which ends them without saving, before they are killed."""

_INTERNAL = int(galactic.ErrorCode.INTERNAL)


def launch(ranks: int, command: Sequence[str]) -> int:
    """Runs `command` in `ranks` processes that find each other by torch.distributed's environment
    variables, and waits for them. Returns the code of the one that failed, else 0. Interrupts reach
    the ranks, which end as they see fit, and a terminal that closes asks them to end. Those that do not, being stuck,
    are killed: see _PassedOn. Ctrl-Z stops them, too, until this process goes on. Raises galactic.Error where another
    signal has ended a rank, which could not say so itself. Ranks that call follow_launcher() do not outlive this
    process, whatever ends it."""
    store = torch.distributed.TCPStore("127.0.0.1", 0, is_master=True, wait_for_workers=False)
    environment = {
        **os.environ,
        "MASTER_ADDR": "127.0.0.1",
        "MASTER_PORT": str(store.port),
        # The store is there already: no rank has to be its server.
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
                # Away from the terminal's group: an interrupt comes from here, once.
                with interrupts.held_back():
                    processes.append(subprocess.Popen(command, env=own, start_new_session=True))
            signals.all_have_started()
            rank, code = _wait(processes, signals)
        except BaseException:
            # Those that have started would wait for the others.
            for process in processes:
                process.kill()
            raise
    if signals.have_killed:
        put(sys.stderr, "ranks that did not end were killed\n")
        return INTERRUPTED
    return code if code >= 0 else _ended_by(signal.Signals(-code), rank)


def follow_launcher() -> None:
    """Ends this rank when its launcher does: killed, that cannot end its ranks itself. Does nothing in a
    rank of torchrun, which sees to its own."""
    launcher = os.environ.get(LAUNCHER)
    if launcher is None:
        return
    set_parent_death_signal = 1  # PR_SET_PDEATHSIG of Linux
    ctypes.CDLL(None).prctl(set_parent_death_signal, int(signal.SIGKILL), 0, 0, 0)
    if os.getppid() != int(launcher):
        # It was over before.
        os.kill(os.getpid(), signal.SIGKILL)


class _PassedOn:
    """While in force, signals reach the ranks, also those that come before all of them have started.

    Ranks end as they see fit, and have all the time that they need to save, however often SIGTERM comes: systemd and
    Slurm repeat it, and kill them at last. Those that are stuck are killed by Ctrl-C: HURRY after a second one, at
    once with a third one.
    """

    # A rank has no terminal that could close.
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
        """Whether ranks were killed that did not end."""

    def __enter__(self) -> _PassedOn:
        for number in self._AS:
            # nohup ignores what a terminal says when it closes.
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:
                self._before[number] = signal.signal(number, self._pass_on)
        # Of a shell without jobs, none comes.
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
        """To be called now and then."""
        if time.monotonic() > self._deadline and any(one.poll() is None for one in self._processes):
            self.have_killed = True
            self._signal(signal.SIGKILL)

    def _pass_on(self, number: int, _: Any) -> None:
        if number == signal.SIGINT and self._was_asked:
            is_second = self._deadline == float("inf")
            self._deadline = time.monotonic() + (HURRY if is_second else 0.0)
        self._was_asked = True
        if number == signal.SIGHUP:
            # The system says it, and a shell says it again; two signals would end ranks without saving.
            signal.signal(number, signal.SIG_IGN)
        if self._have_started:
            self._send(number)
        else:
            self._early.append(number)

    def _pause(self, number: int, _: Any) -> None:
        """Ranks are in no terminal's group, of which Ctrl-Z stops all, and they hold the processors."""
        self._signal(signal.SIGSTOP)
        os.kill(os.getpid(), signal.SIGSTOP)
        # Here a SIGCONT, which the shell's fg and bg send, lets it go on.
        self._signal(signal.SIGCONT)

    def _send(self, number: int) -> None:
        self._signal(self._AS[signal.Signals(number)])
        # One that somebody has stopped could not end.
        self._signal(signal.SIGCONT)

    def _signal(self, number: int) -> None:
        for process in self._processes:
            if process.poll() is None:
                process.send_signal(number)


def _ended_by(number: signal.Signals, rank: int) -> int:
    """What there is to do about a rank that a signal has ended."""
    if number in (signal.SIGINT, signal.SIGTERM):
        return INTERRUPTED
    code, advice = galactic.ErrorCode.INTERNAL, "please report it"
    if number == signal.SIGKILL:
        # As a lack of memory that the rank could have told.
        code = galactic.ErrorCode.UNSUPPORTED
        advice = "the system does that where memory is lacking: take fewer --envs or --ranks"
    raise galactic.Error(code, f"rank {rank}", f"was ended by {number.name}; {advice}")


def _of_libraries() -> dict[str, str]:
    """What the libraries that multiply and the one that allocates should know, where the environment does
    not say it already.

    OpenBLAS 0.3.21 takes processors that are younger than it for Haswell, and leaves the wider half of
    their registers idle: with AVX-512, naming a core that has it doubles the speed. Threads that wait
    for a share of the work sleep, instead of taking the processor from those that have some. Memory that
    tensors leave stays for the next ones: what glibc gives back to the system comes again page by page,
    each of them cleared, which took a third of an update with images.
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
    """Rank and code of the one that failed, a code of 0 where none has. The others learn that it is gone and fail,
    too, perhaps before it is over: all are waited for, and those killed that take more than GRACE.
    """
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
    """Rank and code, of those of ranks that have ended by themselves. What a signal has ended is what the others
    noticed, and says most. Code 4 says least: ranks that have lost another one have it, too."""
    failed = [(code == _INTERNAL, code, rank) for rank, code in codes.items() if code != 0]
    _, code, rank = min(failed, default=(False, 0, 0))
    return rank, code
