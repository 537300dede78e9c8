"""What a run says of itself: table, page and report of its curves, and the line of progress."""

from __future__ import annotations

import csv
import dataclasses
import io
import json
import os
import pathlib
from typing import Any

import pytest

from galactic.learning.refusals import CheckpointError
from galactic.learning.reports import curves as curves_module
from galactic.learning.reports.curves import Curves, read_curves
from galactic.learning.reports.progress import ProgressLine, amount
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.saving import checkpoint
from galactic.learning.saving.checkpoint import load_policy
from toys import Measured, ReachAndGrasp, Uneven
from trainers import SETTINGS, UPDATE, curve, make_trainer, saved_run


def test_the_curves_begin_when_every_env_has_finished_an_episode(
    tmp_path: pathlib.Path, capsys: Any
) -> None:
    """Before, the short episodes would count alone: all of them successes."""
    trainer = make_trainer(tmp_path, toy=Uneven)
    trainer.begin()
    trainer._iterate()
    trainer._log({})
    assert "success -  return -  " in capsys.readouterr().err
    trainer.save()
    assert load_policy(tmp_path / "best.pt").success is None
    trainer.train()
    rows = curve(tmp_path)
    assert len(rows) == 8 and all(row["episodes"] > 0 for row in rows)
    for name in ("success", "picked", "return", "length"):
        # Of 45 steps, in rollouts of ten.
        assert [row[name] is None for row in rows] == [True] * 4 + [False] * 4, name
    # Four envs make 13 or 14 successes in a rollout, and twelve failed in the fifth.
    assert 0.4 < rows[4]["success"] < 0.7


def test_the_curves_have_what_a_task_measures(tmp_path: pathlib.Path, capsys: Any) -> None:
    """Means of the same episodes as success and length: of the latest ones, and of validations. The columns
    are those of the task, whatever it calls them."""

    def validate(_: Any) -> EpisodeSums:
        return EpisodeSums(4.0, 3.0, 4.0, 20.0, 40.0, {"kl": 1.0, "validation_success": -2.0})

    settings = dataclasses.replace(SETTINGS, validate_every=4 * UPDATE)
    trainer = make_trainer(tmp_path, settings, Measured, validation=validate)
    trainer.reports.progress._live = True
    trainer.begin()
    trainer.train()
    rows = curve(tmp_path)
    assert list(rows[0])[-6:] == [
        "measure_kl",
        "measure_validation_success",
        "measure_steps",
        "validation_measure_kl",
        "validation_measure_validation_success",
        "validation_measure_steps",
    ]
    trained = [row for row in rows if row["kl"] is not None]
    validated = [row for row in rows if row["validation_success"] is not None]
    assert (len(trained), len(validated)) == (8, 2)
    for row in trained:
        assert row["measure_steps"] == row["length"]
        assert row["measure_validation_success"] == row["success"]
        # All that this measures as "kl" are those that have closed the hand.
        assert row["picked"] == row["measure_kl"] and row["validation_picked"] is None
        assert all(row[f"validation_measure_{name}"] is None for name in Measured.measures)
    assert any(row["measure_kl"] not in (row["success"], row["kl"], None) for row in trained)
    for row in validated:
        found = [row[f"validation_measure_{name}"] for name in Measured.measures]
        assert found == [0.25, -0.5, 0.0] and row["measure_steps"] is None
        assert row["validation_picked"] == 1.0 and row["picked"] is None
    said = capsys.readouterr().err
    assert (
        "75.0 % (30.1 to 95.4) of 4 episodes, return 5.00, kl 0.25, validation_success -0.5, steps 0\n"
        in said
    )
    assert f" left  kl {trained[-1]['measure_kl']:.3g}  validation_success " in said
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert report["training"] == trainer.recent.figures() and "measure_kl" in report["training"]
    assert report["validation"] == {
        "success": 0.75,
        "picked": 1.0,
        "return": 5.0,
        "length": 10.0,
        "measure_kl": 0.25,
        "measure_validation_success": -0.5,
        "measure_steps": 0.0,
    }


def test_a_report_has_no_figures_before_the_curves_have(tmp_path: pathlib.Path) -> None:
    trainer = make_trainer(tmp_path, dataclasses.replace(SETTINGS, steps=UPDATE), Uneven)
    trainer.begin()
    trainer.train()
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert report["training"] == report["validation"] == {} and report["best_success"] is None


def test_the_page_of_the_curves_asks_for_nothing(tmp_path: pathlib.Path) -> None:
    trainer = make_trainer(tmp_path, title="</script> & <b>")
    trainer.begin()
    trainer.train()
    page = (tmp_path / "curves.html").read_text(encoding="utf-8")
    assert "http" not in page.replace("http://www.w3.org/2000/svg", "")
    assert page.count("</script>") == 1 and "prefers-color-scheme: dark" in page
    with open(tmp_path / "curves.csv", encoding="utf-8") as file:
        assert len(list(csv.reader(file))) == 1 + 8


