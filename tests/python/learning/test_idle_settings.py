"""Settings that would have no effect are refused."""

from __future__ import annotations

import dataclasses
import pathlib
from typing import Any

import pytest

from galactic import train
from galactic.learning.presets import preset
from galactic.learning.refusals import SettingsError
from galactic.learning.settings import Settings

OTHERS: dict[str, Any] = {
    "network_options": "size=3",
    "sees": "depth",
    "camera": "top",
    "fov": 60.0,
    "camera_position": (0.0, 0.0, 0.5),
    "camera_rpy": (0.0, 30.0, 0.0),
    "near": 0.1,
    "image_size": 64,
    "depth_noise": 0.1,
    "depth_dropout": 0.1,
    "color_noise": (1.0, 2.0),
    "light_jitter": 0.1,
    "camera_jitter": 0.1,
    "camera_jitter_degrees": 1.0,
    "camera_jitter_fov": 1.0,
    "recurrent": True,
    "width": 7,
    "layers": 3,
    "activation": "relu",
    "log_std": "parameter",
    "initial_log_std": -1.0,
    "final_log_std": -2.0,
}
"""Of each setting that has no effect somewhere, another value than its default."""
OF_OWN = {"network_options", "sees"}
COLORS = {"color_noise", "light_jitter"}
IMAGES = {
    name
    for name in OTHERS
    if name.startswith(("camera", "depth")) or name in ("fov", "near", "image_size")
}
LAYERS = {"width", "layers", "activation"}
PARAMETERS = {"initial_log_std", "final_log_std"}


def test_the_settings_that_have_no_effect_somewhere_are_known() -> None:
    scopes = {f.name: f.metadata["scope"] for f in dataclasses.fields(Settings)}
    assert {name for name, scope in scopes.items() if scope is not None} == set(OTHERS)


@pytest.mark.parametrize(
    "around, idle",
    [
        ({"network": "state"}, OF_OWN | IMAGES | COLORS | PARAMETERS),
        ({"network": "state", "log_std": "parameter"}, OF_OWN | IMAGES | COLORS),
        ({"network": "depth"}, OF_OWN | COLORS | PARAMETERS),
        ({"network": "resnet18"}, OF_OWN | LAYERS | PARAMETERS | {"recurrent", "log_std"}),
        ({"network": "lab.py:Net"}, IMAGES | COLORS | LAYERS | PARAMETERS),
        ({"network": "lab.py:Net", "recurrent": True, "sees": "depth", "log_std": "parameter"},
         COLORS | {"layers", "activation"}),
        ({"network": "lab.py:Net", "sees": "rgb"}, LAYERS | PARAMETERS),
    ],
)  # fmt: skip
def test_a_setting_without_effect_is_refused(around: dict[str, Any], idle: set[str]) -> None:
    found = set()
    for name, value in OTHERS.items():
        try:
            Settings(**{**around, name: value})
        except SettingsError as error:
            said = str(error)
            if said.startswith("image_size: found"):  # the paper's networks have another reason
                continue
            assert said.startswith(f"{name} applies only to ") and "; " in said, said
            assert "{" not in said
            found.add(name)
    assert found == idle


@pytest.mark.parametrize(
    "settings, message",
    [
        (
            {"network": "resnet18", "log_std": "parameter"},
            "log_std applies only to the networks state and depth and to networks of your own, and resnet18 is the "
            "paper's, which always has a GRU of its size and log-stds as outputs; choose another one, or leave it out",
        ),
        (
            {"network": "state", "final_log_std": -1.0},
            "final_log_std applies only to log-stds that are parameters, and log_std is output of the network state; "
            "take log_std parameter, which state, depth and networks of your own have, or leave it out",
        ),
        (
            {"network": "resnet9", "layers": 3},
            "layers applies only to the networks state and depth, and the network is resnet9; choose one of them, or "
            "leave it out",
        ),
    ],
)
def test_it_is_said_what_to_do(settings: dict[str, Any], message: str) -> None:
    with pytest.raises(SettingsError) as refused:
        Settings(**settings)
    assert str(refused.value) == message


def test_what_a_preset_says_without_effect_is_left_out() -> None:
    before = preset("quick")
    assert (before.log_std, before.final_log_std) == ("parameter", -1.5)
    chosen = preset("quick", network="resnet18")
    assert (chosen.log_std, chosen.final_log_std) == ("output", 2.0)
    kept = dataclasses.replace(chosen, network="state", log_std="parameter", final_log_std=-1.5)
    assert kept == before
    assert not preset("quick-depth", network="resnet9", image_size=128).recurrent
    for name in ("log_std", "final_log_std"):
        with pytest.raises(SettingsError, match=f"^{name} applies only to"):
            preset("quick", network="resnet18", **{name: getattr(before, name)})


@pytest.mark.parametrize(
    "option",
    [
        ["--clip", "0.1"],
        ["--target-kl", "0.01"],
        ["--timeouts", "ends"],
        ["--no-normalize-advantages"],
    ],
)
def test_a_run_that_imitates_has_no_settings_of_acting(
    option: list[str], tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["home.pack", "-o", str(tmp_path / "run"), "--preset", "quick", "--epochs", "2"]
    code = train.main([*command, "--demonstrations", str(tmp_path), *option])
    name = option[0].replace("--no-", "--")
    assert (code, capsys.readouterr().err) == (
        1,
        f"galactic.train: command line: {name} is for a run that acts, and not for one with --demonstrations; leave one of "
        "them out\n",
    )
