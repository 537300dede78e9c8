"""Compares runs: how far they are, how well they do, and in which settings they differ."""

from __future__ import annotations

import hashlib
import math
import os
import pathlib
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from galactic.learning.refusals import SettingsError, refusing
from galactic.learning.reports.curves import VALIDATION, read_curves
from galactic.learning.reports.page import Table, overlaid_page, table
from galactic.learning.reports.progress import amount
from galactic.learning.reports.shares import percent
from galactic.learning.saving.runs import Run, run_in
from galactic.learning.setting_fields import typed
from galactic.learning.simulation_words import simulation_keyword
from galactic.learning.user_code import own_code

NOTHING = "-"
SEED = "seed"


class Success(NamedTuple):
    """A share of successes among `episodes` episodes."""

    share: float
    episodes: float

    def __str__(self) -> str:
        return percent(self.share, self.episodes)


class ComparedRun(NamedTuple):
    """A run in its current state."""

    name: str
    settings: Mapping[str, str]
    """What defines the run, as one types it, by name."""
    wanted_steps: int
    curves: Sequence[Mapping[str, float | None]]
    validations: Sequence[Success]
    """In their order."""

    @property
    def steps(self) -> float:
        return self._last("steps") or 0.0

    @property
    def speed(self) -> float | None:
        """Steps per second over the whole run."""
        seconds = self._last("seconds")
        speed = self.steps / seconds if seconds else math.inf
        return speed if math.isfinite(speed) else None

    @property
    def in_training(self) -> float | None:
        """The share of successes among the latest episodes of training."""
        return self._last("success")

    @property
    def last(self) -> Success | None:
        return self.validations[-1] if self.validations else None

    @property
    def best(self) -> Success | None:
        shares = [one.share for one in self.validations]
        return self.validations[shares.index(max(shares))] if shares else None

    @property
    def but_for_its_seed(self) -> tuple[tuple[str, str], ...]:
        """All settings except the seed: equal for runs that differ in nothing else."""
        return tuple(sorted((n, value) for n, value in self.settings.items() if n != SEED))

    def _last(self, column: str) -> float | None:
        found = (row.get(column) for row in reversed(self.curves))
        return next((value for value in found if value is not None), None)


def read(folders: Sequence[pathlib.Path]) -> list[ComparedRun]:
    """The runs in these folders. Raises galactic.Error if a folder holds no run, and
    CheckpointError if its files are not those of a run."""
    for number, folder in enumerate(folders):
        if folder.resolve() in [other.resolve() for other in folders[:number]]:
            raise SettingsError(f"{folder} is named twice; name it once")
    return [_read(folder) for folder in folders]


def _read(folder: pathlib.Path) -> ComparedRun:
    run, file = run_in(folder), folder / "curves.csv"
    with refusing(f"{file} is no table of curves", "leave this run out"):
        # The file does not exist before the first row.
        rows = read_curves(file) if file.exists() else []
        for row in rows:
            _require_numbers(row)
        validations = [one for one in map(_success_of, rows) if one is not None]
    return ComparedRun(
        os.fspath(folder),
        _settings_of(run, folder),
        run.settings.steps,
        rows,
        validations,
    )


_MOST = {
    **dict.fromkeys(("steps", "seconds", "episodes"), math.inf),
    **dict.fromkeys(("success", f"{VALIDATION}success"), 1.0),
}


def _require_numbers(row: Mapping[str, float | None]) -> None:
    """Raises ValueError if the numbers to be shown from a row cannot be those of a run."""
    if row.get("steps") is None or row.get("seconds") is None:
        raise ValueError("found a row without steps or seconds")
    for column, most in _MOST.items():
        value = row.get(column)
        if value is not None and not (math.isfinite(value) and 0.0 <= value <= most):
            wanted = "0 or more" if most == math.inf else f"0 to {most:.0f}"
            raise ValueError(f"{column}: found {value:g}, expected {wanted}")


def _success_of(row: Mapping[str, float | None]) -> Success | None:
    """The success of the validation in a row, or None. Raises ValueError if the row lacks the
    number of episodes."""
    share, episodes = row.get(f"{VALIDATION}success"), row.get("episodes")
    if share is None:
        return None
    if not episodes:
        raise ValueError("found a validation without a number of episodes")
    return Success(share, episodes)


