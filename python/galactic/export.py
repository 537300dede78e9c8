"""Makes a policy pack of a trained policy: `python3 -m galactic.export runs/pick/best.pt -o picker.pack`.

`galactic-run --policy picker.pack` plays the pack without Python, and galactic.LearnedPolicy plays
it without torch. docs/policies.md describes what is in it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from galactic.learning.command import EXIT_CODES, OK, Parser, named_path, told
from galactic.learning.packs.content import export_policy


def make_parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="python3 -m galactic.export",
        description="Makes a policy pack of a trained policy, for galactic-run --policy.",
        epilog=EXIT_CODES,
    )
    parser.add_argument("policy", type=named_path, help="best.pt or policy.pt of a run")
    parser.add_argument(
        "-o",
        "--out",
        type=named_path,
        required=True,
        metavar="FILE.pack",
        help="the pack to write",
    )
    parser.add_argument(
        "--name", default="", help="name of the policy (default: the pack's file name)"
    )
    parser.add_argument(
        "--robot",
        default="",
        help="the only robot that it may move (default: any with as many actions)",
    )
    parser.add_argument(
        "--network",
        metavar="FILE.py:CLASS|MODULE:CLASS",
        help="the class of a network of your own, which a policy that was trained with one needs",
    )
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    options = make_parser().parse_args(arguments)

    def export() -> int:
        export_policy(options.policy, options.out, options.name, options.robot, options.network)
        return OK

    return told("galactic.export", export)


if __name__ == "__main__":
    sys.exit(main())
