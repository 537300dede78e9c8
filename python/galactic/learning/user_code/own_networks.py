"""User-defined networks: encoders that the user writes, and checks that report what is wrong with
one before training begins."""

from __future__ import annotations

import hashlib
import inspect
import pathlib
import traceback
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import torch
from torch import Tensor

from galactic.learning.encoders import Encoder, Inputs
from galactic.learning.policies.networks import PolicyShape
from galactic.learning.policies.privileges import parts_of_actor
from galactic.learning.refusals import NetworkError, SettingsError
from galactic.learning.settings import Settings
from galactic.learning.user_code.own_code import (
    CodeName,
    class_of,
    goes_on,
    keywords_of,
    mismatch,
    named,
    siblings_of,
)

BASE = "galactic.learning.encoders.Encoder"


class Seen(NamedTuple):
    """The sizes of what a network sees: the argument of its class."""

    state: int
    """S, numbers of Inputs.state: normalized as the settings say, without what only the critic
    sees, then their closeups."""
    parts: Mapping[str, slice]
    """The columns of each part of the observation in a row of the state, by name."""
    images: Mapping[str, tuple[int, ...]]
    """The shape of one picture, by name: `rgb` is (height, width, 3), `depth` (height, width)."""
    actions: int
    """A, numbers of Inputs.previous: the motions, then hand and terminate."""

    @property
    def channels(self) -> int:
        """C, channels of a picture from encoders.images()."""
        return 3 * ("rgb" in self.images) + ("depth" in self.images)


def seen_by(settings: Settings, shape: PolicyShape, parts: Sequence[tuple[str, int]]) -> Seen:
    """What the network of a policy with these settings sees."""
    edge = settings.image_size
    places, first = {}, 0
    for name, size in parts_of_actor(settings.critic_only, parts):
        places[name] = slice(first, first + size)
        first += size
    images = {name: (edge, edge, 3) if name == "rgb" else (edge, edge) for name in settings.sight}
    return Seen(shape.seen - shape.apart, places, images, shape.motions + 2)


class _Trial(NamedTuple):
    """Inputs with which a network is tried out."""

    inputs: Inputs
    memory: Tensor  # [n, M]: before the first step
    starts: Tensor  # [T, n] bool

    def part(self, steps: slice, envs: slice) -> _Trial:
        """Some of the steps of some of the envs."""
        parts = [None if one is None else one[steps, envs] for one in self.inputs]
        state, *seen = parts
        assert state is not None
        return _Trial(Inputs(state, *seen), self.memory[envs], self.starts[steps, envs])