def _settings_of(run: Run, folder: pathlib.Path) -> dict[str, str]:
    values = run.settings.to_dict()
    words = str(values.pop("simulation")).split()
    about = {
        "world": run.world,
        "validation": run.validation,
        "start_from": run.start_from,
        "teacher": run.teacher,
        "demonstrations": " ".join(map(str, run.demonstrations)) or None,
    }
    found = {name: str(typed(value)) for name, value in {**values, **about}.items()}
    # User code is compared by the contents of its file, not by its path; each option of the
    # simulation is compared by itself.
    copies = {name: folder / name for name in own_code.COPIES.values()}
    found |= {name: _digest(copy) for name, copy in copies.items() if copy.is_file()}
    for word in words:
        found[f"simulation {simulation_keyword(word)}"] = word.partition("=")[2] or "true"
    return {
        name.replace("_", "-"): NOTHING if value in ("", "None") else value
        for name, value in found.items()
    }


def _digest(file: pathlib.Path) -> str:
    """Eight digits of the hash of a file, enough to tell two files apart."""
    return hashlib.sha256(file.read_bytes()).hexdigest()[:8]


def differing(runs: Sequence[ComparedRun]) -> list[str]:
    """The settings that differ between runs, except the steps, which are in every table."""
    names = dict.fromkeys(name for run in runs for name in run.settings if name != "steps")
    return [name for name in names if len({run.settings.get(name) for run in runs}) > 1]


def table_of(runs: Sequence[ComparedRun]) -> list[list[str]]:
    """A header row and a row for each run."""
    names = differing(runs)
    rows = [["run", "steps", "steps/s", "last validation", "best validation", "training", *names]]
    for run in runs:
        trained, speed = run.in_training, run.speed
        rows.append(
            [
                run.name,
                f"{amount(run.steps)} of {amount(run.wanted_steps)}",
                NOTHING if speed is None else amount(speed),
                str(run.last or NOTHING),
                str(run.best or NOTHING),
                NOTHING if trained is None else f"{100.0 * trained:.1f} %",
                *(run.settings.get(name, NOTHING) for name in names),
            ]
        )
    return rows


def table_of_seeds(runs: Sequence[ComparedRun]) -> list[list[str]]:
    """A header row and a row for each group of runs that differ only in their seed; empty if there
    is no such group. Of runs with the same seed, which are repetitions, the first counts."""
    alike: dict[tuple[tuple[str, str], ...], dict[str, ComparedRun]] = {}
    for run in runs:
        alike.setdefault(run.but_for_its_seed, {}).setdefault(run.settings.get(SEED, ""), run)
    rows = [
        [
            ", ".join(run.name for run in group),
            _spread(run.last for run in group),
            _spread(run.best for run in group),
        ]
        for group in ([*by_seed.values()] for by_seed in alike.values())
        if len(group) > 1
    ]
    return [["seeds", "last validation", "best validation"], *rows] if rows else []


def _spread(found: Iterable[Success | None]) -> str:
    """Mean, minimum and maximum."""
    shares = [100.0 * one.share for one in found if one is not None]
    if not shares:
        return NOTHING
    mean = math.fsum(shares) / len(shares)
    return f"{mean:.1f} % ({min(shares):.1f} to {max(shares):.1f}) of {len(shares)}"


OF_SHARES = "success in percent, in brackets the interval of 95 %"
_OF_SEEDS = "runs that differ in nothing but the seed: means, in brackets the least and the most"


def text_of(runs: Sequence[ComparedRun]) -> str:
    """The tables, for a console."""
    text = _aligned(table_of(runs)) + f"({OF_SHARES})\n"
    seeds = table_of_seeds(runs)
    return text + (f"\n{_aligned(seeds)}({_OF_SEEDS})\n" if seeds else "")


def _aligned(rows: Sequence[Sequence[str]]) -> str:
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths)) for row in rows)
    return "".join(f"{line.rstrip()}\n" for line in lines)


def page_of(runs: Sequence[ComparedRun]) -> str:
    """The page that overlays the runs' curves, with the tables below, as text."""
    tables = {run.name: _columns_of(run.curves) for run in runs}
    below = _under("Runs", OF_SHARES, table_of(runs))
    seeds = table_of_seeds(runs)
    below += _under("Seeds", _OF_SEEDS, seeds) if seeds else ""
    return overlaid_page(" and ".join(tables) if len(tables) < 4 else f"{len(tables)} runs", tables, below)  # fmt: skip


def _columns_of(rows: Sequence[Mapping[str, float | None]]) -> Table:
    columns = list(rows[0]) if rows else []
    return Table(columns, [[row[name] for name in columns] for row in rows])


def _under(title: str, about: str, rows: Sequence[Sequence[str]]) -> str:
    return f"<div><h2>{title} <small>{about}</small></h2>{table(rows)}</div>"
