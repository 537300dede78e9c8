"""The programs galactic.train and galactic.evaluate on the sample world: what they say, what they leave
behind, and that a policy learns."""

from __future__ import annotations

import json
import math
import os
import pathlib
import signal
import subprocess
import time
from typing import Any

import pytest
import torch

import galactic
from galactic import export, train
from galactic.learning.homes import Homes
from galactic.learning.playing import validation
from galactic.learning.ranks import job
from galactic.learning.refusals import CheckpointError
from galactic.learning.reports.curves import read_curves
from galactic.learning.saving import checkpoint
from programs import (
    HELD_OUT,
    SMALL,
    SMALL_OF_ANY_RANKS,
    UPDATE,
    WORLD,
    call,
    command,
    curve,
    needs_worlds,
    run,
)

BLIND = "geodesic=false geodesic-weight=0 bump=false bump-penalty=0"
LASER = "laser-beams=24 laser-heights=0.25,0.8 laser-range=4"
SENSORS = "laser-beams=8 laser-noise=0.01 geodesic geodesic-weight=1 bump"
TO_BE_CUT = [*SMALL, "--halves", "2", "--critic-only", "geodesic", "--simulation", f"task=pick episode-steps=60 {SENSORS}",
             "--checkpoint-every", 10 * UPDATE, "--steps", 80 * UPDATE]  # fmt: skip

pytestmark = needs_worlds


