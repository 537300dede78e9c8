"""Policy packs of torch's policies: what galactic plays is what torch computes."""

from __future__ import annotations

import copy
import os
import pathlib
import subprocess
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is missing: nothing to compare with")
_core = pytest.importorskip("galactic._core", reason="the compiled module is not built")

import galactic  # noqa: E402
from galactic import export  # noqa: E402
from galactic.learning.encoders import Inputs  # noqa: E402
from galactic.learning.homes import Homes  # noqa: E402
from galactic.learning.packs import content  # noqa: E402
from galactic.learning.packs.content import content_of  # noqa: E402
from galactic.learning.packs.layers import ExportError, Layers  # noqa: E402
from galactic.learning.policies.networks import PolicyShape  # noqa: E402
from galactic.learning.policies.privileges import critic_columns  # noqa: E402
from galactic.learning.policies.sight import SIGHT  # noqa: E402
from galactic.learning.saving import checkpoint  # noqa: E402
from galactic.learning.settings import Settings  # noqa: E402
from policies import untrained  # noqa: E402

WORLD = pathlib.Path(os.environ.get("GALACTIC_LEARNING_WORLDS", "none")) / "held_out.pack"
needs_world = pytest.mark.skipif(
    not WORLD.is_file(), reason="GALACTIC_LEARNING_WORLDS has no worlds"
)
PARTS = [("robot_target", 3), ("joints", 6), ("bump", 1), ("laser", 10), ("geodesic", 6)]
STATE = 26
TOLERANCE = 1e-4
"""Of actions; float sums in another order differ by a tenth of it."""


def saved_policy(terminate: bool = True, **settings: Any) -> checkpoint.SavedPolicy:
    """A policy with random weights, none of them where it began: heads as large as the others."""
    torch.manual_seed(11)
    made = Settings(**{"envs": 4, "mini_batches": 1, "simulation": "task=pick", **settings})
    shape = PolicyShape(
        state=STATE,
        motions=9,
        decides_terminate=terminate,
        normalize=made.normalize,
        closeup=made.closeup,
        second_closeup=made.second_closeup,
        critic_only=critic_columns(made.critic_only, PARTS),
    )
    policy = checkpoint.new_policy(made, shape)
    policy.action.linear.weight.data.normal_(0.0, 0.1)
    policy.action.linear.bias.data.normal_(0.0, 0.3)
    # Decisions that hang on what is seen.
    policy.action.linear.weight.data[-4:].normal_(0.0, 0.5)
    policy.action.linear.bias.data[-4:] = 0.0
    for module in policy.modules():
        if isinstance(module, (torch.nn.GroupNorm, torch.nn.LayerNorm)):
            module.weight.data.uniform_(0.5, 1.5)
            module.bias.data.normal_(0.0, 0.3)
        if isinstance(module, torch.nn.GRU):
            module.bias_ih_l0.data.normal_(0.0, 0.2)
            module.bias_hh_l0.data.normal_(0.0, 0.2)
    if policy.normalize is not None:
        policy.normalize.mean.normal_()
        policy.normalize.scale.uniform_(0.3, 3.0)
    policy.eval()
    return checkpoint.SavedPolicy(policy, made, shape, PARTS, 123, 0.5)


class Recorded:
    """What `envs` envs see in `steps` steps, and where their episodes end."""

    def __init__(self, envs: int, steps: int, network: str = "state", edge: int = 128):
        draws = np.random.default_rng(5)
        self.state = draws.normal(0.0, 1.5, (steps, envs, STATE)).astype(np.float32)
        self.dones = draws.random((steps, envs)) < 0.15
        self.dones[0] = False
        self.rgb: np.ndarray | None = None
        self.depth: np.ndarray | None = None
        part = edge // 4
        if "rgb" in SIGHT[network]:
            # Rough pictures, each with its own colors, and grain.
            rough = (
                draws.uniform(0.0, 235.0, (steps, envs, 4, 4, 3)).repeat(part, 2).repeat(part, 3)
            )
            grain = draws.uniform(0.0, 20.0, (steps, envs, edge, edge, 3))
            self.rgb = (rough + grain).astype(np.uint8)
        if "depth" in SIGHT[network]:
            far = draws.uniform(0.0, 13.0, (steps, envs, 4, 4)).repeat(part, 2).repeat(part, 3)
            self.depth = far.astype(np.float32)


