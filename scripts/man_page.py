#!/usr/bin/env python3
"""Makes a man page of what a tool, or a verb of it, says with --help: help2man does the work, this names the
page and puts what is no option (examples, exit codes) into sections of its own."""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def parts_of(text: str) -> tuple[str, str, list[str], list[str]]:
    """One line about the tool, the help without its footer, examples, exit codes (`0  success`)."""
    summary = text.strip().splitlines()[0].split(";")[0].rstrip(".")
    body, exits = text, []
    found = re.search(r"^Exit codes:\n((?:  .*\n?)+)", text, re.MULTILINE)
    if found:
        exits = [line.strip() for line in found[1].splitlines()]
        body = text[: found.start()] + text[found.end() :]
    examples = []
    found = re.search(r"^Examples:\n((?:  .*\n?)+)", body, re.MULTILINE)
    if found:
        examples = [line.strip() for line in found[1].splitlines()]
        body = body[: found.start()] + body[found.end() :]
    return summary, body, examples, exits


def sections(examples: list[str], exits: list[str], see_also: str) -> str:
    """An include file of help2man."""
    out = ""
    if exits:
        out += "[EXIT STATUS]\n"
        for line in exits:
            code, meaning = line.split(None, 1)
            out += f".TP\n.B {code}\n{meaning}\n"
    if examples:
        out += (
            "[EXAMPLES]\n.nf\n" + "\n".join(one.replace("-", r"\-") for one in examples) + "\n.fi\n"
        )
    return out + f"[SEE ALSO]\n{see_also}\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--help2man", required=True)
    parser.add_argument("--tool", type=pathlib.Path, required=True)
    parser.add_argument("--version", required=True)
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True)
    parser.add_argument("verb", nargs="?")
    options = parser.parse_args()
    name = " ".join([options.tool.name, *([options.verb] if options.verb else [])])
    help_text = subprocess.run(
        [options.tool, *([options.verb] if options.verb else []), "--help"],
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    summary, body, examples, exits = parts_of(help_text)
    tools = ["galactic-bake", "galactic-dynamics", "galactic-pack", "galactic-run"]
    others = [tool for tool in tools if options.verb or tool != options.tool.name]
    see_also = ",\n".join(f".BR {tool} (1)" for tool in others)
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        include = pathlib.Path(folder, "sections")
        include.write_text(sections(examples, exits, see_also), encoding="utf-8")
        # help2man asks a program for its help; this one answers with what was found above.
        program = pathlib.Path(folder, name.replace(" ", "-"))
        pathlib.Path(folder, "help").write_text(body, encoding="utf-8")
        program.write_text(f'#!/bin/sh\ncat "{folder}/help"\n', encoding="utf-8")
        program.chmod(0o755)
        subprocess.run(
            [options.help2man, "--no-info", "--name", summary[0].lower() + summary[1:],
             "--version-string", options.version, "--source", f"galactic {options.version}",
             "--manual", "galactic", "--include", include, "--out", options.out, program],
            check=True,
            env={**os.environ, "LC_ALL": "C"},
        )  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