def test_a_policy_learns_what_chance_does_not(tmp_path: pathlib.Path) -> None:
    """Mobile Pick on unseen episodes. An untrained policy picks a few percent; docs/learning_results.md
    says what longer runs reach."""
    # Fewer envs than the preset, for more updates in fewer steps, and nothing that costs to sense.
    common = ["--preset", "quick", "--seed", "5", "--validation", HELD_OUT, "--envs", "128"]
    common += ["--simulation", BLIND, "--final-log-std", "2"]
    assert call("train", WORLD, "-o", tmp_path / "raw", *common, "--steps", "1").returncode == 0
    done = run("train", WORLD, "-o", tmp_path / "run", *common, "--steps", "400_000")
    assert done.returncode == 0, done.stderr
    rates = {}
    for name in ("raw", "run"):
        report = tmp_path / f"{name}.json"
        found = call("evaluate", tmp_path / name / "best.pt", HELD_OUT, "--report", report)
        assert found.returncode == 0, found.stderr
        rates[name] = json.loads(report.read_text(encoding="utf-8"))
        # Each episode exactly once.
        assert [one["episode"] for one in rates[name]["each"]] == list(range(100))
    # Of 100 episodes: chance would have to be wrong by more than five standard errors.
    assert rates["raw"]["success"] <= 0.08 and rates["run"]["success"] >= 0.2, rates
    assert rates["run"]["spl"] > 0.1 and rates["run"]["path"] > 0.5
    assert sum(rates["run"]["endings"].values()) == 100


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A run with all sensors that goes through to its end."""
    folder = tmp_path_factory.mktemp("undisturbed") / "run"
    done = call("train", WORLD, "-o", folder, *TO_BE_CUT)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.parametrize("sign, code", [(signal.SIGKILL, -9), (signal.SIGINT, 130)])
def test_a_run_that_was_cut_goes_on_as_if_it_had_not_been(
    tmp_path: pathlib.Path, undisturbed: pathlib.Path, sign: signal.Signals, code: int
) -> None:
    """Killed, it loses what came after its latest checkpoint; interrupted, nothing."""
    # As a rank without its launcher, so that there is one process to kill.
    cut = subprocess.Popen(
        command("train", WORLD, "-o", tmp_path / "cut", *TO_BE_CUT),
        env={**os.environ, "RANK": "0", "WORLD_SIZE": "1"},
        stderr=subprocess.DEVNULL,
    )
    while not list((tmp_path / "cut").glob("checkpoints/[0-9]*")):
        assert cut.poll() is None
        time.sleep(0.01)
    cut.send_signal(sign)
    assert cut.wait(timeout=120) == code, "it was over before it was cut"
    resumed = call("train", "-o", tmp_path / "cut", "--resume")
    assert resumed.returncode == 0, resumed.stderr
    assert "going on after" in resumed.stderr
    assert curve(tmp_path / "cut") == curve(undisturbed)
    assert len(curve(undisturbed)) == 80
    final = f"checkpoints/{80 * UPDATE:012d}/policy.pt"
    found, wanted = (
        checkpoint.load_policy(folder / final).policy.state_dict()
        for folder in (tmp_path / "cut", undisturbed)
    )
    assert all(torch.equal(found[name], value) for name, value in wanted.items())


def test_a_paused_run_was_validated_and_goes_on_as_if_it_had_not_been_paused(
    tmp_path: pathlib.Path,
) -> None:
    # With noise, which goes on from episode to episode, in validations, too.
    noisy = "task=pick episode-steps=20 laser-beams=8 laser-noise=0.5"
    options = [WORLD, *SMALL, "--steps", 6 * UPDATE, "--simulation", noisy]
    options += ["--validation", HELD_OUT, "--validation-episodes", "4"]
    options += ["--validate-every", 3 * UPDATE]
    whole, paused = tmp_path / "whole", tmp_path / "paused"
    assert call("train", "-o", whole, *options).returncode == 0
    first = call("train", "-o", paused, *options, "--pause-at", 3 * UPDATE)
    assert first.returncode == 0, first.stderr
    assert f"paused and saved after {3 * UPDATE} steps; go on with python3" in first.stderr
    half = curve(paused)
    assert [row["validation_success"] is not None for row in half] == [False, False, True, False]
    assert json.loads((paused / "report.json").read_text())["best_success"] is not None
    # It is there already, and stays.
    again = call("train", "-o", paused, "--resume", "--pause-at", 3 * UPDATE)
    assert again.returncode == 0 and "paused and saved" in again.stderr
    assert curve(paused) == half
    rest = call("train", "-o", paused, "--resume")
    assert rest.returncode == 0 and "report.json" in rest.stderr
    assert curve(paused) == curve(whole)


def test_a_run_is_not_resumed_up_to_where_it_has_been(tmp_path: pathlib.Path) -> None:
    folder = tmp_path / "run"
    options = [*SMALL, "--steps", 4 * UPDATE, "--pause-at", 2 * UPDATE]
    assert call("train", WORLD, "-o", folder, *options).returncode == 0
    before = {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()}
    for name, remedy in (("--steps", "begin another run"), ("--pause-at", "leave it out")):
        done = call("train", "-o", folder, "--resume", name, UPDATE)
        assert done.returncode == 1 and done.stderr == (
            f"galactic.train: command line: {name}: found {UPDATE}, and the run has done {2 * UPDATE} "
            f"steps; take more, or {remedy}\n"
        )
    assert {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()} == before
    # The steps that it has anyway, and exactly those that it has done.
    for steps in (4 * UPDATE, 2 * UPDATE):
        done = call("train", "-o", folder, "--resume", "--steps", steps, "--pause-at", 2 * UPDATE)
        assert done.returncode == 0, done.stderr
    assert len(curve(folder)) == 2


def test_a_complete_run_needs_nothing_but_its_folder(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "run"
    assert call("train", WORLD, "-o", folder, *SMALL, "--steps", 2 * UPDATE).returncode == 0
    before = {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()}
    with monkeypatch.context() as without:
        without.setattr(job, "Homes", None)
        done = call("train", "-o", folder, "--resume")
    assert done.returncode == 0
    assert done.stderr == f"{folder} is complete; give it more --steps to go on\n"
    assert {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()} == before
    # Without its report, or one of the latest steps, it is not.
    for left in ("", "{}", "[]", '{"steps": 1}'):
        (folder / "report.json").write_text(left, encoding="utf-8")
        assert "report.json" in call("train", "-o", folder, "--resume").stderr
        assert json.loads((folder / "report.json").read_text())["steps"] == 2 * UPDATE
    more = call("train", "-o", folder, "--resume", "--steps", 3 * UPDATE)
    assert more.returncode == 0 and "going on after" in more.stderr
    assert len(curve(folder)) == 3


def test_an_interrupt_saves_and_says_how_to_go_on(tmp_path: pathlib.Path) -> None:
    process = subprocess.Popen(
        command("train", WORLD, "-o", tmp_path / "run", *SMALL_OF_ANY_RANKS, "--ranks", "2"),
        stderr=subprocess.PIPE,
        text=True,
    )
    while not (tmp_path / "run" / "curves.csv").is_file():
        assert process.poll() is None
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=120)
    assert process.returncode == 130, said
    assert f"go on with python3 -m galactic.train -o {tmp_path / 'run'} --resume" in said
    assert list((tmp_path / "run").glob("checkpoints/[0-9]*/rank-1.pt"))


@pytest.mark.parametrize(
    "arguments, code, message",
    [
        (["--preset", "quick"], 1, "which world? Name a world pack, or --resume a run"),
        ([WORLD, "--preset", "swift"], 1, '"swift" is not a preset; the presets are paper, quick'),
        ([WORLD, "--envs", "6", "--mini-batches", "4"], 1, "cannot be split into 4 mini-batches"),
        ([WORLD, "--gamma", "1.5"], 1, "gamma: found 1.5, expected a number from 0 to 1"),
        ([WORLD, "--network", "big"], 1, 'network is "big"; it can be state'),
        ([WORLD, *SMALL, "--simulation", "seed=3"], 1, "seed is not for --simulation"),
        ([WORLD, *SMALL, "--simulation", "observation=dict"], 1, "observation is not for --sim"),
        ([WORLD, *SMALL, "--simulation", "actions=paper"], 1, "actions is not for --simulation"),
        ([WORLD, *SMALL, "--simulation", "auto-reset"], 1, "auto_reset is not for --simulation"),
        (["nowhere.pack", *SMALL], 2, "nowhere.pack"),
        (
            [WORLD, *SMALL, "--validation", HELD_OUT, "--simulation", "episode-steps=0"],
            1,
            "--simulation: episode-steps is 0, and a validation of episodes without a limit may never",
        ),
        ([WORLD, *SMALL, "--simulation", "no-such"], 1, "--simulation: there is no option no_such"),
        ([WORLD, *SMALL, "--simulation", "laser-range=nan"], 3, "laser_range: is nan, expected"),
        (
            [WORLD, *SMALL, "--critic-only", "geodesik"],
            1,
            'critic_only: "geodesik" is no sensor; did you mean geodesic?',
        ),
        (
            [WORLD, *SMALL, "--critic-only", "joints"],
            1,
            '"joints" is no sensor; it can be of bump, ',
        ),
        (
            [WORLD, *SMALL, "--critic-only", "geodesic,laser"],
            1,
            "critic_only: laser is not observed; turn the sensor on with --simulation",
        ),
        ([WORLD, "--preset", "quik"], 1, '"quik" is not a preset; did you mean quick?'),
        ([WORLD, "--stepz", "5"], 1, "unrecognized arguments: --stepz 5; did you mean --steps?"),
        ([WORLD, "--stepz=5"], 1, "unrecognized arguments: --stepz=5; did you mean --steps?"),
        (["--resume"], 2, "holds no run"),
        (
            [WORLD, *SMALL, "--target-kl", "0.01", "--epochs", "1", "--mini-batches", "1"],
            1,
            "--target-kl goes by the divergence before the step of each mini-batch, which is 0 before",
        ),
        ([WORLD, *SMALL, "--pause-at", "0"], 1, '--pause-at: found "0", expected 1 to 9007'),
        ([WORLD, *SMALL, "--pause-at", "1.5"], 1, 'found "1.5", expected a whole number'),
        ([WORLD, "--device", "cuda"], 1, "--device: found cuda, but this torch has no CUDA device"),
    ],
)
def test_what_cannot_be_is_refused_with_a_sentence(
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[object],
    code: int,
    message: str,
) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    done = call("train", "-o", tmp_path / "run", *arguments)
    assert message in done.stderr and "Traceback" not in done.stderr
    assert done.returncode == code
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    "name, value, message",
    [
        ("parts", [("joints", 4)], "gives observations of joints (4), and "),
        ("playable_episodes", lambda: [], "has no episode in which the robot can start; validate"),
    ],
)
def test_a_world_in_which_nothing_can_be_validated_is_refused_before_training(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, name: str, value: Any, message: str
) -> None:
    def make(world: galactic.World, *arguments: Any, **keywords: Any) -> Homes:
        homes = Homes(world, *arguments, **keywords)
        if world.episodes == galactic.World(HELD_OUT).episodes:
            setattr(homes, name, value)
        return homes

    monkeypatch.setattr(validation, "Homes", make)
    done = call("train", "-o", tmp_path / "run", WORLD, *SMALL, "--validation", HELD_OUT)
    assert done.returncode == 3
    assert done.stderr.startswith(f"galactic.train: {HELD_OUT}: {message}")
    assert not (tmp_path / "run").exists()


def test_a_gpu_for_two_ranks_is_refused_before_they_start(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)
    monkeypatch.setattr(torch.cuda, "device_count", lambda: 1)
    monkeypatch.setattr(train, "launch", lambda *_: pytest.fail("ranks have started"))
    run = [str(WORLD), "-o", str(tmp_path / "run"), "--preset", "quick", "--device", "cuda"]
    assert train.main(run) == 1
    assert "--ranks: found 2, each of which needs a CUDA device" in capsys.readouterr().err


@pytest.mark.parametrize(
    "place, message",
    [
        ("file", "is a file, expected a folder or nothing; give another -o"),
        ("file/run", "cannot make the folder: Not a directory; give another -o"),
    ],
)
def test_a_folder_that_cannot_be_is_refused_before_ranks_start(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: Any, place: str, message: str
) -> None:
    (tmp_path / "file").write_bytes(b"")
    monkeypatch.setattr(train, "launch", lambda *_: pytest.fail("ranks have started"))
    assert train.main([str(WORLD), "-o", str(tmp_path / place), "--preset", "quick"]) == 2
    assert capsys.readouterr().err == f"galactic.train: {tmp_path / place}: {message}\n"
    # As a rank of torchrun, which has no such launcher.
    done = call("train", WORLD, "-o", tmp_path / place, *SMALL, "--steps", UPDATE)
    assert (
        done.returncode == 2 and done.stderr == f"galactic.train: {tmp_path / place}: {message}\n"
    )


def test_the_folder_is_only_tried(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was there stays, what was not is not."""
    monkeypatch.setattr(train, "launch", lambda *_: 0)
    (tmp_path / "here").mkdir()
    for place in ("here", "here/some/run"):
        assert train.main([str(WORLD), "-o", str(tmp_path / place)]) == 0
        assert [one.name for one in tmp_path.rglob("*")] == ["here"]


