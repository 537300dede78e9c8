"""The curves of a run: a CSV table, and a page that draws it."""

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
"""`steps`, `seconds` and `updates` count from the beginning of the run, over all its parts; `sps`:
steps per second since the previous row. `success`, `return`, `length` and `picked` (the share of
episodes in which the target was in the hand) are means over the latest episodes of training, as
soon as every env has finished one; `validation_...`: the same for the validation episodes, in rows
of validations. `episodes`: how many episodes these are. `log_std`: the mean of the policy's
log-stds, if they are parameters. `teacher_kl`: the divergence from what the teacher would do, nats
per step, while the teacher counts."""
VALIDATION = "validation_"
TABLE = "curves.csv"


def columns_of(names: OwnNames) -> tuple[str, ...]:
    """COLUMNS, then the means of what a user-defined task reports, of training and validations. The
    columns of a callback follow these."""
    means = names.of_means
    return (*COLUMNS, *means, *(VALIDATION + name for name in means))


PAGE_SHARE = 0.01
"""The largest share of a run's time that writing the page may take; it is written as a whole each
time."""


class Curves:
    """Rows of columns_of(names), and the files that show them. Missing values are None."""

    def __init__(self, folder: pathlib.Path | None, title: str, names: OwnNames = OwnNames()):
        self._folder = folder
        self._title = title
        self.columns = columns_of(names)
        self._own = len(self.columns)
        self.rows: list[list[float | None]] = []
        # How many rows the table file has; None if the file is not from this process or has other
        # columns.
        self._in_table: int | None = None
        self._next_page = 0.0

    def add(self, values: Mapping[str, float]) -> None:
        self._widen(values)
        self.rows.append([values.get(name) for name in self.columns])

    @property
    def added(self) -> list[str]:
        """The columns that a callback has added, in order."""
        return list(self.columns[self._own :])

    def _widen(self, names: Iterable[str]) -> None:
        new = [name for name in names if name not in self.columns]
        assert all(name.startswith(CALLBACK) for name in new), new
        if new:
            self.columns = (*self.columns, *new)
            for row in self.rows:
                row += [None] * len(new)
            self._in_table = None  # the file begins with the old names, so write it anew

    def take_up(self, count: int, added: Sequence[str]) -> int:
        """Continues after the first `count` rows of the table file, which may lack some columns.
        `added`: the columns of a callback. Returns how many of these rows the file has. The next
        write() removes further rows from it."""
        self._widen(added)
        file = None if self._folder is None else self._folder / TABLE
        before = read_curves(file)[:count] if file is not None and file.exists() else []
        self.rows = [[values.get(name) for name in self.columns] for values in before]
        return len(self.rows)

    def latest_validation(self) -> dict[str, float]:
        """Means of the latest validation, by their names in training; empty if there was none."""
        of_validation = [n for n, name in enumerate(self.columns) if name.startswith(VALIDATION)]
        for row in reversed(self.rows):
            found = [(self.columns[n], row[n]) for n in of_validation]
            means = {name[len(VALIDATION) :]: value for name, value in found if value is not None}
            if means:
                return means
        return {}

    def write(self, settings: Mapping[str, Any], breakdown: Sequence[tuple[str, float]],
              *, is_last: bool = True) -> Error | None:  # fmt: skip
        """Brings curves.csv up to date, and curves.html: always after the last row, but earlier
        only as often as PAGE_SHARE allows. Does nothing without a folder. Raises Error if the table
        cannot be written. An Error of the page, which can be made again, is returned."""
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
        """Makes sure that all rows are on the disk before a checkpoint counts them. Returns their
        number, for take_up()."""
        if self._folder is not None:
            self._write_table(self._folder / TABLE)
            sync(self._folder / TABLE)
        return len(self.rows)

    def _write_table(self, file: pathlib.Path) -> None:
        """Writes the whole table the first time, because a killed run may have left additional or
        partial rows; afterwards, appends the new rows."""
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
    """Appends whole lines to a file in a single write, so that a process that ends leaves no
    partial line."""
    try:
        with open(file, "a", encoding="utf-8") as handle:
            handle.write(text)
    except OSError as error:
        message = f"cannot write the file: {error.strerror}"
        raise Error(ErrorCode.IO, str(file), message) from None


def _cell(value: float | None) -> str:
    """A value as text. Whole numbers keep all their digits: nine are too few for the steps of a
    long run."""
    if value is None:
        return ""
    return str(value) if isinstance(value, int) else f"{value:.9g}"


def _number(text: str) -> float:
    """The inverse of _cell()."""
    return int(text) if text.isdecimal() else float(text)


def read_curves(file: pathlib.Path) -> list[dict[str, float | None]]:
    """The rows of a curves.csv, except a partial last one, as a full disk or a power failure may
    leave it."""
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    whole = [line for line in lines if line.endswith("\n")]
    return [
        {name: _number(value) if value else None for name, value in row.items()}
        for row in csv.DictReader(whole)
    ]


def write_json(file: pathlib.Path, contents: Any) -> None:
    text = json.dumps(contents, indent=2) + "\n"
    write_atomically(file, lambda handle: handle.write(text), "w")
