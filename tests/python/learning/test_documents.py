"""docs/learning.md says what the settings are."""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import pathlib
import re

import pytest

from galactic.learning.presets import PRESETS, preset
from galactic.learning.refusals import SettingsError
from galactic.learning.setting_fields import typed
from galactic.learning.setting_options import add_options, given_options, markdown_tables, resumed
from galactic.learning.settings import Settings
from galactic.learning.simulation_words import simulation_keywords
from galactic.learning.updates.schedules import learning_rate_at

MANUAL = pathlib.Path(__file__).parents[3] / "docs" / "learning.md"


def test_the_manual_has_the_tables_of_the_settings() -> None:
    text = MANUAL.read_text(encoding="utf-8")
    tables = text.split("<!-- settings -->\n")[1].split("<!-- end of settings -->")[0]
    assert (
        tables == markdown_tables()
    ), "copy what settings.markdown_tables() returns into the manual"


def test_the_defaults_are_table_3_of_the_paper() -> None:
    paper = preset("paper")
    assert (paper.learning_rate, paper.learning_rate_end) == (3.5e-4, 0.0)
    assert learning_rate_at(paper, 0.5) == pytest.approx(1.75e-4)
    assert (paper.entropy, paper.max_grad_norm, paper.horizon) == (1e-3, 2.0, 64)
    assert (paper.epochs, paper.mini_batches, paper.network) == (1, 2, "resnet18")
    assert (paper.clip, paper.value_coefficient, paper.gamma) == (0.2, 0.5, 0.99)
    assert (paper.gae_lambda, paper.adam_epsilon) == (0.95, 1e-5)
    assert paper.normalize_advantages and paper.sync_fraction == 0.6


def test_every_setting_can_be_typed() -> None:
    parser = argparse.ArgumentParser()
    add_options(parser)
    words, expected = [], {}
    for field in dataclasses.fields(Settings):
        name = "--" + field.name.replace("_", "-")
        if isinstance(field.default, bool):
            words.append(name if not field.default else "--no-" + name[2:])
            expected[field.name] = not field.default
        else:
            words += [name, str(typed(field.default))]
            expected[field.name] = field.default
    assert given_options(parser.parse_args(words)) == expected
    assert given_options(parser.parse_args(["--steps", "2.5e6"])) == {"steps": 2_500_000}
    assert given_options(parser.parse_args([])) == {}


def test_presets_are_settings_that_can_be() -> None:
    for name in PRESETS:
        assert Settings.from_dict(preset(name).to_dict()) == preset(name)
    with pytest.raises(SettingsError, match='"none" is not a preset'):
        preset("none")
    with pytest.raises(SettingsError, match="unknown to this version"):
        Settings.from_dict({"color": 1})


def test_an_option_of_the_simulation_overrides_the_one_of_its_name() -> None:
    chosen = preset("quick", simulation="--task=rearrange bump=false target-up target-up=false")
    before, after = PRESETS["quick"]["simulation"].split(), chosen.simulation.split()
    assert len(before) == 6 and before[0] == "task=pick" and before[4] == "bump"
    assert after == ["--task=rearrange", *before[1:4], "bump=false", before[5], "target-up=false"]
    assert simulation_keywords(chosen.simulation)["bump"] == "false"
    # The settings of a run are complete, whatever a later version's preset has.
    assert Settings.from_dict(chosen.to_dict()) == chosen
    assert preset("quick", simulation="").simulation == PRESETS["quick"]["simulation"]
    assert preset("paper", simulation="task=pick").simulation == "task=pick"


def test_a_network_that_sees_nothing_has_no_camera() -> None:
    for camera in ({"camera": "top"}, {"fov": 60.0}, {"camera_rpy": (0.0, 30.0, 0.0)}):
        (name,) = camera
        with pytest.raises(
            SettingsError, match=f"^{name} applies only to networks that see images"
        ):
            preset("quick", **camera)
        assert getattr(preset("quick", network="resnet9", **camera), name) == camera[name]


def test_only_a_network_of_any_size_has_another_size() -> None:
    assert preset("quick", network="depth", image_size=36).image_size == 36
    for wrong, message in (
        ({"network": "depth", "image_size": 35}, "image_size: found 35, expected a number from 36"),
        (
            {"network": "resnet9", "image_size": 64},
            "image_size: found 64, expected 128, which resnet9",
        ),
        ({"image_size": 64}, "image_size applies only to networks that see images"),
        (
            {"network": "simple_cnn", "recurrent": True},
            "recurrent applies only to the networks state and",
        ),
    ):
        with pytest.raises(SettingsError, match=f"^{message}"):
            preset("quick", **wrong)


def test_a_word_of_the_simulation_has_a_name() -> None:
    for word in ("=3", "--", "-"):
        with pytest.raises(
            SettingsError, match=f'--simulation: found "{word}", expected NAME=VALUE'
        ):
            simulation_keywords(f"task=pick {word}")


def test_a_resumed_run_stays_what_it_is() -> None:
    before = preset("quick", simulation="task=rearrange")
    assert resumed(before, {"simulation": "task=rearrange bump"}) == before
    with pytest.raises(SettingsError, match="cannot continue with .* target-up; begin a new one"):
        resumed(before, {"simulation": "target-up"})
    assert resumed(before, {"steps": 7, "gamma": before.gamma}).steps == 7
    with pytest.raises(SettingsError, match="cannot continue with 0.5; begin a new one"):
        resumed(before, {"gamma": 0.5})
    with pytest.raises(SettingsError, match="began with --camera-position 0,0,0, and .* 0,0,0.5;"):
        resumed(before, {"camera_position": (0.0, 0.0, 0.5)})


def test_three_numbers_are_kept_and_checked() -> None:
    placed = preset("paper", camera_position=(0.1, -2.0, 0.25), camera_rpy=(0, 30, 0))
    assert Settings.from_dict(json.loads(json.dumps(placed.to_dict()))) == placed
    for wrong, message in (
        ((1.0, 2.0), "found (1.0, 2.0), expected three numbers"),
        ((1.0, 2.0, "x"), "expected three numbers"),
        (0.5, "found 0.5, expected three numbers"),
        ((0.0, 101.0, 0.0), "found 101.0, expected a number from -100 to 100"),
        ((0.0, math.nan, 0.0), "found nan, expected a number from -100 to 100"),
    ):
        with pytest.raises(SettingsError, match=re.escape(message)):
            preset("paper", camera_position=wrong)
