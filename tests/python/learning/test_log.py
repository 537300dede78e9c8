"""galactic.train --log-to: rows of the curves for a function of the user's."""

from __future__ import annotations

import json
import pathlib

import pytest

from programs import HELD_OUT, SMALL, UPDATE, WORLD, call, curve, needs_worlds

LOG = """
import json

def to_lines(folder, settings):
    file = open(folder / "rows.jsonl", "a")
    print(json.dumps({"envs": settings["envs"]}), file=file, flush=True)
    return lambda row: print(json.dumps(row), file=file, flush=True)

def to_nowhere(folder, settings):
    def take(row):
        raise ConnectionError(f"no tracker")
    return take

def to_nothing(folder, settings):
    return None

no_function = 3
"""


@needs_worlds
def test_rows_are_handed_on(tmp_path: pathlib.Path) -> None:
    (tmp_path / "lab.py").write_text(LOG, encoding="utf-8")
    run, lines = tmp_path / "run", f"{tmp_path / 'lab.py'}:to_lines"
    options = [
        *SMALL,
        "--steps",
        4 * UPDATE,
        "--validation",
        HELD_OUT,
        "--validation-episodes",
        "4",
    ]
    first = call("train", WORLD, "-o", run, *options, "--pause-at", 2 * UPDATE, "--log-to", lines)
    assert first.returncode == 0, first.stderr
    assert call("train", "-o", run, "--resume", "--log-to", lines).returncode == 0
    made, *rows = [json.loads(line) for line in (run / "rows.jsonl").read_text().splitlines()]
    assert made == {"envs": 16}
    # Of both parts of the run, what its table has.
    rows.remove(made)
    assert [row["steps"] for row in rows] == [row["steps"] for row in curve(run)]
    assert [row.get("validation_success") for row in rows] == [
        row["validation_success"] for row in curve(run)
    ]


@needs_worlds
def test_a_run_goes_on_without_its_tracker(tmp_path: pathlib.Path) -> None:
    (tmp_path / "lab.py").write_text(LOG, encoding="utf-8")
    run, nowhere = tmp_path / "run", f"{tmp_path / 'lab.py'}:to_nowhere"
    done = call("train", WORLD, "-o", run, *SMALL, "--steps", 4 * UPDATE, "--log-to", nowhere)
    assert done.returncode == 0 and len(curve(run)) == 4
    said = "--log-to: ConnectionError: no tracker; the row is lost, and the run goes on"
    assert done.stderr.count(said) == 1


@needs_worlds
@pytest.mark.parametrize(
    "name, message",
    [
        ("lab", 'found "lab", expected FILE.py:NAME or MODULE:NAME'),
        ("{lab}:to_line", "lab.py has no to_line"),
        ("{lab}:no_function", "lab.py:no_function is no function; name one that takes a folder"),
        ("{lab}:to_nothing", "lab.py:to_nothing returned a NoneType, expected what takes a row"),
    ],
)
def test_what_cannot_take_rows_is_refused(tmp_path: pathlib.Path, name: str, message: str) -> None:
    lab = tmp_path / "lab.py"
    lab.write_text(LOG, encoding="utf-8")
    done = call("train", WORLD, "-o", tmp_path / "run", *SMALL, "--log-to", name.format(lab=lab))
    assert done.returncode == 1 and message in done.stderr
    assert not (tmp_path / "run" / "settings.json").exists()