def test_the_page_of_the_curves_draws_what_a_task_measures(tmp_path: pathlib.Path) -> None:
    def charts(toy: Any) -> dict[str, Any]:
        trainer = make_trainer(tmp_path, toy=toy)
        trainer.begin()
        trainer.train()
        page = (tmp_path / "curves.html").read_text(encoding="utf-8")
        data = json.loads(page.split("const data = ")[1].split(";\n")[0])
        drawn = {name for chart in data["charts"] for name, _, _ in chart["lines"]}
        (table,) = data["tables"]
        assert drawn <= set(table["columns"])
        return {chart["title"]: chart for chart in data["charts"]}

    plain, measured = charts(ReachAndGrasp), charts(Measured)
    assert list(measured) == [*list(plain)[:4], *Measured.measures, *list(plain)[4:]]
    assert measured["steps"]["lines"] == [
        ["measure_steps", "training", 0],
        ["validation_measure_steps", "validation", 0],
    ]


def test_a_line_of_progress_fits_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """A longer one would leave its beginning behind each time."""

    class Terminal(io.StringIO):
        isatty = lambda self: True
        fileno = lambda self: 7

    said = Terminal()
    for columns, shown in ((20, "x" * 19), (0, "x" * 30)):
        monkeypatch.setattr(os, "get_terminal_size", lambda _: os.terminal_size((columns, 24)))
        ProgressLine(said).show("x" * 30)
        assert said.getvalue().endswith(f"\x1b[K{shown}")


def test_amounts_are_rounded_before_their_unit_is_chosen() -> None:
    said = {0: "0", 12.4: "12", 999.4: "999", 1000: "1 k", 1234567: "1.23 M", 999_400: "999 k"}
    said |= {
        999_700: "1 M",
        999_700_000: "1 G",
        -999_700: "-1 M",
        12_340_000_000: "12.3 G",
        999.7: "1 k",
    }
    assert {number: amount(number) for number in said} == said


def test_the_table_of_the_curves_keeps_every_digit_of_whole_numbers(tmp_path: pathlib.Path) -> None:
    curves = Curves(tmp_path, "long run")
    curves.add({"steps": 2_500_000_128, "seconds": 1 / 3, "success": 0.5})
    curves.write({}, [])
    (row,) = read_curves(tmp_path / "curves.csv")
    assert row["steps"] == 2_500_000_128
    assert row["seconds"] == pytest.approx(1 / 3, rel=1e-8)
    assert row["success"] == 0.5 and row["return"] is None


def test_the_table_of_the_curves_grows_row_by_row(tmp_path: pathlib.Path) -> None:
    """It is not written again: that takes longer with each row."""
    curves = Curves(tmp_path, "long run")
    table = tmp_path / "curves.csv"
    files = set()
    for step in range(1, 5):
        curves.add({"steps": step})
        if step != 2:  # as rows of validations, which wait for the next one
            curves.write({}, [])
            files.add(table.stat().st_ino)
            assert [row["steps"] for row in read_curves(table)] == list(range(1, step + 1))
    assert len(files) == 1


def test_a_torn_row_of_the_curves_is_ignored_and_mended(tmp_path: pathlib.Path) -> None:
    resumed = saved_run(tmp_path)
    table = tmp_path / "curves.csv"
    whole = table.read_bytes()
    assert len(read_curves(table)) == 2
    later = whole.splitlines(keepends=True)[-1]
    for damaged, rows in ((whole + later[:9], 2), (whole + later, 3)):
        table.write_bytes(damaged)
        assert len(read_curves(table)) == rows
        resumed = make_trainer(tmp_path, resumed.settings)
        resumed.resume()
        resumed.reports.curves.write({}, [])
        assert table.read_bytes() == whole


