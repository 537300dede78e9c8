"""galactic.evaluate --dynamics: what it asks of the tool, what it makes of the answer, and how it refuses.
The tool itself is tested in tests/dynamics and tests/cli; here a program stands in for it."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import sys

import pytest

import galactic
from galactic import evaluate
from galactic.learning import command, dynamics
from galactic.learning.homes import Homes
from galactic.learning.playing import judging
from galactic.learning.saving import checkpoint
from galactic.learning.settings import Settings
from policies import untrained
from programs import HELD_OUT, needs_worlds

STAND_IN = f"""#!{sys.executable}
import json, pathlib, sys
words = sys.argv[1:]
value = lambda name: words[words.index(name) + 1]
assert pathlib.Path(value("--policy")).read_bytes() == b"a pack"
share = lambda part: {{"share": part}}
report = {{"words": [one for one in words if "/galactic-dynamics-" not in one], "success": {{
    "dynamics": share(0.5), "dynamics_after_2_s": share(0.25), "picked_in_dynamics": share(0.75)}}}}
pathlib.Path(value("--report")).write_text(json.dumps(report), encoding="utf-8")
sys.exit(int(pathlib.Path(__file__).with_suffix(".code").read_text()))
"""


@pytest.fixture(name="tool")
def _tool(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """A program named galactic-dynamics, alone on the PATH; beside it stands its exit code."""
    folder = tmp_path / "bin"
    folder.mkdir()
    tool = folder / dynamics.TOOL
    tool.write_text(STAND_IN, encoding="utf-8")
    tool.chmod(0o755)
    (folder / "galactic-dynamics.code").write_text("0", encoding="utf-8")
    monkeypatch.setenv("PATH", str(folder))
    monkeypatch.setattr(
        dynamics,
        "export_policy",
        lambda _, pack, network=None: pathlib.Path(pack).write_bytes(b"a pack"),
    )
    return tool


def run_of(**changes: object) -> dynamics.DynamicsRun:
    words: dict[str, object] = {"policy": pathlib.Path("best.pt"), "pack": b"a pack", "world": pathlib.Path("w.pack"),
                                "recipe": pathlib.Path("w.toml"), **changes}  # fmt: skip
    return dynamics.DynamicsRun(**words)  # type: ignore[arg-type]


def test_the_tool_is_asked_for_what_was_asked_for(tool: pathlib.Path) -> None:
    report = dynamics.play(
        run_of(arm="kinematic", data=pathlib.Path("d"), deterministic=True, seed=7, episodes=20)
    )
    assert report["words"][:2] == ["w.toml", "w.pack"]
    said = " ".join(report["words"])
    for wanted in ("--arm kinematic", "--data d", "--deterministic", "--seed 7", "--episodes 20"):
        assert wanted in said, (tool, said)
    assert dynamics.told(report) == {
        "success_in_dynamics": 0.5,
        "dynamics_after_2_s": 0.25,
        "picked_in_dynamics": 0.75,
    }
    # It has no noise of motion, and refuses a world that has some.
    assert said.endswith("--set motion-noise=0 --set motion-bias=0 --set action-delay=0")
    plain = " ".join(dynamics.play(run_of())["words"])
    assert "--arm motors" in plain and "--data" not in plain and "--deterministic" not in plain


@needs_worlds
def test_a_world_with_noise_of_motion_is_played_without_it(
    tool: pathlib.Path,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    """And that is said before anything is played."""
    settings = Settings(network="state", width=16, simulation="task=pick episode-steps=5")
    policy = tmp_path / "best.pt"
    checkpoint.save_policy(untrained(settings), policy)
    words = [str(policy), str(HELD_OUT), "--episodes", "4", "--dynamics", "world.toml"]
    assert evaluate.main(words) == 0
    plain = capfd.readouterr()
    assert plain.err == "" and "success_in_dynamics 0.5\n" in plain.out
    assert "success    0.0 % (0.0 to 49.0) of 4 episodes\n" in plain.out

    def homes_of(world: galactic.World, settings: Settings, *rest: object, **more: object) -> Homes:
        """Those of a world whose own task has noise."""
        simulation = f"{settings.simulation} motion-bias=0.25"
        return Homes(world, dataclasses.replace(settings, simulation=simulation), 1)

    monkeypatch.setattr(judging, "Homes", homes_of)
    assert evaluate.main(words) == 0
    noisy = capfd.readouterr()
    assert noisy.err == (
        "galactic.evaluate: --dynamics: robots there move without the noise and delay of the world's task "
        "(motion-bias=0.25)\n"
    )
    assert "success_in_dynamics 0.5\n" in noisy.out and noisy.out != plain.out
    assert evaluate.main(words[:-2]) == 0
    assert capfd.readouterr().err == ""


def test_its_exit_codes_are_passed_on(tool: pathlib.Path) -> None:
    for code, wanted in ((3, galactic.ErrorCode.INVALID_INPUT), (1, galactic.ErrorCode.INTERNAL)):
        tool.with_name("galactic-dynamics.code").write_text(str(code), encoding="utf-8")
        with pytest.raises(galactic.Error) as refused:
            dynamics.play(run_of())
        assert refused.value.code == wanted and f"exit code {code}" in str(refused.value)


def test_a_tool_that_a_signal_ends_has_said_nothing(tool: pathlib.Path) -> None:
    tool.write_text(f"#!{sys.executable}\nimport os\nos.kill(os.getpid(), 9)\n", encoding="utf-8")
    with pytest.raises(galactic.Error, match="galactic-dynamics: was ended by SIGKILL, and could"):
        dynamics.play(run_of())


def test_an_interrupted_tool_interrupts_what_asked_for_it(
    tool: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tool.with_name("galactic-dynamics.code").write_text("130", encoding="utf-8")

    def play() -> int:
        dynamics.play(run_of())
        return 0

    assert command.told("galactic.evaluate", play) == 130
    assert capsys.readouterr().err == "galactic.evaluate: interrupted\n"


def test_where_it_is_not_installed_evaluate_says_so_first(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    words = ["none.pt", "none.pack", "--dynamics", "world.toml"]
    assert evaluate.main(words) == 5
    said = capsys.readouterr().err
    assert "--dynamics: needs galactic-dynamics on the PATH" in said and "install" in said
    assert not os.listdir(tmp_path)
