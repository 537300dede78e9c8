"""Every option of the programs, as their --help lists them, with every kind of bad value."""

from __future__ import annotations

import argparse
import dataclasses
import pathlib
import re
import shlex
from collections.abc import Callable
from typing import Any

import pytest

from galactic import evaluate, export, train
from galactic.learning.presets import preset
from galactic.learning.saving import runs
from galactic.learning.setting_options import given_options

NO_NUMBER = ("", "nan", "-nan", "inf", "-inf", "1e300", "-1e300", "nonsense", "1x", " 1", "1,1")
NO_WHOLE_NUMBER = (*NO_NUMBER, "-1", "1.5", "9" * 20)
NO_CHOICE = ("", "nan", "-1", "0", "nonsense")
NO_THREE = ("", "1", "1,2", "1,2,3,4", "1,,2", "nan,0,0", "0,0,inf", "0,0,1000", "a,b,c", "1, 2,3")
# Neither a number of 0 or more, nor a range of such.
NO_DRAWN = (*NO_NUMBER, "-1", "-0.1-0.2", "0.1-", "0.3-0.1", "0.1-0.2-0.3", "0.1..0.2", "0-nan")
# Numbers that may be below 0: logarithms, and where it says "no change".
BELOW_ZERO = ("--initial-log-std", "--final-log-std", "--entropy-end")
PROGRAMS: dict[str, tuple[Any, list[str]]] = {
    "train": (train, ["none.pack", "--out", "run"]),
    "evaluate": (evaluate, ["none.pt", "none.pack"]),
    "export": (export, ["none.pt", "--out", "out.pack"]),
}
Run = Callable[[list[str]], tuple[int, str]]


def options_of(name: str) -> list[argparse.Action]:
    """The options of a program but --help. --help prints the same list."""
    parser: argparse.ArgumentParser = PROGRAMS[name][0].make_parser()
    options = [one for one in parser._actions if one.option_strings and one.dest != "help"]
    printed = set(re.findall(r"--[a-z][a-z-]+", parser.format_help()))
    assert {text for one in options for text in one.option_strings if text[1] == "-"} <= printed
    return options


def test_defaults_are_shown_as_one_types_them() -> None:
    help_text = " ".join(train.make_parser().format_help().split())
    assert (
        "a task of your own, which defines rewards and the ends of episodes: `FILE.py:CLASS`"
        in help_text
    )
    assert "('" not in help_text
    assert (
        "meters ahead, to the left and up (0,0,0)" in help_text and "(`auto`) (auto)" in help_text
    )


CASES = [
    pytest.param(name, action, id=f"{name} {action.option_strings[-1]}")
    for name in PROGRAMS
    for action in options_of(name)
]


def bad_values(action: argparse.Action) -> tuple[str, ...]:
    """Values that are none of the option's kind; () for a switch."""
    option = action.option_strings[-1]
    if action.nargs == 0:
        return ()
    if getattr(action.type, "__name__", "") == "_drawn":
        return NO_DRAWN
    if action.choices or (isinstance(action.metavar, str) and "|" in action.metavar):
        return NO_CHOICE
    if action.type is None or action.type is str:
        return ()  # a name or a text may be anything
    if action.type.__name__ == "named_path":
        return ("",)
    if action.type.__name__ == "_three":
        return NO_THREE
    if action.type.__name__ == "_real":
        return NO_NUMBER + (() if option in BELOW_ZERO else ("-1",))
    # What is not known here has to be a whole number.
    return NO_WHOLE_NUMBER


