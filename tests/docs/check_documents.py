#!/usr/bin/env python3
"""Checks of the documents (README.md, docs/ and the folders' READMEs).

    check_documents.py code              blocks that quote a file equal it
    check_documents.py examples          examples/README.md lists what is in examples/python, and tests run it
    check_documents.py links             links lead to files, and to headings in them
    check_documents.py commands --bin D  the commands of docs/ that call our tools do as they say
    check_documents.py options --bin D   docs/tools.md lists the options of our tools, and no others

A block quotes a file when the line before it is <!-- file: PATH -->. Commands are the lines of blocks
marked "sh" that begin with one of RUN; a line that ends in "# exit 7" has to end with that code. All
commands of one document run in one fresh folder, in which packs/ and schema/ are the project's. What
calls tools that are not built is skipped: a document's commands, a tool's options. Options are what
--help of a tool and its verbs begins a line with.
"""

import argparse
import difflib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

PROJECT = pathlib.Path(__file__).parents[2]
BLOCK = re.compile(r"(?:<!-- file: (?P<file>\S+) -->\n)?```(?P<language>\w*)\n(?P<text>.*?)```\n",
                   re.DOTALL)
LINK = re.compile(r"\]\(([^)#\s]*)(?:#([^)\s]*))?\)")
# Text in which neither links nor headings are any.
CODE = re.compile(r"^```.*?^```$|(`+)[^`\n]*?\1", re.DOTALL | re.MULTILINE)
HEADING = re.compile(r"^#{1,6} +(.*?)\s*$", re.MULTILINE)
ANCHOR = re.compile(r"<a (?:id|name)=\"([^\"]+)\"")
# Our tools, and what prepares or looks at their files.
RUN = ("galactic-", "flatc ", "printf ", "tail ")
TOOL = re.compile(r"(?<![\w./-])galactic-\w+")
EXPECTED_EXIT = re.compile(r"\s+# exit (\d+)$")
TOOL_SECTION = re.compile(r"^## (galactic-\w+)\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)
VERB_HEADING = re.compile(r"^### (\w+)$", re.MULTILINE)
HELP_OPTION = re.compile(r"^ +(?:-\w,)?(--[a-z0-9-]+)", re.MULTILINE)
OPTION = re.compile(r"--[a-z][a-z0-9-]*")
# Said once, for all tools.
OF_ALL_TOOLS = {"--help", "--version"}


def documents(root: pathlib.Path) -> list[pathlib.Path]:
    found = [path for path in root.rglob("*.md")
             if path.relative_to(root).parts[0] not in {"build", ".git"}]
    return sorted(found)


def check_code(root: pathlib.Path) -> list[str]:
    offences = []
    quoted = 0
    for document in documents(root):
        for block in BLOCK.finditer(document.read_text(encoding="utf-8")):
            if not block["file"]:
                continue
            quoted += 1
            file = root / block["file"]
            if not file.is_file():
                offences.append(f"{document.relative_to(root)}: quotes {block['file']}, which is gone")
            elif file.read_text(encoding="utf-8") != block["text"]:
                offences.append(f"{document.relative_to(root)}: differs from {block['file']}; copy the "
                                "file into the block")
    return offences if quoted else ["no document quotes a file: nothing was compared"]


def check_examples(root: pathlib.Path) -> list[str]:
    offences = []
    programs = sorted((root / "examples" / "python").glob("*.py"))
    listed = (root / "examples" / "README.md").read_text(encoding="utf-8") if programs else ""
    tests = "".join(file.read_text(encoding="utf-8") for file in sorted((root / "tests" / "python").rglob("*.py")))
    for program in programs:
        shown = program.relative_to(root)
        if f"\n| `{program.name}" not in listed:
            offences.append(f'{shown}: examples/README.md has no row "| `{program.name}"; add one')
        if not re.search(rf"""["'/]{re.escape(program.name)}["']""", tests):
            offences.append(f'{shown}: no test in tests/python says "{program.name}"; run it in test_examples.py there '
                            "or, where it learns, in learning/")
    return offences if programs else ["examples/python has no programs: nothing was looked at"]


def anchors_of(text: str) -> set[str]:
    """What follows "#" in links to the headings of a document, as GitHub names them."""
    without_blocks = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
    anchors = set(ANCHOR.findall(without_blocks))
    seen: dict[str, int] = {}
    for heading in HEADING.findall(without_blocks):
        shown = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", shown.lower()).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        anchors.add(f"{slug}-{count}" if count else slug)
    return anchors


def check_links(root: pathlib.Path) -> list[str]:
    offences = []
    for document in documents(root):
        shown = document.relative_to(root)
        text = document.read_text(encoding="utf-8")
        for file, anchor in LINK.findall(CODE.sub("", text)):
            if "://" in file or file.startswith("mailto:"):
                continue
            target = document.parent / file if file else document
            if not target.exists():
                offences.append(f"{shown}: links to {file}, which is not there")
            elif anchor and target.suffix == ".md":
                anchors = anchors_of(target.read_text(encoding="utf-8"))
                if anchor not in anchors:
                    nearest = difflib.get_close_matches(anchor, anchors, 1)
                    advice = f"did you mean #{nearest[0]}?" if nearest else "link to one that it has"
                    offences.append(f"{shown}: links to {file}#{anchor}, but no heading there is called so; {advice}")
    return offences


def commands_of(text: str) -> list[tuple[str, int]]:
    """The commands of a document that call our tools, and the exit codes that they announce."""
    found = []
    for block in BLOCK.finditer(text):
        if block["language"] != "sh":
            continue
        for line in block["text"].replace("\\\n", " ").splitlines():
            if not line.startswith(RUN):
                continue
            expected = EXPECTED_EXIT.search(line)
            found.append((line, int(expected[1]) if expected else 0))
    return found


def check_commands(root: pathlib.Path, programs: pathlib.Path) -> list[str]:
    offences = []
    total = 0
    environment = {**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}
    for document in documents(root):
        with tempfile.TemporaryDirectory() as folder:
            for shared in ("packs", "schema"):
                (pathlib.Path(folder) / shared).symlink_to(root / shared)
            commands = commands_of(document.read_text(encoding="utf-8"))
            missing = sorted({tool for line, _ in commands for tool in TOOL.findall(line)
                              if not (programs / tool).exists()})
            if missing:
                print(f"{document.relative_to(root)}: skipped, without {', '.join(missing)}")
                continue
            for line, expected in commands:
                total += 1
                run = subprocess.run(["bash", "-c", line], cwd=folder, env=environment, text=True,
                                     stdin=subprocess.DEVNULL, capture_output=True, check=False)
                if run.returncode != expected:
                    offences.append(f"{document.relative_to(root)}: {line}\n  ended with "
                                    f"{run.returncode} instead of {expected}: {run.stderr.strip()}")
    print(f"{total} commands")
    return offences if total else [
        "no document has a command whose tools are built: nothing was run; build all of them"]


def options_of(tool: pathlib.Path, verbs: list[str]) -> set[str]:
    texts = [subprocess.run([tool, *verb, "--help"], text=True, capture_output=True, check=True).stdout
             for verb in ([], *([verb] for verb in verbs))]
    return {option for text in texts for option in HELP_OPTION.findall(text)} - OF_ALL_TOOLS


def options_in_tables(section: str) -> set[str]:
    cells = [line.split("|")[1] for line in section.splitlines() if line.startswith("|")]
    return {option for cell in cells for option in OPTION.findall(cell)}


def check_options(root: pathlib.Path, programs: pathlib.Path) -> list[str]:
    offences = []
    total = 0
    for tool, section in TOOL_SECTION.findall((root / "docs" / "tools.md").read_text(encoding="utf-8")):
        if not (programs / tool).exists():
            continue
        options = options_of(programs / tool, VERB_HEADING.findall(section))
        total += len(options)
        offences += [f"docs/tools.md: does not list {tool} {option}"
                     for option in sorted(options - set(OPTION.findall(section)))]
        offences += [f"docs/tools.md: lists {option}, which {tool} does not have"
                     for option in sorted(options_in_tables(section) - options)]
    print(f"{total} options")
    return offences if total else [
        "no tool that is built has an option: nothing was compared; build all of them"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("code", "examples", "links", "commands", "options"))
    parser.add_argument("--root", type=pathlib.Path, default=PROJECT)
    parser.add_argument("--bin", type=pathlib.Path, help="folder of the built tools")
    options = parser.parse_args()
    if options.what == "code":
        offences = check_code(options.root)
    elif options.what == "examples":
        offences = check_examples(options.root)
    elif options.what == "links":
        offences = check_links(options.root)
    elif options.bin is None:
        parser.error(f"{options.what} needs --bin")
    elif options.what == "options":
        offences = check_options(options.root, options.bin.resolve())
    else:
        offences = check_commands(options.root, options.bin.resolve())
    for offence in offences:
        print(offence)
    print(f"documents, {options.what}: {len(offences)} offences")
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
