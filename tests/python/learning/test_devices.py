"""Where networks run and images are drawn. The devices are those of the stand-in for CUDA's driver, or made up."""

from __future__ import annotations

import json
import os
import pathlib
import socket
import subprocess
import sys

import numpy as np
import pytest
import torch
from torch.distributed import HashStore

import galactic
from galactic.learning.homes import Homes
from galactic.learning.playing.evaluation import Actor
from galactic.learning.presets import preset
from galactic.learning.ranks import distributed
from galactic.learning.ranks.distributed import Group, device_of, where_words
from galactic.learning.rollouts.environments import Observation
from galactic.learning.saving import checkpoint
from policies import untrained
from programs import SMALL, UPDATE, WORLD, call, needs_worlds

pytestmark = needs_worlds


@pytest.mark.parametrize("devices, ranks, wanted", [(0, 1, "cpu"), (1, 2, "cpu"), (2, 2, "cuda")])
def test_each_rank_has_a_cuda_device_of_its_own_or_none_has(
    monkeypatch: pytest.MonkeyPatch, devices: int, ranks: int, wanted: str
) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: devices > 0)
    monkeypatch.setattr(torch.cuda, "device_count", lambda: devices)
    assert device_of("cpu", 1, ranks) == torch.device("cpu")
    for rank in range(ranks):
        device = torch.device("cuda", rank) if wanted == "cuda" else torch.device("cpu")
        assert device_of("auto", rank, ranks) == device
        if wanted == "cuda":
            assert device_of("cuda", rank, ranks) == device


@pytest.mark.parametrize("name", ["auto", "cuda"])
def test_ranks_that_see_one_cuda_device_each_take_it(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)
    monkeypatch.setattr(torch.cuda, "device_count", lambda: 1)
    monkeypatch.setattr(distributed, "_uuid_of_first", lambda: "first")
    store = HashStore()
    here = socket.gethostname()
    for other, is_dealt in (
        (f"{here} second", True),
        ("elsewhere first", True),
        (f"{here} first", False),
        ("", False),
    ):
        store.set("device/1", other)
        assert distributed.devices_are_dealt(store, 0, 2) == is_dealt
    assert device_of(name, 1, 2, is_dealt=True) == torch.device("cuda", 0)
    assert device_of("cpu", 1, 2, is_dealt=True) == torch.device("cpu")
    monkeypatch.setattr(torch.cuda, "device_count", lambda: 2)
    store.set("device/1", f"{here} second")
    assert not distributed.devices_are_dealt(store, 0, 2)


def test_a_run_says_where_its_networks_are(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)
    monkeypatch.setattr(torch.cuda, "device_count", lambda: 3)
    monkeypatch.setattr(torch.cuda, "get_device_name", lambda device: f"GPU {device.index}")
    monkeypatch.setenv("LOCAL_WORLD_SIZE", "8")
    cuda = Group(0, 8, torch.device("cuda", 2))
    assert where_words(cuda, "cuda, GPU 2") == (
        "networks run on cuda:2 (GPU 2); images are drawn by cuda, GPU 2 (rank 0)"
    )
    assert where_words(Group.alone(), None) == (
        "networks run on the processor, though there are CUDA devices: 3 of them for 8 ranks here"
    )


def of_stand_in(script: str) -> str:
    """What a program prints that finds the stand-in for CUDA's driver, with its two devices."""
    places = {"LD_LIBRARY_PATH": os.environ["GALACTIC_CUDA_STANDIN"]}
    done = subprocess.run(
        [sys.executable, "-B", "-c", script], env={**os.environ, **places}, capture_output=True, text=True  # fmt: skip
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_images_are_drawn_on_the_device_of_the_networks() -> None:
    drawn_by = of_stand_in(
        f"""
import galactic, torch
from galactic.learning.homes import Homes
from galactic.learning.presets import preset
settings = preset("quick-depth", envs=2, halves=1, mini_batches=1, image_size=36)
world = galactic.World({str(WORLD)!r})
look = {{"camera": "follow", "width": 32, "height": 32}}
for device in (torch.device("cuda", 1), torch.device("cuda", 0)):
    homes = Homes(world, settings, 1, device=device)
    both = Homes(world, settings, 1, device=device, onlooker=look)
    print(homes.drawn_by, *(one.description for one in both.env.renderers[0].values()), sep="; ")
"""
    )
    second, first = drawn_by.splitlines()
    assert second.count("Stand-in B") == 3 and first.count("Stand-in A") == 3


def test_the_processor_draws_where_nothing_can_draw_on_the_device_of_the_networks() -> None:
    settings = preset("quick-depth", envs=2, halves=1, mini_batches=1)
    homes = Homes(galactic.World(WORLD), settings, 1, device=torch.device("cuda", 7))
    assert homes.drawn_by is not None and homes.drawn_by.startswith("soft")
    homes = Homes(galactic.World(WORLD), preset("quick", envs=4, halves=1, mini_batches=1), 1)
    assert homes.drawn_by is None


def test_the_first_device_of_a_rank_is_known_by_its_uuid(monkeypatch: pytest.MonkeyPatch) -> None:
    script = "from galactic.learning.ranks import distributed; print(distributed._uuid_of_first())"
    assert of_stand_in(script) == bytes(range(16)).hex()
    monkeypatch.setenv("CUDA_VISIBLE_DEVICES", "1")
    assert of_stand_in(script) == bytes(range(16, 32)).hex()


def test_a_run_tells_where_it_learns(tmp_path: pathlib.Path) -> None:
    done = call(
        "train", WORLD, "-o", tmp_path / "run", *SMALL, "--steps", UPDATE, "--device", "cpu"
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("networks run on the processor") == 1


def test_policies_run_where_it_is_asked_for(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    policy, report, demos = (tmp_path / name for name in ("policy.pt", "report.json", "demos"))
    settings = preset("quick", envs=4, halves=1, mini_batches=1)
    checkpoint.save_policy(untrained(settings), policy)
    evaluating = ["evaluate", policy, WORLD, "--episodes", 2, "--report", report]
    demonstrating = ["demonstrate", WORLD, "-o", demos, "--expert", policy, "--episodes", 2]
    demonstrating += ["--preset", "quick"]
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    for words in (evaluating, demonstrating):
        refused = call(*words, "--device", "cuda")
        assert refused.returncode == 1 and "this torch has no CUDA device" in refused.stderr
        done = call(*words, "--device", "cpu")
        assert done.returncode == 0, done.stderr
    assert json.loads(report.read_text())["device"] == "cpu"


@pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU")
def test_a_policy_on_a_gpu_does_as_one_on_a_processor(tmp_path: pathlib.Path) -> None:
    settings = preset("quick", envs=4, halves=1, mini_batches=1)
    saved, seen = untrained(settings), torch.rand(4, untrained(settings).shape.state)
    starts, numbers = np.ones(4, np.bool_), np.arange(4)
    found = []
    for device in (torch.device("cpu"), torch.device("cuda", 0)):
        actor = Actor(saved.policy.to(device), deterministic=False, device=device)
        actor.begin(4)
        found.append(actor.act(Observation(seen), starts, numbers, numbers))
    np.testing.assert_allclose(found[0], found[1], atol=1e-2)
