"""Networks of one's own: galactic.train --network, and what uses its policies."""

from __future__ import annotations

import dataclasses
import pathlib
import sys
from typing import Any

import numpy as np
import pytest
import torch

import galactic
from galactic import evaluate
from galactic.learning.encoders import Inputs
from galactic.learning.packs import content
from galactic.learning.packs.content import export_policy
from galactic.learning.refusals import CheckpointError, NetworkError, SettingsError
from galactic.learning.saving import checkpoint
from galactic.learning.settings import Settings
from galactic.learning.user_code import own_code, own_networks
from galactic.learning.user_code.own_networks import OwnNetwork, Seen
from programs import HELD_OUT, SMALL, UPDATE, WORLD, call, curve, needs_worlds
from toys import Remember
from trainers import SETTINGS, UPDATE as TOY_UPDATE, make_trainer, parameters

EXAMPLE = pathlib.Path(__file__).parents[3] / "examples" / "python" / "own_network.py"
WRONG = """
import torch
from torch import nn
from galactic.learning.encoders import Encoder, Eyes, StateEncoder
from galactic.learning.sequences import run_gru

class Net(Encoder):
    features = 8

    def __init__(self, seen):
        super().__init__()
        self.layer = nn.Linear(seen.state, 8)

    def forward(self, inputs):
        return self.layer(inputs.state)

class Narrow(Net):
    features = 9

class Nameless(Net):
    features = 0

class Flat(Net):
    def forward(self, inputs):
        return self.layer(inputs.state).sum(-1)

class Nothing(Net):
    def forward(self, inputs):
        pass

class Misfit(Net):
    def forward(self, inputs):
        return self.layer(inputs.state[..., 1:])

class Blind(Net):
    def forward(self, inputs):
        return self.layer(inputs.state) + inputs.depth.mean()

class Unmade(Net):
    def __init__(self, seen):
        raise KeyError("no such part")

class Ends(Net):
    def __init__(self, seen):
        raise SystemExit(0)

class NaNs(Net):
    def forward(self, inputs):
        return self.layer(inputs.state) / 0.0 * 0.0

class Wide(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.scale = nn.Parameter(torch.ones(8, dtype=torch.float64))

class Drops(Net):
    def forward(self, inputs):
        return nn.functional.dropout(self.layer(inputs.state), 0.5, self.training)

class Remembers(Net):
    memory = 4

    def forward(self, inputs, memory, starts):
        return self.layer(inputs.state) + memory.sum(), memory

class Forgets(Remembers):
    def forward(self, inputs, memory, starts):
        return self.layer(inputs.state)

class Short(Remembers):
    def forward(self, inputs, memory, starts):
        return self.layer(inputs.state), memory[..., 1:]

class Formless(Encoder):
    features = 8

class Looks(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.features = 8 + seen.state
        self.eyes = Eyes(nn.Sequential(
            nn.Conv2d(seen.channels, 4, 8, 8), nn.ReLU(), nn.Flatten(), nn.Linear(4 * 4 * 4, 8)))

    def forward(self, inputs):
        return torch.cat([self.eyes(inputs), inputs.state], -1)

class Sines(Net):
    def forward(self, inputs):
        return torch.sin(self.layer(inputs.state))

class Branches(Net):
    def forward(self, inputs):
        return self.layer(inputs.state) if inputs.state.sum() > 0 else self.layer(-inputs.state)

class Sums(Net):
    features = 12

    def forward(self, inputs):
        x = self.layer(inputs.state)
        return torch.cat([torch.relu(x) + torch.tanh(x), x[..., 2:6]], -1)

class Doubled(nn.Conv2d):
    def forward(self, x):
        return 2.0 * super().forward(x)

class Weighted(nn.Conv2d):
    def _conv_forward(self, x, weight, bias):
        return super()._conv_forward(x, 2.0 * weight, bias)

class Backwards(nn.Sequential):
    def forward(self, x):
        return -super().forward(x)

class Patch(nn.Sequential):
    def __init__(self, first):
        super().__init__(first, nn.ReLU(inplace=True), nn.Flatten(), nn.Linear(4 * 4 * 4, 8))

class LooksTwice(Looks):
    def __init__(self, seen, doubled=True):
        super().__init__(seen)
        first = (Doubled if doubled else Weighted)(seen.channels, 4, 8, 8)
        self.eyes = Eyes(Patch(first))

class LooksBack(Looks):
    def __init__(self, seen):
        super().__init__(seen)
        self.eyes = Eyes(Backwards(*self.eyes.layers))

class LooksPlainly(Looks):
    def __init__(self, seen):
        super().__init__(seen)
        self.eyes = Eyes(Patch(nn.Conv2d(seen.channels, 4, 8, 8)))

class Halved(StateEncoder):
    def __init__(self, seen, width=8):
        super().__init__(seen.state, width, 1, "tanh")

    def forward(self, inputs):
        return torch.cat([super().forward(inputs)[..., 0:4], inputs.state[..., 0:4]], -1)

class Perceptron(StateEncoder):
    def __init__(self, seen):
        super().__init__(seen.state, 8, 1, "tanh")

class InPlace(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.relu = nn.ReLU(inplace=True)

    def forward(self, inputs):
        x = self.layer(inputs.state)
        return self.relu(x) + x

class InPlaceToo(Net):
    def forward(self, inputs):
        x = self.layer(inputs.state)
        return nn.functional.relu(x, inplace=True) + x

class OfASlice(Net):
    features = 6

    def forward(self, inputs):
        x = self.layer(inputs.state)
        nn.functional.relu(x[..., 0:6], True)
        return x[..., 0:6]

class BehindAView(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.flat = nn.Flatten(2)
        self.relu = nn.ReLU(inplace=True)

    def forward(self, inputs):
        x = self.layer(inputs.state)
        return self.relu(self.flat(x)) + x

class WeightNormed(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.layer = nn.utils.weight_norm(self.layer)

class Parametrized(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.layer = nn.utils.parametrizations.orthogonal(self.layer)

class Replaced(Net):
    def __init__(self, seen):
        super().__init__(seen)
        forward = self.layer.forward
        self.layer.forward = lambda x: 2.0 * forward(x)

class MixesSteps(Net):
    def forward(self, inputs):
        x = self.layer(inputs.state)
        return x - x.mean(0, keepdim=True)

class MixesEnvs(Net):
    def forward(self, inputs):
        x = self.layer(inputs.state)
        return x - x.mean(1, keepdim=True)

class MixesAll(Net):
    def forward(self, inputs):
        return self.layer(inputs.state) / inputs.state.norm()

class MixesImages(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.eyes = Eyes(nn.Sequential(nn.Conv2d(seen.channels, 8, 36), nn.Flatten()))

    def forward(self, inputs):
        return self.eyes(inputs) / inputs.rgb.float().std()

class OneEnvAlone(Net):
    def forward(self, inputs):
        return self.layer(inputs.state).squeeze(1)

class Averages(Net):
    # The mean of all that it has seen of an episode: a memory of how many steps, and of their sum.
    memory = 9
    resets = True

    def forward(self, inputs, memory, starts):
        features = []
        for seen, begun in zip(self.layer(inputs.state), starts):
            kept = memory * (~begun).unsqueeze(-1) if self.resets or not features else memory
            memory = torch.cat([kept[:, :1] + 1.0, kept[:, 1:] + seen], -1)
            features.append(memory[:, 1:] / memory[:, :1])
        return torch.stack(features), memory

class EmptiedAtFirst(Averages):
    resets = False

class LosesSteps(Averages):
    def forward(self, inputs, memory, starts):
        features, _ = super().forward(inputs, memory, starts)
        return features, torch.zeros_like(memory)

class Attends(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.attention = nn.MultiheadAttention(8, 2, batch_first=True)

    def forward(self, inputs):
        x = self.layer(inputs.state).unsqueeze(-2)
        shape, x = x.shape, x.flatten(0, 1)
        return self.attention(x, x, x, need_weights=False)[0].view(*shape[:2], -1)  # Attends

class Unrolls(Net):
    def forward(self, inputs):
        return torch.stack([self.layer(one) for one in inputs.state])  # Unrolls

class Bilinear(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.both = nn.Bilinear(seen.state, 8, 8)

    def forward(self, inputs):
        return self.both(inputs.state, self.layer(inputs.state))  # Bilinear

def no_class(seen):
    pass
"""
EYES = {"sees": "rgb", "image_size": 36}
SEEN = Seen(6, {"way": slice(0, 3)}, {}, 4)