def by_torch(saved: checkpoint.SavedPolicy, seen: Recorded) -> list[Any]:
    """The action distributions of all steps, acting by their modes."""
    steps, envs = seen.dones.shape
    hidden = saved.policy.initial_hidden(envs, torch.device("cpu"))
    previous = torch.zeros(1, envs, 11)
    said = []
    with torch.inference_mode():
        for step in range(steps):
            starts = torch.from_numpy(seen.dones[step : step + 1].copy())
            if step == 0:
                starts[:] = True
            inputs = Inputs(
                torch.from_numpy(seen.state[step : step + 1]),
                None if seen.rgb is None else torch.from_numpy(seen.rgb[step : step + 1]),
                None if seen.depth is None else torch.from_numpy(seen.depth[step : step + 1]),
                previous * (~starts).unsqueeze(-1),
            )
            outputs = saved.policy.act(inputs, hidden, starts)
            hidden = outputs.hidden
            previous = outputs.actions.mode().clamp(-1.0, 1.0)
            said.append(outputs.actions)
    return said


def observed(saved: checkpoint.SavedPolicy, seen: Recorded) -> Recorded:
    """What the pack of the policy observes of it."""
    kept = [n for n in range(STATE) if n not in saved.shape.critic_only]
    less = copy.copy(seen)
    less.state = np.ascontiguousarray(seen.state[..., kept])
    return less


def by_pack(pack: pathlib.Path, seen: Recorded) -> np.ndarray:
    """Likeliest actions [steps, envs, A]."""
    steps, envs = seen.dones.shape
    player = _core.LearnedPolicy(pack, envs, deterministic=True, threads=2)
    return np.stack(
        [
            player.act(
                seen.state[step],
                seen.dones[step],
                None if seen.rgb is None else seen.rgb[step],
                None if seen.depth is None else seen.depth[step],
            )
            for step in range(steps)
        ]
    )


def write(content: dict[str, Any], file: pathlib.Path) -> pathlib.Path:
    _core.write_policy_pack(file, content, {}, "policy.pt", b"")
    return file


NETWORKS = {
    "state": {"network": "state"},
    "state_normalized": {"network": "state", "normalize": True, "closeup": 0.2},
    "state_closeup": {"network": "state", "closeup": 0.2, "activation": "relu"},
    "state_closeups": {"network": "state", "closeup": 0.2, "second_closeup": 0.04},
    "state_recurrent": {"network": "state", "recurrent": True, "log_std": "parameter"},
    "state_unsure": {"network": "state", "odds_limit": 1.5},
    "state_taught": {
        "network": "state",
        "critic_only": "bump,geodesic",
        "normalize": True,
        "closeup": 0.2,
    },
    "depth_taught": {
        "network": "depth",
        "image_size": 64,
        "critic_only": "laser",
        "recurrent": True,
        "log_std": "parameter",
        "second_closeup": 0.1,
    },
    "resnet9_taught": {"network": "resnet9", "critic_only": "geodesic"},
    "depth": {"network": "depth", "image_size": 64, "normalize": True, "closeup": 0.2},
    "depth_recurrent": {"network": "depth", "recurrent": True, "log_std": "parameter"},
    "simple_cnn": {"network": "simple_cnn", "normalize": True},
    "resnet9": {"network": "resnet9"},
    "resnet18": {"network": "resnet18"},
}


@pytest.mark.parametrize("name", NETWORKS)
def test_a_pack_acts_as_torch_does(name: str, tmp_path: pathlib.Path) -> None:
    saved = saved_policy(**NETWORKS[name])
    network, edge = saved.settings.network, saved.settings.image_size
    seen = Recorded(2 if SIGHT[network] else 7, 20, network, edge)
    pack = write(content_of(saved, name), tmp_path / "policy.pack")
    wanted = np.stack([actions.mode()[0].numpy() for actions in by_torch(saved, seen)])
    played = by_pack(pack, observed(saved, seen))
    assert played.shape == wanted.shape
    np.testing.assert_allclose(played, wanted, atol=TOLERANCE)
    decisions = wanted[..., 9:].mean()
    assert 0.1 < decisions < 0.9, "decisions go both ways"


