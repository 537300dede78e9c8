"""Policy packs from torch modules that were trained in the user's own loop: docs/policies.md."""

from __future__ import annotations

import copy
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import torch
from torch import Tensor, nn

from galactic import _core
from galactic.cameras import options_of_cameras
from galactic.learning.encoders import Inputs
from galactic.learning.packs.content import image_of
from galactic.learning.packs.encoder_layers import PLAIN_LAYERS, beside_memory, followed
from galactic.learning.packs.layers import ExportError, Layers, numbers_of
from galactic.learning.packs.same_actions import (
    ENVS,
    Network,
    made_up,
    require_same_actions,
    step_of,
)
from galactic.learning.policies.privileges import (
    critic_columns,
    of_own_tasks,
    options_of_actor,
    parts_of_actor,
)
from galactic.learning.simulation_words import CHOSEN_BY_TRAINER
from galactic.vector_env import VectorEnv

NO_NOISE = -20.0
"""The logarithm of a standard deviation that is too small to change an action."""


class ActionParameters(NamedTuple):
    """What forward() of a module must return for export_module(): the parameters of the
    distributions from which the actions of T steps of n envs are drawn."""

    mean: Tensor | None = None
    """[T, n, C] float32: the means of the first C actions, which are normally distributed; None:
    there are no such actions."""
    log_deviation: Tensor | None = None
    """[T, n, C], or [C] if constant: natural logarithms of their standard deviations; None: the
    means are the actions."""
    logits: Sequence[Tensor] = ()
    """For each following action that has several values: [T, n, V] for its V values, or, for an
    action of two values, also [T, n, 1], the log-odds of the second."""


def export_module(path: str | pathlib.Path, module: nn.Module, envs: VectorEnv, *,
                  discrete: Sequence[Sequence[float]] = ((0.0, 1.0), (0.0, 1.0)),
                  critic_only: Sequence[str] = (), name: str = "", robot: str = "",
                  trained_with: Mapping[str, Any] | None = None) -> None:  # fmt: skip
    """Makes a policy pack from a torch module, for galactic-run, galactic-dynamics and
    galactic.LearnedPolicy.

    Before the pack is written, it is played on made-up inputs and compared with the module. The
    file is written atomically. The module is not changed, and stays on its device.

    Args:
        path: the pack to write.
        module: has forward(inputs) -> ActionParameters. `inputs` are galactic.learning.encoders.Inputs, of T steps of
            n envs: `state` float32 [T, n, S], the flat observation; `rgb` uint8 [T, n, H, W, 3] and `depth` float32
            [T, n, H, W], if `envs` draw them, which only encoders.Eyes may read; and `previous` float32
            [T, n, A], the previous actions, clamped to [-1, 1] and zero where an episode begins. forward() is traced
            down to layers that a pack has (docs/policies.md). With a memory of M numbers for each env, the module
            has an attribute `memory`, M, and forward(inputs, memory, starts) -> (ActionParameters, memory), `memory`
            float32 [n, M] and `starts` bool [T, n], which it must pass on to galactic.learning.sequences.run_gru().
        envs: the envs in which the module was trained, or others with the same options. They define what is
            observed, what is drawn and which options of the simulation go into the pack. Noise of robots and cameras
            is left out.
        discrete: for each of the last actions, the values that it can have. An action with a single value always
            has that value, and no logits. The actions before these are continuous.
        critic_only: parts of the observation that only the critic saw, and that `inputs.state` lacks.
        name: the name of the policy; by default, that of the file.
        robot: the name of the only robot that the policy may move, such as envs.world.robot; by default, any robot
            with as many actions.
        trained_with: what the pack records about the training, such as {"steps": 6_000_000}.

    Raises ExportError, which names the line, if the module cannot become a pack; TypeError, ValueError and
    SettingsError for other invalid arguments; galactic.Error if the file cannot be written, or a weight is not
    finite.
    """
    if not isinstance(envs, VectorEnv):
        raise TypeError(
            f"envs is a {type(envs).__name__}, expected a galactic.VectorEnv: no pack has what a wrapper does"
        )
    path, values = pathlib.Path(path), [[float(one) for one in of] for of in discrete]
    exported = _Exported(_copied(module), envs, values, ",".join(critic_only))
    content = exported.content(name or path.stem, robot)
    require_same_actions(content, exported.network(), exported.inputs, PLAIN_LAYERS)
    _core.write_policy_pack(path, content, dict(trained_with or {}), "", b"")


