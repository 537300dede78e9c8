"""The programs with standard streams that cannot be written, as tests/cli/lose_streams.py has them for the others."""

from __future__ import annotations

import contextlib
import os
import pathlib
import subprocess
import sys
from collections.abc import Iterator, Sequence
from typing import Any

import pytest

pytest.importorskip("torch", reason="torch is missing: the programs do not start")

from galactic import evaluate, export, train  # noqa: E402
from galactic.learning.command import told  # noqa: E402

WORLD = pathlib.Path(os.environ.get("GALACTIC_LEARNING_WORLDS", "none")) / "held_out.pack"
LOST = "standard output: cannot be written; check that it is open and that its disk has room\n"

needs_world = pytest.mark.skipif(
    not WORLD.is_file(), reason="GALACTIC_LEARNING_WORLDS has no worlds"
)


def run(program: str, words: Sequence[str], lost: str, kind: str) -> Any:
    """Runs galactic.PROGRAM with `lost`, "stdout" or "stderr", "closed" or on a "full" disk."""
    number = {"stdout": 1, "stderr": 2}[lost]
    streams: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with open("/dev/full", "w", encoding="utf-8") as full:
        if kind == "full":
            streams[lost] = full
        else:
            streams["preexec_fn"] = lambda: os.close(number)
        command = [sys.executable, "-B", "-m", f"galactic.{program}", *words]
        return subprocess.run(command, text=True, timeout=300, check=False, **streams)


@contextlib.contextmanager
def losing(stream: str, kind: str) -> Iterator[None]:
    """This process with a standard stream as such a program has it."""
    with open("/dev/full", "w", encoding="utf-8") as full, pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, stream, full if kind == "full" else None)
        yield


@pytest.mark.parametrize("kind", ["closed", "full"])
def test_help_that_nobody_can_read_ends_with_a_line_about_it(kind: str) -> None:
    done = run("export", ["--help"], "stdout", kind)
    assert (done.returncode, done.stderr) == (2, f"galactic.export: {LOST}")


@pytest.mark.parametrize("kind", ["closed", "full"])
@pytest.mark.parametrize("program", [train, evaluate])
def test_help_of_the_others_does_so_too(program: Any, kind: str, capsys: Any) -> None:
    """In this process: how Python comes out of what is closed is tested above."""
    with losing("stdout", kind), pytest.raises(SystemExit) as ended:
        program.main(["--help"])
    assert (ended.value.code, capsys.readouterr().err) == (2, f"{program.__name__}: {LOST}")


@pytest.mark.parametrize("kind", ["closed", "full"])
def test_a_message_that_nobody_can_read_changes_nothing(kind: str, capsys: Any) -> None:
    done = run("export", ["none.pt", "-o", "none.pack"], "stderr", kind)
    assert (done.returncode, done.stdout) == (2, "")
    with losing("stderr", kind), pytest.raises(SystemExit) as ended:
        export.main(["--no-such-option"])
    assert (ended.value.code, capsys.readouterr().out) == (1, "")


@pytest.mark.parametrize(
    "error, asked",
    [
        (RuntimeError("[enforce fail at alloc_cpu.cpp:75] err == 0. DefaultCPUAllocator: can't "
                      "allocate memory: you tried to allocate 1040 bytes. Error code 12"),
         ", of which 1040 bytes more were asked for"),
        (RuntimeError("CUDA out of memory. Tried to allocate 20.00 MiB (GPU 0; 79 GiB total)"),
         ", of which 20.00 MiB more were asked for"),
        (MemoryError("Unable to allocate 1.50 GiB for an array with shape (1048576, 64, 6)"),
         ", of which 1.50 GiB more were asked for"),
        (MemoryError(), ""),
    ],
)  # fmt: skip
def test_a_lack_of_memory_is_a_sentence(
    error: Exception, asked: str, capsys: pytest.CaptureFixture[str]
) -> None:
    def work() -> int:
        raise error

    assert told("galactic.train", work) == 5
    wanted = f"needs more memory than there is{asked}; take less, such as fewer --envs"
    assert capsys.readouterr().err == f"galactic.train: {wanted}\n"


def test_faults_of_the_program_are_told_with_its_lines(capsys: pytest.CaptureFixture[str]) -> None:
    def work() -> int:
        raise RuntimeError("The size of tensor a (78) must match the size of tensor b (81)")

    assert told("galactic.train", work) == 4
    said = capsys.readouterr().err
    assert said.startswith(
        "galactic.train: an exception that nobody has thought of ended it\nTrace"
    )
    assert "in work\n" in said and said.endswith("must match the size of tensor b (81)\n")


@needs_world
@pytest.mark.parametrize("kind", ["closed", "full"])
def test_work_is_done_whoever_reads_of_it(kind: str, tmp_path: pathlib.Path, capsys: Any) -> None:
    out = str(tmp_path / "run")
    words = [str(WORLD), "-o", out, "--preset", "quick", "--envs", "8", "--mini-batches", "1",
             "--steps", "64", "--horizon", "4", "--width", "8", "--ranks", "1"]  # fmt: skip
    done = run("train", words, "stderr", kind)
    assert (done.returncode, done.stdout) == (0, "")
    best, report = tmp_path / "run" / "best.pt", tmp_path / "report.json"
    words = [str(best), str(WORLD), "--episodes", "2", "--report", str(report)]
    with losing("stdout", kind):
        code = evaluate.main(words)
    assert (code, capsys.readouterr().err) == (2, f"galactic.evaluate: {LOST}")
    assert report.is_file()
