"""Policy packs of modules of one's own: what galactic plays is what the module computes."""

from __future__ import annotations

import pathlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import torch
from torch import nn

import galactic
from galactic.learning import ActionParameters, export_module, read_policy
from galactic.learning.encoders import Eyes, Inputs
from galactic.learning.packs.layers import ExportError
from galactic.learning.refusals import SettingsError
from galactic.learning.saving import checkpoint
from galactic.learning.sequences import run_gru
from galactic.learning.settings import Settings
from galactic.learning.homes import Homes
from policies import untrained
from programs import WORLD, needs_worlds

pytestmark = needs_worlds
ENVS, STEPS, TOLERANCE = 5, 6, 1e-4
SIGHT = {"width": 36, "height": 40, "camera": "head", "fov_degrees": 70, "position": (0.1, 0, 0)}


@pytest.fixture(scope="module", name="homes")
def made_homes() -> galactic.VectorEnv:
    options: dict[str, Any] = {"geodesic": True, "motion_noise": 0.1}
    return galactic.VectorEnv(WORLD, 2, task="pick", slide_attempts=0, **options)


@pytest.fixture(scope="module", name="seeing")
def made_seeing_homes() -> galactic.VectorEnv:
    return galactic.VectorEnv(WORLD, 2, images={**SIGHT, "depth_noise": 0.01})


def size_of(envs: galactic.VectorEnv) -> int:
    return max(part.stop for part in envs.observation_parts.values())


class Perceptron(nn.Module):
    """With most of what a loop of one's own may have around its layers, and a critic, which no pack has."""

    def __init__(self, seen: int, motions: int) -> None:
        super().__init__()
        self.motions = motions
        self.actor = nn.Sequential(nn.Linear(2 * seen, 32), nn.Tanh(), nn.Linear(32, motions + 3))
        self.critic = nn.Bilinear(seen, seen, 1)
        self.log_std = nn.Parameter(torch.randn(motions))
        self.register_buffer("mean", torch.randn(seen, dtype=torch.float64))
        self.register_buffer("variance", torch.rand(seen, dtype=torch.float64))
        self.value = torch.zeros(1)

    mean: torch.Tensor
    variance: torch.Tensor

    def forward(self, inputs: Inputs) -> ActionParameters:
        state = inputs.state
        self.value = self.critic(state, state)
        scale = self.variance.add(1e-5).rsqrt().float()
        normalized = ((state - self.mean.float()) * scale).clamp(-2, 2)
        rows = self.actor(torch.cat([normalized, torch.tanh(1 - state / 2)], -1))
        hand, terminate = rows[..., self.motions : -1], rows[..., -1:]
        return ActionParameters(
            torch.tanh(rows[..., : self.motions]), self.log_std.clamp(max=0.5), (hand, terminate)
        )


class Convolutions(nn.Module):
    def __init__(self, seen: int, actions: int) -> None:
        super().__init__()
        self.eyes = Eyes(
            nn.Sequential(nn.Conv2d(4, 8, 8, 4), nn.ReLU(), nn.Flatten(), nn.Linear(8 * 9 * 8, 16))
        )
        self.head = nn.Linear(16 + seen + actions, 2 * actions)

    def forward(self, inputs: Inputs) -> ActionParameters:
        assert inputs.previous is not None
        joined = torch.cat([self.eyes(inputs), inputs.state, inputs.previous], -1)
        mean, log_std = self.head(joined).chunk(2, -1)
        return ActionParameters(mean, log_std)


class Remembering(nn.Module):
    memory = 16

    def __init__(self, seen: int, motions: int) -> None:
        super().__init__()
        self.rnn = nn.GRU(seen, self.memory)
        self.head = nn.Linear(self.memory, motions)
        self.hand = nn.Linear(self.memory, 3)

    def forward(
        self, inputs: Inputs, memory: torch.Tensor, starts: torch.Tensor
    ) -> tuple[ActionParameters, torch.Tensor]:
        features, memory = run_gru(self.rnn, inputs.state, memory, starts)
        return ActionParameters(self.head(features), logits=(self.hand(features),)), memory