@pytest.mark.parametrize(
    "name", ["state_normalized", "state_recurrent", "state_unsure", "simple_cnn"]
)
def test_deviations_and_odds_are_those_of_torch(name: str, tmp_path: pathlib.Path) -> None:
    saved = saved_policy(**NETWORKS[name])
    seen = Recorded(3, 5, saved.settings.network)
    made = content_of(saved, name)
    # A policy whose actions are all that the network says.
    heads = [made["continuous"]["mean"], made["continuous"]["log_deviation"]]
    heads += [action["logits"] for action in made["discrete"]]
    layers = made["layers"]
    layers.append({"kind": "concatenate", "inputs": heads})
    everything = {"count": 22, "mean": len(layers) - 1, "log_deviation": len(layers) - 1}
    made.update(continuous=everything, discrete=[])
    played = by_pack(write(made, tmp_path / "all.pack"), seen)
    for step, actions in enumerate(by_torch(saved, seen)):
        np.testing.assert_allclose(played[step, :, :9], actions.mean[0], atol=TOLERANCE)
        np.testing.assert_allclose(played[step, :, 9:18], actions.log_std[0], atol=TOLERANCE)
        odds = played[step, :, 19::2] - played[step, :, 18::2]
        np.testing.assert_allclose(odds, actions.logits[0], atol=TOLERANCE)


def _unlimited(layers: Layers, limit: float, logits: int) -> int:
    return logits


def _linear_closeup(layers: Layers, scale: float, state: int, size: int) -> int:
    return layers.times(1.0 / scale, state, size)


def _forgetful_gru(layers: Layers, gru: torch.nn.GRU, x: int) -> int:
    number = GRU(layers, gru, x)
    layers.list[number]["state_weight"] = 0.9 * layers.list[number]["state_weight"]
    return number


GRU = Layers.gru


@pytest.mark.parametrize(
    "network, place, attribute, other",
    [
        ("state_unsure", content, "_limited", _unlimited),
        ("state", content, "HIGHEST_LOG_STD", 0.5),
        ("state_closeup", Layers, "closeup", _linear_closeup),
        ("state_recurrent", Layers, "gru", _forgetful_gru),
    ],
)
def test_a_pack_that_acts_otherwise_is_not_written(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: Any,
    network: str, place: Any, attribute: str, other: Any
) -> None:  # fmt: skip
    """As where a layer of the pack is made wrong."""
    file, pack = tmp_path / "policy.pt", tmp_path / "policy.pack"
    checkpoint.save_policy(saved_policy(**NETWORKS[network]), file)
    monkeypatch.setattr(place, attribute, other)
    assert export.main([str(file), "-o", str(pack)]) == 3
    said = capsys.readouterr().err
    assert "the layers of the pack make other actions than the network (" in said
    assert said.endswith(" apart on made-up inputs): please report it\n")
    assert not pack.exists()


def test_a_weight_that_is_no_number_is_told_of_the_policy(
    tmp_path: pathlib.Path, capsys: Any
) -> None:
    file, pack = tmp_path / "policy.pt", tmp_path / "picker.pack"
    saved = saved_policy(network="state")
    saved.policy.action.linear.weight.data[0, 0] = float("nan")
    checkpoint.save_policy(saved, file)
    assert export.main([str(file), "-o", str(pack)]) == 3
    said = capsys.readouterr().err
    assert said.startswith(
        f"galactic.export: {file} cannot become a policy pack: picker: policy.layers[5].weight[0]: is not finite"
    )
    assert not pack.exists()


def test_nobody_terminates_where_the_task_does_not_ask(tmp_path: pathlib.Path) -> None:
    saved = saved_policy(terminate=False, network="state")
    seen = Recorded(20, 3)
    played = by_pack(write(content_of(saved, "p"), tmp_path / "p.pack"), seen)
    assert 0.1 < played[..., 9].mean() < 0.9
    assert not played[..., 10].any()