class _Exported:
    """A module, and the inputs with which it is tried."""

    def __init__(
        self, module: nn.Module, envs: VectorEnv, values: list[list[float]], critic_only: str
    ):
        self._module = module
        self._values = values
        self._memory = int(getattr(module, "memory", 0))
        self._actions = envs.simulators[0].action_count
        self._motions = self._actions - len(values)
        parts = [(part, at.stop - at.start) for part, at in envs.observation_parts.items()]
        critic_columns(critic_only, parts)
        self._observation = parts_of_actor(critic_only, parts)
        own = of_own_tasks(self._observation)
        if own:
            raise ExportError(
                f"the envs observe {', '.join(own)}, which their task gives in Python alone; leave it out with "
                "critic_only, or play the policy in Python"
            )
        self._options = options_of_actor(critic_only, _options_of(envs))
        self._image = _image_of(envs)
        state = sum(size for _, size in self._observation)
        self.inputs = made_up(state, self._image, self._actions)
        """The inputs with which the module is tried."""

    def content(self, name: str, robot: str) -> dict[str, Any]:
        """The pack in the form that _core.write_policy_pack() takes."""
        arguments = (
            step_of(self.inputs, 0),
            self._no_memory(),
            torch.ones(1, ENVS, dtype=torch.bool),
        )
        tried, _ = self._called(*arguments)
        layers, expected = Layers(), 3 if self._memory else 1
        made = followed(layers, self._module, layers.add("observation"), arguments[:expected])
        if self._memory:
            made = beside_memory(made)
        continuous = None
        if self._motions:
            deviation = _constant_deviations(self._motions, made.log_deviation)
            continuous = {
                "count": self._motions,
                "mean": _number(layers, "mean", made.mean),
                "log_deviation": _number(layers, "log_deviation", deviation),
            }
        logits, discrete = iter(zip(made.logits, tried.logits)), []
        for values in self._values:
            if len(values) == 1:
                # In a pack, an action has at least two values.
                always = _number(layers, "logits", torch.zeros(2))
                discrete.append({"logits": always, "values": 2 * values})
                continue
            of, shaped = next(logits)
            number = _number(layers, "logits", of)
            if shaped.shape[-1] == 1:
                halves = np.array([[-0.5], [0.5]], np.float32)
                number = layers.add("linear", number, outputs=2, weight=halves, bias=None)
            discrete.append({"logits": number, "values": values})
        sees = any(layer["kind"] == "image" for layer in layers.list)
        return {
            "name": name,
            "robot": robot,
            "options": self._options,
            "observation": self._observation,
            "image": self._image if sees else None,
            "layers": layers.list,
            "continuous": continuous,
            "discrete": discrete,
        }

    def network(self) -> Network:
        """The network with which a pack of the module is compared."""

        def heads(inputs: Inputs, memory: Tensor, starts: Tensor) -> tuple[list[Tensor], Tensor]:
            made, memory = self._called(inputs, memory, starts)
            return self._heads(made), memory

        return Network(heads, self._memory)

    def _called(
        self, inputs: Inputs, memory: Tensor, starts: Tensor
    ) -> tuple[ActionParameters, Tensor]:
        """The checked result of the module for one step, and the memory after it."""
        arguments = (memory.clone(), starts.clone()) if self._memory else ()
        try:
            with torch.no_grad():
                made = self._module(inputs, *arguments)
        except Exception as error:  # of the user's code
            said = " ".join(str(error).split()) or "nothing more"
            raise ExportError(
                f"forward() of {type(self._module).__name__} failed on made-up inputs: {type(error).__name__}: {said}"
            ) from error
        if self._memory:
            if not isinstance(made, tuple) or isinstance(made, ActionParameters) or len(made) != 2:
                raise ExportError(
                    f"forward() returned a {type(made).__name__}, expected ActionParameters and the memory after the "
                    f"last step: memory is {self._memory}"
                )
            made, memory = made
            _require_shape("memory", memory, [ENVS, self._memory], "as the attribute memory says")
        if not isinstance(made, ActionParameters):
            raise ExportError(
                f"forward() returned a {type(made).__name__}, expected ActionParameters"
            )
        self._require_parameters(made)
        return made, memory

    def _require_parameters(self, made: ActionParameters) -> None:
        """Raises ExportError if the parameters do not fit the actions of the envs."""
        several = [len(values) for values in self._values if len(values) > 1]
        counts = f"the envs have {self._actions} actions, and `discrete` has the values of the last {len(self._values)}"
        if self._motions:
            shape = [1, ENVS, self._motions]
            _require_shape("mean", made.mean, shape, counts)
            if made.log_deviation is not None:
                is_constant = (
                    isinstance(made.log_deviation, Tensor) and made.log_deviation.dim() == 1
                )
                shape = shape[-1:] if is_constant else shape
                _require_shape("log_deviation", made.log_deviation, shape, counts)
        elif made.mean is not None or made.log_deviation is not None:
            raise ExportError(f"forward() returned mean or log_deviation, expected None: {counts}")
        if not isinstance(made.logits, (list, tuple)) or len(made.logits) != len(several):
            found = len(made.logits) if isinstance(made.logits, (list, tuple)) else "no tuple"
            raise ExportError(
                f"forward() returned logits of {found}, expected those of {len(several)} actions, as many as `discrete` "
                "has with more values than one"
            )
        for logits, values in zip(made.logits, several):
            is_odds = values == 2 and isinstance(logits, Tensor) and logits.shape[-1:] == (1,)
            width = 1 if is_odds else values
            _require_shape("logits", logits, [1, ENVS, width], f"their action has {values} values")

    def _heads(self, made: ActionParameters) -> list[Tensor]:
        """The heads of one step, as in Network."""
        heads = []
        if made.mean is not None:
            deviation = _constant_deviations(self._motions, made.log_deviation)
            heads = [made.mean[0], deviation.expand_as(made.mean)[0]]
        logits = iter(made.logits)
        for values in self._values:
            given = next(logits)[0] if len(values) > 1 else torch.zeros(ENVS, 1)
            heads.append(given if given.shape[-1] == 1 else given[:, 1:] - given[:, :1])
        return heads

    def _no_memory(self) -> Tensor:
        return torch.zeros(ENVS, self._memory)


