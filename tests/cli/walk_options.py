#!/usr/bin/env python3
"""Gives every option of a program every kind of bad value, and some good ones.

    walk_options.py PROGRAM WORLD PACKS

The options come from what the program itself prints for --help, and so do the verbs: a new one is walked
without a line here, and what takes an unusual value has to be said below. WORLD is a world pack, PACKS the
folder of the golden packs.

What is no value of its kind ends with 1 and one line of the form PROGRAM: command line: MESSAGE that names the
option. Everything else ends with 0, or is refused in one line PROGRAM: WHERE: MESSAGE with a code of docs/tools.md.
Nothing ends by a signal, in an internal error, or not at all.
"""

import dataclasses
import os
import pathlib
import re
import subprocess
import sys
import tempfile

# Seconds; a run of two steps takes a hundredth of one.
LIMIT = 60
COMMAND_LINE, INTERNAL = 1, 4
CODES = (0, 1, 2, 3, 5)
HUGE = "9" * 20
NO_NUMBER = ("", "nan", "-nan", "inf", "-inf", "1e300", "-1e300", "nonsense", "1x", " 1", "0x10", "1,1")
NO_WHOLE_NUMBER = (*NO_NUMBER, "-1", "1.5", HUGE, "-" + HUGE)
NO_CHOICE = ("", "nan", "-1", "0", "1", "2", "nonsense", HUGE)
ODD_TEXT = ("nan", "-1", "0", HUGE, "nonsense", "/", "a" * 5000)
WHOLE = {"N", "PIXELS"}
NUMBER = {"NUMBER", "METERS", "DEGREES", "RADIANS"}
PATH = {"FILE", "FOLDER", "FILE.json", "FILE.html", "FILE.glb", "FILE.png"}
# What may be below 0: rewards and penalties, thresholds of actions, and sensors, where it means the recipe's.
BELOW_ZERO = re.compile(r"--(.*-(reward|weight|penalty)|grasp-from|release-below|terminate-from|laser-.*)$")


@dataclasses.dataclass
class Option:
    name: str
    # What the help says of its value; "" for a switch.
    value: str
    several: bool

    @property
    def bad(self) -> tuple[str, ...]:
        """Values that are none of its kind."""
        if self.value in WHOLE:
            return NO_WHOLE_NUMBER
        if self.value in NUMBER:
            return NO_NUMBER + (() if BELOW_ZERO.match(self.name) else ("-1",))
        if "|" in self.value and not re.search(r"[A-Z]", self.value):
            return NO_CHOICE
        return ("",)

    @property
    def odd(self) -> tuple[str, ...]:
        """Values that may be refused, and may not."""
        if self.name == "--steps":
            return ("0", "1")  # many are what one may ask for
        if self.value in WHOLE:
            return ("0", "1", "4294967295", "4294967296", "18446744073709551615")
        if self.value in NUMBER:
            return ("0", "-0", "1e-300", "0.1", "1000")
        if "|" in self.value and not re.search(r"[A-Z]", self.value):
            return tuple(self.value.split("|"))
        return ODD_TEXT


def help_of(program: str, verb: list[str]) -> str:
    return subprocess.run([program, *verb, "--help"], capture_output=True, text=True, check=True).stdout


def options_of(text: str) -> list[Option]:
    """The options of a help page but --help and --version."""
    found = []
    for line in text.splitlines():
        match = re.match(r" {2}(?:-\w,)?(--[a-z-]+)\S*((?: (?!\[| )\S+)*)", line)
        if not match or match[1] in ("--help", "--version"):
            continue
        words = [word for word in match[2].split() if word not in ("REQUIRED", "...")]
        found.append(Option(match[1], words[0] if words else "", "..." in match[2].split()))
    return found