def test_a_checkpoint_becomes_a_pack(tmp_path: pathlib.Path, capsys: Any) -> None:
    saved = saved_policy(network="state", simulation="task=pick slide=off no-distractors")
    checkpoint.save_policy(saved, tmp_path / "best.pt")
    pack = tmp_path / "picker.pack"
    assert export.main([str(tmp_path / "best.pt"), "-o", str(pack)]) == 0
    player = _core.LearnedPolicy(pack, 1)
    assert player.name == "picker"
    assert player.robot == ""
    assert player.options == {"task": "pick", "no_distractors": True, "slide_attempts": 0}
    assert player.observation == PARTS
    assert player.images is None
    assert player.action_count == 11
    # The same checkpoint gives the same bytes.
    again = tmp_path / "again" / "picker.pack"
    again.parent.mkdir()
    assert export.main([str(tmp_path / "best.pt"), "-o", str(again)]) == 0
    assert again.read_bytes() == pack.read_bytes()
    for word in (b"slide-attempts", b"no-distractors", b"best.pt", b"trained-steps"):
        assert word in pack.read_bytes()
    assert capsys.readouterr().err == ""


def test_a_pack_needs_no_sensor_that_the_critic_alone_saw(tmp_path: pathlib.Path) -> None:
    simulation = "task=pick geodesic geodesic-weight=1 bump laser-beams=5 laser-range=4"
    saved = saved_policy(network="state", simulation=simulation, critic_only="laser,geodesic")
    checkpoint.save_policy(saved, tmp_path / "best.pt")
    assert export.main([str(tmp_path / "best.pt"), "-o", str(tmp_path / "p.pack")]) == 0
    player = _core.LearnedPolicy(tmp_path / "p.pack", 1)
    assert player.options == {"task": "pick", "geodesic_weight": 1.0, "bump": True}
    assert player.observation == [("robot_target", 3), ("joints", 6), ("bump", 1)]


def test_errors_say_what_to_do(tmp_path: pathlib.Path, capsys: Any) -> None:
    missing = tmp_path / "no.pt"
    assert export.main([str(missing), "-o", str(tmp_path / "p.pack")]) == 2
    assert "no.pt: cannot open the file: No such file" in capsys.readouterr().err
    checkpoint.save_policy(saved_policy(network="state"), tmp_path / "best.pt")
    assert export.main([str(tmp_path / "best.pt"), "-o", "/nowhere/p.pack"]) == 2
    assert "/nowhere" in capsys.readouterr().err
    with pytest.raises(galactic.Error, match="best.pt: is a checkpoint, expected a policy pack; "):
        galactic.LearnedPolicy(tmp_path / "best.pt", 1)
    infinite = saved_policy(network="state")
    infinite.policy.action.linear.weight.data[0, 0] = float("inf")
    checkpoint.save_policy(infinite, tmp_path / "bad.pt")
    assert export.main([str(tmp_path / "bad.pt"), "-o", str(tmp_path / "p.pack")]) == 3
    assert "is not finite, expected a number" in capsys.readouterr().err
    assert not (tmp_path / "p.pack").exists()


def test_a_checkpoint_is_not_replaced_by_its_pack(tmp_path: pathlib.Path, capsys: Any) -> None:
    file, link = tmp_path / "best.pt", tmp_path / "link.pack"
    checkpoint.save_policy(saved_policy(network="state"), file)
    link.symlink_to(file)
    before = file.read_bytes()
    for output in (file, tmp_path / "." / "best.pt", link):
        assert export.main([str(file), "-o", str(output)]) == 3
        wanted = f"galactic.export: {output}: is also an input; write to another file\n"
        assert capsys.readouterr().err == wanted
    assert file.read_bytes() == before


@pytest.mark.parametrize(
    "simulation, fault",
    [
        ("task=pick hover=3", "there is no option hover; did you mean order?"),
        ("task=cook", "task: is cook, expected rearrange, pick or none"),
        ("envs=3", "envs is not for --simulation; the trainer chooses it"),
    ],
)
def test_a_policy_of_other_options_is_named(
    tmp_path: pathlib.Path, capsys: Any, simulation: str, fault: str
) -> None:
    file = tmp_path / "best.pt"
    checkpoint.save_policy(saved_policy(network="state", simulation=simulation), file)
    assert export.main([str(file), "-o", str(tmp_path / "p.pack")]) == 3
    said = capsys.readouterr().err
    assert said.startswith(f"galactic.export: {file} cannot become a policy pack: {fault}")
    assert said.endswith("; take another policy\n") and said.count("\n") == 1


