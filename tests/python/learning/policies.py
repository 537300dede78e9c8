"""Policies that nobody has trained, for tests of what is done with policies."""

from __future__ import annotations


import torch

import galactic
from galactic.learning.homes import Homes
from galactic.learning.policies.networks import PolicyShape
from galactic.learning.saving.checkpoint import SavedPolicy, new_policy
from galactic.learning.settings import Settings
from programs import WORLD


def untrained(settings: Settings, homes: Homes | None = None) -> SavedPolicy:
    """A policy that moves about in `homes`, or in those of the world to learn in: of the same weights whatever
    noise there is in the settings."""
    homes = homes or Homes(galactic.World(WORLD), settings, 1)
    shape = PolicyShape(homes.state_size, homes.motions, homes.decides_terminate)
    torch.manual_seed(3)
    policy = new_policy(settings, shape)
    policy.action.linear.weight.data.normal_(0.0, 0.2)
    return SavedPolicy(policy, settings, shape, homes.parts, 0, None)
