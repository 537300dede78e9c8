"""In how many episodes the target has been in the hand: in curves, validations and evaluations."""

from __future__ import annotations

import json
import pathlib

import numpy as np
import pytest

import galactic
from galactic.learning.homes import Homes
from galactic.learning.playing import evaluation
from galactic.learning.playing.experts import ScriptedExpert
from galactic.learning.rollouts.environments import Observation
from galactic.learning.settings import Settings
from programs import HELD_OUT, SMALL, UPDATE, WORLD, call, curve, needs_worlds

pytestmark = needs_worlds

TASK = '''
"""In every second episode of a world, the target is in the hand from the beginning."""

import numpy as np
import galactic

class Half(galactic.Task):
    options = {"episode_steps": 6}
    measures = ["even"]

    def place(self, envs, which, states):
        states.hold(envs.world, rows=np.flatnonzero(states.episode % 2 == 0))
        return states

    def step(self, envs):
        ends = envs.uniform("end")[:, 0] < 0.05
        return galactic.Outcome(envs.rewards, ends, envs.uniform("fail")[:, 0] < 0.05)

    def measure(self, envs, which):
        return {"even": envs.states.episode[which] % 2 == 0}
'''


@pytest.fixture
def task_file(tmp_path: pathlib.Path) -> pathlib.Path:
    file = tmp_path / "half.py"
    file.write_text(TASK, encoding="utf-8")
    return file


class Keeper(ScriptedExpert):
    """Picks as the scripted policy does, and places nothing."""

    def __init__(self, homes: Homes):
        super().__init__(homes)
        parts = homes.env.simulators[0].observation_parts
        self._holding = parts["is_holding"].start

    def act(
        self, seen: Observation, starts: np.ndarray, episodes: np.ndarray, steps: np.ndarray
    ) -> np.ndarray:
        actions = super().act(seen, starts, episodes, steps)
        held = seen.state[:, self._holding].numpy() != 0
        actions[held] = 0.0
        actions[held, -2] = 1.0  # the hand
        return actions


class Idler(ScriptedExpert):
    """Does nothing."""

    def act(
        self, seen: Observation, starts: np.ndarray, episodes: np.ndarray, steps: np.ndarray
    ) -> np.ndarray:
        return np.zeros_like(super().act(seen, starts, episodes, steps))


def test_who_picks_and_never_places_is_no_idler() -> None:
    """By success alone, both are the same."""
    settings = Settings(
        envs=8, halves=1, mini_batches=1, simulation="task=rearrange episode-steps=250"
    )
    world = galactic.World(HELD_OUT)
    shares = {}
    for player in (Keeper, Idler, ScriptedExpert):
        homes = Homes(world, settings, 1)
        played = evaluation.Evaluator(homes, player(homes)).play(homes.playable_episodes()[:16])
        told = evaluation.summary(played, world)
        assert told["picked"] == np.mean([one["picked"] for one in told["each"]])
        assert told["picked"] == evaluation.sums_of(played).means()["picked"]
        assert told["picked"] >= told["success"]
        shares[player] = told["success"], told["picked"]
        homes.close()
    assert shares[Idler] == (0.0, 0.0)
    assert shares[Keeper][0] == 0.0 and shares[Keeper][1] > 0.5
    assert shares[ScriptedExpert][0] > 0.1


def test_the_curves_and_an_evaluation_tell_them(
    tmp_path: pathlib.Path, task_file: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Also of a task of one's own, which ends episodes that go on below."""
    run, report = tmp_path / "run", tmp_path / "report.json"
    task = ["--task", f"{task_file}:Half"]
    options = [*SMALL, "--steps", 6 * UPDATE, *task, "--validation", HELD_OUT]
    options += ["--validate-every", 3 * UPDATE, "--validation-episodes", 9, "--halves", 2]
    done = call("train", WORLD, "-o", run, *options)
    assert done.returncode == 0, done.stderr
    rows = curve(run)
    trained = [row["picked"] for row in rows if row["success"] is not None]
    assert trained and all(0.2 < share < 0.8 for share in trained)
    assert [row["picked"] for row in rows] == [row["measure_even"] for row in rows]
    validated = [row["validation_picked"] for row in rows if row["validation_success"] is not None]
    assert len(validated) == 2
    assert validated == [
        row["validation_measure_even"] for row in rows if row["validation_picked"] is not None
    ]
    told = json.loads((run / "report.json").read_text(encoding="utf-8"))
    assert told["validation"]["picked"] == pytest.approx(validated[-1])
    assert '"title":"Target picked"' in (run / "curves.html").read_text(encoding="utf-8")
    capsys.readouterr()
    done = call("evaluate", run / "best.pt", HELD_OUT, "--episodes", 9, *task, "--report", report)
    assert done.returncode == 0, done.stderr
    found = json.loads(report.read_text(encoding="utf-8"))
    assert found["picked"] == pytest.approx(validated[-1])
    assert [one["picked"] for one in found["each"]] == [
        one["episode"] % 2 == 0 for one in found["each"]
    ]
    assert f"picked     {found['picked']:.4g}\n" in capsys.readouterr().out