def test_modules_that_no_layer_can_say_are_refused() -> None:
    layers = Layers()
    for module in (
        torch.nn.Conv2d(4, 8, 3, groups=2),
        torch.nn.Conv2d(4, 8, (3, 5)),
        torch.nn.Conv2d(4, 8, 3, padding="same"),
        torch.nn.AvgPool2d(3, count_include_pad=False),
        torch.nn.GroupNorm(2, 4, affine=False),
        torch.nn.Sigmoid(),
    ):
        with pytest.raises(ExportError):
            layers.module(module, 0)
    with pytest.raises(ExportError):
        layers.gru(torch.nn.GRU(4, 4, num_layers=2), 0)


def test_a_played_policy_checks_its_arrays(tmp_path: pathlib.Path) -> None:
    pack = write(content_of(saved_policy(network="simple_cnn"), "p"), tmp_path / "p.pack")
    player = _core.LearnedPolicy(pack, 2)
    images = {"width": 128, "height": 128, "color": "rgb", "depth": True}
    camera = {"camera": "head", "fov_degrees": 0, "near": 0}
    place = {"position": (0, 0, 0), "rpy_degrees": (0, 0, 0)}
    assert player.images == {**images, **camera, **place}
    state = np.zeros((2, STATE), np.float32)
    rgb, depth = np.zeros((2, 128, 128, 3), np.uint8), np.zeros((2, 128, 128), np.float32)
    assert player.act(state, None, rgb, depth).shape == (2, 11)
    for wrong in (
        (state[:1], None, rgb, depth),
        (state, np.zeros(3, np.uint8), rgb, depth),
        (state, None, rgb[..., :2], depth),
        (state, None, rgb, depth[:, :64]),
    ):
        with pytest.raises(ValueError):
            player.act(*wrong)
    with pytest.raises(TypeError):
        player.act(state, None, None, depth)
    # Colors from 0 to 1 would all be black, or nearly.
    for floats in ((None, rgb / np.float32(255), depth), (np.zeros(2), rgb, depth)):
        with pytest.raises(TypeError, match="numbers, expected an array of whole numbers"):
            player.act(state, *floats)
    for number in (np.nan, np.inf):
        wrong = state.copy()
        wrong[1, 5] = number
        with pytest.raises(
            ValueError, match=rf"^observations\[1, 5\] is {number}, expected finite"
        ):
            player.act(wrong, None, rgb, depth)
    blind = _core.LearnedPolicy(
        write(content_of(saved_policy(network="state"), "b"), tmp_path / "b.pack"), 2
    )
    for given, name in (({"rgb": rgb}, "rgb"), ({"depth": depth}, "depth")):
        with pytest.raises(ValueError, match=f"^{name} is a ndarray, and the policy does not see"):
            blind.act(state, **given)
    assert blind.act(state).shape == (2, 11)
    with pytest.raises(galactic.Error):
        _core.LearnedPolicy(tmp_path / "no.pack", 2)
    assert repr(player) == "<galactic.LearnedPolicy p>"


def test_two_threads_cannot_use_one_played_policy_at_once(
    tmp_path: pathlib.Path, refused_at_once: Callable[..., list[str]]
) -> None:
    pack = write(content_of(saved_policy(network="state"), "p"), tmp_path / "p.pack")
    player = _core.LearnedPolicy(pack, 1024, deterministic=True, threads=1)
    state = np.random.default_rng(1).normal(size=(1024, STATE)).astype(np.float32)
    wanted = player.act(state)

    def act() -> None:
        np.testing.assert_array_equal(player.act(state), wanted)

    assert set(refused_at_once(act, act, times=100)) == {
        "another thread is using this galactic.LearnedPolicy; give each thread its own"
    }


PLACED = {"camera_position": (-0.1, 0.0, 0.35), "camera_rpy": (0.0, 25.0, -10.1), "near": 0.3}


