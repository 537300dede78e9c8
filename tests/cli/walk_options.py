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
NO_LIST = ("", ",", "nan", "inf", "1,nan", "1,,2", "1,", "nonsense", "1x", "1 2", "1;2")
NO_RANGE = ("3-1", "0.3-0.1", "1-", "1-2-3", "1..2", "0-nan", "0-1e300", "0 -1")
NO_PART = ("", "0/0", "0/2", "3/2", "-1/2", "1/-2", "1", "1/", "/2", "nan/nan", f"1/{HUGE}", "nonsense")
WHOLE = {"N", "PIXELS"}
NUMBER = {"NUMBER", "METERS", "DEGREES", "RADIANS", "SHARE", "GIB", "X"}
LIST = {"R,R,...", "N,N,...", "X,Y,Z", "LOW,HIGH", "LEAST[,MOST]", "N|LEAST,MOST", "H,LOW-HIGH,..."}
PATH = {"FILE", "FOLDER", "FILE.json", "FILE.html", "FILE.glb", "FILE.png"}
# What may be below 0: rewards and penalties, thresholds of actions, and sensors, where it means the recipe's.
BELOW_ZERO = re.compile(r"--(.*-(reward|weight|penalty)|grasp-from|release-below|terminate-from|laser-.*)$")


@dataclasses.dataclass
class Option:
    name: str
    # What the help says of its value; "" for a switch.
    value: str
    several: bool
    # The heading of the help under which it stands.
    heading: str

    @property
    def bad(self) -> tuple[str, ...]:
        """Values that are none of its kind."""
        if self.value in WHOLE:
            return NO_WHOLE_NUMBER
        if self.value in NUMBER:
            return NO_NUMBER + (() if BELOW_ZERO.match(self.name) else ("-1",))
        if self.value.endswith("|LOW-HIGH"):
            return (*(NO_WHOLE_NUMBER if self.value.startswith("N|") else NO_NUMBER), *NO_RANGE)
        if self.value in LIST:
            return NO_LIST
        if self.value == "I/N":
            return NO_PART
        if self.value == "AXIS":
            return NO_CHOICE
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


def is_repeated(line: str, value: str) -> bool:
    """Whether the help says that an option may be given several times."""
    return "..." in value.split() or "(may be repeated)" in line or "repeat it" in line


def options_of(text: str) -> list[Option]:
    """The options of a help page but --help and --version."""
    found = []
    heading = ""
    for line in text.splitlines():
        heading = line.removesuffix(":") if re.fullmatch(r"\S.*:", line) else heading
        match = re.match(r" {2}(?:-\w,)?(--[a-z-]+)\S*((?: (?!\[| )\S+)*)", line)
        if not match or match[1] in ("--help", "--version"):
            continue
        words = [word for word in match[2].split() if word not in ("REQUIRED", "...")]
        rest = re.sub(r"^ \[[^\]]*\]", "", line[match.end() :])
        assert len(words) <= 1 and re.match(r" *$|  ", rest), f"an option runs into its explanation: {line}"
        found.append(Option(match[1], words[0] if words else "", is_repeated(line, match[2]), heading))
    return found


