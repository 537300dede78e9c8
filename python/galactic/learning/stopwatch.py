"""Where the time goes (paper, tables 5 and 6)."""

from __future__ import annotations

import contextlib
import time
from typing import Iterator


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
