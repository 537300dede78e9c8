"""Files that hold policies and the state of a run, which appear whole or not at all.

A .pt file is a dictionary that `torch.load(..., weights_only=True)` reads: tensors under their
names, and everything else as JSON text under "values" (in that mode, torch 1.13 reads no plain
floats). The number "format" comes first; files whose format is not FORMAT are rejected. A policy.pt
holds:

    policy      the network's state_dict
    values      settings  Settings.to_dict()
                shape     PolicyShape._asdict()
                parts     names and sizes of the parts of an observation, in order: [[name, size], ...]
                meanings  what their numbers mean: sensors.meaning_of()
                network_digest  SHA-256 of the file of a network of one's own
                steps     steps of training
                success   success rate by which it was judged, or null
                return    the mean return of the same episodes, or null
"""

from __future__ import annotations

import io
import json
import math
import os
import pathlib
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import torch
from torch import Tensor

from galactic import files
from galactic._core import ErrorCode
from galactic.errors import Error
from galactic.learning.encoders import Encoder
from galactic.learning.policies.networks import Policy, PolicyShape, make_policy
from galactic.learning.policies.outlines import Outlined, give_memory
from galactic.learning.policies.privileges import critic_columns, names_of
from galactic.learning.policies.sight import OF_THE_PAPER
from galactic.learning.refusals import (
    CheckpointError,
    NetworkError,
    SettingsError,
    refusing,
    require_types,
)
from galactic.learning.settings import Settings
from galactic.learning.user_code.own_code import place_beside
from galactic.learning.user_code.own_networks import OwnNetwork, own_network, seen_by, with_options

FORMAT = 1
"""The format of all files that save() writes, and the only one that load() reads. It changes if
names or meanings do."""
# The first bytes of every pack: docs/packs.md.
_PACK = b"GALAPACK"
_ANOTHER_POLICY = "take best.pt or a policy.pt of a run"


@dataclass
class SavedPolicy:
    """A policy as it was saved. `parts`: names and sizes of the parts of its observations.
    `success`, `mean_return`: of the episodes by which it was judged; None if it was not judged.
    `meanings`: what the numbers of its observations mean (sensors.meaning_of()), as far as that is
    known. `network`: what made its network, if that is user-defined."""

    policy: Policy
    settings: Settings
    shape: PolicyShape
    parts: list[tuple[str, int]]
    steps: int
    success: float | None
    meanings: Mapping[str, Any] = field(default_factory=dict)
    network: OwnNetwork | None = None
    mean_return: float | None = None


class Score(NamedTuple):
    """How well a policy did in some episodes; None for what is unknown."""

    success: float | None = None
    mean_return: float | None = None

    def is_below(self, other: Score) -> bool:
        """Whether this score has fewer successes, or as many successes and a smaller return: the
        return decides in tasks without successes. An unknown value is below every known one."""
        ours, theirs = (
            [-math.inf if one is None else one for one in score] for score in (self, other)
        )
        return ours < theirs


def new_policy(settings: Settings, shape: PolicyShape, parts: Sequence[tuple[str, int]] = (),
               network: OwnNetwork | None = None) -> Policy:  # fmt: skip
    """The policy that the settings describe, with weights from torch's global random stream.
    `network` makes a user-defined network, which is told where the `parts` of an observation
    are."""
    return _policy_around(_own_encoder(settings, shape, parts, network), settings, shape)


def _own_encoder(settings: Settings, shape: PolicyShape, parts: Sequence[tuple[str, int]],
                 network: OwnNetwork | None) -> Encoder | None:  # fmt: skip
    if network is None:
        return None
    return network.make(seen_by(settings, shape, parts), settings.recurrent)


def _policy_around(encoder: Encoder | None, settings: Settings, shape: PolicyShape) -> Policy:
    free = settings.log_std == "parameter"
    return make_policy(
        settings.network,
        shape,
        image_size=settings.image_size,
        recurrent=settings.recurrent,
        width=settings.width,
        layers=settings.layers,
        activation=settings.activation,
        initial_log_std=settings.initial_log_std if free else None,
        odds_limit=settings.odds_limit,
        own=encoder,
    )


