"""galactic.evaluate with the folder of a run: each policy in it, on the same episodes."""

from __future__ import annotations

import json
import pathlib
import shutil
from typing import Any

import pytest

from programs import HELD_OUT, SMALL, UPDATE, WORLD, call, needs_worlds

pytestmark = needs_worlds
QUICK = ["--episodes", 9]


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """Of a run that keeps two of its three checkpoints."""
    folder = tmp_path_factory.mktemp("runs") / "run"
    options = ["--steps", 3 * UPDATE, "--checkpoint-every", UPDATE, "--keep", 2]
    done = call("train", WORLD, "-o", folder, *SMALL, *options)
    assert done.returncode == 0, done.stderr
    return folder


def report_of(file: pathlib.Path, *words: object) -> dict[str, Any]:
    done = call("evaluate", *words, HELD_OUT, *QUICK, "--report", file)
    assert done.returncode == 0, done.stderr
    return json.loads(file.read_text(encoding="utf-8"))


def test_each_policy_of_a_run_is_judged_as_if_it_was_named(
    run_folder: pathlib.Path, tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = report_of(tmp_path / "all.json", run_folder)
    table = capsys.readouterr().out.splitlines()
    kept = [f"{count * UPDATE:012d}" for count in (2, 3)]
    files = [*(run_folder / "checkpoints" / name / "policy.pt" for name in kept)]
    files.append(run_folder / "best.pt")
    policies = whole.pop("policies")
    assert [one["policy"] for one in policies] == [str(file) for file in files]
    for file, found in zip(files, policies):
        alone = report_of(tmp_path / "one.json", file)
        assert found == {name: alone[name] for name in found}
        about = {name: alone[name] for name in whole if name != "run"}
        assert whole == {"run": str(run_folder), **about}
    # Not all of them do the same.
    assert policies[0]["each"] != policies[1]["each"]
    assert table[0].split() == ["policy", "steps", "success", "picked", "return", "length", "spl"]
    assert [line.split()[0] for line in table[1:-1]] == [*kept, "best.pt"]
    for line, found in zip(table[1:], policies):
        assert f"{found['trained_steps']}  " in line and f"{100 * found['success']:.1f} % (" in line
        assert f"  {found['return']:.4g} " in line and line.split()[-1] == f"{found['spl']:.4g}"
    assert table[-1].startswith("(episodes: 9; success in percent, in brackets the interval")


@pytest.mark.parametrize(
    "option, value",
    [("--contact-sheet", "sheet.png"), ("--video", "film.mp4"), ("--dynamics", "world.toml")],
)
def test_what_is_of_one_policy_is_refused(
    run_folder: pathlib.Path, tmp_path: pathlib.Path, option: str, value: str
) -> None:
    done = call("evaluate", run_folder, HELD_OUT, option, tmp_path / value)
    assert done.returncode == 1
    assert done.stderr == (
        f"galactic.evaluate: command line: {option} is for one policy, and {run_folder} is a folder; name best.pt or a "
        "policy.pt in it\n"
    )


def test_a_folder_without_policies_is_refused(tmp_path: pathlib.Path) -> None:
    done = call("evaluate", tmp_path, HELD_OUT)
    assert done.returncode == 2
    assert done.stderr == (
        f"galactic.evaluate: {tmp_path}: holds no best.pt and no checkpoint; name the folder of a run that has saved "
        "one, or a policy.pt\n"
    )


def test_no_file_of_the_run_is_written_over(run_folder: pathlib.Path) -> None:
    for name in ("report.json", f"checkpoints/{3 * UPDATE:012d}/trainer.pt"):
        before = (run_folder / name).read_bytes()
        done = call("evaluate", run_folder, HELD_OUT, "--report", run_folder / name)
        assert done.returncode == 3 and f"{name}: is also an input" in done.stderr
        assert (run_folder / name).read_bytes() == before


def test_a_damaged_policy_of_a_run_is_named(
    run_folder: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    copy = shutil.copytree(run_folder, tmp_path / "copy")
    (copy / "best.pt").write_bytes(b"no policy")
    done = call("evaluate", copy, HELD_OUT, *QUICK)
    assert done.returncode == 3
    assert f"{copy / 'best.pt'} cannot be read as a checkpoint" in done.stderr
