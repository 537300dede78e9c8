"""How long a run takes, and where the time goes (paper, tables 5 and 6)."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Collection, Iterator
from typing import Any


class Stopwatch:
    """Adds up wall-clock seconds by name. Work on a GPU counts for the name under which its result
    is awaited."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextlib.contextmanager
    def time(self, name: str) -> Iterator[None]:
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start

    def shares(self, total: float) -> list[tuple[str, float]]:
        """Names and shares of `total` seconds."""
        total = max(total, 1e-9)
        shares = [(name, seconds / total) for name, seconds in self.seconds.items()]
        return [*shares, ("the rest", max(0.0, 1.0 - sum(share for _, share in shares)))]

    def tables(self, updates: int, horizon: int, of_rollout: Collection[str]) -> dict[str, Any]:
        """Tables 5 and 6 of the paper, in milliseconds, after `updates` updates with rollouts of
        `horizon` steps. `of_rollout`: the names that are parts of a rollout."""
        per_update = {
            name: 1e3 * seconds / max(updates, 1) for name, seconds in self.seconds.items()
        }
        rollout = {
            name: value / horizon for name, value in per_update.items() if name in of_rollout
        }
        return {
            "rollout_step_ms": {**rollout, "total": sum(rollout.values())},
            "update_ms": {
                "compute rollouts": sum(rollout.values()) * horizon,
                "update agent": per_update.get("update", 0.0),
            },
        }


class RunClock:
    """Time since a run began, over all its parts."""

    def __init__(self) -> None:
        self._seconds_before = 0.0
        self._processor_seconds_before = 0.0
        self.start()

    def start(self) -> None:
        """Starts the wall clock of this part of the run."""
        self._started = time.perf_counter()

    def take_up(self, seconds: float, processor_seconds: float) -> None:
        """Adds the parts before this one."""
        self._seconds_before = seconds
        # Processor time that this process used before it took up the run does not count.
        self._processor_seconds_before = processor_seconds - time.process_time()

    @property
    def seconds(self) -> float:
        """Wall-clock seconds."""
        return self._seconds_before + time.perf_counter() - self._started

    @property
    def processor_seconds(self) -> float:
        """Processor seconds of this rank."""
        return self._processor_seconds_before + time.process_time()
