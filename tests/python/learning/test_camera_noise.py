"""Policies that see through noisy cameras: what they are trained with, and judged by."""

from __future__ import annotations

import argparse
import json
import pathlib
from typing import Any

import numpy as np
import pytest

import galactic
from galactic.learning.homes import Homes
from galactic.learning.network_settings import CAMERA_NOISE
from galactic.learning.presets import preset
from galactic.learning.refusals import SettingsError
from galactic.learning.saving import checkpoint
from galactic.learning.setting_options import add_options, given_options, option_lines
from galactic.learning.settings import Settings
from policies import untrained
from programs import HELD_OUT, WORLD, call, curve, needs_worlds

NOISE = {"depth_noise": 0.05, "depth_dropout": 0.2, "camera_jitter": 0.05}


def of_depth(**more: Any) -> Settings:
    settings = {"network": "depth", "image_size": 36, "width": 16, "envs": 6, "halves": 1}
    return Settings(**{**settings, "mini_batches": 1, "simulation": "task=pick", **more})


def run(program: str, *arguments: object) -> None:
    done = call(program, *arguments)
    assert done.returncode == 0, done.stderr


COLORS = ("color_noise", "light_jitter")


def test_noise_is_a_setting_of_networks_that_see_what_it_changes() -> None:
    for name in CAMERA_NOISE:
        what = "colors" if name in COLORS else "images"
        with pytest.raises(
            SettingsError, match=f"^{name} applies only to networks that see {what}"
        ):
            preset("quick", **{name: 0.1})
        noisy = preset("quick", network="simple_cnn", **{name: 0.1})
        assert getattr(noisy, name) == 0.1
        assert noisy.without_noise() == preset("quick", network="simple_cnn")
        with pytest.raises(SettingsError, match=f"{name}: found -0.1, expected a number from 0"):
            preset("quick", network="simple_cnn", **{name: -0.1})
        drawn = preset("quick", network="simple_cnn", **{name: (0.1, 0.3)})
        assert drawn.without_noise() == preset("quick", network="simple_cnn")
        assert Settings.from_dict(json.loads(json.dumps(drawn.to_dict()))) == drawn
        assert f"--{name.replace('_', '-')} 0.1-0.3  # default: 0.0\n" in option_lines(drawn)
        for wrong in (
            (0.3, 0.1),
            (-0.1, 0.1),
            (0.1, 0.2, 0.3),
            (0.1,),
            ("0.1", 0.2),
            (0.1, np.nan),
        ):
            with pytest.raises(SettingsError, match=f"{name}: found .*, expected a number from 0"):
                preset("quick", network="simple_cnn", **{name: wrong})
    for name in COLORS:
        with pytest.raises(
            SettingsError, match=f"^{name} applies only to networks that see colors"
        ):
            of_depth(**{name: 0.1})


def test_a_range_of_noise_is_typed_with_a_dash() -> None:
    parser = argparse.ArgumentParser()
    add_options(parser, CAMERA_NOISE)

    def given(*words: str) -> Any:
        return given_options(parser.parse_args(words))

    assert given("--depth-noise", "0.001-0.02") == {"depth_noise": (0.001, 0.02)}
    assert given("--depth-noise", "1e-3-2e-2") == {"depth_noise": (0.001, 0.02)}
    assert given("--color-noise", "3") == {"color_noise": 3.0}
    for wrong in ("0.1-", "0.1-0.2-0.3", "much", "0.1..0.2", "", "nan-1"):
        with pytest.raises(SystemExit):
            given("--depth-noise", wrong)


@needs_worlds
def test_a_network_is_trained_with_the_noise_of_its_settings() -> None:
    def seen(settings: Settings) -> Any:
        homes = Homes(galactic.World(WORLD), settings, 1)
        return homes.env.reset()[0], homes.env.renderers[0].world_from_camera

    plain, cameras = seen(of_depth())
    noisy, jittered = seen(of_depth(**NOISE))
    np.testing.assert_array_equal(noisy["state"], plain["state"])
    # Of what it sees, a fifth has no depth.
    assert abs((noisy["depth"] == 0).mean() - 0.2) < 0.05 and (plain["depth"] > 0).mean() > 0.95
    moved = np.abs(jittered - cameras)[:, :3, 3]
    assert 0.01 < moved.max() < 0.1


@needs_worlds
def test_a_policy_is_evaluated_without_the_noise_of_its_training(tmp_path: pathlib.Path) -> None:
    reports = []
    for number, settings in enumerate((of_depth(), of_depth(**NOISE))):
        policy, report = tmp_path / f"{number}.pt", tmp_path / f"{number}.json"
        checkpoint.save_policy(untrained(settings), policy)
        run("evaluate", policy, HELD_OUT, "--episodes", 6, "--report", report)
        reports.append(json.loads(report.read_text(encoding="utf-8"))["each"])
    assert reports[0] == reports[1]
    # Unless that is asked for.
    run(
        "evaluate",
        tmp_path / "1.pt",
        HELD_OUT,
        "--episodes",
        6,
        "--report",
        report,
        "--camera-noise",
    )
    noisy = json.loads(report.read_text(encoding="utf-8"))
    assert noisy["camera_noise"] and noisy["each"] != reports[1]
    assert call("evaluate", tmp_path / "0.pt", HELD_OUT, "--camera-noise").returncode == 1
    # And so it is played.
    pack = tmp_path / "policy.pack"
    run("export", tmp_path / "1.pt", "-o", pack)
    images = galactic.LearnedPolicy(pack, 2).images
    assert images is not None and not set(CAMERA_NOISE) & set(images)
    assert b"depth-noise" in pack.read_bytes(), "what it was trained with stands in the pack"


@needs_worlds
def test_a_run_with_noise_goes_on_as_if_it_had_not_been_paused(tmp_path: pathlib.Path) -> None:
    words = [WORLD, "--preset", "quick", "--network", "depth", "--image-size", 36, "--ranks", 1]
    words += ["--envs", 8, "--horizon", 8, "--log-every", 0, "--steps", 4 * 64]
    words += ["--simulation", "task=pick episode-steps=6", "--validation", HELD_OUT]
    words += ["--validation-episodes", 4, "--validate-every", 2 * 64]
    noise = ["--depth-noise", "0.02-0.08", "--depth-dropout", 0.2, "--camera-jitter-degrees", 3]
    whole, paused, plain = (tmp_path / name for name in ("whole", "paused", "plain"))
    run("train", "-o", whole, *words, *noise)
    run("train", "-o", paused, *words, *noise, "--pause-at", 2 * 64)
    run("train", "-o", paused, "--resume")
    run("train", "-o", plain, *words)
    assert curve(whole) == curve(paused) != curve(plain)


def test_settings_take_the_noise_that_the_renderer_takes() -> None:
    for name, most in galactic.Renderer.NOISE_LIMITS.items():
        assert getattr(Settings(network="simple_cnn", **{name: most}), name) == most
        with pytest.raises(SettingsError, match=f"{name}: found .*, expected .* to {most:g}"):
            Settings(network="simple_cnn", **{name: 1.001 * most})