def module_of(
    make: Callable[[int, int], nn.Module], envs: galactic.VectorEnv, discrete: int
) -> nn.Module:
    torch.manual_seed(3)
    motions = envs.simulators[0].action_count - discrete
    return make(size_of(envs), motions)


def played_and_made(
    pack: pathlib.Path, module: nn.Module, images: bool = False
) -> tuple[np.ndarray, list[ActionParameters]]:
    """The likeliest actions of a pack, [steps, envs, A], and what the module makes of the same."""
    draws = np.random.default_rng(5)
    player = galactic.LearnedPolicy(pack, ENVS, deterministic=True)
    size, actions = sum(one for _, one in player.observation), player.action_count
    memory = torch.zeros(ENVS, int(getattr(module, "memory", 0)))
    previous, played, made = np.zeros((ENVS, actions), np.float32), [], []
    for step in range(STEPS):
        dones = draws.random(ENVS) < (0.3 if step else 0.0)
        starts = dones if step else np.ones(ENVS, np.bool_)
        state = draws.normal(0.0, 1.5, (ENVS, size)).astype(np.float32)
        rgb = draws.integers(0, 256, (ENVS, 40, 36, 3)).astype(np.uint8) if images else None
        depth = draws.uniform(0, 13, (ENVS, 40, 36)).astype(np.float32) if images else None
        previous[starts] = 0.0
        given = [None if one is None else torch.from_numpy(one)[None] for one in (rgb, depth)]
        inputs = Inputs(torch.from_numpy(state)[None], *given, torch.from_numpy(previous)[None])
        with torch.no_grad():
            if memory.shape[1]:
                parameters, memory = module(inputs, memory, torch.from_numpy(starts)[None])
            else:
                parameters = module(inputs)
        played.append(player.act(state, dones, rgb, depth))
        made.append(parameters)
        previous = played[-1].clip(-1.0, 1.0)
    return np.stack(played), made


def test_a_perceptron_acts_as_it_does_in_torch(
    homes: galactic.VectorEnv, tmp_path: pathlib.Path
) -> None:
    module, pack = module_of(Perceptron, homes, 2), tmp_path / "own.pack"
    members = {*vars(module)}
    export_module(pack, module, homes, discrete=((0, 1), (0, 1)), trained_with={"steps": 12_345})
    assert {*vars(module)} == members and module.training
    played, made = played_and_made(pack, module)
    motions = played.shape[-1] - 2
    for actions, parameters in zip(played, made):
        assert parameters.mean is not None
        np.testing.assert_allclose(actions[:, :motions], parameters.mean[0], atol=TOLERANCE)
        hand, terminate = (one[0].numpy() for one in parameters.logits)
        np.testing.assert_array_equal(actions[:, motions], hand.argmax(-1))
        np.testing.assert_array_equal(actions[:, motions + 1], terminate[:, 0] > 0.0)
    assert 0.1 < played[..., motions:].mean() < 0.9, "decisions go both ways"
    player = galactic.LearnedPolicy(pack, 1)
    assert player.options == {"task": "pick", "geodesic": True, "slide_attempts": 0}
    parts = homes.observation_parts.items()
    assert player.observation == [(name, part.stop - part.start) for name, part in parts]
    assert player.images is None and player.name == "own" and player.robot == ""
    assert b"12345" in pack.read_bytes()


def test_deviations_are_those_of_the_module(
    homes: galactic.VectorEnv, tmp_path: pathlib.Path
) -> None:
    module, pack = module_of(Perceptron, homes, 2), tmp_path / "own.pack"
    export_module(pack, module, homes)
    envs = 4096
    player = galactic.LearnedPolicy(pack, envs, seed=4)
    drawn = player.act(np.zeros((envs, size_of(homes)), np.float32))[:, :-2]
    wanted = module.log_std.detach().clamp(max=0.5).exp().numpy()
    np.testing.assert_allclose(drawn.std(0), wanted, rtol=0.06)