def save_policy(saved: SavedPolicy, file: pathlib.Path) -> None:
    """Writes a policy.pt, atomically."""
    values = {
        "settings": saved.settings.to_dict(),
        "shape": saved.shape._asdict(),
        "parts": [list(part) for part in saved.parts],
        "meanings": dict(saved.meanings),
        # No digest for a module: its author is responsible for its versions.
        "network_digest": saved.network.digest if saved.network and saved.network.code.file else "",
        "steps": saved.steps,
        "success": saved.success,
        "return": saved.mean_return,
    }
    save(file, values, {"policy": saved.policy.state_dict()})


def load_policy(file: pathlib.Path, remedy: str = "", network: OwnNetwork | None = None,
                without: str = "") -> SavedPolicy:  # fmt: skip
    """Reads a policy.pt or best.pt; the policy is on the processor, ready to act. `remedy` is as in
    load(). `network` makes a user-defined network: the user must name it, as no file runs code by
    itself. `without` says what to do if it was not named."""
    values, tensors = load(file, remedy)
    remedy = remedy or _ANOTHER_POLICY
    if "policy" not in tensors:
        raise CheckpointError(f"{file} holds no policy; {remedy}")
    with refusing(f"{file} is not a policy of this version", remedy):
        require_types(values, _POLICY)
        settings = Settings.from_dict(values["settings"])
        if not settings.has_own_network:
            network = None
        else:
            network = _same_network(file, settings, values["network_digest"], network, without)
        return _policy_of(values, tensors["policy"], settings, network)


def read_score(file: pathlib.Path, remedy: str) -> Score:
    """The score of the policy in a policy.pt or best.pt. `remedy` is as in load()."""
    values, _ = load(file, remedy)
    with refusing(f"{file} is not a policy of this version", remedy):
        require_types(values, _SCORE)
        return Score(values["success"], values["return"])


def read_policy(path: str | pathlib.Path, network: str | None = None) -> SavedPolicy:
    """Reads the best.pt or a policy.pt of a run of galactic.train. The `policy` of the result is a
    torch module, on the processor, ready to act.

    `network`, FILE.py:CLASS or MODULE:CLASS, is the class of a user-defined network, as in
    --network: no file runs code by itself. Raises CheckpointError if the file is not a policy,
    SettingsError if `network` is missing or not needed, and galactic.Error if the file cannot be
    read.
    """
    file, named = pathlib.Path(path), own_network(network) if network is not None else None
    saved = load_policy(file, network=named)
    if named is not None and saved.network is None:
        raise SettingsError(
            f"--network: found {named.code}, and {file} has the network {saved.settings.network}; leave it out"
        )
    return saved


def _same_network(file: pathlib.Path, settings: Settings, digest: str,
                  network: OwnNetwork | None, without: str) -> OwnNetwork:  # fmt: skip
    """The network named for a policy, with the options of its training. Raises NetworkError if it
    is not the one with which the policy learned."""
    place = place_beside(file, "--network", settings.network)
    trusted = f"if you trust it, add --network {shlex.quote(place)}"
    learned = f"{file} was trained with a network of its own, {settings.network!r}"
    if network is None:
        raise NetworkError(f"{learned}; {without or trusted}")
    if network.code.name != settings.network.rpartition(":")[2]:
        raise NetworkError(f"{learned}, found --network {network.code}; {without or trusted}")
    if digest and network.digest != digest:
        raise NetworkError(
            f"{learned}, and {network.code.place} is another file than it was then; put it back, or name the copy "
            "that a run keeps, network.py"
        )
    return with_options(network, settings.network_options)


# The JSON types of the values in a policy.pt, and of its shape.
_SCORE = {"success": (float, int, type(None)), "return": (float, int, type(None))}
_POLICY: dict[str, Any] = {
    "settings": dict,
    "shape": dict,
    "parts": list,
    "meanings": dict,
    "network_digest": str,
    "steps": int,
    **_SCORE,
}
_SHAPE = {
    "state": int,
    "motions": int,
    "decides_terminate": bool,
    "normalize": bool,
    "closeup": (float, int),
    "second_closeup": (float, int),
    "critic_only": (list, tuple),
}


