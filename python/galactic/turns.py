"""The halves of a VectorEnv, each of which steps on a thread of its own: all at the same time, or
in turns."""

from __future__ import annotations

import os
import threading
from collections.abc import Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic.batch_part import BatchPart, StepResult

#: Arrays for the results of one step: see VectorEnv.step().
Row = Mapping[str, NDArray[Any]]


class Turns:
    """Keeps track of which `parts` of a batch (its halves, or all of it) have a step under way."""

    def __init__(self, parts: Sequence[BatchPart]) -> None:
        self._parts = list(parts)
        self._threads = [ThreadPoolExecutor(1, f"galactic-half-{n}") for n in range(len(parts))]
        self._pending: list[Future[StepResult] | None] = [None] * len(parts)
        self._beginning = threading.Lock()
        self._process = os.getpid()

    def __len__(self) -> int:
        return len(self._pending)

    def begin(self, half: int, actions: NDArray[np.float32], out: Row | None) -> Future[StepResult]:
        """Begins a step of one half."""
        self._require_threads()
        # A second thread may have come this far.
        with self._beginning:
            self._require_open()
            self.require_idle(half)
            return self._submit(half, actions, out)

    def end(self, half: int) -> StepResult:
        """Waits for the step that begin() began. If Ctrl-C ends the wait, the step stays under
        way."""
        self._require_threads()
        wait([self._under_way(half)])
        # A second thread may have waited for the same step.
        with self._beginning:
            step = self._under_way(half)
            self._pending[half] = None
        return step.result()

    def step(
        self, actions: Sequence[NDArray[np.float32]], out: Sequence[Row | None]
    ) -> list[StepResult]:
        """Steps all halves at the same time. Anything that cuts the step off, including Ctrl-C,
        cuts off all halves, and no step is then under way."""
        self._require_threads()
        has_begun = False
        try:
            with self._beginning:
                self._require_open()
                self.require_idle()
                has_begun = True
                steps = [
                    self._submit(half, rows, places)
                    for half, (rows, places) in enumerate(zip(actions, out))
                ]
            wait(steps)
            results = [step.result() for step in steps]
        except BaseException:
            if has_begun:
                self._cut_off()
            raise
        self._pending = [None] * len(self)
        return results

    def require_idle(self, *halves: int) -> None:
        """Raises RuntimeError if one of these halves, or of all halves if none is given, is under
        way."""
        asked = halves or range(len(self))
        busy = [half for half in asked if self._pending[half] is not None]
        if busy:
            raise RuntimeError(
                f"half {busy[0]} is under way; call recv({busy[0]}) first, from one thread alone"
            )

    def close(self) -> None:
        """Waits for steps that are under way, whose results end() still returns, and releases the
        halves."""
        for thread in self._threads:
            thread.shutdown()
        self._parts = []

    def _require_threads(self) -> None:
        if os.getpid() != self._process:
            raise RuntimeError("the threads of this env are in another process; make one in each")

    def _require_open(self) -> None:
        if not self._parts:
            raise RuntimeError("this env is closed; make another one")

    def _submit(
        self, half: int, actions: NDArray[np.float32], out: Row | None
    ) -> Future[StepResult]:
        step = self._threads[half].submit(self._parts[half].step, actions, out)
        self._pending[half] = step
        return step

    def _cut_off(self) -> None:
        """Marks all halves as cut off, since some may have made a step that others have not. Each
        thread does this after the work that it was given before, even if an interrupt came before
        that work was recorded anywhere.
        """
        wait(
            [
                thread.submit(setattr, part, "is_cut_off", True)
                for thread, part in zip(self._threads, self._parts)
            ]
        )
        self._pending = [None] * len(self)

    def _under_way(self, half: int) -> Future[StepResult]:
        step = self._pending[half]
        if step is None:
            raise RuntimeError(f"half {half} has nothing under way; call send() first")
        return step


def part_of(out: Row | None, rows: slice) -> Row | None:
    """Arrays for the results of some envs of the batch."""
    return None if out is None else {name: array[rows] for name, array in out.items()}


def batch_of(parts: Sequence[Any]) -> Any:
    """Results of the halves (arrays, or dictionaries of arrays), joined to results of the batch."""
    first = parts[0]
    if len(parts) == 1:
        return first
    if isinstance(first, dict):
        return {name: batch_of([part[name] for part in parts]) for name in first}
    return np.concatenate(parts)


def step_of_batch(parts: Sequence[BatchPart], results: Sequence[StepResult]) -> StepResult:
    """The results of a step of each part, joined to those of a step of the batch."""
    *arrays, infos = zip(*results)
    observations, rewards, terminations, truncations = (batch_of(each) for each in arrays)
    have_ended = ["final_info" in info for info in infos]
    if any(have_ended):
        # A part in which no episode ended gets masks that are false everywhere.
        infos = tuple(
            info if has_ended else {**info, **part.blank_infos()}
            for info, has_ended, part in zip(infos, have_ended, parts)
        )
    return observations, rewards, terminations, truncations, batch_of(infos)