def test_convolutions_act_as_they_do_in_torch(
    seeing: galactic.VectorEnv, tmp_path: pathlib.Path
) -> None:
    module, pack = module_of(Convolutions, seeing, 0), tmp_path / "own.pack"
    export_module(pack, module, seeing, discrete=(), name="seer", robot=seeing.world.robot)
    played, made = played_and_made(pack, module, images=True)
    for actions, parameters in zip(played, made):
        assert parameters.mean is not None
        np.testing.assert_allclose(actions, parameters.mean[0], atol=TOLERANCE)
    player = galactic.LearnedPolicy(pack, 1)
    assert player.name == "seer" and player.robot == seeing.world.robot
    assert player.images is not None and "depth_noise" not in player.images
    assert {name: player.images[name] for name in ("width", "height", "fov_degrees")} == {
        "width": 36,
        "height": 40,
        "fov_degrees": 70,
    }
    assert player.images["position"] == pytest.approx((0.1, 0, 0))


def test_a_memory_starts_over_where_an_episode_does(
    homes: galactic.VectorEnv, tmp_path: pathlib.Path
) -> None:
    module, pack = module_of(Remembering, homes, 2), tmp_path / "own.pack"
    # The hand has three places, and nobody terminates.
    export_module(pack, module, homes, discrete=((0.0, 0.25, 1.0), (0.0,)))
    played, made = played_and_made(pack, module)
    for actions, parameters in zip(played, made):
        assert parameters.mean is not None
        np.testing.assert_allclose(actions[:, :-2], parameters.mean[0], atol=TOLERANCE)
        places = np.array([0.0, 0.25, 1.0])[parameters.logits[0][0].argmax(-1)]
        np.testing.assert_allclose(actions[:, -2], places)
    assert not played[..., -1].any()


def test_what_the_critic_alone_sees_is_left_out(
    homes: galactic.VectorEnv, tmp_path: pathlib.Path
) -> None:
    pack, size = tmp_path / "own.pack", size_of(homes) - 6
    export_module(pack, Perceptron(size, 9), homes, critic_only=["geodesic"])
    player = galactic.LearnedPolicy(pack, 1)
    assert "geodesic" not in dict(player.observation)
    assert player.options == {"task": "pick", "slide_attempts": 0}
    with pytest.raises(SettingsError, match='"geodesics" is no sensor; did you mean geodesic?'):
        export_module(pack, Perceptron(size, 9), homes, critic_only=["geodesics"])


class Blind(nn.Module):
    """Returns what `make` makes of a linear layer on the state, its weights, and the inputs."""

    def __init__(self, seen: int, outputs: int, make: Callable[..., Any]) -> None:
        super().__init__()
        self.layer = nn.Linear(seen, outputs)
        self.own = [make]

    def forward(self, inputs: Inputs) -> Any:
        return self.own[0](self.layer(inputs.state), inputs)


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda x, inputs: x, "^forward.. returned a Tensor, expected ActionParameters$"),
        (
            lambda x, inputs: ActionParameters(x[..., :5], x[0, 0, :5]),
            r"^forward\(\) returned mean of float32 \[1, 8, 5\], expected \[1, 8, 11\] .* has the values of the last 0",
        ),
        (
            lambda x, inputs: ActionParameters(x, x[..., :3]),
            r"returned log_deviation of float32 \[1, 8, 3\], expected \[1, 8, 11\] on made-up inputs",
        ),
        (
            lambda x, inputs: ActionParameters(x, logits=(x,)),
            "returned logits of 1, expected those of 0 actions, as many as `discrete` has with",
        ),
        (
            lambda x, inputs: ActionParameters(torch.sin(x)),
            r"^line \d+ of test_export_module.py: a policy pack has no layer for sin in forward\(\)",
        ),
        (
            lambda x, inputs: ActionParameters(x * x),
            r"has no layer for mul in forward\(\) .*: it has the layers of docs/policies.md, slices",
        ),
        (lambda x, inputs: ActionParameters(1.0 / x), "has no layer for truediv"),
        (lambda x, inputs: ActionParameters(x if x.sum() > 0 else -x), "cannot be followed in line"),
        (lambda x, inputs: ActionParameters(x + inputs.depth.mean()), "failed on made-up inputs: Attri"),
        (
            lambda x, inputs: ActionParameters(x + (4.0 if isinstance(x, torch.Tensor) else 3.0)),
            r"make other actions than the network \(1 apart on made-up inputs\): write forward\(\) of",
        ),
    ],
)  # fmt: skip
def test_what_no_pack_has_is_refused(
    homes: galactic.VectorEnv, tmp_path: pathlib.Path, make: Callable[..., Any], message: str
) -> None:
    with pytest.raises(ExportError, match=message):
        export_module(tmp_path / "own.pack", Blind(size_of(homes), 11, make), homes, discrete=())
    assert not list(tmp_path.iterdir())