MOST_NUMBERS = 1 << 20
"""Limit of the sizes in the shape of a policy that is read."""


def _policy_of(values: dict[str, Any], state: dict[str, Any], settings: Settings,
               network: OwnNetwork | None) -> SavedPolicy:  # fmt: skip
    sizes = dict(values["shape"])
    require_types(sizes, _SHAPE)
    for name in ("state", "motions"):
        if not 0 <= sizes[name] <= MOST_NUMBERS:
            raise ValueError(f"{name}: found {sizes[name]}, expected 0 to {MOST_NUMBERS}")
    sizes["critic_only"] = tuple(sizes["critic_only"])
    shape = PolicyShape(**sizes)
    parts = [(str(name), int(size)) for name, size in values["parts"]]
    _require_columns(settings, shape, parts)
    # The user's class may draw random numbers; loading a policy must not advance the caller's
    # stream.
    with torch.random.fork_rng(devices=[]):
        encoder = _own_encoder(settings, shape, parts, network)
    # The settings in a stranger's file may describe a network of any size, so no memory is
    # allocated yet.
    with Outlined():
        policy = _policy_around(encoder, settings, shape)
    wanted = policy.state_dict()
    require_tensors(state, wanted)
    for name in wanted:
        _require_own_memory(name, state[name])
    give_memory(policy)
    policy.load_state_dict(state)
    policy.eval()
    return SavedPolicy(
        policy,
        settings,
        shape,
        parts,
        values["steps"],
        values["success"],
        values["meanings"],
        network,
        values["return"],
    )


def _require_columns(settings: Settings, shape: PolicyShape, parts: list[tuple[str, int]]) -> None:
    """Raises ValueError if the critic-only columns of the shape are not those of the settings."""
    names = names_of(settings.critic_only)
    # The sizes come from a stranger's file, so compare the counts before listing columns.
    count = sum(max(size, 0) for name, size in parts if name in names)
    found = shape.critic_only
    if count != len(found) or critic_columns(settings.critic_only, parts) != found:
        wanted = ", ".join(names) or "nothing"
        raise ValueError(f"critic_only: found columns {found}, expected those of {wanted}")


def require_tensors(found: Any, wanted: Mapping[str, Tensor]) -> None:
    """Raises ValueError unless `found` is a dictionary with tensors of these names, shapes and
    types: torch would broadcast some to fit."""
    tensors = found if isinstance(found, dict) else {}
    for name, tensor in wanted.items():
        one = _described(tensors.get(name))
        if one != _described(tensor):
            raise ValueError(f"{name}: found {one}, expected {_described(tensor)}")


def _require_own_memory(name: str, tensor: Tensor) -> None:
    """Raises ValueError if elements of a tensor share memory: a small file could then hold a tensor
    of any size."""
    places = 1 + sum((size - 1) * step for size, step in zip(tensor.shape, tensor.stride()))
    if tensor.numel() > max(places, 0):
        raise ValueError(
            f"{name}: found {tensor.numel()} numbers in {places} places, expected one place for each"
        )


def _described(value: Any) -> str:
    """Describes a tensor, as "float32 [16, 4]", or says what a value is instead."""
    if value is None:
        return "nothing"
    if not isinstance(value, Tensor):
        return f"{type(value).__name__}, which is no tensor"
    return f"{str(value.dtype).removeprefix('torch.')} {list(value.shape)}"


NEW_TERMINATE_LOGIT = -4.0
"""Log-odds, in every state, of a terminate action that the policy has not learned yet: it
terminates in one step of 55."""

_NETWORK = (
    "network",
    "network_options",
    "sees",
    "image_size",
    "recurrent",
    "width",
    "layers",
    "activation",
    "log_std",
)


