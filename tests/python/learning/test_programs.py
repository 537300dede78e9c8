"""What the programs say in a Python that lacks their libraries."""

from __future__ import annotations

import os
import pathlib
import resource
import subprocess
import sys

import pytest

from galactic.programs import ADDRESS_SPACE
from programs import run


def hide(libraries: list[str], folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From each Python that starts: importing them fails as if they were not installed."""
    hidden = "".join(f"sys.modules[{name!r}] = None\n" for name in libraries)
    (folder / "sitecustomize.py").write_text(f"import sys\n{hidden}", encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", f"{folder}:{os.environ.get('PYTHONPATH', '')}")


@pytest.mark.parametrize("program", ["train", "evaluate", "export", "demonstrate", "compare"])
@pytest.mark.parametrize(
    "libraries, needs, install",
    [
        (["torch"], "torch", "it (Debian: python3-torch)"),
        (["numpy"], "numpy", "it (Debian: python3-numpy)"),
        (["numpy", "torch"], "numpy and torch", "them (Debian: python3-numpy python3-torch)"),
    ],
)
def test_a_missing_library_is_told_in_a_sentence(
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    program: str,
    libraries: list[str],
    needs: str,
    install: str,
) -> None:
    hide(libraries, tmp_path, monkeypatch)
    done = run(program, "--help")
    assert (done.returncode, done.stdout) == (5, "")
    assert done.stderr == (
        f"galactic.{program}: needs {needs}, which {sys.executable} does not have; install {install}\n"
    )


def test_who_imports_the_package_needs_no_torch(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And gets the exception where it is missing all the same."""
    hide(["torch"], tmp_path, monkeypatch)
    code = "import galactic\ntry: import galactic.train\nexcept ImportError as error: print(error.name)"
    done = subprocess.run(
        [sys.executable, "-B", "-c", code, "-m", "galactic.train"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.stdout, done.stderr) == ("torch\n", "")


def in_room_of(size: int, *words: str) -> subprocess.CompletedProcess[str]:
    """Python with no more address space than so many bytes."""
    return subprocess.run(
        [sys.executable, "-B", *words],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)),
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


@pytest.mark.parametrize("program", ["train", "evaluate", "export", "demonstrate", "compare"])
@pytest.mark.parametrize("size, shown", [(500_000_000, "500"), (ADDRESS_SPACE - 1, "1,499")])
def test_too_little_address_space_is_told_before_libraries_want_more(
    program: str, size: int, shown: str
) -> None:
    done = in_room_of(size, "-m", f"galactic.{program}", "--help")
    assert (done.returncode, done.stdout) == (5, "")
    assert done.stderr == (
        f"galactic.{program}: found a limit of {shown} MB on the address space of a process, expected at least "
        "1,500 MB; raise the limit (ulimit -v), or lift it\n"
    )


def test_as_much_address_space_as_is_asked_for_is_enough(tmp_path: pathlib.Path) -> None:
    words = ["-m", "galactic.train", "none.pack", "-o", str(tmp_path / "run"), "--ranks", "1"]
    done = in_room_of(ADDRESS_SPACE, *words)
    assert done.returncode == 2 and "none.pack" in done.stderr.splitlines()[-1]


def test_who_imports_the_package_is_refused_no_room() -> None:
    done = in_room_of(ADDRESS_SPACE - 1, "-c", "import galactic; print('on')")
    assert (done.returncode, done.stdout) == (0, "on\n")