def test_a_run_is_not_written_over_nor_turned_into_another(tmp_path: pathlib.Path) -> None:
    options = [*SMALL, "--steps", UPDATE]
    assert call("train", WORLD, "-o", tmp_path / "run", *options).returncode == 0
    again = call("train", WORLD, "-o", tmp_path / "run", *options)
    assert again.returncode == 1 and "already holds a run" in again.stderr
    other = call("train", "-o", tmp_path / "run", "--resume", "--gamma", "0.9")
    assert other.returncode == 1 and "cannot continue with 0.9" in other.stderr
    longer = call("train", "-o", tmp_path / "run", "--resume", "--steps", 3 * UPDATE)
    assert longer.returncode == 0 and len(curve(tmp_path / "run")) == 3


def test_a_damaged_checkpoint_is_one_sentence_on_any_number_of_ranks(
    tmp_path: pathlib.Path,
) -> None:
    """Also of the ranks whose own files are whole."""
    folder = tmp_path / "run"
    words = [*SMALL_OF_ANY_RANKS, "--ranks", "2", "--steps", 2 * UPDATE]
    assert run("train", WORLD, "-o", folder, *words).returncode == 0
    (file,) = folder.glob("checkpoints/[0-9]*/rank-1.pt")
    whole = file.read_bytes()

    def refuse(code: int, message: str) -> None:
        done = run("train", "-o", folder, "--resume", "--steps", 3 * UPDATE)
        assert done.returncode == code, done.stderr
        begun, _, said = done.stderr.partition("\n")
        assert begun.endswith(f": 2 ranks of 16 envs, {3 * UPDATE} steps; starting ...")
        assert said.startswith(f"galactic.train: {message}") and said.count("\n") == 1, said

    file.write_bytes(whole[:100])
    refuse(3, f"{file} cannot be read as a checkpoint: found 100 bytes of something else")
    file.unlink()
    refuse(2, f"{file}: cannot open the file: No such file or directory; no checkpoint is before")


