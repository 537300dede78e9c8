"""Networks of one's own: galactic.train --network, and what uses its policies."""

from __future__ import annotations

import dataclasses
import pathlib
import sys

import pytest
import torch

import galactic
from galactic.learning.refusals import CheckpointError, NetworkError, SettingsError
from galactic.learning.saving import checkpoint
from galactic.learning.settings import Settings
from galactic.learning.user_code import own_code
from own_lab import EXAMPLE, NETWORKS, SEEN, lab, named, saved_policy, with_line
from programs import HELD_OUT, SMALL, UPDATE, WORLD, call, curve, needs_worlds
from toys import Look, Remember
from trainers import SETTINGS, UPDATE as TOY_UPDATE, make_trainer, parameters


@pytest.mark.parametrize(
    "name, message",
    [
        ("Narrow", r"returned features of float32 \[2, 3, 8\], expected \[2, 3, 9\], which is \[T, n, fe"),
        ("Nameless", "has features = 0, expected a whole number from 1"),
        ("Flat", r"returned features of float32 \[2, 3\], expected \[2, 3, 8\]"),
        ("Nothing", r"returned features of NoneType, expected \[2, 3, 8\]"),
        ("Misfit", r"failed in forward\(\), in line {line}: RuntimeError: mat1 and mat2 shapes cannot be"),
        ("Blind", r"failed in forward\(\), in line {line}: AttributeError: 'NoneType' object has no attri"),
        ("Unmade", r"failed in __init__\(\), in line {line}: KeyError: 'no such part'"),
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
    message = with_line(message, name)
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


def test_convolutions_of_three_dimensions_learn(lab: pathlib.Path) -> None:
    settings = dataclasses.replace(
        SETTINGS,
        width=128,
        network="lab.py:Stacks",
        sees="depth",
        image_size=Look.EDGE,
        steps=TOY_UPDATE,
    )
    trainer = make_trainer(None, settings, Look, network=named(lab, "Stacks"))
    weights = trainer.policy.encoder.layers[0].weight
    before = weights.detach().clone()
    trainer.begin()
    trainer.train()
    assert not torch.equal(weights, before)


def test_a_resumed_run_is_the_run_that_would_have_been(
    tmp_path: pathlib.Path, lab: pathlib.Path
) -> None:
    settings = dataclasses.replace(
        SETTINGS, width=128, network="lab.py:Net", checkpoint_every=TOY_UPDATE
    )
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
    lab.write_text(NETWORKS + "# changed\n", encoding="utf-8")
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
    settings = dataclasses.replace(SETTINGS, width=128, network="lab:Net", steps=TOY_UPDATE)
    (tmp_path / "run").mkdir()
    trainer = make_trainer(
        tmp_path / "run", settings, network=named(lab, "Net")._replace(digest="")
    )
    trainer.begin()
    trainer.train()
    lab.write_text(NETWORKS.replace("8)", "7)").replace("= 8", "= 7"), encoding="utf-8")
    with pytest.raises(
        CheckpointError, match=r"encoder.layer.weight: found float32 \[8, 4\], expected"
    ):
        checkpoint.load_policy(tmp_path / "run" / "best.pt", network=named(lab, "Net"))


def test_a_module_is_another_file_than_the_one_that_a_policy_learned_with(
    tmp_path: pathlib.Path, lab: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    checkpoint.save_policy(saved_policy(named(lab, "Net")), tmp_path / "own.pt")
    (tmp_path / "own_module_a.py").write_text(NETWORKS, encoding="utf-8")
    (tmp_path / "own_module_b.py").write_text(NETWORKS + "# changed\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    load = checkpoint.read_policy
    assert load(tmp_path / "own.pt", "own_module_a:Net").network is not None
    with pytest.raises(NetworkError, match="own_module_b is another file than it was then; put it"):
        load(tmp_path / "own.pt", "own_module_b:Net")


@pytest.mark.parametrize("value", ["{[1]:2}", "(" * 300, "-" * 100_000 + "1"])
def test_options_that_are_no_literal_are_text(value: str) -> None:
    assert own_code.keywords_of(f"a={value}", "--network-options") == {"a": value}


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
    file.write_text(NETWORKS + TIRES, encoding="utf-8")
    (tmp_path / "own_package.py").write_text("from own_tired import Tires\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    for name in ("own_tired", "own_package"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    options = [*SMALL, "--network", f"{module}:Tires", "--steps", 2 * UPDATE]
    done = call("train", WORLD, "-o", tmp_path / "run", *options)
    assert done.returncode == 3, done.stderr
    assert "an exception of the code that was named ended it\nTraceback" in done.stderr
    assert f'File "{file}", line ' in done.stderr and "LookupError: no more" in done.stderr


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
