"""Plays a policy with real dynamics, where things have mass: runs the tool galactic-dynamics, which
needs the bake side."""

from __future__ import annotations

import json
import pathlib
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import galactic
from galactic.learning.packs.content import export_policy
from galactic.learning.command import INTERRUPTED

TOOL = "galactic-dynamics"
EXACT = {"motion_noise": 0, "motion_bias": 0, "action_delay": 0}
"""Options of the simulation that the tool requires: in its world, dynamics make motions inexact."""


@dataclass(frozen=True)
class DynamicsRun:
    """A run of galactic-dynamics. `pack`: what packed() made of the policy; `recipe`: what the
    world was baked from; `data`: the folder of the recipe's files that are not beside it;
    `episodes`: how many to play, from the first on, 0 for all; `threads`: 0 for one per
    processor."""

    policy: pathlib.Path
    pack: bytes
    world: pathlib.Path
    recipe: pathlib.Path
    data: pathlib.Path | None = None
    arm: str = "motors"
    deterministic: bool = False
    seed: int = 1
    episodes: int = 0
    threads: int = 0


def require_tool() -> str:
    """The path of the tool. If it is missing, raises galactic.Error, which says what to install."""
    found = shutil.which(TOOL)
    if found is None:
        raise galactic.Error(
            galactic.ErrorCode.UNSUPPORTED,
            "--dynamics",
            f"needs {TOOL} on the PATH, which is not here; install the bake side of galactic",
        )
    return found


def packed(policy: pathlib.Path, network: str | None) -> bytes:
    """The policy pack for the tool. Raises what export_policy() raises, before anything is
    played."""
    with tempfile.TemporaryDirectory(prefix="galactic-dynamics-") as folder:
        pack = pathlib.Path(folder) / f"{policy.stem}.pack"
        export_policy(policy, pack, network=network)
        return pack.read_bytes()


def play(run: DynamicsRun) -> dict[str, Any]:
    """Plays each episode in both worlds; returns the report of galactic-dynamics. The tool prints
    to the output of this process. Raises galactic.Error if the tool fails, KeyboardInterrupt if it
    was interrupted."""
    tool = require_tool()
    with tempfile.TemporaryDirectory(prefix="galactic-dynamics-") as folder:
        pack = pathlib.Path(folder) / f"{run.policy.stem}.pack"
        report = pathlib.Path(folder) / "report.json"
        pack.write_bytes(run.pack)
        command = [tool, str(run.recipe), str(run.world), "--policy", str(pack), "--arm", run.arm,
                   "--seed", str(run.seed), "--episodes", str(run.episodes),
                   "--threads", str(run.threads), "--report", str(report)]  # fmt: skip
        command += ["--data", str(run.data)] if run.data else []
        command += ["--deterministic"] if run.deterministic else []
        for name, value in EXACT.items():
            command += ["--set", f"{_typed(name)}={value}"]
        code = subprocess.run(command, check=False).returncode
        if code == INTERRUPTED:
            raise KeyboardInterrupt
        if code < 0:
            message = f"was ended by {signal.Signals(-code).name}, and could not say why"
            raise galactic.Error(galactic.ErrorCode.INTERNAL, TOOL, message)
        if code != 0:
            raise galactic.Error(
                _error_of(code), TOOL, f"ended with exit code {code}; it has said why"
            )
        return dict(json.loads(report.read_text(encoding="utf-8")))


def noise_left_out(options: Mapping[str, Any]) -> str:
    """The options of the simulation that the tool does not apply, as a user types them; "" if there
    are none."""
    left_out = [name for name, value in EXACT.items() if options[name] != value]
    return " ".join(f"{_typed(name)}={_shown(options[name])}" for name in left_out)


def _shown(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:.3g}"  # a range is text


def _typed(name: str) -> str:
    return name.replace("_", "-")


def _error_of(code: int) -> galactic.ErrorCode:
    known = {int(one): one for one in galactic.ErrorCode.__members__.values()}
    return known.get(code, galactic.ErrorCode.INTERNAL)


def told(report: dict[str, Any]) -> dict[str, float]:
    """The numbers of a report that an evaluation adds to its summary."""
    success = report["success"]
    return {
        "success_in_dynamics": success["dynamics"]["share"],
        "dynamics_after_2_s": success["dynamics_after_2_s"]["share"],
        "picked_in_dynamics": success["picked_in_dynamics"]["share"],
    }
