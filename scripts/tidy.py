#!/usr/bin/env python3
"""clang-tidy over our own sources, on all cores.

    tidy.py BUILD_FOLDER

Says what it found and exits with 1 when it found something. A source that passed is not examined again
until something changes that it is made of: itself, what it includes of ours, its compile command, the
checks, or an installed package. What passed is remembered for all checkouts of the user, in
~/.cache/galactic/tidy, or in the folder that GALACTIC_TIDY_CACHE names.
"""

import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

CLANG_TIDY = "clang-tidy-14"
ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("bake", "pack_tool", "runtime")
INCLUDE = re.compile(rb'^[ \t]*#[ \t]*include[ \t]*["<]([^">\n]+)[">]', re.MULTILINE)
FINDING = re.compile(r"(warning|error): ")


@functools.cache
def contents(path: pathlib.Path) -> tuple[bytes, tuple[str, ...]]:
    """The digest of a file, and what it includes as it is written there."""
    text = path.read_bytes()
    names = tuple(name.decode(errors="replace") for name in INCLUDE.findall(text))
    return hashlib.sha256(text).digest(), names


def search_folders(command: list[str], folder: pathlib.Path) -> list[pathlib.Path]:
    """The include folders of a compile command that lie in this checkout."""
    found = []
    for at, word in enumerate(command):
        if word in ("-I", "-isystem") and at + 1 < len(command):
            found.append(command[at + 1])
        elif word.startswith("-I"):
            found.append(word[2:])
    folders = [(folder / name).resolve() for name in found]
    return [path for path in folders if path.is_relative_to(ROOT)]


def made_of(source: pathlib.Path, folders: list[pathlib.Path]) -> list[pathlib.Path]:
    """The source and all files of this checkout that it includes, whatever the conditions are."""
    seen = {source}
    waiting = [source]
    while waiting:
        file = waiting.pop()
        for name in contents(file)[1]:
            for folder in (file.parent, *folders):
                path = folder / name
                if path not in seen and path.is_file():
                    seen.add(path)
                    waiting.append(path)
    return sorted(seen)


def surroundings() -> bytes:
    """Digest of what all results depend on: the tool, the checks, the installed packages."""
    digest = hashlib.sha256((ROOT / ".clang-tidy").read_bytes())
    digest.update(subprocess.run([CLANG_TIDY, "--version"], capture_output=True, check=True).stdout)
    try:
        packages = subprocess.run(["dpkg-query", "-W"], capture_output=True, check=False)
        digest.update(packages.stdout)
    except FileNotFoundError:
        pass
    return digest.digest()


def key_of(entry: dict, common: bytes) -> str:
    """Digest of everything that the result for a source depends on, the checkout's place apart."""
    command = shlex.split(entry["command"])
    folder = pathlib.Path(entry["directory"])
    digest = hashlib.sha256(common)
    digest.update(entry["command"].replace(str(ROOT), "").encode())
    for path in made_of(pathlib.Path(entry["file"]), search_folders(command, folder)):
        digest.update(os.path.relpath(path, ROOT).encode() + b"\0" + contents(path)[0])
    return digest.hexdigest()


def examine(build: pathlib.Path, source: str) -> tuple[int, str]:
    """Exit code of clang-tidy for a source, and what it said."""
    run = subprocess.run([CLANG_TIDY, "--quiet", "-p", str(build), source], capture_output=True,
                         text=True, check=False, stdin=subprocess.DEVNULL)
    # On stderr it counts what it does not show; that matters only when it could not do its work.
    return run.returncode, run.stdout if run.stdout or run.returncode == 0 else run.stderr


def main() -> int:
    if len(sys.argv) != 2:
        print("tidy: give the build folder, which has compile_commands.json", file=sys.stderr)
        return 1
    build = pathlib.Path(sys.argv[1]).resolve()
    passed = pathlib.Path(os.environ.get("GALACTIC_TIDY_CACHE") or pathlib.Path.home() / ".cache/galactic/tidy")
    passed.mkdir(parents=True, exist_ok=True)
    ours = tuple(f"{ROOT / folder}{os.sep}" for folder in FOLDERS)
    # A source of several targets is examined once.
    entries = {entry["file"]: entry
               for entry in json.loads((build / "compile_commands.json").read_text())
               if entry["file"].startswith(ours)}
    common = surroundings()
    keys = {source: key_of(entry, common) for source, entry in entries.items()}
    # The longest first, so that no core waits at the end.
    waiting = sorted((source for source in keys if not (passed / keys[source]).exists()),
                     key=lambda source: (-os.path.getsize(source), source))
    findings: set[str] = set()
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        results = pool.map(functools.partial(examine, build), waiting)
        for source, (code, said) in zip(waiting, results):
            if code == 0:
                (passed / keys[source]).touch()
                continue
            failed += 1
            print(said, flush=True)
            findings.update(line for line in said.splitlines() if FINDING.search(line))
    for line in sorted(findings):
        print(line)
    print(f"clang-tidy: {failed} sources with findings; examined {len(waiting)} of {len(keys)}, the"
          " others are as they were when they passed")
    return 1 if failed or not keys else 0


if __name__ == "__main__":
    sys.exit(main())