def _copied(module: nn.Module) -> nn.Module:
    """A copy of the module on the processor, in eval mode; torch.fx changes what it traces."""
    if not isinstance(module, nn.Module):
        raise TypeError(f"module is a {type(module).__name__}, expected a torch.nn.Module")
    try:
        return copy.deepcopy(module).cpu().eval()
    except Exception as error:  # modules may hold anything
        raise ExportError(
            f"{type(module).__name__} cannot be copied ({type(error).__name__}: {error}): keep in it what it acts with"
        ) from error


def _options_of(envs: VectorEnv) -> dict[str, Any]:
    """The options of the simulation that the envs set in addition to the world's, without noise."""
    left_out = CHOSEN_BY_TRAINER.union(_core.Simulator.NOISE_OPTIONS)
    of_world = envs.world.options
    return {
        name: value
        for name, value in envs.simulators[0].options.items()
        if name not in left_out and (name == "task" or value != of_world.get(name))
    }


def _image_of(envs: VectorEnv) -> dict[str, Any] | None:
    """The image that the envs draw; None if they draw none."""
    cameras = options_of_cameras("images", envs.images)
    if len(cameras) > 1:
        raise ExportError(
            f"the envs draw images of the cameras {', '.join(cameras)}, and a policy pack has one: train with one"
        )
    for options in cameras.values():
        image = image_of(options)
        if options.get("color") == "rgba":
            raise ExportError(
                "the envs draw color='rgba', and a policy pack has 'rgb': train with that"
            )
        return image
    return None


def _constant_deviations(motions: int, given: Any) -> Any:
    """The logarithms of deviations in a common form: constants are flattened, and None becomes
    NO_NOISE."""
    if given is None:
        return torch.full((motions,), NO_NOISE)
    return given.flatten() if isinstance(given, Tensor) and given.dim() == 1 else given


def _number(layers: Layers, what: str, made: Any) -> int:
    """The layer that computes what a forward() returns."""
    if isinstance(made, Tensor):
        return layers.add("constant", values=numbers_of(made.flatten()))
    if not isinstance(made, int):
        raise ExportError(f"forward() returns {what} that no layer makes")
    return made


def _require_shape(name: str, found: Any, wanted: list[int], why: str) -> None:
    is_one = isinstance(found, Tensor) and found.is_floating_point()
    if not is_one or list(found.shape) != wanted:
        kind = (
            f"{found.dtype} {list(found.shape)}"
            if isinstance(found, Tensor)
            else type(found).__name__
        )
        raise ExportError(
            f"forward() returned {name} of {kind.removeprefix('torch.')}, expected {wanted} on made-up inputs of one "
            f"step of {ENVS} envs: {why}"
        )