class OwnNetwork(NamedTuple):
    """The class of a network, and its arguments. `digest`: SHA-256 of its file, to recognize a
    different one."""

    code: CodeName
    make_encoder: Callable[..., Encoder]
    keywords: Mapping[str, Any]
    digest: str

    def make(self, seen: Seen, recurrent: bool) -> Encoder:
        """Makes the encoder and tries it out. Raises NetworkError if it cannot be part of a policy,
        with a GRU behind it if `recurrent`."""
        with goes_on(self.code, "when it was made; raise an exception instead"):
            encoder = self._tried("__init__()", lambda: self.make_encoder(seen, **self.keywords))
        if recurrent and encoder.memory:
            raise self._fault(
                "has a memory of its own; leave --recurrent out, which puts a GRU behind it"
            )
        self._require_contract(encoder, seen)
        return encoder

    def _require_contract(self, encoder: Encoder, seen: Seen) -> None:
        for name, least in (("features", 1), ("memory", 0)):
            size = getattr(encoder, name)
            if not isinstance(size, int) or size < least:
                raise self._fault(f"has {name} = {size!r}, expected a whole number from {least}")
        trial = _trial(encoder, seen)
        features, _ = self._result(encoder.eval(), trial)
        if not bool(torch.isfinite(features).all()):
            raise self._fault("returned features that are no numbers (NaN or infinite)")
        for name, parameter in encoder.named_parameters():
            if parameter.dtype != torch.float32 or not bool(torch.isfinite(parameter).all()):
                kind = str(parameter.dtype).removeprefix("torch.")
                raise self._fault(
                    f"has a parameter {name} of {kind}, expected float32, and numbers"
                )
        if encoder.memory:
            self._require_forgetting(encoder, trial, features)
        trained, _ = self._result(encoder.train(), trial)
        if not _are_same(trained, features):
            raise self._fault(
                "computes something else while it learns than while it acts, which PPO compares: take LayerNorm or "
                "GroupNorm in the place of BatchNorm, and no Dropout"
            )
        self._require_unmixed(encoder.eval(), trial)

    def _require_forgetting(self, encoder: Encoder, trial: _Trial, features: Tensor) -> None:
        """Checks that the memory before the start of an episode has no effect: all episodes of the
        trial begin in its first step."""
        other, _ = self._result(encoder, trial._replace(memory=torch.ones_like(trial.memory)))
        if not _are_same(other, features):
            raise self._fault(
                "remembers what was before the start of an episode; empty the memory where `starts` is true, "
                "as sequences.run_gru() does"
            )

    def _require_unmixed(self, encoder: Encoder, trial: _Trial) -> None:
        """Checks that steps and envs do not influence each other: a network acts step by step, but
        learns from many steps of any number of envs at once."""
        whole = self._result(encoder, trial)
        steps, envs = trial.starts.shape
        by_step, after = [], trial.memory
        for step in range(steps):
            alone = trial.part(slice(step, step + 1), slice(None))._replace(memory=after)
            features, after = self._result(encoder, alone)
            by_step.append(features)
        by_env = [
            self._result(encoder, trial.part(slice(None), slice(env, env + 1)))
            for env in range(envs)
        ]
        columns, memories = zip(*by_env)
        found = {
            "steps": (torch.cat(by_step), after),
            "envs": (torch.cat(columns, 1), torch.cat(memories)),
        }
        mixed = [
            axis
            for axis, results in found.items()
            if not all(_are_same(one, other) for one, other in zip(results, whole))
        ]
        if mixed:
            each = " and ".join(axis.removesuffix("s") for axis in mixed)
            remedy = (
                "sum, average and sort along the last dimension alone, not along those of [T, n]"
            )
            if encoder.memory:
                remedy += ", and empty the memory in each step where `starts` is true"
            raise self._fault(
                f"mixes {' and '.join(mixed)}: it returns something else for {steps} steps of {envs} envs at once, as "
                f"it learns, than for each {each} by itself, as it acts; {remedy}"
            )

    def _result(self, encoder: Encoder, trial: _Trial) -> tuple[Tensor, Tensor]:
        """The features of a trial, and the memory after its steps."""
        inputs, memory, starts = trial
        steps, envs = starts.shape
        with torch.no_grad(), goes_on(self.code, "in forward(); raise an exception instead"):
            if encoder.memory:
                # The network may change its arguments in place.
                before = memory.clone()
                found = self._tried("forward()", lambda: encoder(inputs, before, starts.clone()))
                if not isinstance(found, tuple) or len(found) != 2:
                    raise self._fault(
                        f"returned {_described(found)}, expected features and memory: memory is {encoder.memory}"
                    )
                features, after = found
            else:
                features = self._tried("forward()", lambda: encoder(inputs))
                after = torch.zeros(envs, 0)
        self._require_shape("features", features, [steps, envs, encoder.features])
        self._require_shape("memory", after, [envs, encoder.memory])
        return features, after

    def _require_shape(self, name: str, found: Any, wanted: list[int]) -> None:
        if (
            not isinstance(found, Tensor)
            or not found.is_floating_point()
            or list(found.shape) != wanted
        ):
            meaning = "[T, n, features]" if name == "features" else "[n, memory]"
            raise self._fault(
                f"returned {name} of {_described(found)}, expected {wanted}, which is {meaning}"
            )

    def _tried(self, method: str, work: Callable[[], Any]) -> Any:
        """The result of `work`. An exception becomes a NetworkError that says where it was
        raised."""
        try:
            return work()
        except Exception as error:  # of the user's code
            lines = traceback.extract_tb(error.__traceback__)
            own = [line for line in lines if line.filename == _source(self.make_encoder)]
            where = f", in line {own[-1].lineno}" if own else ""
            said = " ".join(str(error).split()) or "nothing more"
            raise self._fault(
                f"failed in {method}{where}: {type(error).__name__}: {said}"
            ) from error

    def _fault(self, what: str) -> NetworkError:
        return NetworkError(f"--network: {self.code} {what}")