@pytest.fixture
def run(monkeypatch: Any, capsys: Any, tmp_path: pathlib.Path) -> Callable[[str, list[str]], Any]:
    """Runs a program until it has read its options; the exit code and what it says."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("RANK", raising=False)
    monkeypatch.setattr(train, "launch", lambda ranks, command: 0)

    def run_program(name: str, words: list[str]) -> tuple[int, str]:
        try:
            code = PROGRAMS[name][0].main(words)
        except SystemExit as stop:
            code = stop.code
        return code, capsys.readouterr().err

    return run_program


def needed(name: str, action: argparse.Action) -> list[str]:
    """What the program cannot do without, but for the option itself."""
    words = PROGRAMS[name][1]
    if action.dest != "out":
        return words
    return words[: words.index("--out")]


@pytest.mark.parametrize("name,action", CASES)
def test_a_bad_value_is_refused_in_one_line_that_names_the_option(
    name: str, action: argparse.Action, run: Any
) -> None:
    option = action.option_strings[-1]
    for value in bad_values(action):
        code, said = run(name, [*needed(name, action), f"{option}={value}"])
        assert code == 1, f"{value!r}: {said}"
        assert re.fullmatch(rf"galactic\.{name}: command line: .*\n", said), f"{value!r}: {said}"
        assert option in said or option[2:].replace("-", "_") in said, f"{value!r}: {said}"


@pytest.mark.parametrize("name,action", CASES)
def test_an_option_is_given_once(name: str, action: argparse.Action, run: Any) -> None:
    option = action.option_strings[-1]
    word = option if action.nargs == 0 else f"{option}=1"
    code, said = run(name, [*needed(name, action), word, word])
    assert code == 1 and "given more than once" in said


def test_the_walk_reaches_options_that_are_taken(run: Any) -> None:
    words = [*PROGRAMS["train"][1], "--steps", "2e6", "--envs", "4", "--learning-rate", "1e-3"]
    world = pathlib.Path("none.pack").resolve()
    begun = (0, f"{world}: 1 rank of 4 envs, 2 M steps; starting ...\n")
    assert run("train", [*words, "--entropy-end", "-1", "--no-normalize"]) == begun
    # Values that begin with a dash, too, and are no plain numbers.
    words += ["--initial-log-std", "-5e-1", "--camera-position", "-0.1,0,.2", "--near", "0.1"]
    assert run("train", [*words, "--camera-rpy", "-.5,0,1e1"]) == begun
    # The policy that is missing is looked for after the options.
    assert run("evaluate", ["none.pt", "none.pack", "--seed", "7", "--episodes", "1"])[0] == 2
    assert run("export", ["none.pt", "-o", "out.pack", "--name", "a"])[0] == 2


def test_the_settings_of_a_run_are_those_that_another_starts_from(
    run: Any, tmp_path: pathlib.Path
) -> None:
    begun = preset("quick", seed=7, simulation="task=rearrange", envs=64)
    folder = tmp_path / "run"
    folder.mkdir()
    runs.write_run(runs.Run(pathlib.Path("/homes.pack"), None, begun), folder)
    assert preset(str(folder)) == begun
    changed = preset(str(folder), seed=8, simulation="episode-steps=300")
    assert (changed.seed, changed.envs) == (8, 64)
    assert changed.simulation == begun.simulation.replace("steps=200", "steps=300")
    # Code of one's own is where the run found it.
    for setting in ("task", "network"):
        own = dataclasses.replace(begun, **{setting: "lab.py:Own"})
        files: Any = {f"{setting}_file": pathlib.Path("/lab/lab.py")}
        runs.write_run(runs.Run(pathlib.Path("/homes.pack"), None, own, **files), folder)
        assert getattr(preset(str(folder)), setting) == "/lab/lab.py:Own"
    code, said = run("train", ["--preset", str(tmp_path / "none"), "--print-settings"])
    assert code == 2 and "none holds no run" in said


def test_settings_are_printed_as_one_types_them(run: Any, capsys: Any) -> None:
    """Without a world or a folder; typed again, they are the same."""
    changes = ["--no-normalize", "--camera-position=-0.1,0,.2", "--steps", "2e6"]
    assert train.main(["--preset", "quick-depth", *changes, "--print-settings"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == ["# Run", "--steps 2000000  # default: 200000000"]
    assert "--no-normalize" in lines and "--camera-position -0.1,0,0.2  # default: 0,0,0" in lines
    assert "--recurrent  # default: False" in lines and not any(
        line.startswith("--task ") for line in lines
    )
    words = shlex.split("\n".join(lines), comments=True)
    found = given_options(train.make_parser().parse_args(words))
    assert preset("paper", **found) == preset(
        "quick-depth", normalize=False, camera_position=(-0.1, 0.0, 0.2), steps=2_000_000
    )
    assert not list(pathlib.Path().iterdir())
    for words, message in (
        (["--resume", "-o", "run"], "--print-settings is for a new run; one that is resumed has"),
        (["--preset", "quack"], '"quack" is not a preset; did you mean quick?'),
    ):
        code, said = run("train", [*words, "--print-settings"])
        assert code == 1 and message in said
    for words, wanted, message in (
        (
            ["--simulation", "task=nope"],
            3,
            "--simulation: task: is nope, expected rearrange, pick or",
        ),
        (
            ["--simulation", "epsiode-steps=5"],
            1,
            "no option epsiode_steps; did you mean episode_ste",
        ),
        (["--critic-only", "foo"], 1, 'critic_only: "foo" is no sensor; it can be of bump'),
    ):
        code, said = run("train", [*words, "--preset", "quick", "--print-settings"])
        assert code == wanted and message in said
    code, said = run("train", ["none.pack"])
    assert code == 1 and "the following arguments are required: -o/--out" in said


@pytest.mark.parametrize(
    "words, what, remedy",
    [
        (["--shown", "3"], "pictures", "--contact-sheet or --video"),
        (["--arm", "motors"], "dynamics", "--dynamics"),
        (["--dynamics-data", "."], "dynamics", "--dynamics"),
    ],
)
def test_an_option_that_nothing_would_come_of_is_refused(
    run: Any, words: list[str], what: str, remedy: str
) -> None:
    said = f"command line: {words[0]} applies to {what} only; add {remedy}"
    assert run("evaluate", ["none.pt", "none.pack", *words]) == (1, f"galactic.evaluate: {said}\n")
