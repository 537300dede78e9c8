"""Where tests have networks of one's own: a file, and policies that were made of it."""

from __future__ import annotations

import pathlib
import sys
from typing import Any

import pytest
import torch

from galactic.learning.saving import checkpoint
from galactic.learning.settings import Settings
from galactic.learning.user_code import own_code, own_networks
from galactic.learning.user_code.own_networks import OwnNetwork, Seen

EXAMPLE = pathlib.Path(__file__).parents[3] / "examples" / "python" / "own_network.py"
NETWORKS = (pathlib.Path(__file__).parent / "odd_networks.py").read_text(encoding="utf-8")
EYES = {"sees": "rgb", "image_size": 36}
SEEN = Seen(6, {"way": slice(0, 3)}, {}, 4)


@pytest.fixture
def lab(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """NETWORKS in a file of their own."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    file = tmp_path / "lab.py"
    file.write_text(NETWORKS, encoding="utf-8")
    return file


def named(file: pathlib.Path, name: str, options: str = "") -> OwnNetwork:
    found = own_networks.network_of(own_code.named(f"{file}:{name}", "--network"))
    return own_networks.with_options(found, options)


def with_line(message: str, name: str) -> str:
    """`message` with the line of NETWORKS in which a network fails in place of "{line}"."""
    lines = [n for n, one in enumerate(NETWORKS.splitlines(), 1) if one.endswith(f"  # {name}")]
    return message.replace("{line}", str(lines[0])) if lines else message


def saved_policy(own: OwnNetwork, **settings: Any) -> checkpoint.SavedPolicy:
    parts = [("robot_target", 3), ("joints", 3)]
    made = Settings(**{"network": str(own.code), "simulation": "task=pick", **settings})
    shape = checkpoint.PolicyShape(6, 9)
    torch.manual_seed(2)
    policy = checkpoint.new_policy(made, shape, parts, own)
    policy.action.linear.weight.data.normal_(0.0, 0.3)
    return checkpoint.SavedPolicy(policy.eval(), made, shape, parts, 1, None, {}, own)
