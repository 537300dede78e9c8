#!/usr/bin/env python3
"""clang-tidy over our own sources, on all cores.

    tidy.py BUILD_FOLDER

Says what it found. Exits with 1 when there is a bug among it (an error: WarningsAsErrors of .clang-tidy says what
is one), with 10 when there are matters of style only.

Sources that can be compiled as one are examined as one, which saves most of the time: it goes into the headers of
other projects. What was said of a source is remembered until something changes that it is made of: itself, what it
includes of ours, its compile command, the checks, or an installed package. It is remembered for all checkouts of
the user, in ~/.cache/galactic/tidy, or in the folder that GALACTIC_TIDY_CACHE names.
"""

import collections
import concurrent.futures
import dataclasses
import functools
import hashlib
import itertools
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

import source_groups

CLANG_TIDY = "clang-tidy-14"
ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("bake", "dynamics", "pack_tool", "runtime", "scripted", "view")
INCLUDE = re.compile(rb'^[ \t]*#[ \t]*include[ \t]*["<]([^">\n]+)[">]', re.MULTILINE)
FINDING = re.compile(r"^(/[^:]*):\d+:\d+: (warning|error): .*$", re.MULTILINE)
MATTERS_OF_STYLE = 10
# Most of the time goes into headers of other projects, once for each group.
MOST_SOURCES = 48


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


def key_of(entry: dict, files: list[pathlib.Path], common: bytes) -> str:
    """Digest of everything that the result for a source depends on, the checkout's place apart."""
    digest = hashlib.sha256(common)
    digest.update(entry["command"].replace(str(ROOT), "").encode())
    for path in files:
        digest.update(os.path.relpath(path, ROOT).encode() + b"\0" + contents(path)[0])
    return digest.hexdigest()


@dataclasses.dataclass(frozen=True)
class Source:
    path: str
    flags: tuple[str, ...]
    folder: str
    remembered: pathlib.Path
    made_of: frozenset[str]


def sources_of(build: pathlib.Path, cache: pathlib.Path) -> list[Source]:
    """Our sources of a build folder; one of several targets once."""
    ours = tuple(f"{ROOT / folder}{os.sep}" for folder in FOLDERS)
    entries = {entry["file"]: entry for entry in json.loads((build / "compile_commands.json").read_text())
               if entry["file"].startswith(ours)}
    common = surroundings()
    result = []
    for path, entry in entries.items():
        command = shlex.split(entry["command"])
        folder = pathlib.Path(entry["directory"])
        files = made_of(pathlib.Path(path), search_folders(command, folder))
        # All but the compiler, how much it optimizes, and -o OBJECT -c SOURCE at the end.
        flags = tuple(flag for flag in command[1:-4] if not re.fullmatch("-O[0-9]", flag))
        result.append(Source(path, flags, str(folder), cache / key_of(entry, files, common),
                             frozenset(map(str, files))))
    return result


def kind_of(source: Source) -> tuple[str, ...]:
    """What sources have to have in common to be examined as one: all flags but definitions and include folders."""
    return tuple(flag for flag, before in zip(source.flags, ("", *source.flags))
                 if not flag.startswith(("-D", "-I", "-isystem")) and before != "-isystem")


def definitions_of(source: Source) -> dict[str, str]:
    return {flag.partition("=")[0]: flag for flag in source.flags if flag.startswith("-D")}


def flags_of(group: list[Source]) -> list[str]:
    """The flags of all sources of a group, each once."""
    flags: list[str] = []
    for source in group:
        words = iter(source.flags)
        for word in words:
            flag = [word, next(words)] if word == "-isystem" else [word]
            if flag[-1] not in flags:
                flags += flag
    return flags


