"""What the programs say in a Python that lacks their libraries."""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys

import pytest

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
