"""The curves of a run: a table in CSV, and a page that draws it."""

from __future__ import annotations

import csv
import io
import json
import pathlib
import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from galactic._core import ErrorCode
from galactic.errors import Error
from galactic.files import sync, write_atomically
from galactic.learning.reports.page import curves_page
from galactic.learning.rollouts.episode_sums import OwnNames
from galactic.learning.user_code.callbacks import CALLBACK

COLUMNS = (
    "steps",
    "seconds",
    "updates",
    "sps",
    "episodes",
    "success",
    "return",
    "length",
    "validation_success",
    "validation_return",
    "validation_length",
    "policy_loss",
    "value_loss",
    "entropy",
    "kl",
    "clipped",
    "grad_norm",
    "explained_variance",
    "log_std",
    "learning_rate",
    "teacher_kl",
    "picked",
    "validation_picked",
)
"""Steps, seconds and updates since the run began, over all its parts; sps: steps per second since the
row before. Success, return and length: means of the latest episodes of training, from when every env
has finished one, and so is picked, the share of those in which the target has been in the hand;
`validation_...`: of the episodes for validation, in rows that have them. Episodes: how many episodes that are.
Log_std: the mean of the policy's, where they are parameters. Teacher_kl: the divergence from what the teacher
would do, nats per step, while it counts."""
VALIDATION = "validation_"
TABLE = "curves.csv"


def columns_of(names: OwnNames) -> tuple[str, ...]:
    """COLUMNS, and behind them, before those of a callback, means of what a task of one's own says, of training and
    validations."""
    means = names.of_means
    return (*COLUMNS, *means, *(VALIDATION + name for name in means))


PAGE_SHARE = 0.01
"""The most of a run's time that the page may take, which is written whole each time."""


class Curves:
    """Rows of columns_of(names), and the files that show them. Not given values are None."""

    def __init__(self, folder: pathlib.Path | None, title: str, names: OwnNames = OwnNames()):
        self._folder = folder
        self._title = title
        self.columns = columns_of(names)
        self._own = len(self.columns)
        self.rows: list[list[float | None]] = []
        # How many of them the table has; None: it is none of this run's yet, or has others.
        self._in_table: int | None = None
        self._next_page = 0.0

    def add(self, values: Mapping[str, float]) -> None:
        self._widen(values)
        self.rows.append([values.get(name) for name in self.columns])

    @property
    def added(self) -> list[str]:
        """The columns of a callback, which come as it names them."""
        return list(self.columns[self._own :])

    def _widen(self, names: Iterable[str]) -> None:
        new = [name for name in names if name not in self.columns]
        assert all(name.startswith(CALLBACK) for name in new), new
        if new:
            self.columns = (*self.columns, *new)
            for row in self.rows:
                row += [None] * len(new)
            self._in_table = None  # which has a row of names to begin with

    def take_up(self, count: int, added: Sequence[str]) -> int:
        """Goes on behind the first `count` rows of the table, which may lack some of the columns: those of a callback
        are `added`. Returns how many it has of them. The others leave it with the next write()."""
        self._widen(added)
        file = None if self._folder is None else self._folder / TABLE
        before = read_curves(file)[:count] if file is not None and file.exists() else []
        self.rows = [[values.get(name) for name in self.columns] for values in before]
        return len(self.rows)

    def latest_validation(self) -> dict[str, float]:
        """Means of the latest validation, by their names in training; nothing where there was none."""
        of_validation = [n for n, name in enumerate(self.columns) if name.startswith(VALIDATION)]
        for row in reversed(self.rows):
            found = [(self.columns[n], row[n]) for n in of_validation]
            means = {name[len(VALIDATION) :]: value for name, value in found if value is not None}
            if means:
                return means
        return {}

    def write(self, settings: Mapping[str, Any], breakdown: Sequence[tuple[str, float]],
              *, is_last: bool = True) -> Error | None:  # fmt: skip
        """Brings curves.csv up to date, and curves.html: after the last row in any case, before it only
        where that takes no more than PAGE_SHARE of the time. Nothing without a folder. Raises Error where the
        table cannot be written; returns the one of the page, which can be made again."""
        if self._folder is None:
            return None
        self._write_table(self._folder / TABLE)
        begin = time.monotonic()
        if not is_last and begin < self._next_page:
            return None
        page = curves_page(self._title, self.columns, self.rows, settings, breakdown)
        try:
            write_atomically(self._folder / "curves.html", lambda file: file.write(page), "w")
        except Error as error:
            return error
        finally:
            end = time.monotonic()
            self._next_page = end + (end - begin) / PAGE_SHARE
        return None

    def keep(self) -> int:
        """Has all rows on the disk, for a checkpoint, from which take_up() goes on. Returns how many there are."""
        if self._folder is not None:
            self._write_table(self._folder / TABLE)
            sync(self._folder / TABLE)
        return len(self.rows)

    def _write_table(self, file: pathlib.Path) -> None:
        """The first time the whole table, which a run that was killed may have left with more rows, or
        with a part of one; from then on what is new."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        if self._in_table is None:
            writer.writerow(self.columns)
        for row in self.rows[self._in_table or 0 :]:
            writer.writerow([_cell(value) for value in row])
        if self._in_table is None:
            write_atomically(file, lambda handle: handle.write(text.getvalue()), "w")
        else:
            _append(file, text.getvalue())
        self._in_table = len(self.rows)


def _append(file: pathlib.Path, text: str) -> None:
    """Adds whole lines to a file, in one go, so that a process that ends leaves them whole."""
    try:
        with open(file, "a", encoding="utf-8") as handle:
            handle.write(text)
    except OSError as error:
        message = f"cannot write the file: {error.strerror}"
        raise Error(ErrorCode.IO, str(file), message) from None


def _cell(value: float | None) -> str:
    """Whole numbers whole: nine digits do not hold the steps of a long run."""
    if value is None:
        return ""
    return str(value) if isinstance(value, int) else f"{value:.9g}"


def _number(text: str) -> float:
    """Of which _cell() makes the same text again."""
    return int(text) if text.isdecimal() else float(text)


def read_curves(file: pathlib.Path) -> list[dict[str, float | None]]:
    """The rows of a curves.csv, but for a last one that is not whole: of a run that a full disk or a
    power failure has ended."""
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    whole = [line for line in lines if line.endswith("\n")]
    return [
        {name: _number(value) if value else None for name, value in row.items()}
        for row in csv.DictReader(whole)
    ]


def write_json(file: pathlib.Path, contents: Any) -> None:
    text = json.dumps(contents, indent=2) + "\n"
    write_atomically(file, lambda handle: handle.write(text), "w")
