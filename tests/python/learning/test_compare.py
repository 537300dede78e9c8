"""galactic.compare: several runs side by side."""

from __future__ import annotations

import json
import pathlib
from typing import Any

import pytest

from galactic import compare
from galactic.learning.reports import comparison
from galactic.learning.saving.runs import Run, write_run
from galactic.learning.settings import Settings
from programs import HELD_OUT, SMALL, UPDATE, WORLD, call, needs_worlds

HEAD = "steps,seconds,episodes,success,validation_success,kl\n"
ROWS = [
    "1000,10,50,0.25,,0.1\n",
    "1000,10,200,,0.5,\n",
    "2000,20,60,0.5,,0.2\n",
    "2000,20,200,,0.4,\n",
]


def make_run(
    folder: pathlib.Path, table: str = HEAD + "".join(ROWS), **settings: Any
) -> pathlib.Path:
    folder.mkdir()
    made = Settings(**{"steps": 4000, "simulation": "task=pick bump", **settings})
    write_run(Run(pathlib.Path("homes.pack"), None, made), folder)
    if table:
        (folder / "curves.csv").write_text(table, encoding="utf-8")
    return folder


def told(capsys: pytest.CaptureFixture[str], *words: Any) -> tuple[int, str, str]:
    code = compare.main(list(map(str, words)))
    said = capsys.readouterr()
    return code, said.out, said.err


