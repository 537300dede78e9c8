"""galactic.demonstrate and galactic.train --demonstrations: what experts are kept of, and who learns from
it."""

from __future__ import annotations

import json
import pathlib
import runpy
import shutil
import sys

import numpy as np
import pytest
import torch

import galactic
from galactic import Demonstrations, demonstrate
from galactic.learning.homes import Homes
from galactic.learning.playing import demonstrating
from galactic.learning.playing.evaluation import NO_EPISODE
from galactic.learning.playing.experts import RolledIn
from galactic.learning.saving import checkpoint
from programs import (
    HELD_OUT,
    SMALL,
    UPDATE,
    WORLD,
    call,
    curve,
    files_of_at_most,
    needs_worlds,
    run,
)

pytestmark = needs_worlds
QUICK = ["--preset", "quick"]


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """Demonstrations of 24 episodes of Mobile Pick, in three parts."""
    folder = tmp_path_factory.mktemp("shown") / "demos"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(demonstrate, "EPISODES_OF_PART", 8)
        done = call("demonstrate", WORLD, "-o", folder, *QUICK, "--episodes", 24)
    assert done.returncode == 0, done.stderr
    return folder


def contents(folder: pathlib.Path) -> dict[str, bytes]:
    return {str(f.relative_to(folder)): f.read_bytes() for f in folder.rglob("*.npy")}


def test_demonstrations_are_what_happens_when_their_actions_are_done(shown: pathlib.Path) -> None:
    made = Demonstrations(shown)
    assert len(made) == 24
    assert np.mean([one.is_solved for one in made]) > 0.7
    about = made.about
    assert about.expert == "scripted" and about.world == str(WORLD.resolve())
    assert about.options["task"] == "pick" and about.camera is None
    homes = galactic.VectorEnv(WORLD, len(made), order="partition", **about.options)
    episodes = np.array([one.episode for one in made])
    seen, _ = homes.reset(options={"reset_mask": np.ones(len(made), bool), "episodes": episodes})
    assert dict(about.parts) == {
        name: part.stop - part.start for name, part in homes.observation_parts.items()
    }
    over = np.zeros(len(made), bool)
    for step in range(int(made.lengths.max())):
        under_way = [(env, one) for env, one in enumerate(made) if step < len(one)]
        actions = np.zeros(homes.action_space.shape, np.float32)
        for env, one in under_way:
            np.testing.assert_array_equal(seen[env], one.state[step])
            assert one.by_expert[step]
            actions[env] = one.actions[step]
        seen, rewards, terminated, truncated, infos = homes.step(actions)
        for env, one in under_way:
            assert rewards[env] == one.rewards[step]
            over[env] = terminated[env] or truncated[env]
            assert over[env] == (step + 1 == len(one))
            if over[env]:
                assert infos["final_info"]["ending"][env] == one.ending
                assert len(one.state) == len(one) + 1
                np.testing.assert_array_equal(infos["final_obs"][env], one.state[-1])
    assert over.all()