def test_a_folder_that_does_not_say_what_the_run_is_is_refused_before_ranks_start(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.setattr(train, "launch", lambda *_: pytest.fail("ranks have started"))
    (tmp_path / "settings.json").write_text("[]", encoding="utf-8")
    assert train.main(["-o", str(tmp_path), "--resume"]) == 3
    said = capsys.readouterr().err
    told = f"galactic.train: {tmp_path / 'settings.json'} does not say what the run is: "
    assert said.startswith(told) and said.count("\n") == 1


def test_a_run_starts_from_what_another_learned(tmp_path: pathlib.Path) -> None:
    """The weights of Mobile Pick begin a run of Rearrange, which has a decision more."""
    pick, rearrange = tmp_path / "pick", tmp_path / "rearrange"
    small = [*SMALL, "--steps", UPDATE, "--learning-rate", "0"]
    assert call("train", WORLD, "-o", pick, *small, "--simulation", LASER).returncode == 0
    other = [*small, "--simulation", f"{LASER} task=rearrange", "--start-from", pick / "best.pt"]
    done = call("train", WORLD, "-o", rearrange, *other)
    assert done.returncode == 0, done.stderr
    told = [json.loads((one / "settings.json").read_text()) for one in (pick, rearrange)]
    before, after = (one["settings"]["simulation"] for one in told)
    assert "laser-beams=24" in before and after == before.replace("=pick", "=rearrange")
    learned, begun = (checkpoint.load_policy(one / "best.pt").policy for one in (pick, rearrange))
    head, begun_head = learned.action.linear, begun.action.linear
    assert torch.equal(begun.encoder[0].weight, learned.encoder[0].weight)
    assert torch.equal(begun_head.weight[:-2], head.weight[:-2])
    # Nobody decided to terminate before: the decision starts rare instead of even.
    assert begun_head.weight[-2:].count_nonzero() == 0 and head.weight[-2:].count_nonzero() > 0
    assert begun_head.bias[-1] - begun_head.bias[-2] == checkpoint.NEW_TERMINATE_LOGIT
    blind = call("train", WORLD, "-o", tmp_path / "blind", *small, "--simulation", BLIND,
                 "--start-from", pick / "best.pt")  # fmt: skip
    fault = (
        "does not fit this run: observations: the run lacks bump, laser, geodesic; give this run"
    )
    assert blind.returncode == 3 and fault in blind.stderr
    short = call("train", WORLD, "-o", tmp_path / "blind", *small, "--simulation",
                 f"{LASER} laser-beams=8 target-up bump=false",
                 "--start-from", pick / "best.pt")  # fmt: skip
    fault = (
        "observations: the run lacks bump and the policy lacks target_up and laser has 48 numbers "
    )
    assert short.returncode == 3 and fault + "in the policy and 16 in the run;" in short.stderr
    wide = call("train", WORLD, "-o", tmp_path / "wide", *small, "--simulation", LASER,
                "--width", "64", "--start-from", pick / "best.pt")  # fmt: skip
    assert wide.returncode == 3 and "width: found 128, expected 64" in wide.stderr
    assert not (tmp_path / "blind").exists() and not (tmp_path / "wide").exists()
    resumed = call("train", "-o", rearrange, "--resume", "--start-from", pick / "best.pt")
    assert resumed.returncode == 1 and "leave them out" in resumed.stderr


def test_a_run_learns_from_a_teacher_that_sees_more(tmp_path: pathlib.Path) -> None:
    """It keeps a copy of it, and goes on with that."""
    teacher, folder = tmp_path / "teacher", tmp_path / "run"
    assert call("train", WORLD, "-o", teacher, *SMALL, "--steps", UPDATE).returncode == 0
    taught = ["--simulation", LASER, "--critic-only", "geodesic", "--recurrent"]
    taught += ["--teacher", teacher / "best.pt", "--teacher-share", "0.6"]
    words = [*SMALL, *taught, "--steps", 4 * UPDATE, "--checkpoint-every", UPDATE]
    for place, pause in ((folder, []), (tmp_path / "cut", ["--pause-at", 2 * UPDATE])):
        done = call("train", WORLD, "-o", place, *words, *pause)
        assert done.returncode == 0, done.stderr
    told = [row["teacher_kl"] for row in curve(folder)]
    assert told[0] and told[1] and told[2] and told[3] is None
    assert json.loads((folder / "settings.json").read_text())["teacher"] == str(teacher / "best.pt")
    words = [*SMALL_OF_ANY_RANKS, "--ranks", "2", *taught, "--steps", UPDATE]
    both = run("train", WORLD, "-o", tmp_path / "both", *words)
    assert both.returncode == 0, both.stderr
    (teacher / "best.pt").unlink()
    assert call("train", "-o", tmp_path / "cut", "--resume").returncode == 0
    assert curve(tmp_path / "cut") == curve(folder)
    policy = checkpoint.load_policy(folder / "best.pt")
    other = checkpoint.load_policy(tmp_path / "cut" / "best.pt")
    for one, two in zip(policy.policy.parameters(), other.policy.parameters()):
        assert torch.equal(one, two)

    untaught = [*SMALL[2:], "--preset", "quick-laser", "--steps", UPDATE]
    done = call("train", WORLD, "-o", tmp_path / "untaught", *untaught)
    assert done.returncode == 0
    assert "the preset quick-laser is made for a --teacher; without one" in done.stderr

    def refuse(code: int, message: str, *options: object) -> None:
        done = call("train", *options)
        assert done.returncode == code and message in done.stderr, done.stderr

    new = [WORLD, "-o", tmp_path / "new", *SMALL, "--teacher"]
    refuse(2, "best.pt: cannot open the file: No such file", *new, teacher / "best.pt")
    copy = folder / "teacher.pt"
    blind = [*new, copy, "--simulation", BLIND]
    refuse(3, f"{copy} sees bump, which this run does not observe; turn the sensor on", *blind)
    refuse(3, f"{folder / 'best.pt'} has a memory, expected a teacher", *new, folder / "best.pt")
    refuse(1, "--teacher-share goes with --teacher", *new[:-1], "--teacher-share", "0.3")
    refuse(1, "its teacher and its demonstrations", "-o", folder, "--resume", "--teacher", copy)
    assert not (tmp_path / "new").exists()
    copy.unlink()
    gone = (
        f"{copy}: cannot open the file: No such file or directory; put back this copy of {teacher}"
    )
    refuse(2, gone, "-o", folder, "--resume", "--steps", 5 * UPDATE)


def test_a_policy_pack_knows_the_options_of_its_env(tmp_path: pathlib.Path) -> None:
    small = [*SMALL, "--steps", UPDATE, "--simulation", LASER]
    assert call("train", WORLD, "-o", tmp_path / "run", *small).returncode == 0
    pack = tmp_path / "policy.pack"
    assert export.main([str(tmp_path / "run" / "best.pt"), "-o", str(pack)]) == 0
    policy = galactic.LearnedPolicy(pack, 4, deterministic=True)
    # Numbers, words and truth values.
    some = {"task": "pick", "laser_beams": 24, "laser_range": 4, "bump": True, "episode_steps": 200}
    assert some.items() <= policy.options.items()
    homes = galactic.VectorEnv(HELD_OUT, 4, **policy.options)
    observations, _ = homes.reset()
    homes.step(policy.act(observations))
    sizes = [(n, one.stop - one.start) for n, one in homes.simulators[0].observation_parts.items()]
    assert policy.observation == sizes
    assert policy.options.items() <= homes.simulators[0].options.items()


def test_what_the_critic_alone_saw_is_no_part_of_the_pack(tmp_path: pathlib.Path) -> None:
    small = [*SMALL, "--steps", UPDATE, "--critic-only", "geodesic"]
    taught = tmp_path / "taught" / "best.pt"
    assert call("train", WORLD, "-o", taught.parent, *small).returncode == 0
    pack = tmp_path / "policy.pack"
    assert export.main([str(taught), "-o", str(pack)]) == 0
    policy = galactic.LearnedPolicy(pack, 4, deterministic=True)
    homes = galactic.VectorEnv(HELD_OUT, 4, **policy.options)
    observations, _ = homes.reset()
    homes.step(policy.act(observations))
    assert "geodesic" not in homes.simulators[0].observation_parts
    # Weights of a critic that saw more fit no other run.
    plain = call("train", WORLD, "-o", tmp_path / "run", *SMALL, "--start-from", taught)
    assert (
        plain.returncode == 3 and "critic_only: found geodesic, expected nothing;" in plain.stderr
    )
    file = tmp_path / "other.pt"
    values, tensors = checkpoint.load(taught)
    values["shape"]["critic_only"] = [1, 2]
    checkpoint.save(file, values, tensors)
    fault = "critic_only: found columns .1, 2., expected those of geodesic"
    with pytest.raises(CheckpointError, match=fault):
        checkpoint.load_policy(file)
    values["parts"] = [["geodesic", 10**15]]
    checkpoint.save(file, values, tensors)
    with pytest.raises(CheckpointError, match=fault):
        checkpoint.load_policy(file)


def test_an_evaluation_repeats_itself(tmp_path: pathlib.Path) -> None:
    assert call("train", WORLD, "-o", tmp_path / "run", *SMALL, "--steps", UPDATE).returncode == 0
    reports = []
    for number, mode in enumerate(("--sampled", "--sampled", "--deterministic")):
        file = tmp_path / f"{number}.json"
        done = call("evaluate", tmp_path / "run" / "best.pt", HELD_OUT, mode, "--episodes", "20",
                    "--report", file)  # fmt: skip
        assert done.returncode == 0, done.stderr
        reports.append(json.loads(file.read_text(encoding="utf-8")))
    assert reports[0] == reports[1] and reports[0]["each"] != reports[2]["each"]
    assert len(reports[0]["each"]) == 20


@pytest.mark.parametrize("network, edge", [("simple_cnn", 128), ("depth", 40)])
def test_a_policy_that_sees_pictures_trains_goes_on_and_is_evaluated(
    tmp_path: pathlib.Path, network: str, edge: int
) -> None:
    """Two updates of the paper's preset, small."""
    small = [WORLD, "--network", network, "--image-size", edge, "--envs", 4, "--horizon", 4,
             "--steps", 2 * 4 * 4, "--log-every", 0, "--validation", HELD_OUT,
             "--validation-episodes", 3, "--simulation", "task=pick episode-steps=6"]  # fmt: skip
    done = call("train", "-o", tmp_path / "run", *small)
    assert done.returncode == 0, done.stderr
    assert call("train", "-o", tmp_path / "paused", *small, "--pause-at", 16).returncode == 0
    assert call("train", "-o", tmp_path / "paused", "--resume").returncode == 0
    final = f"checkpoints/{32:012d}/policy.pt"
    found, wanted = (
        checkpoint.load_policy(tmp_path / name / final).policy.state_dict()
        for name in ("paused", "run")
    )
    assert all(torch.equal(found[name], value) for name, value in wanted.items())
    begin = [*small, "--start-from", tmp_path / "run" / "best.pt", "-o", tmp_path / "begun"]
    if network == "depth":
        other = call("train", *(48 if word == edge else word for word in begin))
        assert other.returncode == 3 and "image_size: found 40, expected 48;" in other.stderr
    assert call("train", *begin).returncode == 0
    rows = read_curves(tmp_path / "run" / "curves.csv")
    updates = [row for row in rows if row["policy_loss"] is not None]
    assert len(updates) == 2 and "validation after 32 steps" in done.stderr
    for row in updates:
        for name in ("policy_loss", "value_loss", "entropy", "grad_norm"):
            assert row[name] is not None and math.isfinite(row[name]), row
    report = tmp_path / "report.json"
    done = call("evaluate", tmp_path / "run" / "best.pt", HELD_OUT, "--episodes", 5, "--report",
                report)  # fmt: skip
    assert done.returncode == 0, done.stderr
    each = json.loads(report.read_text(encoding="utf-8"))["each"]
    assert len(each) == 5 and all(1 <= one["length"] <= 6 for one in each)


def test_an_error_that_all_ranks_find_is_said_once(tmp_path: pathlib.Path) -> None:
    done = run("train", WORLD, "-o", tmp_path / "run", *SMALL_OF_ANY_RANKS, "--ranks", "2",
               "--simulation", "no-such")  # fmt: skip
    assert done.returncode == 1
    assert done.stderr.count("--simulation: there is no option no_such") == 1, done.stderr


def test_an_evaluation_refuses_what_is_no_policy(tmp_path: pathlib.Path) -> None:
    done = call("evaluate", tmp_path / "none.pt", HELD_OUT)
    assert done.returncode == 2
    assert f"{tmp_path / 'none.pt'}: cannot open the file: No such file" in done.stderr
    done = call("evaluate", WORLD, HELD_OUT)
    assert done.returncode == 3
    assert "is a pack, and no checkpoint; play a policy pack with galactic-run" in done.stderr
    (tmp_path / "bad.pt").write_bytes(b"nonsense")
    done = call("evaluate", tmp_path / "bad.pt", HELD_OUT)
    assert done.returncode == 3 and "cannot be read as a checkpoint" in done.stderr
    assert "weights_only" not in done.stderr
    checkpoint.save(tmp_path / "bad.pt", {}, {"policy": {}})
    done = call("evaluate", tmp_path / "bad.pt", HELD_OUT)
    assert done.returncode == 3 and "Traceback" not in done.stderr
    assert "bad.pt is not a policy of this version: settings: found nothing" in done.stderr


@pytest.mark.parametrize("option", ["--report", "--contact-sheet"])
@pytest.mark.parametrize("place, why", [("nowhere/x", "No such file"), ("", "Is a directory")])
def test_an_evaluation_tries_its_outputs_before_it_plays(
    tmp_path: pathlib.Path, option: str, place: str, why: str
) -> None:
    """Before it looks for the policy, even."""
    output = tmp_path / place
    done = call("evaluate", tmp_path / "none.pt", HELD_OUT, option, output)
    assert done.returncode == 2
    assert done.stderr.startswith(f"galactic.evaluate: {output}: cannot write the file: {why}")
    assert not list(tmp_path.iterdir())
