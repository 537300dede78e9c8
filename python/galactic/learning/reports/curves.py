"""The curves of a run: a table in CSV, and a page that draws it."""

from __future__ import annotations

import csv
import io
import json
import pathlib
from typing import Any, Mapping, Optional, Sequence

from galactic.learning.checkpoint import write_atomically
from galactic.learning.reports.page import curves_page

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
)
"""Steps, seconds and updates since the run began, over all its parts; sps: steps per second since the
row before. Success, return and length: means of the latest episodes of training, from when every env
has finished one; `validation_...`: of the episodes for validation, in rows that have them. Log_std:
the mean of the policy's, where they are parameters. Teacher_kl: the divergence from what the teacher
would do, nats per step, while it counts. New columns come last: see Trainer."""


class Curves:
    """Rows of COLUMNS, and the files that show them. Not given values are None."""

    def __init__(self, folder: Optional[pathlib.Path], title: str):
        self._folder = folder
        self._title = title
        self.rows: list[list[Optional[float]]] = []

    def add(self, values: Mapping[str, float]) -> None:
        unknown = set(values) - set(COLUMNS)
        assert not unknown, unknown
        self.rows.append([values.get(name) for name in COLUMNS])

    def write(self, settings: Mapping[str, Any], breakdown: Sequence[tuple[str, float]]) -> None:
        """Writes curves.csv and curves.html, atomically; nothing without a folder."""
        if self._folder is None:
            return
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(COLUMNS)
        for row in self.rows:
            writer.writerow([_cell(value) for value in row])
        table = text.getvalue()
        write_atomically(self._folder / "curves.csv", lambda file: file.write(table), "w")
        page = curves_page(self._title, COLUMNS, self.rows, settings, breakdown)
        write_atomically(self._folder / "curves.html", lambda file: file.write(page), "w")


def _cell(value: Optional[float]) -> str:
    """Whole numbers whole: nine digits do not hold the steps of a long run."""
    if value is None:
        return ""
    return str(value) if isinstance(value, int) else f"{value:.9g}"


def read_curves(file: pathlib.Path) -> list[dict[str, Optional[float]]]:
    """The rows of a curves.csv."""
    with open(file, encoding="utf-8", newline="") as handle:
        return [
            {name: float(value) if value else None for name, value in row.items()}
            for row in csv.DictReader(handle)
        ]


def write_json(file: pathlib.Path, contents: Any) -> None:
    text = json.dumps(contents, indent=2) + "\n"
    write_atomically(file, lambda handle: handle.write(text), "w")
