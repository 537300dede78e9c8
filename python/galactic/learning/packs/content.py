"""The contents of the policy pack of a trained policy: docs/policies.md."""

from __future__ import annotations

import math
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import torch
from torch import Tensor

from galactic import _core, files
from galactic.cameras import stands_in_world
from galactic.learning.encoders import Inputs
from galactic.learning.homes import camera_options
from galactic.learning.packs.encoder_layers import PLAIN_LAYERS, encoded
from galactic.learning.packs.layers import ExportError, Layers, numbers_of
from galactic.learning.packs.same_actions import Network, made_up, require_same_actions
from galactic.learning.policies.distributions import DECISIONS, HIGHEST_LOG_STD, LOWEST_LOG_STD
from galactic.learning.policies.networks import (
    ActorHead,
    EncoderPolicy,
    FeedForwardPolicy,
    Policy,
    RecurrentPolicy,
)
from galactic.learning.policies.privileges import of_own_tasks, options_of_actor, parts_of_actor
from galactic.learning.policies.sight import FARTHEST
from galactic.learning.refusals import refusing
from galactic.learning.saving import checkpoint
from galactic.learning.setting_fields import typed
from galactic.learning.simulation_words import simulation_keywords
from galactic.learning.user_code import own_code


def export_policy(file: pathlib.Path, output: pathlib.Path, name: str = "", robot: str = "",
                  network: str | None = None) -> None:  # fmt: skip
    """Reads the checkpoint `file` and writes the policy pack `output`. `network`: the value of
    --network."""
    code = own_code.named(network, "--network").file if network is not None else None
    files.require_apart({"--out": output}, [file, *([code] if code else [])])
    saved = checkpoint.read_policy(file, network)
    trained_with = {
        field.replace("_", "-"): typed(value) for field, value in saved.settings.to_dict().items()
    }
    trained_with["trained-steps"] = saved.steps
    trained_with["success"] = saved.success
    with refusing(f"{file} cannot become a policy pack", "take another policy"):
        content = content_of(saved, name or output.stem, robot)
        _core.write_policy_pack(output, content, trained_with, file.name, file.read_bytes())


def fault_of(policy: Policy) -> str:
    """Why the encoder of a policy cannot become layers of a pack, whatever its weights; "" if it
    can. User code may raise any exception when it is traced, and can be trained nevertheless."""
    layers = Layers()
    try:
        encoded(layers, policy.encoder, layers.add("observation"))
    except ExportError as error:
        return str(error)
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return ""


def content_of(saved: checkpoint.SavedPolicy, name: str, robot: str = "") -> dict[str, Any]:
    """A saved policy in the form that _core.write_policy_pack() takes, without the critic and
    without what only the critic sees. Raises ExportError if the policy cannot become a pack, or if
    the pack would act differently."""
    policy, privileges = saved.policy, saved.settings.critic_only
    observation = parts_of_actor(privileges, saved.parts)
    own = of_own_tasks(observation)
    if own:
        raise ExportError(
            f"the policy observes {', '.join(own)}, which its task {saved.settings.task} gives in Python "
            "alone; train one that keeps it for the critic (--critic-only), or play this one in Python"
        )
    layers = Layers()
    columns = [n for n in range(saved.shape.state) if n not in saved.shape.critic_only]
    seen = layers.seen(policy, layers.add("observation"), columns)
    if isinstance(policy, FeedForwardPolicy):
        features = layers.module(policy.encoder, seen)
    elif isinstance(policy, (RecurrentPolicy, EncoderPolicy)):
        features = encoded(layers, policy.encoder, seen)
        if isinstance(policy, RecurrentPolicy):
            features = layers.gru(policy.rnn, features)
    else:
        raise ExportError(f"the policy {type(policy).__name__} is unknown")
    actions = _actions(layers, policy.action, features)
    content: dict[str, Any] = {
        "name": name,
        "robot": robot,
        "options": options_of_actor(
            privileges, simulation_keywords(saved.settings.without_robot_noise().simulation)
        ),
        "observation": observation,
        "image": image_of(camera_options(saved.settings)) if saved.settings.sight else None,
        "layers": layers.list,
        **actions,
    }
    inputs = made_up(saved.shape.state, content["image"], saved.shape.motions + DECISIONS)
    remedy = "please report it" if saved.network is None else PLAIN_LAYERS
    require_same_actions(content, _network_of(policy, columns), inputs, remedy)
    return content