def groups_of(sources: list[Source]) -> list[list[Source]]:
    """What can be examined as one, the longest first, so that no core waits at the end."""
    alike: dict[tuple[str, ...], list[list[Source]]] = collections.defaultdict(list)
    for source in sources:
        for members in alike[kind_of(source)]:
            known = {name: flag for member in members for name, flag in definitions_of(member).items()}
            if all(known.get(name, flag) == flag for name, flag in definitions_of(source).items()):
                members.append(source)
                break
        else:
            alike[kind_of(source)].append([source])
    groups = []
    for members in itertools.chain.from_iterable(alike.values()):
        by_path = {source.path: source for source in members}
        groups += [[by_path[path] for path in paths]
                   for paths in source_groups.group_sources(list(by_path), MOST_SOURCES)]
    return sorted(groups, key=lambda group: -sum(os.path.getsize(source.path) for source in group))


def findings_in(said: str) -> list[tuple[str, str]]:
    """The file of each finding, and what was said of it, notes and all."""
    begins = list(FINDING.finditer(said))
    ends = [match.start() for match in begins[1:]] + [len(said)]
    return [(match.group(1), said[match.start():end].rstrip()) for match, end in zip(begins, ends)]


def examine(together: pathlib.Path, group: list[Source]) -> dict[Source, list[str]]:
    """What clang-tidy says of each source of a group. `together` is a folder for what compiles them as one."""
    main = group[0].path
    if len(group) > 1:
        main = str(together / f"{group[0].remembered.name}.cpp")
        pathlib.Path(main).write_text("".join(
            f'#include "{source.path}"  // NOLINT(bugprone-suspicious-include)\n' for source in group))
    header_filter = f"^{re.escape(str(ROOT))}/({'|'.join(source_groups.FOLDERS)})/"
    run = subprocess.run([CLANG_TIDY, "--quiet", f"--config-file={ROOT / '.clang-tidy'}",
                          f"--header-filter={header_filter}", main, "--", *flags_of(group)],
                         cwd=group[0].folder, capture_output=True, text=True, check=False,
                         stdin=subprocess.DEVNULL)
    found = findings_in(run.stdout)
    failed = run.returncode != 0 and not found
    if len(group) == 1:
        if failed:
            return {group[0]: [f"{main}:1:1: error: {CLANG_TIDY} could not examine it\n{run.stderr.rstrip()}"]}
        return {group[0]: [text for _, text in found]}
    if failed or ": error: " in run.stdout:
        # What is wrong as one may be right one by one: nothing is called a bug that only the group has.
        return {source: said for one in group for source, said in examine(together, [one]).items()}
    return {source: [text for file, text in found if os.path.normpath(file) in source.made_of] for source in group}


def main() -> int:
    if len(sys.argv) != 2:
        print("tidy: give the build folder, which has compile_commands.json", file=sys.stderr)
        return 1
    build = pathlib.Path(sys.argv[1]).resolve()
    cache = pathlib.Path(os.environ.get("GALACTIC_TIDY_CACHE") or pathlib.Path.home() / ".cache/galactic/tidy")
    together = build / "together"
    cache.mkdir(parents=True, exist_ok=True)
    together.mkdir(exist_ok=True)
    sources = sources_of(build, cache)
    waiting = [source for source in sources if not source.remembered.exists()]
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for said in pool.map(functools.partial(examine, together), groups_of(waiting)):
            for source, findings in said.items():
                unfinished = source.remembered.with_suffix(f".{os.getpid()}")
                unfinished.write_text(json.dumps(findings).replace(f"{ROOT}/", ""))
                unfinished.replace(source.remembered)
    # What a header has is said of all sources that include it.
    findings = sorted({text for source in sources for text in json.loads(source.remembered.read_text() or "[]")})
    for text in findings:
        print(text)
    bugs = sum(": error: " in text.partition("\n")[0] for text in findings)
    print(f"clang-tidy: {bugs} bugs, {len(findings) - bugs} matters of style in {len(sources)} sources;"
          f" examined {len(waiting)}, the others are as they were")
    if bugs or not sources:
        return 1
    return MATTERS_OF_STYLE if findings else 0


if __name__ == "__main__":
    sys.exit(main())