@pytest.fixture
def lab(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """WRONG in a file."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    file = tmp_path / "lab.py"
    file.write_text(WRONG, encoding="utf-8")
    return file


def named(file: pathlib.Path, name: str, options: str = "") -> OwnNetwork:
    found = own_networks.network_of(own_code.named(f"{file}:{name}", "--network"))
    return own_networks.with_options(found, options)


@pytest.mark.parametrize(
    "name, message",
    [
        ("Narrow", r"returned features of float32 \[2, 3, 8\], expected \[2, 3, 9\], which is \[T, n, fe"),
        ("Nameless", "has features = 0, expected a whole number from 1"),
        ("Flat", r"returned features of float32 \[2, 3\], expected \[2, 3, 8\]"),
        ("Nothing", r"returned features of NoneType, expected \[2, 3, 8\]"),
        ("Misfit", r"failed in forward\(\), in line 33: RuntimeError: mat1 and mat2 shapes cannot be"),
        ("Blind", r"failed in forward\(\), in line 37: AttributeError: 'NoneType' object has no attri"),
        ("Unmade", r"failed in __init__\(\), in line 41: KeyError: 'no such part'"),
        ("Ends", "ended the program when it was made; raise an exception instead"),
        ("NaNs", r"returned features that are no numbers \(NaN or infinite\)"),
        ("Wide", "has a parameter scale of float64, expected float32"),
        ("Drops", "computes something else while it learns than while it acts"),
        ("Remembers", "remembers what was before the start of an episode; empty the memory where `star"),
        ("Forgets", "returned float32 .*, expected features and memory: memory is 4"),
        ("MixesSteps", "mixes steps: it returns something else for 2 steps of 3 envs at once, as it learns, th"),
        ("MixesEnvs", "mixes envs: it returns .* than for each env by itself, as it acts; sum, average and"),
        ("MixesAll", "mixes steps and envs: it returns"),
        ("OneEnvAlone", r"returned features of float32 \[2, 8\], expected \[2, 1, 8\], which is \[T, n, fe"),
        ("EmptiedAtFirst", "mixes steps: .*, and empty the memory in each step where `starts` is true"),
        ("LosesSteps", "mixes steps: it returns"),
        ("Short", r"returned memory of float32 \[3, 3\], expected \[3, 4\]"),
    ],
)  # fmt: skip
def test_what_cannot_be_a_network_says_why(lab: pathlib.Path, name: str, message: str) -> None:
    with pytest.raises(SettingsError, match=f"^--network: lab.py:{name} {message}"):
        named(lab, name).make(SEEN, recurrent=False)


def test_networks_that_see_may_not_mix_either(lab: pathlib.Path) -> None:
    seen = SEEN._replace(images={"rgb": (36, 36, 3)})
    with pytest.raises(NetworkError, match="MixesImages mixes steps and envs: it returns"):
        named(lab, "MixesImages").make(seen, recurrent=False)
    named(lab, "Looks").make(seen, recurrent=False)


def test_what_a_memory_keeps_of_other_steps_is_not_mixed(lab: pathlib.Path) -> None:
    for name in ("Averages", "Net", "Sums", "Halved"):
        named(lab, name).make(SEEN, recurrent=False)
    named(EXAMPLE, "Remembering").make(SEEN, recurrent=False)


@pytest.mark.parametrize(
    "name, options, message",
    [
        ("Nett", "", "has no Nett; did you mean Net?"),
        ("no_class", "", "is no class that inherits from galactic.learning.encoders.Encoder"),
        ("Formless", "", r"has no forward\(\); write one, which returns features"),
        ("Net", "width=3", "--network-options: lab.py:Net cannot be made of what it sees, one argument"),
        ("Net", "width", '--network-options: found "width", expected NAME=VALUE'),
    ],
)  # fmt: skip
def test_what_is_no_network_is_told_apart(
    lab: pathlib.Path, name: str, options: str, message: str
) -> None:
    with pytest.raises(SettingsError, match=message):
        named(lab, name, options)


def test_two_memories_are_one_too_many() -> None:
    with pytest.raises(NetworkError, match="has a memory of its own; leave --recurrent out"):
        named(EXAMPLE, "Remembering").make(SEEN, recurrent=True)


def test_settings_of_a_network_of_ones_own_are_checked() -> None:
    own = Settings(network="lab.py:Net", sees="rgb", image_size=36, color_noise=1.0)
    assert own.sight == ("rgb",) and Settings.from_dict(own.to_dict()) == own
    for wrong, message in (
        ({"network": "lab.py"}, "or FILE.py:CLASS or MODULE:CLASS"),
        ({"network": "state", "sees": "depth"}, "sees applies only to networks of your own"),
        ({"network_options": "width=3"}, "network_options applies only to networks of your own"),
        ({"network": "lab.py:Net", "camera": "top"}, "camera applies only to networks that see"),
        ({"network": "lab.py:Net", "sees": "depth", "color_noise": 1.0}, "that see colors"),
    ):
        with pytest.raises(SettingsError, match=message):
            Settings(**wrong)  # type: ignore[arg-type]


def test_it_learns_what_only_a_memory_of_its_own_knows() -> None:
    own = named(EXAMPLE, "Remembering", "width=16")
    settings = Settings(
        envs=32, horizon=16, steps=32 * 16 * 30, network="own_network.py:Remembering", epochs=4,
        mini_batches=2, learning_rate=1e-2, log_std="parameter", gamma=0.9, validate_every=0, window=200,
    )  # fmt: skip
    trainer = make_trainer(None, settings, Remember, network=own)
    trainer.begin()
    trainer.train()
    assert trainer.recent.figures()["success"] > 0.8  # without a memory, 0.5


def test_a_resumed_run_is_the_run_that_would_have_been(
    tmp_path: pathlib.Path, lab: pathlib.Path
) -> None:
    settings = dataclasses.replace(SETTINGS, network="lab.py:Net", checkpoint_every=TOY_UPDATE)
    own = named(lab, "Net")
    for name in ("whole", "half"):
        (tmp_path / name).mkdir()
    whole = make_trainer(tmp_path / "whole", settings, network=own)
    whole.begin()
    whole.train()
    half = make_trainer(tmp_path / "half", settings, network=own)
    half.begin()
    half.train(pause_at=4 * TOY_UPDATE)
    resumed = make_trainer(tmp_path / "half", settings, network=own)
    resumed.resume()
    resumed.train()
    assert torch.equal(parameters(whole), parameters(resumed))
    # The file is another one now.
    file = next((tmp_path / "half").glob("checkpoints/*/policy.pt"))
    lab.write_text(WRONG + "# changed\n", encoding="utf-8")
    with pytest.raises(NetworkError, match="lab.py is another file than it was then; put it back"):
        checkpoint.load_policy(file, network=named(lab, "Net"))
    with pytest.raises(NetworkError, match="found --network lab.py:Narrow; if you trust it, add"):
        checkpoint.load_policy(file, network=named(lab, "Narrow"))
    with pytest.raises(NetworkError, match="with a network of its own, 'lab.py:Net'; if you trust"):
        checkpoint.load_policy(file)


def test_weights_of_another_class_of_the_name_are_refused(
    tmp_path: pathlib.Path, lab: pathlib.Path
) -> None:
    """As those of a module, whose file may change."""
    settings = dataclasses.replace(SETTINGS, network="lab:Net", steps=TOY_UPDATE)
    (tmp_path / "run").mkdir()
    trainer = make_trainer(
        tmp_path / "run", settings, network=named(lab, "Net")._replace(digest="")
    )
    trainer.begin()
    trainer.train()
    lab.write_text(WRONG.replace("8)", "7)").replace("= 8", "= 7"), encoding="utf-8")
    with pytest.raises(CheckpointError, match="is not a policy of this version: Error"):
        checkpoint.load_policy(tmp_path / "run" / "best.pt", network=named(lab, "Net"))


def saved_policy(own: OwnNetwork, **settings: Any) -> checkpoint.SavedPolicy:
    parts = [("robot_target", 3), ("joints", 3)]
    made = Settings(**{"network": str(own.code), "simulation": "task=pick", **settings})
    shape = checkpoint.PolicyShape(6, 9)
    torch.manual_seed(2)
    policy = checkpoint.new_policy(made, shape, parts, own)
    policy.action.linear.weight.data.normal_(0.0, 0.3)
    return checkpoint.SavedPolicy(policy.eval(), made, shape, parts, 1, None, {}, own)


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
    ],
)
def test_a_pack_of_known_layers_does_what_the_network_does(
    tmp_path: pathlib.Path, lab: pathlib.Path, name: str, settings: dict[str, Any]
) -> None:
    saved, pack = saved_policy(named(lab, name), **settings), tmp_path / "own.pack"
    checkpoint.save_policy(saved, tmp_path / "own.pt")
    export_policy(tmp_path / "own.pt", pack, network=f"{lab}:{name}")
    draws = np.random.default_rng(1)
    seen = draws.normal(size=(5, 6)).astype(np.float32)
    rgb = draws.integers(0, 256, (5, 36, 36, 3)).astype(np.uint8) if settings is EYES else None
    with torch.inference_mode():
        hidden = saved.policy.initial_hidden(5, torch.device("cpu"))
        starts = torch.ones(1, 5, dtype=torch.bool)
        colors = torch.from_numpy(rgb)[None] if rgb is not None else None
        said = saved.policy.act(Inputs(torch.from_numpy(seen)[None], colors), hidden, starts)
    played = galactic.LearnedPolicy(pack, 5, deterministic=True).act(seen, rgb=rgb)
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
        ("InPlace", {}, r"relu in forward\(\) works in place on what is read elsewhere \(%relu"),
        ("InPlaceToo", {}, "works in place on what is read elsewhere .*: leave inplace=True out"),
        ("OfASlice", {}, "works in place on what is read elsewhere"),
        ("BehindAView", {}, r"make other features than it \([0-9.]+ apart on made-up inputs\): write"),
        ("WeightNormed", {}, r"layer \(Linear\) has hooks around its forward\(\), as torch.nn.utils.wei"),
        ("Replaced", {}, r"layer \(Linear\) was given another forward\(\) than its class has"),
    ],
)  # fmt: skip
def test_what_a_pack_does_not_know_is_refused(
    tmp_path: pathlib.Path, lab: pathlib.Path, name: str, settings: dict[str, Any], message: str
) -> None:
    own = own_networks.with_options(named(lab, name), settings.get("network_options", ""))
    checkpoint.save_policy(saved_policy(own, **settings), tmp_path / "own.pt")
    lines = [n for n, one in enumerate(WRONG.splitlines(), 1) if one.endswith(f"  # {name}")]
    message = message.replace("{line}", str(lines[0]) if lines else "")
    with pytest.raises(CheckpointError, match=message):
        export_policy(tmp_path / "own.pt", tmp_path / "own.pack", network=f"{lab}:{name}")
    assert not (tmp_path / "own.pack").exists()


def test_a_pack_has_no_memory_of_ones_own(tmp_path: pathlib.Path) -> None:
    checkpoint.save_policy(saved_policy(named(EXAMPLE, "Remembering")), tmp_path / "own.pt")
    with pytest.raises(CheckpointError, match="has a memory of its own, and .* with --recurrent"):
        export_policy(tmp_path / "own.pt", tmp_path / "a.pack", network=f"{EXAMPLE}:Remembering")


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


def test_a_module_is_another_file_than_the_one_that_a_policy_learned_with(
    tmp_path: pathlib.Path, lab: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    checkpoint.save_policy(saved_policy(named(lab, "Net")), tmp_path / "own.pt")
    (tmp_path / "own_module_a.py").write_text(WRONG, encoding="utf-8")
    (tmp_path / "own_module_b.py").write_text(WRONG + "# changed\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    load = checkpoint.load_with
    assert load("own_module_a:Net", tmp_path / "own.pt").network is not None
    with pytest.raises(NetworkError, match="own_module_b is another file than it was then; put it"):
        load("own_module_b:Net", tmp_path / "own.pt")


@pytest.mark.parametrize("value", ["{[1]:2}", "(" * 300, "-" * 100_000 + "1"])
def test_options_that_are_no_literal_are_text(value: str) -> None:
    assert own_code.keywords_of(f"a={value}", "--network-options") == {"a": value}


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


TIRES = """

class Tires(Net):
    calls = 0

    def forward(self, inputs):
        Tires.calls += 1
        if Tires.calls > 12:
            raise LookupError("no more")
        return self.layer(inputs.state)
"""


@needs_worlds
@pytest.mark.parametrize("module", ["own_tired", "own_package"])
def test_what_a_network_in_a_module_raises_is_the_users(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, module: str
) -> None:
    """Also where the module has the class from another one."""
    file = tmp_path / "own_tired.py"
    file.write_text(WRONG + TIRES, encoding="utf-8")
    (tmp_path / "own_package.py").write_text("from own_tired import Tires\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    for name in ("own_tired", "own_package"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    options = [*SMALL, "--network", f"{module}:Tires", "--steps", 2 * UPDATE]
    done = call("train", WORLD, "-o", tmp_path / "run", *options)
    assert done.returncode == 3, done.stderr
    assert "an exception of the code that was named ended it\nTraceback" in done.stderr
    assert f'File "{file}", line ' in done.stderr and "LookupError: no more" in done.stderr


def test_no_fault_of_what_is_exported_ends_a_training(monkeypatch: pytest.MonkeyPatch) -> None:
    def raises(*_: Any) -> int:
        raise RuntimeError("a __repr__ of one's own")

    monkeypatch.setattr(content, "encoded", raises)
    policy = make_trainer(None).policy
    assert content.fault_of(policy) == "RuntimeError: a __repr__ of one's own"


@needs_worlds
def test_programs_take_a_network_of_ones_own(tmp_path: pathlib.Path, lab: pathlib.Path) -> None:
    """It sees colors alone; it is trained, resumed, judged, exported, and shows others what to do."""
    run, name = tmp_path / "run", f"{lab}:Looks"
    own = ["--network", name, "--sees", "rgb", "--image-size", 36]
    options = [*SMALL, *own, "--steps", 2 * UPDATE, "--validation", HELD_OUT]
    options += ["--validation-episodes", 2, "--pause-at", UPDATE]
    done = call("train", WORLD, "-o", run, *options)
    assert done.returncode == 0, done.stderr
    lab.unlink()
    kept = f"{run / 'network.py'}:Looks"
    assert call("train", "-o", run, "--resume").returncode == 0 and len(curve(run)) >= 2
    refused = call("evaluate", run / "best.pt", HELD_OUT)
    assert refused.returncode == 1 and f"if you trust it, add --network {kept}\n" in refused.stderr
    done = call("evaluate", run / "best.pt", HELD_OUT, "--episodes", 2, "--network", kept)
    assert done.returncode == 0, done.stderr
    pack = tmp_path / "own.pack"
    done = call("export", run / "best.pt", "-o", pack, "--network", kept)
    assert done.returncode == 0, done.stderr
    assert galactic.LearnedPolicy(pack, 2).images["depth"] is False
    demos = tmp_path / "demos"
    own[1] = kept
    done = call("demonstrate", WORLD, "-o", demos, "--preset", "quick", *own, "--episodes", 2,
                "--expert", run / "best.pt")  # fmt: skip
    assert done.returncode == 0, done.stderr
    # A teacher is of another kind, and without its copy a run does not go on.
    done = call("train", WORLD, "-o", tmp_path / "b", *SMALL, "--teacher", run / "best.pt")
    assert done.returncode == 1 and "give another --teacher, of the network state" in done.stderr
    (run / "network.py").unlink()
    done = call("train", "-o", run, "--resume", "--steps", 9 * UPDATE)
    assert done.returncode == 2 and f"{run / 'network.py'}: is missing, the copy of" in done.stderr