def test_a_writer_of_ones_own_keeps_the_same(shown: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """And the trainer learns from it."""
    made, mine = Demonstrations(shown), tmp_path / "mine"
    homes = galactic.VectorEnv(WORLD, len(made), **made.about.options)
    episodes = np.array([one.episode for one in made])
    seen, _ = homes.reset(options={"episodes": episodes})
    expert = galactic.ScriptedPolicy(homes.simulators[0])
    with galactic.DemonstrationWriter(mine, homes, expert="scripted", world=WORLD) as writer:
        for _ in range(int(made.lengths.max())):
            actions = expert.act()
            then, rewards, _, _, infos = homes.step(actions)
            writer.add(seen, actions, rewards, infos)
            seen = then
    first: dict[int, galactic.Demonstration] = {}
    for one in Demonstrations(mine):
        first.setdefault(one.episode, one)
    for one in made:
        for name in ("state", "actions", "rewards", "by_expert"):
            np.testing.assert_array_equal(getattr(first[one.episode], name), getattr(one, name))
    options = [*SMALL, "--steps", 2 * UPDATE, "--demonstrations", mine, shown]
    done = call("train", WORLD, "-o", tmp_path / "clone", *options)
    assert done.returncode == 0, done.stderr


def test_they_are_the_same_bytes_whoever_makes_them(
    shown: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In other threads, in another number of envs, and after an interrupt."""
    monkeypatch.setattr(demonstrate, "EPISODES_OF_PART", 8)
    monkeypatch.setattr(demonstrate, "MOST_ENVS", 5)
    options = [WORLD, "-o", tmp_path / "demos", *QUICK, "--episodes", 24, "--threads", 1]
    write = demonstrating.write_part

    def interrupt(part: pathlib.Path, episodes: object) -> None:
        if part.name == "part-000001":
            raise KeyboardInterrupt
        write(part, episodes)  # type: ignore[arg-type]

    with monkeypatch.context() as patch:
        patch.setattr(demonstrating, "write_part", interrupt)
        done = call("demonstrate", *options)
        assert done.returncode == 130 and "the same command makes what is missing" in done.stderr
    assert len(Demonstrations(tmp_path / "demos")) == 8
    kept = (tmp_path / "demos/part-000000/state.npy").stat().st_mtime_ns
    assert call("demonstrate", *options).returncode == 0
    assert (tmp_path / "demos/part-000000/state.npy").stat().st_mtime_ns == kept
    assert contents(tmp_path / "demos") == contents(shown)
    # Complete, there is nothing left to do.
    assert call("demonstrate", *options).returncode == 0
    assert contents(tmp_path / "demos") == contents(shown)


@pytest.mark.parametrize(
    "sight",
    [
        [*QUICK, "--simulation", "laser-beams=8 laser-noise=0.1"],
        [
            "--preset",
            "quick-depth",
            "--image-size",
            36,
            "--depth-noise",
            0.05,
            "--camera-jitter",
            0.02,
        ],
    ],
)
def test_noise_is_the_same_after_an_interrupt(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, sight: list[object]
) -> None:
    for name in ("EPISODES_OF_PART", "EPISODES_WITH_IMAGES"):
        monkeypatch.setattr(demonstrate, name, 1)
    options = [WORLD, "-o", tmp_path / "demos", *sight, "--episodes", 3]
    assert call("demonstrate", *options).returncode == 0
    before = contents(tmp_path / "demos")
    assert before["part-000000/state.npy"] != before["part-000001/state.npy"]
    shutil.rmtree(tmp_path / "demos/part-000001")
    done = call("demonstrate", *options)
    assert done.returncode == 0 and "3 of 3 parts" in done.stderr
    assert contents(tmp_path / "demos") == before


def test_a_full_disk_leaves_nothing_unfinished(tmp_path: pathlib.Path) -> None:
    folder = tmp_path / "demos"
    with files_of_at_most(60_000):
        done = call("demonstrate", WORLD, "-o", folder, *QUICK, "--episodes", 12)
    assert done.returncode == 2
    assert "part-000000: cannot write the file: File too large" in done.stderr
    assert {file.name for file in folder.iterdir()} == {"demonstrations.json", ".lock"}


def test_parts_of_nobody_knows_what_are_left_alone(
    shown: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    folder = tmp_path / "demos"
    shutil.copytree(shown, folder)
    (folder / "demonstrations.json").unlink()
    done = call("demonstrate", WORLD, "-o", folder, *QUICK, "--episodes", 24)
    assert done.returncode == 1 and "holds parts of demonstrations" in done.stderr


def test_a_world_in_which_no_robot_can_start_is_refused(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Homes, "playable_episodes", lambda self: [])
    done = call("demonstrate", WORLD, "-o", tmp_path / "demos", *QUICK)
    assert done.returncode == 3 and "no episode in which the robot can start" in done.stderr


class _Fake:
    """Acts by a number of its own, and remembers what it heard was done."""

    def __init__(self, number: float) -> None:
        self.number = number
        self.heard: list[np.ndarray] = []
        self.acted = np.zeros(2, np.bool_)

    def begin(self, envs: int) -> None:
        pass

    def act(self, seen, starts, episodes, steps) -> np.ndarray:
        self.acted = episodes != NO_EPISODE
        return np.full((2, 4), self.number, np.float32)

    def override_actions(self, actions: np.ndarray) -> None:
        self.heard.append(actions.copy())


def test_both_know_what_was_done() -> None:
    """A memory of what it would have done itself would be one of another episode."""
    learner, expert = _Fake(0.25), _Fake(0.75)
    both = RolledIn(learner, expert, most=5, seed=3)
    both.begin(2)
    for step in range(8):
        done = both.act(None, np.zeros(2, np.bool_), np.array([4, 9]), np.full(2, step))
        np.testing.assert_array_equal(done[:, 0], np.where(both.acted, 0.75, 0.25))
        for one in (learner, expert):
            np.testing.assert_array_equal(one.heard[-1], done)
    assert both.acted.all()
    assert len({tuple(heard[:, 0]) for heard in expert.heard}) == 3, "they switched at once"


def test_others_are_not_mixed_with_them(shown: pathlib.Path) -> None:
    before = contents(shown)
    for options, message in (
        (["--episodes", 16], "episodes: found 24, expected 16"),
        (["--episodes", 24, "--seed", 2], "seed: found 1, expected 2"),
        (["--episodes", 24, "--simulation", "no-distractors"], "simulation: found"),
    ):
        done = call("demonstrate", WORLD, "-o", shown, *QUICK, *options)
        assert done.returncode == 1 and message in done.stderr
    assert contents(shown) == before


@pytest.fixture(scope="module")
def clone(shown: pathlib.Path, tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """The run of a policy that has imitated them for a while."""
    folder = tmp_path_factory.mktemp("clones") / "clone"
    options = [*SMALL, "--steps", 60 * UPDATE, "--validation", WORLD, "--validation-episodes", 8]
    done = call("train", WORLD, "-o", folder, "--demonstrations", shown, *options)
    assert done.returncode == 0, done.stderr
    assert "loss" in done.stderr
    return folder


def test_a_run_imitates_them(clone: pathlib.Path, shown: pathlib.Path) -> None:
    losses = [row["policy_loss"] for row in curve(clone) if row["policy_loss"] is not None]
    assert np.mean(losses[-5:]) < np.mean(losses[:5]) - 1.5
    assert all(row["success"] is None and row["kl"] is None for row in curve(clone))
    report = json.loads((clone / "report.json").read_text(encoding="utf-8"))
    assert report["steps"] == 60 * UPDATE and 0.0 <= report["best_success"] <= 1.0
    saved = checkpoint.load_policy(clone / "best.pt")
    assert saved.parts == Demonstrations(shown).about.parts


def test_an_imitating_run_goes_on_bit_for_bit(shown: pathlib.Path, tmp_path: pathlib.Path) -> None:
    options = [WORLD, *SMALL, "--steps", 8 * UPDATE, "--demonstrations", shown, "--recurrent"]
    whole, paused = tmp_path / "whole", tmp_path / "paused"
    assert call("train", "-o", whole, *options).returncode == 0
    assert call("train", "-o", paused, *options, "--pause-at", 3 * UPDATE).returncode == 0
    assert call("train", "-o", paused, "--resume").returncode == 0
    final = f"checkpoints/{8 * UPDATE:012d}/policy.pt"
    one, two = (checkpoint.load_policy(folder / final) for folder in (whole, paused))
    weights = two.policy.state_dict()
    assert all(torch.equal(value, weights[name]) for name, value in one.policy.state_dict().items())
    assert curve(paused)[-1] == curve(whole)[-1]
    # Other demonstrations would be another run.
    settings = json.loads((paused / "settings.json").read_text(encoding="utf-8"))
    settings["demonstrations"] = [str(tmp_path / "gone")]
    (paused / "settings.json").write_text(json.dumps(settings), encoding="utf-8")
    (paused / "report.json").unlink()
    done = call("train", "-o", paused, "--resume")
    assert done.returncode == 2 and "gone" in done.stderr


def test_two_ranks_imitate_together(shown: pathlib.Path, tmp_path: pathlib.Path) -> None:
    options = [
        "--preset",
        "quick",
        "--envs",
        16,
        "--horizon",
        8,
        "--ranks",
        2,
        "--steps",
        8 * UPDATE,
    ]
    done = run("train", WORLD, "-o", tmp_path / "both", "--demonstrations", shown, *options)
    assert done.returncode == 0, done.stderr
    rows = curve(tmp_path / "both")
    assert rows[-1]["steps"] == 8 * UPDATE and rows[-1]["updates"] == 4


def test_a_run_begins_with_what_it_has_imitated(
    clone: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    options = [*SMALL, "--steps", 2 * UPDATE, "--target-kl", "0.01"]
    done = call(
        "train", WORLD, "-o", tmp_path / "tuned", *options, "--start-from", clone / "best.pt"
    )
    assert done.returncode == 0, done.stderr
    done = call("train", WORLD, "-o", tmp_path / "taught", *SMALL, "--steps", 2 * UPDATE,
                "--teacher", clone / "best.pt")  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_an_expert_goes_on_where_a_learner_has_led(
    clone: pathlib.Path, shown: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    folder = tmp_path / "corrected"
    options = ["--learner", clone / "best.pt", "--learner-steps", 20, "--episodes", 24]
    done = call("demonstrate", WORLD, "-o", folder, *QUICK, *options)
    assert done.returncode == 0, done.stderr
    made = Demonstrations(folder)
    led = [int((~one.by_expert).sum()) for one in made]
    assert len(set(led)) > 8 and max(led) <= 20
    for one, steps in zip(made, led):
        # First the one, then the other.
        assert not one.by_expert[:steps].any() and one.by_expert[steps:].all()
    assert np.mean([one.is_solved for one in made]) > 0.4
    done = call("train", WORLD, "-o", tmp_path / "again", *SMALL, "--steps", UPDATE,
                "--demonstrations", shown, folder)  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_a_policy_can_be_the_expert(clone: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """Also one that sees less than what is kept, and what it did is within the limits of actions."""
    folder = tmp_path / "of_clone"
    sensors = ["--simulation", "laser-beams=8"]
    options = ["--expert", clone / "best.pt", "--episodes", 12, *sensors]
    assert call("demonstrate", WORLD, "-o", folder, *QUICK, *options).returncode == 0
    made = Demonstrations(folder)
    assert dict(made.about.parts)["laser"] == 8
    assert made.about.expert == str((clone / "best.pt").resolve())
    actions = np.concatenate([one.actions for one in made])
    assert np.abs(actions).max() == 1.0
    # Of policies that are sampled, the episode decides what they do, not where it is played.
    again = tmp_path / "again"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(demonstrate, "EPISODES_OF_PART", 12)
        patch.setattr(demonstrate, "MOST_ENVS", 3)
        assert call("demonstrate", WORLD, "-o", again, *QUICK, *options).returncode == 0
    for one, other in zip(made, Demonstrations(again)):
        # Sums of a network depend on how many envs it acts in, in their last bits.
        np.testing.assert_allclose(one.actions[0], other.actions[0], atol=1e-5)


def test_images_are_kept(tmp_path: pathlib.Path) -> None:
    folder = tmp_path / "seen"
    sight = ["--preset", "quick-depth", "--image-size", 36]
    done = call("demonstrate", WORLD, "-o", folder, *sight, "--episodes", 3)
    assert done.returncode == 0, done.stderr
    made = Demonstrations(folder)
    assert made.about.images == {"depth": (36, 36)}
    homes = galactic.VectorEnv(WORLD, 1, images=made.about.camera, **made.about.options)
    episodes = np.array([made[0].episode])
    seen, _ = homes.reset(options={"reset_mask": np.ones(1, bool), "episodes": episodes})
    np.testing.assert_array_equal(seen["depth"][0].astype(np.float16), made[0].depth[0])
    for one in made:
        assert one.depth is not None and one.depth.shape == (len(one) + 1, 36, 36)
        assert 0.0 < one.depth.max() < 20.0
    options = ["--envs", 8, "--horizon", 8, "--ranks", 1, "--steps", 128, "--log-every", 0]
    done = call(
        "train", WORLD, "-o", tmp_path / "clone", *sight, *options, "--demonstrations", folder
    )
    assert done.returncode == 0, done.stderr
    done = call(
        "train", WORLD, "-o", tmp_path / "other", *sight[:2], *options, "--demonstrations", folder
    )
    assert done.returncode == 3 and "found images {'depth': (36, 36)}, expected" in done.stderr
    done = call("train", WORLD, "-o", tmp_path / "wide", *sight, "--fov", 120, *options,
                "--demonstrations", folder)  # fmt: skip
    assert done.returncode == 3 and "fov_degrees 0.0, expected 120.0" in done.stderr
    done = call("train", WORLD, "-o", tmp_path / "noisy", *sight, "--depth-noise", 0.01, *options,
                "--demonstrations", folder)  # fmt: skip
    assert done.returncode == 0, done.stderr


TASK = """
import numpy as np
import galactic

class Hold(galactic.Task):
    base, parts = "pick", {"reach": 1}

    def step(self, envs):
        return galactic.Outcome(envs.rewards + 1.0)

    def observe(self, envs):
        return {"reach": np.linalg.norm(envs.observations["grip_target"], axis=1, keepdims=True)}
"""


def test_without_a_preset_they_are_of_the_papers_task(tmp_path: pathlib.Path) -> None:
    """And have no images, which nobody has asked for."""
    short = ["--simulation", "episode-steps=40"]
    done = call("demonstrate", WORLD, "-o", tmp_path / "demos", "--episodes", 3, *short)
    assert done.returncode == 0, done.stderr
    made = Demonstrations(tmp_path / "demos")
    assert made.about.images == {} and made.about.made_with["settings"]["network"] == "state"
    homes = galactic.VectorEnv(WORLD, 1, **made.about.options)
    assert homes.simulators[0].options["task"] == "rearrange"
    done = call(
        "demonstrate", WORLD, "-o", tmp_path / "seen", "--episodes", 1, "--network", "depth", *short
    )
    assert done.returncode == 0, done.stderr
    assert Demonstrations(tmp_path / "seen").about.images == {"depth": (128, 128)}


def test_they_may_be_of_a_task_of_ones_own(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "hold.py"
    file.write_text(TASK, encoding="utf-8")
    task = ["--task", f"{file}:Hold"]
    options = [WORLD, "-o", tmp_path / "demos", *QUICK, "--episodes", 3, *task]
    done = call("demonstrate", *options)
    assert done.returncode == 0, done.stderr
    made = Demonstrations(tmp_path / "demos")
    assert dict(made.about.parts)["reach"] == 1 and "task" not in made.about.options
    assert min(one.rewards.mean() for one in made) > 0.5
    done = call("train", WORLD, "-o", tmp_path / "clone", *SMALL, "--steps", UPDATE, *task,
                "--demonstrations", tmp_path / "demos")  # fmt: skip
    assert done.returncode == 0, done.stderr
    # Another class of the same name would pay something else.
    file.write_text(TASK.replace("1.0", "2.0"), encoding="utf-8")
    done = call("demonstrate", *options)
    assert done.returncode == 1 and "sha256 of the task" in done.stderr


def test_a_network_of_ones_own_learns_from_them(
    shown: pathlib.Path,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The example, with fewer updates: it says what it has read, learns, and plays all episodes."""
    example = pathlib.Path(__file__).parents[3] / "examples/python/clone.py"
    text = example.read_text(encoding="utf-8")
    assert "range(4000)" in text and "% 1000 == 999" in text
    text = text.replace("range(4000)", "range(400)").replace("% 1000 == 999", "% 100 == 99")
    short = tmp_path / "clone.py"
    short.write_text(text, encoding="utf-8")
    monkeypatch.setattr(sys, "argv", [str(short), str(shown), str(HELD_OUT)])
    runpy.run_path(str(short))
    first, *losses, last = capsys.readouterr().out.splitlines()
    assert first.startswith(f"{sum(one.is_solved for one in Demonstrations(shown))} of 24 episodes")
    figures = [float(line.rpartition(" ")[2]) for line in losses]
    assert len(figures) == 4 and figures[-1] < figures[0]
    assert last.endswith(" episodes solved")


@pytest.mark.parametrize(
    "arguments, code, message",
    [
        (["--learner-steps", 9], 1, "--learner-steps goes with --learner"),
        (["--deterministic"], 1, "--deterministic is for an --expert that is a policy"),
        (["--simulation", "episode-steps=0"], 1, "give them a limit"),
        (["--simulation", "task=none"], 5, "the task is none"),
        (["--expert", "nobody.pt"], 2, "nobody.pt: cannot open the file"),
        (["--learner", WORLD], 3, "is a pack"),
        (["--episodes", 0], 1, "expected a whole number"),
        (["--expert", ""], 1, "--expert is empty"),
        (["--task-options", "x=1"], 1, "--task-options goes with --task"),
        (["--envs", 8], 1, "unrecognized arguments: --envs"),
        (["--network", "resnet9", "--recurrent"], 1, "unrecognized arguments: --recurrent"),
    ],
)
def test_what_cannot_be_made_is_refused(
    tmp_path: pathlib.Path, arguments: list[object], code: int, message: str
) -> None:
    done = call("demonstrate", WORLD, "-o", tmp_path / "demos", *QUICK, *arguments)
    assert done.returncode == code and message in done.stderr, done.stderr
    assert not (tmp_path / "demos").exists()


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["--target-kl", "0.01"], "--target-kl is for a run that acts"),
        (["--teacher", "best.pt"], "--teacher is for a run that acts"),
        (["--simulation", "laser-beams=8"], "laser"),
    ],
)
def test_what_imitation_has_no_use_for_is_refused(
    shown: pathlib.Path, tmp_path: pathlib.Path, arguments: list[str], message: str
) -> None:
    done = call(
        "train", WORLD, "-o", tmp_path / "run", *SMALL, "--demonstrations", shown, *arguments
    )
    assert done.returncode in (1, 3) and message in done.stderr, done.stderr
