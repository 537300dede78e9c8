"""Packs of networks of one's own: what galactic.export makes of them, and what it refuses."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np
import pytest
import torch

import galactic
from galactic import evaluate
from galactic.learning.encoders import Inputs
from galactic.learning.packs import content
from galactic.learning.packs.content import export_policy
from galactic.learning.refusals import CheckpointError
from galactic.learning.saving import checkpoint
from galactic.learning.user_code import own_networks
from own_lab import EYES, lab, named, saved_policy, with_line
from programs import SMALL, UPDATE, WORLD, call, needs_worlds
from trainers import make_trainer


@pytest.mark.parametrize(
    "name, settings",
    [
        ("Sums", {}),
        ("Sums", {"recurrent": True}),
        ("Net", {}),
        ("Perceptron", {}),
        ("Halved", {}),
        ("Parametrized", {}),
        ("LooksPlainly", EYES),
        ("Recalls", {}),
        ("RecallsBeside", {}),
    ],
)
def test_a_pack_of_known_layers_does_what_the_network_does(
    tmp_path: pathlib.Path, lab: pathlib.Path, name: str, settings: dict[str, Any]
) -> None:
    saved, pack = saved_policy(named(lab, name), **settings), tmp_path / "own.pack"
    checkpoint.save_policy(saved, tmp_path / "own.pt")
    export_policy(tmp_path / "own.pt", pack, network=f"{lab}:{name}")
    draws, player = np.random.default_rng(1), galactic.LearnedPolicy(pack, 5, deterministic=True)
    hidden = saved.policy.initial_hidden(5, torch.device("cpu"))
    for step in range(4):
        seen = draws.normal(size=(5, 6)).astype(np.float32)
        rgb = draws.integers(0, 256, (5, 36, 36, 3)).astype(np.uint8) if settings is EYES else None
        begun = np.arange(5) % 3 == step if step else np.ones(5, bool)
        with torch.inference_mode():
            starts = torch.from_numpy(begun)[None]
            colors = torch.from_numpy(rgb)[None] if rgb is not None else None
            said = saved.policy.act(Inputs(torch.from_numpy(seen)[None], colors), hidden, starts)
        hidden = said.hidden
        played = player.act(seen, begun, rgb=rgb)
        np.testing.assert_allclose(played, said.actions.mode()[0].numpy(), atol=1e-4)


@pytest.mark.parametrize(
    "name, settings, message",
    [
        ("Sines", {}, r"line [0-9]+ of lab.py: a policy pack has no layer for sin in forward\(\)"),
        ("Branches", {}, r"forward\(\) cannot be followed in line [0-9]+ of lab.py \(TraceError"),
        ("Attends", {}, "^line {line} of lab.py: a policy pack has no layer for MultiheadAttention$"),
        ("Unrolls", {}, "cannot be followed in line {line} of lab.py.*: write it of layers alone, wit"),
        ("Bilinear", {}, r"^line {line} of lab.py: a policy pack has no layer for Bilinear\(.*\)$"),
        ("LooksTwice", {**EYES, "network_options": "doubled=True"}, "has no layer for Doubled"),
        ("LooksTwice", {**EYES, "network_options": "doubled=False"}, "has no layer for Weighted"),
        ("LooksBack", EYES, "has no layer for Backwards"),
        ("Averages", {}, "cannot be followed in line [0-9]+ of lab.py.*without loops over it or its"),
        ("InPlace", {}, r"relu in forward\(\) works in place on what is read elsewhere \(%relu"),
        ("InPlaceToo", {}, "works in place on what is read elsewhere .*: leave inplace=True out"),
        ("OfASlice", {}, "works in place on what is read elsewhere"),
        ("BehindAView", {}, r"make other actions than the network \([0-9.]+ apart on made-up inputs\): write"),
        ("WeightNormed", {}, r"layer \(Linear\) has hooks around its forward\(\), as torch.nn.utils.wei"),
        ("Replaced", {}, r"layer \(Linear\) was given another forward\(\) than its class has"),
    ],
)  # fmt: skip
def test_what_a_pack_does_not_know_is_refused(
    tmp_path: pathlib.Path, lab: pathlib.Path, name: str, settings: dict[str, Any], message: str
) -> None:
    own = own_networks.with_options(named(lab, name), settings.get("network_options", ""))
    checkpoint.save_policy(saved_policy(own, **settings), tmp_path / "own.pt")
    with pytest.raises(CheckpointError, match=with_line(message, name)):
        export_policy(tmp_path / "own.pt", tmp_path / "own.pack", network=f"{lab}:{name}")
    assert not (tmp_path / "own.pack").exists()


@pytest.mark.parametrize(
    "name, code, message",
    [
        ("Sines", 3, "a policy pack has no layer for sin in forward()"),
        ("Net", 2, "none.pack"),
    ],
)
def test_what_dynamics_cannot_play_is_refused_before_a_world_is_opened(
    tmp_path: pathlib.Path, lab: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: Any,
    name: str, code: int, message: str
) -> None:  # fmt: skip
    """And the network that was named is the one that is exported."""
    monkeypatch.setattr(evaluate.dynamics, "require_tool", lambda: "galactic-dynamics")
    checkpoint.save_policy(saved_policy(named(lab, name)), tmp_path / "own.pt")
    words = [str(tmp_path / "own.pt"), str(tmp_path / "none.pack"), "--dynamics", "none.toml"]
    found, said = evaluate.main([*words, "--network", f"{lab}:{name}"]), capsys.readouterr().err
    assert message in said and found == code, said


@needs_worlds
def test_what_cannot_be_exported_says_so_before_it_learns(
    tmp_path: pathlib.Path, lab: pathlib.Path
) -> None:
    said = {}
    for name in ("Attends", "Net"):
        options = [*SMALL, "--network", f"{lab}:{name}", "--steps", UPDATE]
        done = call("train", WORLD, "-o", tmp_path / name, *options)
        assert done.returncode == 0, done.stderr
        said[name] = done.stderr
    assert (
        "galactic.export can make no pack of lab.py:Attends, which Python alone will"
        in said["Attends"]
    )
    assert "of lab.py: a policy pack has no layer for MultiheadAttention\n" in said["Attends"]
    assert "galactic.export" not in said["Net"]


def test_no_fault_of_what_is_exported_ends_a_training(monkeypatch: pytest.MonkeyPatch) -> None:
    def raises(*_: Any) -> int:
        raise RuntimeError("a __repr__ of one's own")

    monkeypatch.setattr(content, "encoded", raises)
    policy = make_trainer(None).policy
    assert content.fault_of(policy) == "RuntimeError: a __repr__ of one's own"
