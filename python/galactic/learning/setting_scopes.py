"""What each setting applies to, and the check that rejects settings without an effect."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, NamedTuple

from galactic.learning.policies.sight import OF_THE_PAPER
from galactic.learning.refusals import SettingsError


class Scope(NamedTuple):
    """The condition under which a setting has an effect."""

    covers: Callable[[Any], bool]
    """Whether the setting has an effect, given the whole Settings."""
    words: str
    """The rest of the message after "applies only to": what the setting applies to, why that is not
    the case, and what to do. Names of other settings in braces stand for their values."""


class IdleSetting(SettingsError):
    """A setting that differs from its default but has no effect. `name`: its name."""

    def __init__(self, name: str, message: str):
        super().__init__(message)
        self.name = name


OF_IMAGES = Scope(
    lambda settings: bool(settings.sight),
    "networks that see images, and the network {network} does not; choose another one, such as depth",
)
OF_COLORS = Scope(
    lambda settings: "rgb" in settings.sight,
    "networks that see colors, and the network {network} does not; choose another one, such as simple_cnn",
)
OF_OWN_NETWORKS = Scope(
    lambda settings: settings.has_own_network,
    "networks of your own, and the network {network} is none; name a class, as FILE.py:CLASS, or leave it out",
)
OF_PERCEPTRONS = Scope(
    lambda settings: settings.network in ("state", "depth"),
    "the networks state and depth, and the network is {network}; choose one of them, or leave it out",
)
OF_CHOSEN_LAYERS = Scope(
    lambda settings: settings.network not in OF_THE_PAPER,
    "the networks state and depth and to networks of your own, and {network} is the paper's, which always has a GRU "
    "of its size and log-stds as outputs; choose another one, or leave it out",
)
OF_WIDTHS = Scope(
    lambda settings: settings.network in ("state", "depth")
    or (settings.has_own_network and settings.recurrent),
    "the networks state and depth and to the GRU (recurrent) behind one of your own; choose one of these, or leave it out",
)
OF_PARAMETERS = Scope(
    lambda settings: settings.log_std == "parameter" and settings.network not in OF_THE_PAPER,
    "log-stds that are parameters, and log_std is {log_std} of the network {network}; take log_std parameter, which "
    "state, depth and networks of your own have, or leave it out",
)


def require_effect(field: dataclasses.Field[Any], settings: Any) -> None:
    """Raises IdleSetting if the setting differs from its default in these Settings but has no
    effect."""
    scope: Scope | None = field.metadata["scope"]
    if scope is None or getattr(settings, field.name) == field.default or scope.covers(settings):
        return
    words = scope.words.format_map(vars(settings))
    raise IdleSetting(field.name, f"{field.name} applies only to {words}")
