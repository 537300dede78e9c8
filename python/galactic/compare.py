"""Compares runs: `python3 -m galactic.compare runs/a runs/b -o compare.html`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from galactic import files
from galactic.learning.command import EXIT_CODES, OK, Parser, lost_output, named_path, told
from galactic.learning.reports import comparison
from galactic.learning.saving.run_folder import files_of
from galactic.streams import put


def make_parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="python3 -m galactic.compare",
        description="Says how far runs are, how well they do, and in which settings they differ. Those that differ in "
        "nothing but the seed are averaged, too. They may be under way.",
        epilog=EXIT_CODES,
    )
    parser.add_argument("runs", type=named_path, nargs="+", metavar="RUN", help="folder of a run")
    parser.add_argument(
        "-o",
        "--out",
        type=named_path,
        metavar="FILE.html",
        help="also draw their curves over each other, on a page of its own",
    )
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    options = make_parser().parse_args(arguments)
    return told("galactic.compare", lambda: _compare(options))


def _compare(options: argparse.Namespace) -> int:
    if options.out is not None:
        of_runs = [file for folder in options.runs for file in files_of(folder)]
        files.require_apart({"--out": options.out}, of_runs)
        files.require_writable(options.out)
    runs = comparison.read(options.runs)
    if options.out is not None:
        page = comparison.page_of(runs)
        files.write_atomically(options.out, lambda file: file.write(page), "w")
    if not put(sys.stdout, comparison.text_of(runs)):
        raise lost_output()
    return OK


if __name__ == "__main__":
    sys.exit(main())
