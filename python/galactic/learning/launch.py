"""Starts the ranks of a run on this machine, be it one: what torchrun does, for one machine.

Debian 12's torchrun does not start under Python 3.11; this does, everywhere. Across machines, torchrun
is the way: a process that finds RANK in its environment joins the others.

A rank is a process of its own even when it is alone, because the libraries that multiply read their
environment when they are loaded.
"""

from __future__ import annotations

import os
import pathlib
import signal
import subprocess
import time
from typing import Any, Sequence

import torch.distributed

GRACE = 30.0
"""Seconds that the other ranks have when one has failed, before they are killed."""


def launch(ranks: int, command: Sequence[str]) -> int:
    """Runs `command` in `ranks` processes that find each other by torch.distributed's environment
    variables, and waits for them. Returns the first code that is not 0, else 0. Interrupts reach the
    ranks, which end as they see fit."""
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
        **_of_libraries(),
    }
    processes = [
        subprocess.Popen(
            command,
            env={**environment, "RANK": str(rank), "LOCAL_RANK": str(rank)},
            # Away from the terminal's group: an interrupt comes from here, once.
            start_new_session=True,
        )
        for rank in range(ranks)
    ]

    def pass_on(number: int, _: Any) -> None:
        for process in processes:
            if process.poll() is None:
                process.send_signal(number)

    before = {number: signal.signal(number, pass_on) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        return _wait(processes)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _of_libraries() -> dict[str, str]:
    """What the libraries that multiply should know, where the environment does not say it already.

    OpenBLAS 0.3.21 takes processors that are younger than it for Haswell, and leaves the wider half of
    their registers idle: with AVX-512, naming a core that has it doubles the speed. Threads that wait
    for a share of the work sleep, instead of taking the processor from those that have some.
    """
    chosen = {"OMP_WAIT_POLICY": "passive"}
    information = pathlib.Path("/proc/cpuinfo")
    if information.is_file():
        words = set(information.read_text(encoding="utf-8", errors="replace").split())
        if {"avx512f", "avx512bw", "avx512dq", "avx512vl"} <= words:
            chosen["OPENBLAS_CORETYPE"] = "SKYLAKEX"
    return {name: value for name, value in chosen.items() if name not in os.environ}


def _wait(processes: "Sequence[subprocess.Popen[bytes]]") -> int:
    failure = 0
    deadline = float("inf")
    while any(process.poll() is None for process in processes):
        codes = [process.returncode for process in processes if process.returncode]
        if codes and not failure:
            failure, deadline = codes[0], time.monotonic() + GRACE
        if time.monotonic() > deadline:
            for process in processes:
                process.kill()
        time.sleep(0.05)
    return failure or next((p.returncode for p in processes if p.returncode), 0)
