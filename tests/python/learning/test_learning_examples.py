"""The examples that learn do what they say, in few steps; and the one of PPO computes what it should."""

from __future__ import annotations

import importlib.util
import pathlib
import re
import subprocess
import sys
from types import ModuleType

import numpy as np
import pytest
import torch

import galactic
from programs import HELD_OUT, WORLD, needs_worlds

pytestmark = needs_worlds
SEEN = torch.randn(64, 33, generator=torch.Generator().manual_seed(1))
"""Made-up observations."""
EXAMPLES = pathlib.Path(__file__).parents[3] / "examples" / "python"


def output_of(name: str, *arguments: object) -> str:
    command = [sys.executable, "-B", EXAMPLES / name, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_ppo_trains_and_plays_what_it_kept(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "pick.pt"
    steps = 3 * 32 * 1024
    printed = output_of("ppo.py", WORLD, "--unseen", HELD_OUT, "--steps", steps, "-o", file)
    *progress, result = printed.splitlines()
    for line in progress:
        assert re.search(r"^ *\S+ steps, \S+ a second: \S+% solved, \S+ paid$", line)
    assert re.search(r"[\d.]+% by sampled actions, [\d.]+% by the likeliest$", result)
    kept = torch.load(file)
    assert kept["steps"] == steps and kept["seed"] == 1
    assert kept["agent"]["count"] == steps
    pack = tmp_path / "pick.pack"
    assert output_of("ppo.py", HELD_OUT, "--play", file, "--pack", pack).splitlines() == [result]
    agent = ppo().Agent(**kept["sizes"])
    agent.load_state_dict(kept["agent"])
    with torch.no_grad():
        wanted = agent.policy(agent.features(SEEN)).act(likeliest=True)
    played = galactic.LearnedPolicy(pack, len(SEEN), deterministic=True).act(SEEN.numpy())
    np.testing.assert_allclose(played, wanted, atol=1e-4)
    assert galactic.LearnedPolicy(pack, 1).options == ppo().TASK


def test_sac_trains_and_plays_what_it_kept(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "pick.pt"
    printed = output_of("sac.py", WORLD, "--unseen", HELD_OUT, "--steps", 210 * 256, "-o", file)
    *progress, result = printed.splitlines()
    assert re.search(r"^ *53,760 steps, \S+ a second: \S+% solved, ", progress[-1])
    assert re.search(r"[\d.]+% by sampled actions, [\d.]+% by the likeliest$", result)
    pack = tmp_path / "pick.pack"
    assert output_of("sac.py", HELD_OUT, "--play", file, "--pack", pack).splitlines() == [result]
    kept = torch.load(file)
    agent = example("sac.py").Agent(**kept["sizes"])
    agent.load_state_dict(kept["agent"])
    with torch.no_grad():
        wanted = agent.likeliest(agent.features(SEEN))
    for is_likeliest in (False, True):
        player = galactic.LearnedPolicy(pack, len(SEEN), deterministic=is_likeliest)
        played = player.act(SEEN.numpy())
        np.testing.assert_allclose(played[:, :-1], wanted, atol=1e-4)
        assert not played[:, -1].any()


def ppo() -> ModuleType:
    return example("ppo.py")


def example(name: str) -> ModuleType:
    """The example as a module of its own."""
    spec = importlib.util.spec_from_file_location(f"example_{name[:-3]}", EXAMPLES / name)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_ppo_values_what_time_cuts_off_by_its_last_observation(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of each step, the advantage by its definition: sums of later surprises, episode by episode."""
    example, envs, horizon = ppo(), 6, 24
    monkeypatch.setattr(example, "ENVS", envs)
    monkeypatch.setattr(example, "HORIZON", horizon)
    options = {**example.TASK, "episode_steps": 10}
    homes = galactic.VectorEnv(WORLD, envs, halves=2, copy=False, seed=4, **options)
    torch.manual_seed(4)
    agent = example.Agent(*homes.single_observation_space.shape, len(homes.world.actions) - 2)
    rollout = example.Rollout(homes)
    rollout.collect(agent)
    found, returns = rollout.advantages(agent)
    # The same steps in an env of another kind, which knows each observation.
    other = galactic.VectorEnv(WORLD, envs, seed=4, **options)
    seen, _ = other.reset()
    before, after, paid, ends = [], [], [], []
    for actions in rollout.actions.numpy():
        before.append(seen)
        seen, rewards, terminations, truncations, infos = other.step(actions)
        last = seen.copy()
        for env in np.flatnonzero(terminations | truncations):
            last[env] = infos["final_obs"][env]
        after.append(last)
        paid.append(rewards)
        ends.append(np.select([terminations, truncations], [1, 2]))
    assert {0, 2} <= set(np.ravel(ends).tolist())
    with torch.no_grad():
        values, following = (
            agent.values(agent.features(torch.from_numpy(np.stack(rows)))).double().numpy()
            for rows in (before, after)
        )
    surprises = np.stack(paid) + example.GAMMA * following * (np.stack(ends) != 1) - values
    for env in range(envs):
        for step in range(horizon):
            wanted, weight = 0.0, 1.0
            for later in range(step, horizon):
                wanted += weight * surprises[later, env]
                weight *= example.GAMMA * example.LAMBDA
                if ends[later][env]:
                    break
            assert found[step, env].item() == pytest.approx(wanted, abs=1e-4)
            assert returns[step, env].item() == pytest.approx(wanted + values[step, env], abs=1e-4)


def test_a_network_of_ones_own_becomes_a_pack(tmp_path: pathlib.Path) -> None:
    printed = output_of("export_own.py", WORLD, tmp_path / "own.pack")
    assert re.fullmatch(r"own: paid \S+ in the first step\n", printed)
    assert galactic.LearnedPolicy(tmp_path / "own.pack", 1).options == {
        "task": "pick",
        "bump": True,
    }


def test_a_script_demonstrates_and_is_cloned(tmp_path: pathlib.Path) -> None:
    folder = tmp_path / "demos"
    options = ["--episodes", 20, "--updates", 100]
    printed = output_of("scripted_demonstrations.py", WORLD, HELD_OUT, folder, *options)
    script, clone = map(int, re.findall(r"(?:script|clone) solves (\d+) of 100 episodes", printed))
    assert script > 60 > clone
    shown = galactic.Demonstrations(folder)
    assert f"of {len(shown)} demonstrations" in printed and len(shown) >= 20
    assert dict(shown.about.parts)["geodesic"] == 6