class Walk:
    """Walks the options under the given headings, or all."""

    def __init__(
        self, program: str, verb: list[str], base: dict[str, str], packs: list[str], headings: tuple[str, ...] = ()
    ):
        self.headings = headings
        self.program = program
        self.name = pathlib.Path(program).name
        self.verb, self.base, self.packs = verb, base, packs
        self.faults: list[str] = []
        self.runs = 0
        self.refused = 0

    def run(self, option: Option, words: list[str]) -> "subprocess.CompletedProcess[str] | None":
        base = [word for name, value in self.base.items() if name != option.name for word in (name, value) if word]
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
        self.refused += done.returncode == COMMAND_LINE
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
        # galactic-bake has options in files, too, and says where it read them: for these, on the command line.
        starts = (f"{self.name}: command line: ", f"{self.name}: {option.name}: ")
        if done.returncode != COMMAND_LINE or not done.stderr.startswith(starts) or option.name not in done.stderr:
            self.fault(words, f"is to be refused; ended with {done.returncode}: {done.stderr!r}")

    def expect_suggestion(self, option: Option) -> None:
        """A letter too few in the middle of the name."""
        middle = 2 + len(option.name[2:]) // 2
        misspelt = option.name[:middle] + option.name[middle + 1 :]
        done = self.run(option, [misspelt])
        if done is None:
            return
        suggested = f"'{option.name}'" in done.stderr.partition("did you mean ")[2]
        if done.returncode != COMMAND_LINE or not suggested:
            self.fault([misspelt], f"does not suggest {option.name}: {done.stderr!r}")

    def walk(self, option: Option) -> None:
        self.expect_suggestion(option)
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


def bakes(program: str, packs: pathlib.Path) -> "list[Walk]":
    """The options of each kind with an input of that kind; nothing is written."""
    kinds = {
        ("Options", "Spheres", "Files", "Scenes", "Meshes", "Render meshes"): ("scene", ["room.obj"]),
        ("Objects", "Spheres and boxes"): ("object", ["crate.obj"]),
        ("Robots",): ("robot", ["arm.urdf"]),
        ("Episodes",): ("episodes", ["room-column.pack", "crate.pack", "arm.pack"]),
        ("Datasets",): ("dataset", ["none.scene_dataset_config.json"]),
        ("Datasets, worlds from recipes",): ("world", ["none.toml"]),
    }
    found = []
    for headings, (kind, inputs) in kinds.items():
        base = {"--as": kind, "--dry-run": "", "--threads": "1"}
        if kind == "scene":
            base["--check-columns"] = "0"
        found.append(Walk(program, [], base, [str(packs / name) for name in inputs], headings))
    return found


def walks(program: str, world: pathlib.Path, packs: pathlib.Path) -> "list[Walk]":
    """What is walked, with arguments that each verb needs."""
    if pathlib.Path(program).name == "galactic-run":
        base = {"--envs": "2", "--steps": "2", "--threads": "1", "--render": "rgb"}
        return [Walk(program, [], {**base, "--size": "16", "--contact-sheet": "sheet.png"}, [str(world)])]
    if pathlib.Path(program).name == "galactic-dynamics":
        # A recipe that is not there: what passes the command line ends at it.
        return [Walk(program, [], {"--policy": "scripted"}, ["none.toml", str(world)])]
    if pathlib.Path(program).name == "galactic-bake":
        return bakes(program, packs)
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
    verbs = re.findall(r"^ {2}([a-z]+) {2}", help_of(program, []).partition("Verbs:")[2], re.MULTILINE)
    assert verbs and set(verbs) == set(needed), f"the verbs {verbs} are not those that this test has arguments for"
    return [Walk(program, [verb], base, given) for verb in verbs for base, given in needed[verb]]


def main() -> int:
    program, world, packs = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve()
    faults: list[str] = []
    runs = refused = options = 0
    walked: set[str] = set()
    for walk in walks(program, world, packs):
        found = [
            option
            for option in options_of(help_of(program, walk.verb))
            if not walk.headings or option.heading.partition(" (")[0] in walk.headings
        ]
        walked.update(option.name for option in found)
        assert found, "the help has no option"
        for option in found:
            walk.walk(option)
        options += len(found)
        runs, refused = runs + walk.runs, refused + walk.refused
        faults += walk.faults
    if pathlib.Path(program).name == "galactic-bake":
        missed = {option.name for option in options_of(help_of(program, []))} - walked
        assert not missed, f"no kind of input for {sorted(missed)}"
    print(f"{options} options, {runs} runs, {refused} refused, {len(faults)} faults")
    assert 0.1 * runs < refused < 0.95 * runs, "the walk does not reach both sides"
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