def test_a_memory_that_is_no_gru_is_refused(
    homes: galactic.VectorEnv, tmp_path: pathlib.Path
) -> None:
    class Kept(Remembering):
        def forward(self, inputs: Inputs, memory: Any, starts: Any) -> Any:
            made, after = super().forward(inputs, memory, starts)
            return made, 0.5 * after

    class Shifted(Remembering):
        def forward(self, inputs: Inputs, memory: Any, starts: Any) -> Any:
            return super().forward(inputs, memory + 1.0, starts)

    given: dict[str, Any] = {"discrete": ((0, 1, 2), (0,))}
    for kind, message in (
        (Kept, "has no layer for mul"),
        (Shifted, "has no layer for add|else than"),
    ):
        with pytest.raises(ExportError, match=message):
            export_module(tmp_path / "own.pack", module_of(kind, homes, 2), homes, **given)


class Farther(galactic.Task):
    observes = {"farther": 1}

    def observation(self, envs: galactic.TaskEnvs) -> Any:
        return {"farther": np.zeros((envs.num_envs, 1), np.float32)}


def test_what_no_pack_can_be_played_in_is_refused(
    homes: galactic.VectorEnv, tmp_path: pathlib.Path
) -> None:
    module, pack = module_of(Perceptron, homes, 2), tmp_path / "own.pack"
    with pytest.raises(TypeError, match="envs is a Simulator, expected a galactic.VectorEnv"):
        export_module(pack, module, homes.simulators[0])  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="module is a int, expected a torch.nn.Module"):
        export_module(pack, 3, homes)  # type: ignore[arg-type]
    two = galactic.VectorEnv(WORLD, 1, images={"head": {}, "top": {}})
    with pytest.raises(ExportError, match="cameras head, top, and a policy pack has one"):
        export_module(pack, module, two)
    for camera, message in (
        ({"world_from_camera": np.eye(4)}, "stands in the world"),
        ({"robot": False}, "drawn without the robot"),
    ):
        with pytest.raises(ExportError, match=message):
            export_module(pack, module, galactic.VectorEnv(WORLD, 1, images=camera))
    with pytest.raises(galactic.Error, match="/nowhere"):
        export_module("/nowhere/own.pack", module, homes)
    with torch.no_grad():
        module.actor[0].weight[0, 0] = np.nan
    with pytest.raises(galactic.Error, match="is not finite, expected a number"):
        export_module(pack, module, homes)
    assert not pack.exists()


def test_a_saved_policy_is_a_module_of_torch(tmp_path: pathlib.Path) -> None:
    settings = Settings(network="state", envs=4, halves=1, mini_batches=1, simulation="task=pick")
    homes = Homes(galactic.World(WORLD), settings, 1)
    checkpoint.save_policy(untrained(settings, homes), tmp_path / "best.pt")
    saved = read_policy(str(tmp_path / "best.pt"))
    assert isinstance(saved.policy, nn.Module) and not saved.policy.training
    state, starts = torch.zeros(1, 4, saved.shape.state), torch.ones(1, 4, dtype=torch.bool)
    hidden = saved.policy.initial_hidden(4, torch.device("cpu"))
    assert saved.policy.act(Inputs(state), hidden, starts).actions.mode().shape == (1, 4, 11)
