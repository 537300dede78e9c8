"""What a run reports while it goes on: rows of the curves, for their files and for the user's
program, and lines of progress."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping, Sequence

from galactic.learning.reports.curves import TABLE, VALIDATION, Curves
from galactic.learning.reports.log import Log
from galactic.learning.reports.progress import ProgressLine, amount, duration
from galactic.learning.reports.shares import percent_of
from galactic.learning.rollouts.episode_sums import MEASURE, EpisodeSums, OwnNames
from galactic.learning.rollouts.stopwatch import RunClock, Stopwatch
from galactic.learning.settings import Settings
from galactic.learning.user_code.callbacks import CALLBACK


class RunReports:
    """The reports of a rank. Only the one with `is_heard` prints and writes; the others are silent.
    With `folder` None, no files are written."""

    def __init__(self, settings: Settings, folder: pathlib.Path | None, title: str, names: OwnNames,
                 clock: RunClock, stopwatch: Stopwatch, *, is_heard: bool):  # fmt: skip
        self.curves = Curves(folder if is_heard else None, title, names)
        self.progress = ProgressLine(quiet=not is_heard)
        self.log: Log | None = None
        """The user's program that also takes rows of the curves."""
        self.added: dict[str, float] = {}
        """What a callback has logged since the latest row."""
        self._settings = settings
        self._clock = clock
        self._stopwatch = stopwatch
        # Seconds and steps when an update was last reported.
        self._told = (0.0, 0)
        self._speed = 0.0
        self._lacks_page = False

    @property
    def are_due(self) -> bool:
        """Whether it is time to report an update again."""
        return self._clock.seconds - self._told[0] >= self._settings.log_every

    def speed(self, steps: int) -> float:
        """Steps per second since the last reported update, when `steps` are done."""
        seconds, before = self._told
        if steps > before:
            self._speed = (steps - before) / max(self._clock.seconds - seconds, 1e-9)
        return self._speed

    def add_row(self, values: Mapping[str, float]) -> None:
        """Adds a row, together with what a callback has logged."""
        row = {**values, **self.added}
        self.added.clear()
        self.curves.add(row)
        if self.log is not None:
            with self._stopwatch.time("reports"):
                self.log.add(row)

    def tell_update(self, row: Mapping[str, float], figures: Mapping[str, float], *,
                    imitates: bool, is_last: bool) -> None:  # fmt: skip
        """Reports an update. `figures` are those of recent episodes; a run that `imitates` has
        none, and shows its loss."""
        steps = int(row["steps"])
        self._told = (self._clock.seconds, steps)
        self.add_row(row)
        left = (self._settings.steps - steps) / max(row["sps"], 1e-9)
        if imitates:
            goes = f"loss {row['policy_loss']:.2f}"
        elif figures:
            goes = f"success {100.0 * figures['success']:.1f} %  return {figures['return']:.2f}"
        else:
            goes = "success -  return -"
        self.progress.show(
            f"{amount(steps)} of {amount(self._settings.steps)} steps  "
            f"{amount(row['sps'])} steps/s  {goes}  {duration(left)} left"
            + "".join(f"  {one}" for one in _measured(figures))
        )
        self.write(is_last=is_last)

    def tell_validation(self, steps: int, found: EpisodeSums) -> dict[str, float]:
        """Reports a validation. Returns its row of the curves."""
        means = found.means()
        named = {VALIDATION + name: value for name, value in means.items()}
        row = {
            "steps": steps,
            "seconds": self._clock.seconds,
            "episodes": found.episodes,
            **named,
        }
        self.add_row(row)
        self.progress.say(
            f"validation after {amount(steps)} steps: success "
            f"{percent_of(means['success'], found.episodes)}, return "
            f"{means['return']:.2f}" + "".join(f", {one}" for one in _measured(means))
        )
        return row

    def write(self, *, is_last: bool) -> None:
        """Brings the files of the curves up to date. Reports once if the page cannot be written."""
        with self._stopwatch.time("reports"):
            shares = self._stopwatch.shares(self._clock.seconds)
            lost = self.curves.write(self._settings.to_dict(), shares, is_last=is_last)
        if lost is not None and not self._lacks_page:
            self._lacks_page = True
            self.progress.say(f"{lost}; the run goes on, and tries again")

    def take_up(self, count: int, columns: Sequence[str], added: Mapping[str, float]) -> None:
        """Continues after `count` rows, and with the values `added` that a callback has logged
        since. `columns`: those that the callback has added. Raises ValueError if the file of the
        curves is not valid."""
        found = self.curves.take_up(
            count, [str(one) for one in columns if str(one).startswith(CALLBACK)]
        )
        if found < count:
            self.progress.say(
                f"{TABLE} has {found} of the {count} rows that the run had told; the curves go on without the others"
            )
        self.added = {name: value for name, value in added.items() if name.startswith(CALLBACK)}

    def begin_at(self, steps: int) -> None:
        """Measures the speed from `steps` on."""
        self._told = (self._clock.seconds, steps)


def _measured(means: Mapping[str, float]) -> list[str]:
    """What a user-defined task measures, for a line of progress."""
    return [
        f"{name.removeprefix(MEASURE)} {value:.3g}"
        for name, value in means.items()
        if name.startswith(MEASURE)
    ]