def test_a_checkpoint_counts_rows_that_are_on_the_disk(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also those of validations, which are written with the next ones of training, much later here. Whatever ends the
    run between two changes of names, no row of before a checkpoint is lost."""
    settings = dataclasses.replace(
        SETTINGS, validate_every=UPDATE, checkpoint_every=UPDATE, log_every=1e9, keep=8
    )
    episodes = EpisodeSums(2.0, 1.0, 1.0, 3.0, 8.0)
    trainer = make_trainer(tmp_path, settings, validation=lambda policy: episodes)
    counts: list[int] = []
    change = os.replace

    def change_and_look(source: Any, target: Any) -> None:
        change(source, target)
        if trainer.checkpoints.complete():
            values, tensors = checkpoint.load(trainer.checkpoints.latest() / "trainer.pt")
            assert "rows" not in values and list(tensors) == ["optimizer"]
            assert len(read_curves(tmp_path / "curves.csv")) >= values["row_count"]
            counts.append(values["row_count"])

    monkeypatch.setattr(os, "replace", change_and_look)
    trainer.begin()
    trainer.train()
    assert set(counts) == {1, 2, 3, 4, 5, 6, 7, 9}


def test_a_resumed_run_goes_on_behind_the_rows_that_its_checkpoint_counts(
    tmp_path: pathlib.Path,
) -> None:
    """Numbers come back from the table as they are in it: with nine digits, whole ones whole."""
    resumed = saved_run(tmp_path)
    table = tmp_path / "curves.csv"
    whole = table.read_text(encoding="utf-8")
    later = whole.splitlines()[-1].replace(str(2 * UPDATE), "12345678901", 1)
    table.write_text(whole + later + "\n", encoding="utf-8")
    file = resumed.checkpoints.latest() / "trainer.pt"
    values, tensors = checkpoint.load(file)
    for count, rows in ((3, [UPDATE, 2 * UPDATE, 12345678901]), (1, [UPDATE])):
        checkpoint.save(file, {**values, "row_count": count}, tensors)
        resumed = make_trainer(tmp_path, resumed.settings)
        resumed.resume()
        # Nothing is gone before something comes.
        assert table.read_text(encoding="utf-8") == whole + later + "\n" or count == 1
        resumed.reports.curves.write({}, [])
        found = table.read_text(encoding="utf-8").splitlines()
        assert found == [*whole.splitlines(), later][: count + 1]
        assert [row["steps"] for row in read_curves(table)] == rows


def test_curves_that_are_lost_cost_no_run(tmp_path: pathlib.Path, capsys: Any) -> None:
    resumed = saved_run(tmp_path)
    (tmp_path / "curves.csv").unlink()
    resumed.resume()
    assert (
        "curves.csv has 0 of the 2 rows that the run had told; the curves go on without the others\n"
        in capsys.readouterr().err
    )
    resumed.train()
    assert [row["updates"] for row in curve(tmp_path)] == [3, 4, 5, 6, 7, 8]


def test_curves_that_are_none_are_refused_with_what_to_do(tmp_path: pathlib.Path) -> None:
    resumed = saved_run(tmp_path)
    table = tmp_path / "curves.csv"
    table.write_text("steps,seconds\n1,a\n", encoding="utf-8")
    with pytest.raises(CheckpointError) as refused:
        resumed.resume()
    assert str(refused.value) == (
        f"{table} does not fit this run: could not convert string to float: 'a'; move it away, and the curves "
        "begin anew"
    )


def test_the_page_of_the_curves_takes_a_hundredth_of_the_time(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = [1000.0]
    pages = []

    def draw(*arguments: Any) -> str:
        clock[0] += 0.5
        pages.append(clock[0])
        return "page"

    monkeypatch.setattr(curves_module.time, "monotonic", lambda: clock[0])
    monkeypatch.setattr(curves_module, "curves_page", draw)
    curves = Curves(tmp_path, "long run")
    for step in range(1000):
        clock[0] += 2.0
        curves.add({"steps": step})
        curves.write({}, [], is_last=False)
    assert clock[0] - 1000.0 == pytest.approx(2000.0 + 0.5 * len(pages))
    assert 2000.0 / 52 - 1 <= len(pages) <= 2000.0 / 50 + 1
    curves.write({}, [], is_last=True)
    assert pages[-1] == clock[0]


@pytest.mark.parametrize("log_std", ["parameter", "output"])
def test_the_curves_show_standard_deviations_that_are_parameters(
    tmp_path: pathlib.Path, log_std: str
) -> None:
    trainer = make_trainer(tmp_path, dataclasses.replace(SETTINGS, log_std=log_std))
    trainer.begin()
    trainer.train()
    shown = [row["log_std"] for row in read_curves(tmp_path / "curves.csv")]
    if log_std == "output":
        assert shown == [None] * 8
        return
    parameter = trainer.policy.action.log_std
    assert parameter is not None
    assert shown[-1] == pytest.approx(parameter.mean().item())
    assert shown[0] != shown[-1]


def test_a_page_that_cannot_be_written_is_told_once_and_ends_no_run(
    tmp_path: pathlib.Path, capsys: Any
) -> None:
    page = tmp_path / "curves.html"
    page.mkdir()  # which no file can replace
    trainer = make_trainer(tmp_path)
    trainer.begin()
    assert trainer.train() and (tmp_path / "report.json").is_file()
    said = capsys.readouterr().err
    assert said.count(f"{page}: cannot write the file: Is a directory; ") == 1
    assert said.count("the run goes on, and tries again\n") == 1
    assert len(curve(tmp_path)) == 8
    page.rmdir()
    trainer.reports.write(is_last=True)
    assert page.is_file()
