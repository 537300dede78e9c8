"""galactic.train --log-to: rows of the curves for a function of the user's."""

from __future__ import annotations

import json
import pathlib

import pytest

from programs import (
    HELD_OUT,
    SMALL,
    SMALL_OF_ANY_RANKS,
    UPDATE,
    WORLD,
    call,
    curve,
    needs_worlds,
    run,
)

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

class Tracker:
    def __init__(self, folder, settings):
        self.folder, self.rows = folder, 0

    def __call__(self, row):
        self.rows += 1

    def close(self):
        with open(self.folder / "closed", "a") as file:
            print(self.rows, (self.folder / "report.json").exists(), file=file)

class Finished(Tracker):
    close = None

    def finish(self):
        Tracker.close(self)
        raise ConnectionError("gone")

def takes_less(folder):
    pass

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
        ("{lab}:takes_less", "takes_less cannot be called with a folder and settings: too many"),
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


@needs_worlds
def test_the_end_is_told(tmp_path: pathlib.Path) -> None:
    """Also of a part of a run."""
    (tmp_path / "lab.py").write_text(LOG, encoding="utf-8")
    folder, tracker = tmp_path / "run", f"{tmp_path / 'lab.py'}:Tracker"
    options = [*SMALL, "--steps", 5 * UPDATE, "--pause-at", 2 * UPDATE, "--log-to", tracker]
    assert call("train", WORLD, "-o", folder, *options).returncode == 0
    assert call("train", "-o", folder, "--resume", "--log-to", tracker).returncode == 0
    assert (folder / "closed").read_text() == "2 True\n3 True\n"
    finished = f"{tmp_path / 'lab.py'}:Finished"
    options = [*SMALL, "--steps", UPDATE, "--log-to", finished]
    done = call("train", WORLD, "-o", tmp_path / "other", *options)
    assert done.returncode == 0 and (tmp_path / "other" / "closed").read_text() == "1 True\n"
    assert "--log-to: ConnectionError: gone; it came out of its finish()" in done.stderr


@needs_worlds
def test_code_that_cannot_be_imported_ends_before_there_are_ranks(tmp_path: pathlib.Path) -> None:
    (tmp_path / "lab.py").write_text("import nonesuch\ndef log(a, b): return print\n", "utf-8")
    options = [*SMALL_OF_ANY_RANKS, "--ranks", 2, "--log-to", f"{tmp_path / 'lab.py'}:log"]
    done = run("train", WORLD, "-o", tmp_path / "run", *options)
    assert done.returncode == 3 and done.stderr.count("No module named 'nonesuch'") == 1
    assert not (tmp_path / "run").exists()