def data_of(page: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(page.split("const data = ")[1].split(";\n")[0])
    return found


def test_a_table_has_what_runs_came_to_and_where_they_differ(
    tmp_path: pathlib.Path, capsys: Any
) -> None:
    one = make_run(tmp_path / "one", gamma=0.9)
    two = make_run(tmp_path / "two", HEAD + ROWS[0], simulation="task=pick bump=false", steps=9000)
    code, said, fault = told(capsys, one, two)
    assert (code, fault) == (0, "")
    head, first, second, about = said.splitlines()
    names = ["run", "steps", "steps/s", "last validation", "best validation", "training"]
    columns = [head.index(name) for name in names] + [
        head.index("gamma"),
        head.index("simulation bump"),
    ]
    cells = lambda line: [line[a:b].strip() for a, b in zip(columns, [*columns[1:], None])]
    assert cells(head) == [*names, "gamma", "simulation bump"]
    best, last = "50.0 % (43.1 to 56.9)", "40.0 % (33.5 to 46.9)"
    assert cells(first) == [str(one), "2 k of 4 k", "100", last, best, "50.0 %", "0.9", "true"]
    assert cells(second) == [str(two), "1 k of 9 k", "100", "-", "-", "25.0 %", "0.99", "false"]
    assert "interval of 95 %" in about


def test_runs_that_differ_in_their_seed_alone_are_averaged(
    tmp_path: pathlib.Path, capsys: Any
) -> None:
    runs = [make_run(tmp_path / f"s{seed}", seed=seed) for seed in (1, 2)]
    better = HEAD + "".join(ROWS).replace("0.4,", "0.8,")
    runs += [make_run(tmp_path / "s3", better, seed=3), make_run(tmp_path / "other", gamma=0.5)]
    _, said, _ = told(capsys, *runs)
    grouped = said.partition("\n\n")[2].splitlines()
    assert [len(grouped), grouped[0].split()[0]] == [3, "seeds"]
    assert grouped[1].startswith(", ".join(map(str, runs[:3])))
    assert "53.3 % (40.0 to 80.0) of 3  60.0 % (50.0 to 80.0) of 3" in grouped[1]
    assert "nothing but the seed" in grouped[2] and "other" not in grouped[1]
    # One of each is no group.
    assert "seeds" not in told(capsys, runs[0], runs[3])[1]
    # A seed that is there twice counts once.
    again = make_run(tmp_path / "again", seed=2)
    assert "seeds" not in told(capsys, runs[1], again)[1]
    assert grouped[1] in told(capsys, *runs[:3], again)[1]


def test_a_task_of_another_text_is_another_setting(tmp_path: pathlib.Path) -> None:
    runs = [make_run(tmp_path / name, seed=n) for n, name in enumerate(("a", "b"), 1)]
    for number, run in enumerate(runs):
        (run / "task.py").write_text(f"reward = {number}\n", encoding="utf-8")
    found = comparison.read(runs)
    assert comparison.differing(found) == ["seed", "task.py"]
    assert comparison.table_of_seeds(found) == []


def test_a_page_overlays_the_curves_and_asks_for_nothing(
    tmp_path: pathlib.Path, capsys: Any
) -> None:
    runs = [make_run(tmp_path / "a<b>", seed=1), make_run(tmp_path / "new", "", seed=2)]
    runs.append(make_run(tmp_path / "c", HEAD + "".join(ROWS[:2]), seed=3))
    assert told(capsys, *runs, "-o", tmp_path / "page.html")[0] == 0
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "http" not in page.replace("http://www.w3.org/2000/svg", "")
    assert page.count("</script>") == 1 and "a<b>" not in page and "<h2>Seeds " in page
    data = data_of(page)
    assert [len(one["rows"]) for one in data["tables"]] == [4, 0, 2]
    assert data["charts"][0]["title"] == "Success, validation"
    assert data["charts"][0]["lines"] == [
        ["validation_success", str(run), number] for number, run in enumerate(runs)
    ]
    assert {"Success, training", "Divergence of an update"} <= {
        one["title"] for one in data["charts"]
    }


def test_a_run_under_way_may_have_no_table_or_a_part_of_a_row(
    tmp_path: pathlib.Path, capsys: Any
) -> None:
    new = make_run(tmp_path / "new", "")
    cut = make_run(tmp_path / "cut", HEAD + ROWS[0] + "2000,2")
    bare = make_run(tmp_path / "bare", HEAD)
    code, said, _ = told(capsys, new, cut, bare)
    assert code == 0 and "0 of 4 k  " in said and "1 k of 4 k" in said


@pytest.mark.parametrize(
    "table",
    [
        HEAD + "a,10,50,0.25,,0.1\n",
        HEAD + "1000,10,50,0.25,,0.1,7\n",
        "steps,seconds\n,3\n",
        "1,2\n3,4\n",
        b"\xff\xfe\n",
        HEAD + "1000,10,50,,2,\n",
        HEAD + "1000,10,,,0.5,\n",
        HEAD + "1000,10,50,,-0.5,\n",
        HEAD + "1000,10,50,,nan,\n",
        HEAD + "1000,10,50,inf,,\n",
        HEAD + "1000,10,inf,,0.5,\n",
        HEAD + "nan,10,50,0.5,,\n",
        HEAD + "inf,10,50,0.5,,\n",
        HEAD + "1000,-1,50,0.5,,\n",
        HEAD + "1000,inf,50,0.5,,\n",
    ],
)
def test_a_broken_table_is_refused(tmp_path: pathlib.Path, capsys: Any, table: Any) -> None:
    run = make_run(tmp_path / "run", "")
    text = table if isinstance(table, bytes) else table.encode()
    (run / "curves.csv").write_bytes(text)
    code, said, fault = told(capsys, run)
    assert (code, said) == (3, "") and fault.count("\n") == 1
    assert fault.startswith(f"galactic.compare: {run / 'curves.csv'} is no table of curves: ")
    assert fault.endswith("; leave this run out\n")


def test_a_share_that_is_none_is_told(tmp_path: pathlib.Path, capsys: Any) -> None:
    run = make_run(tmp_path / "run", HEAD + "1000,10,50,,2,\n")
    assert "curves: validation_success: found 2, expected 0 to 1; leave" in told(capsys, run)[2]
    # Of no time at all, there is no speed.
    (run / "curves.csv").write_text(HEAD + "1000,1e-320,50,,0.5,\n", encoding="utf-8")
    code, said, _ = told(capsys, run)
    assert code == 0 and "inf" not in said


@pytest.mark.parametrize(
    "name",
    ["settings.json", "curves.csv", "best.pt", "task.py", "checkpoints/000000001024/rank-0.pt"],
)
def test_a_page_in_the_place_of_a_file_of_a_run_is_refused(
    tmp_path: pathlib.Path, capsys: Any, name: str
) -> None:
    runs = [make_run(tmp_path / "one"), make_run(tmp_path / "two", seed=2)]
    file = runs[1] / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.touch()
    before = file.read_bytes()
    code, said, fault = told(capsys, *runs, "-o", file)
    assert (code, said) == (3, "") and file.read_bytes() == before
    assert fault == f"galactic.compare: {file}: is also an input; write to another file\n"
    assert told(capsys, *runs, "-o", runs[1] / "compare.html")[0] == 0


def test_what_is_no_run_is_refused(tmp_path: pathlib.Path, capsys: Any) -> None:
    run = make_run(tmp_path / "run")
    code, _, fault = told(capsys, run, tmp_path)
    assert code == 2 and f"settings.json: does not exist: {tmp_path} holds no run\n" in fault
    code, _, fault = told(capsys, run, tmp_path / "run" / ".." / "run")
    assert code == 1 and "is named twice; name it once" in fault
    (run / "settings.json").write_text("{", encoding="utf-8")
    code, _, fault = told(capsys, run)
    assert code == 3 and "does not say what the run is" in fault
    code, _, fault = told(capsys, run, "-o", tmp_path / "none" / "page.html")
    assert code == 2 and str(tmp_path / "none") in fault and not (tmp_path / "none").exists()


@needs_worlds
def test_it_reads_what_a_training_has_written(tmp_path: pathlib.Path, capsys: Any) -> None:
    options = ["--steps", 2 * UPDATE, "--validation", HELD_OUT, "--validation-episodes", 4]
    runs = [tmp_path / "1", tmp_path / "2"]
    for run in runs:
        done = call("train", WORLD, "-o", run, *SMALL, *options, "--seed", run.name)
        assert done.returncode == 0, done.stderr
    found = comparison.read(runs)
    assert [one.steps for one in found] == [2 * UPDATE] * 2
    assert all(one.last is not None and one.last.episodes == 4 for one in found)
    assert comparison.differing(found) == ["seed"]
    assert told(capsys, *runs)[0] == 0