def begin_with(policy: Policy, settings: Settings, shape: PolicyShape,
               parts: list[tuple[str, int]], file: pathlib.Path,
               network: OwnNetwork | None = None) -> SavedPolicy:  # fmt: skip
    """Gives `policy`, a new_policy(settings, shape, parts, network), the weights of the policy in
    `file`: networks, standard deviations, means and variances of observations. Returns the policy
    read from the file.

    Both must have the same network and see the same observations; CheckpointError says where they
    differ. The task may differ. If only the new policy decides when to terminate, that decision
    starts with NEW_TERMINATE_LOGIT, since its weights in the file were never trained.
    """
    saved = load_policy(file, network=network)
    ours = {name: getattr(settings, name) for name in _NETWORK}
    theirs = {name: getattr(saved.settings, name) for name in _NETWORK}
    if settings.network in OF_THE_PAPER:
        ours = {"network": ours["network"]}
    for described, of, seen, made in (
        (ours, shape, parts, settings),
        (theirs, saved.shape, saved.parts, saved.settings),
    ):
        described.update(
            motions=of.motions,
            normalize=of.normalize,
            closeup=of.closeup,
            second_closeup=of.second_closeup,
            critic_only=", ".join(names_of(made.critic_only)) or "nothing",
            parts=seen,
        )
    for name, wanted in ours.items():
        found = theirs[name]
        if found == wanted:
            continue
        fault = f"{name}: found {found}, expected {wanted}"
        if name == "parts":
            fault = f"observations: {_difference(dict(found), dict(wanted))}"
        raise CheckpointError(
            f"{file} does not fit this run: {fault}; give this run the same network, simulation and "
            "robot, or start without it"
        )
    policy.load_state_dict(saved.policy.state_dict())
    if shape.decides_terminate and not saved.shape.decides_terminate:
        policy.action.start_terminate(NEW_TERMINATE_LOGIT)
    return saved


def _difference(policy: dict[str, int], run: dict[str, int]) -> str:
    """How the observations of a policy and of a run differ, given names and sizes of their
    parts."""
    faults = [
        f"{who} lacks {', '.join(name for name in has if name not in lacks)}"
        for who, lacks, has in (("the run", run, policy), ("the policy", policy, run))
        if has.keys() - lacks.keys()
    ]
    faults += [
        f"{name} has {size} numbers in the policy and {run[name]} in the run"
        for name, size in policy.items()
        if run.get(name, size) != size
    ]
    return " and ".join(faults) or "the same in another order"


def load(file: pathlib.Path, remedy: str = "") -> tuple[dict[str, Any], dict[str, Any]]:
    """Reads the values and tensors of a file. Rejects files that would run code, and those whose
    format is not FORMAT. `remedy`: what to do if the file is not a checkpoint; by default, the
    message says where to find a policy."""
    try:
        handle = open(file, "rb")
    except OSError as error:
        if isinstance(error, IsADirectoryError):
            remedy = remedy or _ANOTHER_POLICY
        message = f"cannot open the file: {error.strerror}" + (remedy and f"; {remedy}")
        raise Error(ErrorCode.IO, str(file), message) from None
    with handle:
        if handle.read(len(_PACK)) == _PACK:
            play = "play a policy pack with galactic-run --policy, or give the best.pt that it was made of"
            raise CheckpointError(f"{file} is a pack, and no checkpoint; {remedy or play}")
        handle.seek(0)
        try:
            contents = torch.load(handle, map_location="cpu", weights_only=True)
            values = json.loads(contents.pop("values"))
            if not isinstance(values, dict):
                raise ValueError("its values have no names")
        except Exception as error:  # torch's readers raise all kinds of exceptions
            # Torch's own message advises to let the file run code, so it is not shown.
            raise CheckpointError(
                f"{file} cannot be read as a checkpoint: found {os.fstat(handle.fileno()).st_size:,} "
                f"bytes of something else, or a part of one; {remedy or _ANOTHER_POLICY}"
            ) from error
    found = values.pop("format", None)
    if found != FORMAT:
        raise CheckpointError(
            f"{file} has {'no format' if found is None else f'format {found}'}, and this version reads format "
            f"{FORMAT}; use it with the version of galactic that wrote it, or train anew"
        )
    return values, contents


def save(file: pathlib.Path, values: dict[str, Any], tensors: dict[str, Any]) -> None:
    """Writes what load() reads, atomically."""
    # Written to memory first, as torch aborts the process if the disk is full.
    contents = io.BytesIO()
    torch.save({"values": json.dumps({"format": FORMAT, **values}), **tensors}, contents)
    files.write_atomically(file, lambda handle: handle.write(contents.getbuffer()))