def own_network(text: str) -> OwnNetwork:
    """The network that `text` names, without options: a policy file holds its own."""
    code = named(text, "--network")
    return network_of(code, siblings_of(code))


def with_options(network: OwnNetwork, options: str) -> OwnNetwork:
    """The same network, to be made with these options. Raises SettingsError if its class does not
    take them."""
    keywords = keywords_of(options, "--network-options")
    fault = mismatch(network.make_encoder, (Seen(0, {}, {}, 0),), keywords)
    if fault:
        raise SettingsError(
            f"--network-options: {network.code} cannot be made of what it sees, one argument, and these: {fault}"
        )
    return network._replace(keywords=keywords)


def network_of(code: CodeName, siblings: pathlib.Path | None = None) -> OwnNetwork:
    """The network whose class `code` names. Its file runs now: see own_code.members_of()."""
    found = class_of(code, Encoder, BASE, siblings)
    if found.forward is Encoder.forward:
        raise NetworkError(f"--network: {code} has no forward(); write one, which returns features")
    return OwnNetwork(code, found, {}, _digest(code, found))


def _digest(code: CodeName, found: type[Encoder]) -> str:
    """SHA-256 of the named file, or of the source of a module's class; "" if there is no source."""
    try:
        file = code.file or pathlib.Path(inspect.getsourcefile(found) or "")
        return hashlib.sha256(file.read_bytes()).hexdigest()
    except (OSError, TypeError):
        return ""


def _trial(encoder: Encoder, seen: Seen) -> _Trial:
    """Two steps of three envs. All episodes begin in the first step; in the second, one env begins
    another."""
    steps, envs = 2, 3
    starts = torch.zeros(steps, envs, dtype=torch.bool)
    starts[0] = starts[1, 0] = True
    inputs = some_inputs(encoder, seen, steps, envs)
    return _Trial(inputs, torch.zeros(envs, encoder.memory), starts)


_SAME = 1e-4
"""The tolerance for sums in a different order, relative to the largest number if that is above
1."""


def _are_same(one: Tensor, other: Tensor) -> bool:
    if not one.numel():
        return True
    largest = max(1.0, float(other.abs().max()))
    return float((one - other).abs().max()) <= _SAME * largest


def some_inputs(encoder: Encoder, seen: Seen, steps: int, envs: int) -> Inputs:
    """Made-up inputs: the same in each call, and different numbers everywhere."""
    random = torch.Generator().manual_seed(1)

    def some(*shape: int) -> Tensor:
        return torch.rand(steps, envs, *shape, generator=random)

    # Pictures of noise all have about the same mean, so each gets its own brightness.
    light = torch.linspace(0.1, 1.0, steps * envs).view(steps, envs, 1, 1)
    rgb = depth = None
    if "rgb" in seen.images:
        rgb = (255.0 * light.unsqueeze(-1) * some(*seen.images["rgb"])).to(torch.uint8)
    if "depth" in seen.images:
        depth = 5.0 * light * some(*seen.images["depth"])
    previous = some(seen.actions) if encoder.needs_previous else None
    return Inputs(some(seen.state), rgb, depth, previous)


def _described(value: Any) -> str:
    if isinstance(value, Tensor):
        return f"{str(value.dtype).removeprefix('torch.')} {list(value.shape)}"
    return type(value).__name__


def _source(found: Any) -> str:
    """The file that defines a class."""
    return str(found.forward.__code__.co_filename)
