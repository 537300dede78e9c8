"""How long a run takes, and where the time goes (paper, tables 5 and 6)."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Collection, Iterator
from typing import Any


class Stopwatch:
    """Adds up wall-clock seconds by name. Work on a GPU counts where somebody waits for it."""

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
        """Tables 5 and 6 of the paper, milliseconds, after so many updates of rollouts of `horizon` steps,
        which the names `of_rollout` are parts of."""
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
        """The clock on the wall: this part begins now."""
        self._started = time.perf_counter()

    def take_up(self, seconds: float, processor_seconds: float) -> None:
        """Adds the parts before this one."""
        self._seconds_before = seconds
        # This process has used some before it took up the run.
        self._processor_seconds_before = processor_seconds - time.process_time()

    @property
    def seconds(self) -> float:
        """On the wall."""
        return self._seconds_before + time.perf_counter() - self._started

    @property
    def processor_seconds(self) -> float:
        """Of this rank's processors."""
        return self._processor_seconds_before + time.process_time()
