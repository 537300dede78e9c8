#!/usr/bin/env python3
"""What CONTRIBUTING.md asks of every text file and a formatter cannot see.

    check_style.py [ROOT]

Too long files, words of unfinished code, code switched off with the preprocessor, paths of one
machine, tests without a namespace of their own, and flags of the command line in messages of the
library, which name options in backquotes.
"""

import pathlib
import re
import sys

import source_tree

CODE = (".h", ".cpp", ".inl", ".py", ".sh", ".fbs", ".cmake")
TEXT = CODE + (".md", ".txt", ".json", "")
# Written by programs, not by people.
GENERATED = re.compile(r"packs/.*\.json$|tests/fuzz/corpus/|\.golden$")
MAX_LINES = 800

WORD_LIST = pathlib.Path(__file__).with_name("forbidden_words.txt")
# The folder that has to name what it forbids.
EXEMPT_FROM_WORDS = pathlib.PurePosixPath("tests/layering")

SWITCHED_OFF = re.compile(r"^\s*#\s*if\s+(0|false)\b")
NAMESPACE = re.compile(r"^namespace (galactic[\w:]*) \{", re.MULTILINE)
# Folders under which no path is the same on two machines; examples live in /home/me.
LOCAL_PATH = re.compile(r"(?<![\w.$}/*])/(home(?!/me/)|work|tmp|root|Users|mnt|srv)/")
# Programs make flags of the options that the library names; recipes and other programs have none.
LIBRARY = ("bake/src", "bake/include")
# A whole command may stand in a text.
FLAG = re.compile(r"(?<!galactic-bake )(?<![\w-])--[a-z]")
# In turn: comments, quotes that begin nothing, raw strings, strings.
COMMENT_OR_LITERAL = re.compile(r"""//[^\n]*|/\*.*?\*/|'\\?"'|R"([^(\s]*)\((?P<raw>.*?)\)\1"|"""
                                r'''"(?P<plain>(?:[^"\\\n]|\\.)*)"''', re.DOTALL)


def forbidden_words() -> re.Pattern:
    lines = WORD_LIST.read_text(encoding="utf-8").splitlines()
    words = [re.escape(line) for line in lines if line and not line.startswith("#")]
    return re.compile(r"(?<![\w])(" + "|".join(words) + r")(?![\w])", re.IGNORECASE)


def check_lines(path: pathlib.PurePath, lines: list[str], words: re.Pattern) -> list[str]:
    offences = []
    exempt = path.is_relative_to(EXEMPT_FROM_WORDS)
    for number, line in enumerate(lines, 1):
        word = None if exempt else words.search(line)
        if word:
            offences.append(f'{path}:{number}: "{word.group(0)}"; finish it, or find a better word')
        if path.suffix in (".h", ".cpp") and SWITCHED_OFF.match(line):
            offences.append(f"{path}:{number}: code switched off with the preprocessor; delete it")
        local = None if exempt else LOCAL_PATH.search(line)
        if local:
            offences.append(f"{path}:{number}: the path {local.group(0)} means nothing on another "
                            "machine; an example is written with /home/me/")
    return offences


def check_flags(path: pathlib.PurePath, text: str) -> list[str]:
    offences = []
    for found in COMMENT_OR_LITERAL.finditer(text):
        literal = found["plain"] or found["raw"] or ""
        if FLAG.search(literal):
            number = text.count("\n", 0, found.start()) + 1
            offences.append(f'{path}:{number}: the library says "{literal}"; it names options as '
                            "`option`, and programs make flags of them")
    return offences


def check_namespace(path: pathlib.PurePath, text: str) -> list[str]:
    """Tests are compiled as one, and may declare the same names."""
    names = NAMESPACE.findall(text)
    if not names or any(name.split("::")[-1] == path.stem for name in names):
        return []
    return [f"{path}: is in the namespace {names[0]}, expected one that ends in the file's name: "
            f"{names[0]}::{path.stem}"]


def check_file(root: pathlib.Path, path: pathlib.Path, words: re.Pattern) -> list[str]:
    text = (root / path).read_text(encoding="utf-8", errors="replace")
    lines = text.splitlines()
    offences = check_lines(pathlib.PurePosixPath(path), lines, words)
    if path.suffix in (".h", ".cpp", ".inl") and any(path.is_relative_to(part) for part in LIBRARY):
        offences += check_flags(path, text)
    if path.is_relative_to("tests") and path.name.endswith("_test.cpp"):
        offences += check_namespace(path, text)
    if path.suffix in CODE and len(lines) > MAX_LINES:
        offences.append(f"{path}: {len(lines)} lines, expected at most {MAX_LINES} (450 is good); "
                        "split it by concern")
    return offences


def check_tree(root: pathlib.Path) -> tuple[list[str], int]:
    """All offences, and the number of files looked at."""
    words = forbidden_words()
    files = [path for path in source_tree.project_files(root, TEXT)
             if not GENERATED.search(path.as_posix()) and path.name != "LICENSE"]
    return [offence for path in files for offence in check_file(root, path, words)], len(files)


def main(arguments: list[str]) -> int:
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parents[2])
    return source_tree.report("style", *check_tree(root))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
