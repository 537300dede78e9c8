#!/usr/bin/env python3
"""Runs the programs with standard streams that cannot be written, and with a limit on the size of files.

    lose_streams.py FOLDER_OF_PROGRAMS WORLD PACKS

WORLD is a world pack, PACKS the folder of the golden packs. What is printed and lost ends a program with 2 and one line
PROGRAM: standard output: MESSAGE, or with the code of its own error; a lost error message changes nothing. A file that
cannot grow ends it with 2, one line, and no file. No program ever ends by a signal.
"""

import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from typing import TextIO

PROGRAMS = ("galactic-run", "galactic-pack", "galactic-bake", "galactic-dynamics")
MOST_BYTES = 2048


def limit_files() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (MOST_BYTES, MOST_BYTES))


def close(*streams: int) -> Callable[[], None]:
    def close_them() -> None:
        for stream in streams:
            os.close(stream)

    return close_them


def run(
    command: list[str],
    folder: str,
    prepare: Callable[[], None] | None = None,
    stdout: TextIO | int = subprocess.PIPE,
    stderr: TextIO | int = subprocess.PIPE,
) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        command,
        text=True,
        cwd=folder,
        preexec_fn=prepare,
        timeout=120,
        stdout=stdout,
        stderr=stderr,
    )


def faults_of_output(program: str, folder: str) -> list[str]:
    """What is wrong where nobody reads what the program prints."""
    name = pathlib.Path(program).name
    faults = []

    def expect(
        what: str, done: "subprocess.CompletedProcess[str]", code: int, pattern: str
    ) -> None:
        said = done.stderr or ""
        if done.returncode != code or not re.fullmatch(pattern, said):
            faults.append(f"{name} {what} ended with {done.returncode}: {said!r}")

    lost = rf"{name}: standard output: cannot be written; [^\n]+\n"
    with open("/dev/full", "w") as full:
        for option in ("--help", "--version"):
            expect(f"{option} on a full disk", run([program, option], folder, stdout=full), 2, lost)
            expect(
                f"{option} with stdout closed", run([program, option], folder, close(1)), 2, lost
            )
        wrong = [program, "--no-such-option"]
        expect("with stderr on a full disk", run(wrong, folder, stderr=full), 1, "")
        expect("with stderr closed", run(wrong, folder, close(2)), 1, "")
        expect("with no stream", run(wrong, folder, close(0, 1, 2)), 1, "")
    return faults


def faults_of_files(command: list[str]) -> list[str]:
    """What is wrong with the file that the command writes, whose name is its last word."""
    name = pathlib.Path(command[0]).name
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, command[-1])
        done = run(command, folder, limit_files)
        if done.returncode != 2 or not re.fullmatch(rf"{name}: [^\n]+: [^\n]+\n", done.stderr):
            faults.append(f"{name} with small files ended with {done.returncode}: {done.stderr!r}")
        if left := os.listdir(folder):
            faults.append(f"{name} with small files left {left}")
        run(command, folder).check_returncode()
        whole = file.read_bytes()
        if len(whole) <= MOST_BYTES:
            faults.append(f"{name} wrote {len(whole)} bytes, too few to test anything")
        # The file must not get the number of a closed stream, and what is printed there.
        run(command, folder, close(0, 1, 2))
        if file.read_bytes() != whole:
            faults.append(f"{name} with no stream wrote another file")
    return faults


def main() -> int:
    programs, world, packs = (pathlib.Path(text).resolve() for text in sys.argv[1:4])
    commands = [
        ["galactic-run", world, "--envs", 2, "--steps", 50, "--threads", 1, "--record", "run.rec"],
        ["galactic-pack", "picture", packs / "crate.pack", "-o", "crate.png"],
        ["galactic-bake", packs / "crate.obj", "--as", "object", "-o", "crate.pack"],
    ]
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for program in PROGRAMS:
            if (programs / program).exists():
                faults += faults_of_output(str(programs / program), folder)
    for program, *words in commands:
        if (programs / program).exists():
            faults += faults_of_files([str(programs / program), *map(str, words)])
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
