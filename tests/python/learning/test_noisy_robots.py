"""Policies of robots that do not do exactly what they are asked to: what they are trained with, and judged by."""

from __future__ import annotations

import json
import pathlib

import galactic
from galactic.learning.saving import checkpoint
from galactic.learning.settings import Settings
from policies import untrained
from programs import HELD_OUT, WORLD, call, curve, needs_worlds

PLAIN = "task=pick episode-steps=30"
NOISY = f"{PLAIN} motion-noise=0.4 --motion_bias=0.3 localization-noise=0.2 action-delay=0-2"


def of_state(simulation: str) -> Settings:
    return Settings(
        network="state", width=16, envs=6, halves=1, mini_batches=1, simulation=simulation
    )


def test_what_a_training_adds_is_left_out_and_nothing_else() -> None:
    assert of_state(NOISY).without_noise() == of_state(PLAIN)
    assert of_state(NOISY).without_camera_noise() == of_state(NOISY)
    twice = of_state("task=pick motion-noise=0 motion-noise=0.1")
    assert twice.without_robot_noise().simulation == "task=pick"
    drawn = of_state(
        "motion-noise=0-0.5 task=pick motion-bias=1e-3-2e-3 localization-noise=.1-.2 action-delay=0-2"
    )
    assert drawn.without_robot_noise().simulation == "task=pick"
    # As it was typed, and the noise of a world that it switches off stays off.
    assert of_state("action-delay=3 task=pick").without_robot_noise().simulation == "task=pick"
    for words in (
        "task=pick  bump",
        "action-delay=0",
        "motion-noise=0 task=pick motion-bias=0.0",
        "motion-noise=x",
    ):
        assert of_state(words).without_robot_noise().simulation == words


def test_all_noise_that_a_simulation_has_is_left_out() -> None:
    for name in galactic.Simulator.NOISE_OPTIONS:
        assert of_state(f"task=pick {name}=0-1").without_noise() == of_state("task=pick"), name


@needs_worlds
def test_a_policy_is_evaluated_without_the_noise_of_its_training(tmp_path: pathlib.Path) -> None:
    report = tmp_path / "report.json"

    def played(policy: pathlib.Path, *words: str) -> list[dict[str, object]]:
        done = call(
            "evaluate",
            policy,
            HELD_OUT,
            "--episodes",
            6,
            "--report",
            report,
            "--deterministic",
            *words,
        )
        assert done.returncode == 0, done.stderr
        said = json.loads(report.read_text(encoding="utf-8"))
        assert said["robot_noise"] == ("--robot-noise" in words)
        return said["each"]

    plain, noisy = tmp_path / "plain.pt", tmp_path / "noisy.pt"
    checkpoint.save_policy(untrained(of_state(PLAIN)), plain)
    checkpoint.save_policy(untrained(of_state(NOISY)), noisy)
    assert played(noisy) == played(plain)
    with_noise = played(noisy, "--robot-noise")
    assert with_noise != played(plain)
    assert played(noisy, "--robot-noise") == with_noise
    # Another seed, another luck.
    assert played(noisy, "--robot-noise", "--seed", "2") != with_noise
    refused = call("evaluate", plain, HELD_OUT, "--robot-noise")
    assert refused.returncode == 1 and "was trained without such noise" in refused.stderr
    # And so it is played.
    pack = tmp_path / "policy.pack"
    done = call("export", noisy, "-o", pack)
    assert done.returncode == 0, done.stderr
    options = galactic.LearnedPolicy(pack, 2).options
    assert options["task"] == "pick" and not set(galactic.Simulator.NOISE_OPTIONS) & set(options)
    assert b"motion-noise=0.4" in pack.read_bytes(), "what it was trained with stands in the pack"


@needs_worlds
def test_a_run_with_noise_goes_on_as_if_it_had_not_been_paused(tmp_path: pathlib.Path) -> None:
    words = [WORLD, "--preset", "quick", "--ranks", 1, "--envs", 8, "--horizon", 8]
    words += ["--log-every", 0, "--steps", 4 * 64, "--validation", HELD_OUT]
    words += ["--validation-episodes", 4, "--validate-every", 2 * 64, "--simulation"]
    whole, paused, plain = (tmp_path / name for name in ("whole", "paused", "plain"))
    for arguments in (
        ("-o", whole, *words, NOISY),
        ("-o", paused, *words, NOISY, "--pause-at", 2 * 64),
        ("-o", paused, "--resume"),
        ("-o", plain, *words, PLAIN),
    ):
        done = call("train", *arguments)
        assert done.returncode == 0, done.stderr
    assert curve(whole) == curve(paused) != curve(plain)