class Walk:
    def __init__(self, program: str, verb: list[str], base: dict[str, str], packs: list[str]):
        self.program = program
        self.name = pathlib.Path(program).name
        self.verb, self.base, self.packs = verb, base, packs
        self.faults: list[str] = []
        self.runs = 0
        self.refused = 0

    def run(self, option: Option, words: list[str]) -> "subprocess.CompletedProcess[str] | None":
        base = [word for name, value in self.base.items() if name != option.name for word in (name, value)]
        command = [self.program, *self.verb, *self.packs, *base, *words]
        self.runs += 1
        with tempfile.TemporaryDirectory() as folder:
            try:
                done = subprocess.run(
                    command, capture_output=True, text=True, errors="replace", timeout=LIMIT, cwd=folder
                )
            except subprocess.TimeoutExpired:
                self.fault(words, f"did not end within {LIMIT} s")
                return None
        self.refused += done.returncode != 0
        self.check_form(words, done)
        return done

    def fault(self, words: list[str], text: str) -> None:
        shown = " ".join(repr(word[:40]) for word in words)
        self.faults.append(" ".join([self.name, *self.verb, shown]) + f": {text}")
        print(self.faults[-1], flush=True)

    def check_form(self, words: list[str], done: "subprocess.CompletedProcess[str]") -> None:
        if done.returncode not in CODES:
            self.fault(words, f"ended with {done.returncode}: {done.stderr[-300:]}")
            return
        lines = done.stderr.strip().splitlines()
        if done.returncode == 0 or (done.stderr == "" and done.returncode != COMMAND_LINE):
            return  # galactic-pack check prints its verdict
        form = rf"{self.name}: [^:]\S*.*: \S"
        if len(lines) != 1 or not re.match(form, lines[0]):
            self.fault(words, f"ended with {done.returncode}, not in one line PROGRAM: WHERE: MESSAGE: {done.stderr!r}")

    def expect_refused(self, option: Option, words: list[str]) -> None:
        done = self.run(option, words)
        if done is None:
            return
        start = f"{self.name}: command line: "
        if done.returncode != COMMAND_LINE or not done.stderr.startswith(start) or option.name not in done.stderr:
            self.fault(words, f"is to be refused; ended with {done.returncode}: {done.stderr!r}")

    def walk(self, option: Option) -> None:
        if option.value == "":
            for value in ("nonsense", "-1", "nan", "2"):
                self.expect_refused(option, [f"{option.name}={value}"])
            self.run(option, [option.name])
            self.run(option, [option.name, option.name])
            return
        self.expect_refused(option, [option.name])
        for value in option.bad:
            self.expect_refused(option, [f"{option.name}={value}"])
        for value in option.odd:
            self.run(option, [option.name, value])
        if not option.several:
            value = option.odd[1]
            self.expect_refused(option, [option.name, value, option.name, value])


def walks(program: str, world: pathlib.Path, packs: pathlib.Path) -> "list[Walk]":
    """What is walked, with arguments that each verb needs."""
    if pathlib.Path(program).name == "galactic-run":
        base = {"--envs": "2", "--steps": "2", "--threads": "1", "--render": "rgb"}
        return [Walk(program, [], {**base, "--size": "16", "--contact-sheet": "sheet.png"}, [str(world)])]
    room, arm, crate = (str(packs / f"{name}.pack") for name in ("room-column", "arm", "crate"))
    needed: dict[str, list[tuple[dict[str, str], list[str]]]] = {
        "info": [({}, [room])],
        "check": [({}, [room])],
        "column": [({"--at": "0,0"}, [room])],
        "diff": [({}, [room, room])],
        "export": [({"--out": "out.obj"}, [room]), ({"--out": "out.glb"}, [arm])],
        "picture": [({"--out": "out.png"}, [pack]) for pack in (room, arm, crate)],
        "report": [({"--out": "out.html"}, [room])],
        "view": [({"--out": "out.html"}, [crate])],
    }
    verbs = re.findall(r"^ {2}([a-z]+) {2}", help_of(program, []).partition("Subcommands:")[2], re.MULTILINE)
    assert verbs and set(verbs) == set(needed), f"the verbs {verbs} are not those that this test has arguments for"
    return [Walk(program, [verb], base, given) for verb in verbs for base, given in needed[verb]]


def main() -> int:
    program, world, packs = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve()
    faults: list[str] = []
    runs = refused = options = 0
    for walk in walks(program, world, packs):
        found = options_of(help_of(program, walk.verb))
        assert found, "the help has no option"
        for option in found:
            walk.walk(option)
        options += len(found)
        runs, refused = runs + walk.runs, refused + walk.refused
        faults += walk.faults
    print(f"{options} options, {runs} runs, {refused} refused, {len(faults)} faults")
    assert 0.1 * runs < refused < 0.95 * runs, "the walk does not reach both sides"
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
