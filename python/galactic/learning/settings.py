"""Every setting of a training run, in one dataclass: the command line, checkpoints, reports and the
tables of docs/learning.md are derived from it."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

from galactic.learning.network_settings import CAMERA_NOISE, NetworkSettings
from galactic.learning.policies.sight import IMAGE_SIZE, OF_THE_PAPER
from galactic.learning.refusals import SettingsError
from galactic.learning.setting_fields import require_valid, setting
from galactic.learning.setting_scopes import IdleSetting, require_effect
from galactic.learning.simulation_words import is_robot_noise, latest_words


@dataclass(frozen=True)
class _RunSettings:
    """The group Run of Settings: what the robot does, and for how long."""

    steps: int = setting(
        200_000_000, "Run", "total steps of all envs of all ranks", low=1, may_change=True
    )
    seed: int = setting(1, "Run", "seed of everything random", low=0)
    envs: int = setting(128, "Run", "environments per rank", low=1, high=1 << 20)
    halves: int = setting(
        2,
        "Run",
        "groups of envs: with 2, one group simulates while the network acts for the other",
        low=1,
        high=2,
        is_of_acting=True,
    )
    simulation: str = setting(
        "",
        "Run",
        "options of the simulation (those of galactic-run), as NAME=VALUE separated by spaces; each "
        "overrides the preset's option of the same name",
    )
    task: str = setting(
        "",
        "Run",
        "a task of your own, which defines rewards and the ends of episodes: `FILE.py:CLASS` or "
        "`MODULE:CLASS`",
    )
    task_options: str = setting(
        "", "Run", "arguments of the task's class, as NAME=VALUE separated by spaces"
    )
    terminate: str = setting(
        "auto",
        "Run",
        "who decides when to terminate: the policy (`learned`), nobody (`never`), or the policy if the "
        "task asks for it (`auto`)",
        choices=("auto", "learned", "never"),
    )


@dataclass(frozen=True)
class Settings(NetworkSettings, _RunSettings):
    """What defines a run. The defaults are those of the preset `paper`: table 3 of the paper, or
    Habitat's DD-PPO where the table gives no value."""

    # These fields follow those of the base classes; the fields of the last base come first.
    learning_rate: float = setting(3.5e-4, "PPO", "Adam's learning rate at the start", low=0.0)
    learning_rate_end: float = setting(
        0.0, "PPO", "learning rate at the end of the run, linear in between", low=0.0
    )
    target_kl: float = setting(
        0.0,
        "PPO",
        "how much an update should change the policy, nats: the divergence before the step of each "
        "mini-batch, averaged over the update. If it is larger, the learning rate goes down; if it is "
        "smaller, the rate goes back up, at most to the schedule's; 0: always the schedule's",
        low=0.0,
        is_of_acting=True,
    )
    adam_epsilon: float = setting(1e-5, "PPO", "Adam's epsilon", low=0.0)
    horizon: int = setting(64, "PPO", "steps per env in a rollout", low=1, high=1 << 20)
    epochs: int = setting(1, "PPO", "how many times a rollout is used", low=1, high=1000)
    mini_batches: int = setting(2, "PPO", "parts of a rollout, by env; divides `envs`", low=1)
    clip: float = setting(
        0.2,
        "PPO",
        "clipping range of the probability ratio",
        low=0.0,
        is_of_acting=True,
    )
    value_coefficient: float = setting(
        0.5, "PPO", "weight of the value loss, which is half the squared error", low=0.0
    )
    value_clip: float = setting(
        0.0,
        "PPO",
        "how far an update may move a value before the loss becomes flat; 0: any distance",
        low=0.0,
        is_of_acting=True,
    )
    entropy: float = setting(
        1e-3,
        "PPO",
        "coefficient of the entropy, which is a plain sum over motions and decisions",
        low=0.0,
        is_of_acting=True,
    )
    entropy_end: float = setting(
        -1.0,
        "PPO",
        "coefficient of the entropy at the end of the run, linear in between; -1: no change",
        low=-1.0,
        is_of_acting=True,
    )
    max_grad_norm: float = setting(
        2.0,
        "PPO",
        "largest norm of the gradient; larger gradients are scaled down; 0: no limit",
        low=0.0,
    )
    gamma: float = setting(0.99, "PPO", "discount factor", low=0.0, high=1.0)
    gae_lambda: float = setting(
        0.95,
        "PPO",
        "lambda of generalized advantage estimates",
        low=0.0,
        high=1.0,
        is_of_acting=True,
    )
    timeouts: str = setting(
        "observed",
        "PPO",
        "what an episode cut off by the time limit is worth from there on: the value of its last observation "
        "(`observed`), its value if there were no time limit (`endless`), or nothing (`ends`)",
        choices=("endless", "ends", "observed"),
        is_of_acting=True,
    )
    normalize_advantages: bool = setting(
        True,
        "PPO",
        "normalize advantages to mean 0, variance 1 over all ranks",
        is_of_acting=True,
    )

    teacher_weight: float = setting(
        1.0,
        "PPO",
        "weight, at the start of the run, of the divergence from what the `--teacher` would do",
        low=0.0,
    )
    teacher_share: float = setting(
        0.5,
        "PPO",
        "share of the run over which that weight falls to 0; the rest of the run learns from rewards alone",
        low=0.0,
        high=1.0,
    )

    ranks: int = setting(
        1,
        "Ranks",
        "processes that train together on this machine; ignored under torchrun, which starts them "
        "across machines",
        low=1,
        high=1024,
    )
    sync_fraction: float = setting(
        0.6,
        "Ranks",
        "when this share of the ranks has finished a rollout, the others cut theirs short; 1: wait for all",
        low=0.0,
        high=1.0,
        is_of_acting=True,
    )
    shortest_rollout: float = setting(
        0.25,
        "Ranks",
        "no rank is cut short before this share of its rollout, nor before its first step",
        low=0.0,
        high=1.0,
        is_of_acting=True,
    )

    simulation_threads: int = setting(
        0,
        "Machine",
        "threads per rank that simulate; 0: its share of the processors",
        low=0,
        high=4096,
        may_change=True,
    )
    torch_threads: int = setting(
        0,
        "Machine",
        "threads per rank that compute the network; 0: its share of the processors, or 1 for `state`, whose "
        "layers are too small to split",
        low=0,
        high=4096,
        may_change=True,
    )
    precision: str = setting(
        "bf16",
        "Machine",
        "precision of networks on a GPU; always fp32 on processors",
        choices=("fp32", "tf32", "bf16"),
    )
    cuda_graphs: bool = setting(
        False,
        "Machine",
        "on a GPU, launch all that the policy computes in a step of a rollout as one CUDA graph",
        is_of_acting=True,
    )

    validate_every: int = setting(
        10_000_000,
        "Reports",
        "steps between validations, if there is a validation world; 0: no validation",
        low=0,
    )
    validation_episodes: int = setting(
        200,
        "Reports",
        "how many episodes of the validation world to play, starting with the first; 0: all",
        low=0,
    )
    checkpoint_every: int = setting(
        1_000_000,
        "Reports",
        "steps between checkpoints; 0: only at the end",
        low=0,
        may_change=True,
    )
    keep: int = setting(
        3,
        "Reports",
        "how many of the latest checkpoints to keep, besides the best policy",
        low=1,
        may_change=True,
    )
    window: int = setting(
        1000,
        "Reports",
        "number of episodes over which the training curves are averaged",
        low=1,
        is_of_acting=True,
    )
    log_every: float = setting(
        2.0, "Reports", "seconds between points of the curves", low=0.0, may_change=True
    )

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            require_valid(field, getattr(self, field.name))
        for field in dataclasses.fields(self):
            require_effect(field, self)
        if self.envs % self.mini_batches:
            raise SettingsError(
                f"{self.envs} envs cannot be split into {self.mini_batches} mini-batches; take a "
                "number of envs that mini_batches divides"
            )
        if self.envs % self.halves:
            raise SettingsError(f"{self.envs} envs cannot be split into {self.halves} halves")
        if self.network in OF_THE_PAPER and self.image_size != IMAGE_SIZE:
            raise SettingsError(
                f"image_size: found {self.image_size}, expected {IMAGE_SIZE}, which {self.network} is "
                "made for; the network depth takes others"
            )

    def require_pace(self) -> None:
        """Raises SettingsError if the divergence that paces the learning rate cannot be measured.
        __post_init__() does not check this, so that policies from such runs can still be loaded and
        played."""
        if self.target_kl > 0.0 and self.epochs * self.mini_batches == 1:
            raise SettingsError(
                "--target-kl goes by the divergence before the step of each mini-batch, which is 0 before "
                "the first, and with --epochs 1 and --mini-batches 1 there is no other; take more of "
                "either, or leave --target-kl out"
            )

    def without_camera_noise(self) -> Settings:
        """The same settings without noise in the images."""
        return dataclasses.replace(self, **{name: 0.0 for name in CAMERA_NOISE})

    def without_robot_noise(self) -> Settings:
        """The same settings without noise in the robots' motions and measurements, except for noise
        that the world itself defines."""
        words = latest_words(self.simulation).split()
        kept = [word for word in words if not is_robot_noise(word)]
        return (
            self
            if len(kept) == len(words)
            else dataclasses.replace(self, simulation=" ".join(kept))
        )

    def without_noise(self) -> Settings:
        """The same settings without camera and robot noise, as policies are judged."""
        return self.without_camera_noise().without_robot_noise()

    @classmethod
    def effective(cls, values: Mapping[str, Any], given: Collection[str] = ()) -> Settings:
        """Settings with these values; those that have no effect take their defaults. Raises
        IdleSetting if a setting without effect is among `given`."""
        kept = dict(values)
        while True:
            try:
                return cls(**kept)
            except IdleSetting as error:
                if error.name in given:
                    raise
                del kept[error.name]

    def to_dict(self) -> dict[str, Any]:
        return dataclasses.asdict(self)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Settings:
        """The inverse of to_dict(), also after a round trip through JSON. Unknown names are
        rejected; a missing setting takes its default."""
        unknown = sorted(set(values) - {field.name for field in dataclasses.fields(cls)})
        if unknown:
            raise SettingsError(f"the settings {', '.join(unknown)} are unknown to this version")
        # JSON has no tuples.
        known = {name: tuple(v) if isinstance(v, list) else v for name, v in values.items()}
        return cls(**known)