def _network_of(policy: Policy, columns: Sequence[int]) -> Network:
    """The network with which a pack of the policy is compared. The pack observes these columns of
    the state."""

    def heads(inputs: Inputs, memory: Tensor, starts: Tensor) -> tuple[list[Tensor], Tensor]:
        if not policy.needs_previous:
            inputs = inputs._replace(previous=None)
        with torch.no_grad():
            said = policy.act(inputs, memory if policy.hidden_size else None, starts)
        made = said.actions
        decided = [made.logits[0, :, number : number + 1] for number in range(DECISIONS)]
        after = memory if said.hidden is None else said.hidden
        return [made.mean[0], made.log_std[0], *decided], after

    return Network(heads, policy.hidden_size, columns)


def _actions(layers: Layers, head: ActorHead, features: int) -> dict[str, Any]:
    motions = head.motions
    rows = layers.module(head.linear, features)
    mean = layers.add("tanh", layers.add("slice", rows, first=0, size=motions))
    if head.log_std is None:
        given = layers.add("slice", rows, first=motions, size=motions)
    else:
        given = layers.add("constant", values=numbers_of(head.log_std))
    log_std = layers.add("clamp", given, lower=LOWEST_LOG_STD, upper=HIGHEST_LOG_STD)
    first = head.linear.out_features - 2 * DECISIONS
    discrete = []
    for decision in range(DECISIONS):
        logits = layers.add("slice", rows, first=first + 2 * decision, size=2)
        if head.odds_limit > 0.0:
            logits = _limited(layers, head.odds_limit, logits)
        # If the policy does not decide when to terminate, both values are 0.
        is_decided = decision + 1 < DECISIONS or head.decides_terminate
        discrete.append({"logits": logits, "values": [0.0, 1.0] if is_decided else [0.0, 0.0]})
    continuous = {"count": motions, "mean": mean, "log_deviation": log_std}
    return {"continuous": continuous, "discrete": discrete}


def _limited(layers: Layers, limit: float, logits: int) -> int:
    """The logits of no and yes, with their difference limited: each gets half of it, with opposite
    signs."""
    half = np.array([[0.5, -0.5], [-0.5, 0.5]], np.float32)
    apart = layers.add("linear", logits, outputs=2, weight=half, bias=None)
    return layers.times(0.5 * limit, layers.closeup(0.5 * limit, apart, 2), 2)


def image_of(options: Mapping[str, Any]) -> dict[str, Any]:
    """The image drawn with these options of galactic.Renderer, in the form that
    _core.write_policy_pack() takes."""
    seen = {**_core.Renderer.DEFAULTS, **options}
    if stands_in_world(seen):
        raise ExportError(
            "the camera stands in the world (world_from_camera), and a policy pack has one on the robot: train with that"
        )
    if not seen["robot"]:
        raise ExportError(
            "the images are drawn without the robot, and a policy pack has none such: train with robot=True"
        )
    return {
        "width": seen["width"],
        "height": seen["height"],
        "color": seen["color"] is not None,
        "color_scale": 1.0 / 255.0,
        "depth": seen["depth"],
        "depth_limit": FARTHEST,
        "depth_scale": 1.0 / FARTHEST,
        "camera": seen["camera"],
        "vertical_fov": math.radians(seen["fov_degrees"]),
        "position": seen["position"],
        "rpy_degrees": seen["rpy_degrees"],
        "near": seen["near"],
    }