@needs_world
@pytest.mark.skipif("GALACTIC_RUN" not in os.environ, reason="GALACTIC_RUN names no program")
def test_galactic_run_sees_what_a_placed_camera_saw_in_training(tmp_path: pathlib.Path) -> None:
    envs, steps, acted = 2, 3, []
    cameras = {
        "placed": {"network": "simple_cnn", **PLACED},
        "head": {"network": "simple_cnn"},
        "depth": {"network": "depth", "image_size": 44},
    }
    for name, chosen in cameras.items():
        settings = Settings(envs=envs, halves=1, mini_batches=1, simulation="task=pick", **chosen)
        homes = Homes(galactic.World(WORLD), settings, 1)
        checkpoint.save_policy(untrained(settings, homes), tmp_path / "best.pt")
        pack = tmp_path / f"{name}.pack"
        assert export.main([str(tmp_path / "best.pt"), "-o", str(pack)]) == 0
        player = galactic.LearnedPolicy(pack, envs, deterministic=True)
        env = galactic.VectorEnv(WORLD, envs, images=player.images, **player.options)
        seen, trained = env.reset()[0], homes.env.reset()[0]
        assert set(seen) == {"state", *SIGHT[settings.network]}
        for image in SIGHT[settings.network]:
            np.testing.assert_array_equal(seen[image], trained[image])
        for _ in range(steps):
            acted.append(player.act(seen["state"], None, seen.get("rgb"), seen["depth"]))
            seen = env.step(acted[-1])[0]
        # After a head of its own length, a recording has the actions of each step and two hashes.
        record = tmp_path / "run.rec"
        run = [os.environ["GALACTIC_RUN"], str(WORLD), "--policy", str(pack), "--deterministic",
               "--envs", str(envs), "--steps", str(steps), "--record", str(record)]  # fmt: skip
        subprocess.run(run, check=True, stdout=subprocess.DEVNULL)
        floats, hashes = acted[-1].size, 4
        rows = np.frombuffer(record.read_bytes()[-steps * 4 * (floats + hashes) :], np.float32)
        rows = rows.reshape(steps, floats + hashes)[:, :floats]
        np.testing.assert_array_equal(rows.reshape(steps, envs, -1), np.stack(acted[-steps:]))
    assert not np.array_equal(acted[0], acted[steps])
    assert not np.array_equal(acted[steps], acted[2 * steps])


def test_a_policy_says_where_its_camera_is(tmp_path: pathlib.Path, capsys: Any) -> None:
    saved = saved_policy(network="simple_cnn", **PLACED)
    checkpoint.save_policy(saved, tmp_path / "best.pt")
    assert checkpoint.load_policy(tmp_path / "best.pt").settings == saved.settings
    pack = tmp_path / "p.pack"
    assert export.main([str(tmp_path / "best.pt"), "-o", str(pack)]) == 0
    images = galactic.LearnedPolicy(pack, 2).images
    assert images is not None
    for name, wanted in (
        ("position", PLACED["camera_position"]),
        ("rpy_degrees", PLACED["camera_rpy"]),
        ("near", PLACED["near"]),
    ):
        np.testing.assert_array_equal(images[name], np.float32(wanted))
    assert b"-0.1,0,0.35" in pack.read_bytes()


@pytest.mark.parametrize("fov", [1, 33.3, 60, 175])
def test_a_policy_says_with_which_camera_it_was_trained(tmp_path: pathlib.Path, fov: float) -> None:
    saved = saved_policy(network="simple_cnn", camera="top", fov=fov)
    pack = write(content_of(saved, "p"), tmp_path / "p.pack")
    images = _core.LearnedPolicy(pack, 2).images
    assert images is not None
    assert (images["camera"], images["fov_degrees"]) == ("top", np.float32(fov))


@pytest.mark.parametrize(
    "options, message",
    [
        ({"envs": 0}, "envs: is 0, expected a whole number from 1 to 1048576"),
        ({"envs": 2.0}, "envs: is 2.0, expected a whole number"),
        ({"envs": 2**40}, "envs: is 1099511627776, expected"),
        ({"deterministic": "yes"}, "deterministic: is 'yes', expected True or False"),
        ({"seed": -1}, "seed: is -1, expected a whole number from 0"),
        ({"threads": 99999}, "threads: is 99999, expected 0 to 4096"),
    ],
)
def test_a_played_policy_checks_its_options(
    tmp_path: pathlib.Path, options: dict[str, Any], message: str
) -> None:
    pack = write(content_of(saved_policy(network="state"), "p"), tmp_path / "p.pack")
    with pytest.raises(galactic.Error) as caught:
        galactic.LearnedPolicy(pack, **{"envs": 2, **options})
    assert message in str(caught.value)
