"""The training loop on a toy: resume, checkpoints. Signals: test_interrupts.py; several ranks: test_ranks.py."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import resource
import shutil
import time
from typing import Any

import pytest
import torch

import galactic
from galactic import files
from galactic.learning.encoders import Inputs
from galactic.learning.policies.networks import PolicyShape
from galactic.learning.policies.outlines import Outlined
from galactic.learning.ranks.distributed import Stragglers
from galactic.learning.refusals import CheckpointError
from galactic.learning.rollouts.episode_sums import EpisodeSums, OwnNames
from galactic.learning.saving import checkpoint
from galactic.learning.saving.checkpoint import load_policy, new_policy
from galactic.learning.saving.run_folder import CheckpointFolder
from galactic.learning.settings import Settings
from toys import Measured, ReachAndGrasp, Remember, Uneven
from trainers import SETTINGS, UPDATE, curve, make_trainer, parameters, saved_run


@pytest.mark.parametrize(
    "toy, recurrent",
    [(ReachAndGrasp, False), (Remember, True), (Uneven, False), (Measured, False)],
)
def test_a_resumed_run_is_the_same_run_bit_for_bit(
    tmp_path: pathlib.Path, toy: Any, recurrent: bool
) -> None:
    settings = dataclasses.replace(SETTINGS, recurrent=recurrent, target_kl=1e-3)
    whole = make_trainer(tmp_path / "whole", settings, toy)
    (tmp_path / "whole").mkdir()
    whole.begin()
    assert whole.train()
    # The same run, killed after its fifth update, when the last checkpoint is from the third.
    (tmp_path / "cut").mkdir()
    cut = make_trainer(tmp_path / "cut", settings, toy)
    cut.begin()
    for update in range(5):
        losses, _ = cut._iterate()
        cut._log(losses)
        if update == 2:
            cut.save()
    again = make_trainer(tmp_path / "cut", settings, toy)
    again.resume()
    assert again.steps == 3 * UPDATE
    assert again.train()
    assert torch.equal(parameters(again), parameters(whole))
    assert torch.equal(again.policy.normalize.mean, whole.policy.normalize.mean)
    assert curve(tmp_path / "cut") == curve(tmp_path / "whole")
    assert len(curve(tmp_path / "whole")) == 8


def test_a_checkpoint_holds_a_policy_that_acts_the_same(tmp_path: pathlib.Path) -> None:
    trainer = make_trainer(tmp_path)
    trainer.begin()
    trainer.train()
    saved = load_policy(trainer.checkpoints.latest() / "policy.pt")
    assert saved.settings == SETTINGS and saved.steps == SETTINGS.steps
    for name, value in trainer.policy.state_dict().items():
        assert torch.equal(saved.policy.state_dict()[name], value)
    assert load_policy(tmp_path / "best.pt").success is not None


def test_only_the_latest_checkpoints_stay(tmp_path: pathlib.Path) -> None:
    settings = dataclasses.replace(SETTINGS, checkpoint_every=UPDATE, keep=2)
    trainer = make_trainer(tmp_path, settings)
    trainer.begin()
    trainer.train()
    names = [path.name for path in sorted((tmp_path / "checkpoints").iterdir())]
    assert names == [f"{7 * UPDATE:012d}", f"{8 * UPDATE:012d}"]


def test_an_unfinished_checkpoint_is_passed_over(tmp_path: pathlib.Path) -> None:
    trainer = make_trainer(tmp_path)
    trainer.begin()
    trainer._iterate()
    trainer.save()
    # Killed while it wrote the next one.
    trainer._iterate()
    checkpoint.save(trainer.checkpoints.begin(trainer.steps) / "policy.pt", {}, {})
    again = make_trainer(tmp_path)
    again.resume()
    assert again.steps == UPDATE
    again._iterate()
    again.save()
    assert again.checkpoints.latest().name == f"{2 * UPDATE:012d}"


def test_a_checkpoint_that_is_written_again_is_whole_all_the_time(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may be the only one, and whatever ends the run may do so between any two steps of that."""
    settings = dataclasses.replace(SETTINGS, keep=1)
    trainer = make_trainer(tmp_path, settings)
    trainer.begin()
    trainer._iterate()
    trainer.save()
    taken_up: list[int] = []

    def look() -> None:
        again = make_trainer(tmp_path, settings)
        again.resume()
        assert torch.equal(parameters(again), parameters(trainer))
        taken_up.append(again.steps)

    def watched(change: Any) -> Any:
        def change_and_look(*arguments: Any, **options: Any) -> None:
            change(*arguments, **options)
            look()

        return change_and_look

    monkeypatch.setattr(os, "replace", watched(os.replace))
    monkeypatch.setattr(shutil, "rmtree", watched(shutil.rmtree))
    trainer.save()
    # Each of three files was written, and then put in its place.
    assert taken_up == [UPDATE] * len(taken_up) and len(taken_up) >= 2 * 3
    assert [path.name for path in (tmp_path / "checkpoints").iterdir()] == [f"{UPDATE:012d}"]


def test_a_write_that_fails_leaves_the_old_file(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "file"
    files.write_atomically(file, lambda handle: handle.write(b"old"))

    def fail(handle: Any) -> None:
        handle.write(b"ne")
        raise OSError("disk full")

    with pytest.raises(galactic.Error, match="file: cannot write the file: disk full; an existing"):
        files.write_atomically(file, fail)
    assert file.read_bytes() == b"old" and os.listdir(tmp_path) == ["file"]


def test_what_is_no_checkpoint_is_refused(tmp_path: pathlib.Path) -> None:
    with pytest.raises(
        galactic.Error,
        match="holds no checkpoint to go on from; leave out --resume and give its options again to",
    ):
        CheckpointFolder(tmp_path, 1).latest()
    (tmp_path / "policy.pt").write_bytes(b"nonsense")
    with pytest.raises(CheckpointError, match="cannot be read as a checkpoint"):
        load_policy(tmp_path / "policy.pt")
    checkpoint.save(tmp_path / "policy.pt", {}, {})
    with pytest.raises(CheckpointError, match="policy.pt holds no policy; take best.pt or a"):
        load_policy(tmp_path / "policy.pt")
    with pytest.raises(galactic.Error, match="none.pt: cannot open the file: No such file"):
        load_policy(tmp_path / "none.pt")


@pytest.mark.parametrize("name", ["trainer.pt", "policy.pt", "rank-0.pt"])
@pytest.mark.parametrize("form, found", [(2, "format 2"), (None, "no format")])
def test_a_file_of_another_format_is_refused_with_what_to_do(
    tmp_path: pathlib.Path, name: str, form: int | None, found: str
) -> None:
    resumed = saved_run(tmp_path)
    file = resumed.checkpoints.latest() / name
    values, tensors = checkpoint.load(file)
    values |= {} if form is None else {"format": form}
    torch.save({"values": json.dumps(values), **tensors}, file)
    with pytest.raises(CheckpointError) as refused:
        resumed.resume()
    assert str(refused.value) == (
        f"{file} has {found}, and this version reads format 1; use it with the version of galactic that wrote it, or "
        "train anew"
    )


SHAPE = PolicyShape(4, 2, False, True)._asdict()


def write_policy(file: pathlib.Path, **changes: Any) -> None:
    """A policy.pt in which some of the values, and "policy", are others; "left out" leaves one out."""
    shape = PolicyShape(**SHAPE)
    policy = new_policy(SETTINGS, shape)
    good = checkpoint.SavedPolicy(
        policy, SETTINGS, shape, [("way", 4)], 7, None, {"laser_fov": 270}
    )
    checkpoint.save_policy(good, file)
    values, tensors = checkpoint.load(file)
    tensors["policy"] = changes.pop("policy", tensors["policy"])
    values = {name: value for name, value in {**values, **changes}.items() if value != "left out"}
    checkpoint.save(file, values, tensors)


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"settings": "left out"}, "settings: found nothing, expected dict"),
        ({"settings": [1, 2]}, r"settings: found \[1, 2\], expected dict"),
        (
            {"settings": {"width": 17}},
            r"encoder.0.weight: found float32 \[16, 4\], expected float32 \[17, 4\]",
        ),
        ({"settings": {"steps": "many"}}, "steps: found 'many', expected a whole number"),
        ({"settings": {"steps": 1.5}}, "steps: found 1.5, expected a whole number"),
        ({"settings": {"gamma": None}}, "gamma: found None, expected a number"),
        ({"settings": {"normalize": 1}}, "normalize: found 1, expected true or false"),
        ({"settings": {"simulation": 3}}, "simulation: found 3, expected text"),
        ({"settings": {"activation": "sine"}}, 'activation is "sine"'),
        ({"settings": {"mood": 1}}, "mood are unknown to this version"),
        ({"shape": "left out"}, "shape: found nothing, expected dict"),
        ({"shape": {"state": 4}}, "motions: found nothing, expected int"),
        ({"shape": {"state": "4", "motions": 2}}, "state: found '4', expected int"),
        ({"shape": {**SHAPE, "state": -4}}, "state: found -4, expected 0 to 1048576"),
        ({"shape": {**SHAPE, "motions": 1 << 40}}, "motions: found 1099511627776, expected 0 to"),
        ({"shape": {**SHAPE, "legs": 2}}, "legs"),
        ({"parts": [["way"]]}, "not enough values"),
        ({"parts": None}, "parts: found None, expected list"),
        ({"meanings": []}, r"meanings: found \[\], expected dict"),
        ({"meanings": "left out"}, "meanings: found nothing, expected dict"),
        ({"return": "left out"}, "return: found nothing, expected float or int or NoneType"),
        ({"shape": {"state": 4, "motions": 2}}, "decides_terminate: found nothing, expected bool"),
        ({"steps": "many"}, "steps: found 'many', expected int"),
        ({"success": "left out"}, "success: found nothing, expected float or int or NoneType"),
        ({"return": "much"}, "return: found 'much', expected float or int or NoneType"),
        ({"policy": []}, "normalize.mean: found nothing, expected float32"),
        ({"policy": {}}, "normalize.mean: found nothing, expected float32"),
        ({"policy": torch.zeros(3)}, "normalize.mean: found nothing, expected float32"),
    ],
)
def test_a_policy_of_other_values_is_refused_with_the_files_name(
    tmp_path: pathlib.Path, changes: dict[str, Any], message: str
) -> None:
    file = tmp_path / "policy.pt"
    if isinstance(changes.get("settings"), dict):
        changes = {"settings": {**SETTINGS.to_dict(), **changes["settings"]}}
    write_policy(file, **changes)
    with pytest.raises(CheckpointError, match=message) as refused:
        load_policy(file)
    said = str(refused.value)
    assert said.startswith(f"{file} is not a policy of this version: ") and "\n" not in said


def test_a_small_file_that_describes_a_large_network_costs_nothing(tmp_path: pathlib.Path) -> None:
    """What it asks for would be a terabyte. Nothing may be made before its tensors have been looked at, which are
    of these sizes in a second file, and in one place."""
    file = tmp_path / "policy.pt"
    large = dataclasses.replace(SETTINGS, width=65536, layers=64)
    write_policy(file, settings=large.to_dict())
    memory = resource.getrlimit(resource.RLIMIT_AS)
    used = int(pathlib.Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + (1 << 30), memory[1]))
    try:
        with pytest.raises(CheckpointError, match=r"expected float32 \[65536, 4\]"):
            load_policy(file)
        with Outlined():
            outline = new_policy(large, PolicyShape(4, 2, False, True)).state_dict()
        write_policy(
            file,
            settings=large.to_dict(),
            policy={
                name: torch.zeros((), dtype=one.dtype).expand(one.shape)
                for name, one in outline.items()
            },
        )
        with pytest.raises(CheckpointError, match="found 4 numbers in 1 places, expected one pl"):
            load_policy(file)
    finally:
        resource.setrlimit(resource.RLIMIT_AS, memory)


@pytest.mark.parametrize("network", ["state", "depth", "simple_cnn", "resnet9"])
@pytest.mark.parametrize("critic_only", ["", "bump"])
def test_a_policy_is_read_without_a_random_number(
    tmp_path: pathlib.Path, network: str, critic_only: str
) -> None:
    settings = Settings(network=network, normalize=True, critic_only=critic_only)
    shape = PolicyShape(5, 2, True, True, 0.2, critic_only=(4,) if critic_only else ())
    policy = new_policy(settings, shape).eval()
    with torch.no_grad():
        for parameter in policy.parameters():
            parameter.add_(torch.randn_like(parameter))
    saved = checkpoint.SavedPolicy(policy, settings, shape, [("way", 4), ("bump", 1)], 7, None)
    checkpoint.save_policy(saved, tmp_path / "policy.pt")
    torch.manual_seed(3)
    before = torch.random.get_rng_state()
    found = load_policy(tmp_path / "policy.pt").policy
    assert torch.equal(torch.random.get_rng_state(), before)
    edge = settings.image_size
    inputs = Inputs(
        torch.randn(2, 3, 5),
        torch.randint(0, 255, (2, 3, edge, edge, 3), dtype=torch.uint8),
        torch.rand(2, 3, edge, edge) * 5.0,
        torch.randn(2, 3, 4),
    )
    starts = torch.zeros(2, 3, dtype=torch.bool)
    hidden = policy.initial_hidden(3, torch.device("cpu"))
    with torch.no_grad():
        for one, other in zip(policy(inputs, hidden, starts), found(inputs, hidden, starts)):
            assert str(one) == str(other)
    assert all(parameter.requires_grad for parameter in found.parameters())


def test_values_that_are_no_dictionary_are_refused(tmp_path: pathlib.Path) -> None:
    torch.save({"values": "[1, 2]"}, tmp_path / "policy.pt")
    with pytest.raises(CheckpointError, match="policy.pt cannot be read as a checkpoint"):
        load_policy(tmp_path / "policy.pt")


@pytest.mark.parametrize("name", ["trainer.pt", "policy.pt", "rank-0.pt"])
@pytest.mark.parametrize("damage", ["empty", "half", "text", "pack", "plain", "of another run"])
def test_a_damaged_file_of_a_checkpoint_is_refused_with_what_to_do(
    tmp_path: pathlib.Path, name: str, damage: str
) -> None:
    resumed = saved_run(tmp_path)
    latest = resumed.checkpoints.latest()
    file = latest / name
    if damage == "of another run":
        (tmp_path / "other").mkdir()
        other = saved_run(tmp_path / "other", width=8, envs=8).checkpoints.latest()
        shutil.copy(other / name, file)
    elif damage == "plain":
        torch.save([1, 2], file)
    else:
        whole = file.read_bytes()
        damaged = {"empty": b"", "half": whole[: len(whole) // 2], "text": b"no checkpoint"}
        file.write_bytes(damaged.get(damage, b"GALAPACK and more"))
    with pytest.raises(CheckpointError) as refused:
        resumed.resume()
    said = str(refused.value)
    assert said.startswith(f"{file} ") and "\n" not in said
    assert said.endswith(
        f"; remove the folder {latest} to resume from {UPDATE:012d}, which is before it"
    )
    shutil.rmtree(latest)
    resumed.resume()
    assert resumed.steps == UPDATE


def test_a_file_that_a_checkpoint_lacks_is_missed(tmp_path: pathlib.Path) -> None:
    resumed = saved_run(tmp_path)
    (resumed.checkpoints.latest() / "rank-0.pt").unlink()
    with pytest.raises(galactic.Error, match="cannot open the file: No such file.*; remove the f"):
        resumed.resume()


def test_the_only_checkpoint_has_none_to_go_back_to(tmp_path: pathlib.Path) -> None:
    resumed = saved_run(tmp_path)
    shutil.rmtree(resumed.checkpoints.complete()[0])
    (resumed.checkpoints.latest() / "trainer.pt").write_bytes(b"")
    with pytest.raises(
        CheckpointError, match=r"found 0 bytes.*; no checkpoint is before it: begin"
    ):
        resumed.resume()


GONE = "gone"
SUMS = EpisodeSums().by_name(OwnNames())
PICKLESS = {name: total for name, total in SUMS.items() if name != "picks"}


@pytest.mark.parametrize(
    "name, changes, message",
    [
        ("trainer.pt", {"ranks": 2}, "is of 2 ranks, not 1; start as many"),
        ("trainer.pt", {"ranks": GONE}, "ranks: found nothing, expected int"),
        ("trainer.pt", {"rate_share": GONE}, "rate_share: found nothing, expected float or int"),
        ("trainer.pt", {"updates": 1.5}, "updates: found 1.5, expected int"),
        ("trainer.pt", {"row_count": "2"}, "row_count: found '2', expected int"),
        ("trainer.pt", {"window": [[1, 2, 3]]}, r"window\[0\]: found \[1, 2, 3\], expected dict"),
        ("trainer.pt", {"window": [4]}, r"window\[0\]: found 4, expected dict"),
        (
            "trainer.pt",
            {"window": [{**SUMS, "lengths": "5"}]},
            "lengths: found '5', expected float or int",
        ),
        ("trainer.pt", {"window": [{"episodes": 3}]}, "successes: found nothing, expected float"),
        ("trainer.pt", {"window": [PICKLESS]}, "picks: found nothing, expected float or int"),
        ("trainer.pt", {"measures": "kl"}, "measures: found 'kl', expected list"),
        ("trainer.pt", {"measures": [[]]}, r"is of a task that measured \[\], and"),
        ("trainer.pt", {"must_validate": 1}, "must_validate: found 1, expected bool"),
        ("trainer.pt", {"seconds": GONE}, "seconds: found nothing, expected float or int"),
        ("trainer.pt", {"stopwatch": {"update": "long"}}, "update: found 'long', expected float"),
        ("trainer.pt", {"optimizer": GONE}, "step: found nothing, expected float32 "),
        ("trainer.pt", {"optimizer": [1]}, "step: found nothing, expected float32 "),
        (
            "trainer.pt",
            {"optimizer": {"step": 3}},
            "step: found int, which is no tensor, expected fl",
        ),
        ("rank-0.pt", {"envs": GONE}, "envs: found nothing, expected Tensor"),
        ("rank-0.pt", {"envs": torch.zeros(7, dtype=torch.uint8)}, "does not fit this run: "),
        ("rank-0.pt", {"starts": GONE}, r"starts: found nothing, expected bool \[16\]"),
        ("rank-0.pt", {"starts": torch.zeros(1).bool()}, r"found bool \[1\], expected bool \[16\]"),
        (
            "rank-0.pt",
            {"returns": torch.zeros(16)},
            r"found float32 \[16\], expected float64 \[16\]",
        ),
        ("rank-0.pt", {"waits": GONE}, r"waits: found nothing, expected bool \[16\]"),
        ("rank-0.pt", {"waits": torch.zeros(2).bool()}, r"waits: found bool \[2\], expected bool"),
    ],
)
def test_a_checkpoint_of_other_values_is_refused(
    tmp_path: pathlib.Path, name: str, changes: dict[str, Any], message: str
) -> None:
    """Some of them torch would have stretched to fit."""
    resumed = saved_run(tmp_path)
    file = resumed.checkpoints.latest() / name
    values, tensors = checkpoint.load(file)
    for key, value in changes.items():
        part = tensors if key in tensors else values
        part[key] = value
        if value is GONE:
            del part[key]
    checkpoint.save(file, values, tensors)
    with pytest.raises(CheckpointError, match=message) as refused:
        resumed.resume()
    assert str(file.parent) in str(refused.value) and "\n" not in str(refused.value)


def test_a_run_goes_on_with_a_task_that_measures_more(tmp_path: pathlib.Path) -> None:
    """Means of what is new begin when all episodes that count have been measured."""
    saved = saved_run(tmp_path, window=250)
    resumed = make_trainer(tmp_path, saved.settings, Measured)
    resumed.resume()
    # From a checkpoint of its own, too.
    resumed.train(pause_at=3 * UPDATE)
    again = make_trainer(tmp_path, saved.settings, Measured)
    again.resume()
    assert again.train()
    rows = curve(tmp_path)
    assert len(rows) == 8 and all(row["length"] is not None for row in rows)
    known = [row["measure_steps"] for row in rows]
    missing = known.count(None)
    assert 2 < missing < 8 and known[:missing] == [None] * missing
    assert known[missing:] == [row["length"] for row in rows[missing:]]


def test_a_task_that_measures_something_else_is_another_run(tmp_path: pathlib.Path) -> None:
    saved = make_trainer(tmp_path, dataclasses.replace(SETTINGS, steps=UPDATE), Measured)
    saved.begin()
    saved.train()
    latest = saved.checkpoints.latest()
    with pytest.raises(CheckpointError) as refused:
        make_trainer(tmp_path).resume()
    assert str(refused.value) == (
        f"{latest} is of a task that measured kl, and the task does so no longer; put its class back as it "
        "was, or begin another run"
    )

    class MeasuresMore(Measured):
        measures = ("steps", "more", "kl", "validation_success")

    more = make_trainer(tmp_path, toy=MeasuresMore)
    more.resume()
    row = dict(zip(more.reports.curves.columns, more.reports.curves.rows[0]))
    assert row["measure_steps"] == row["length"] and row["measure_more"] is None


def test_a_resumed_run_counts_the_processor_time_of_all_its_parts(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    used = [100.0]
    monkeypatch.setattr(time, "process_time", lambda: used[0])
    resumed = saved_run(tmp_path)
    used[0] = 3.0
    resumed.resume()
    used[0] = 5.0
    resumed.train(resumed.steps + UPDATE)
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert report["processor_seconds"] == 100.0 + 2.0


def test_a_loss_that_is_no_number_ends_the_run(tmp_path: pathlib.Path) -> None:
    from galactic.learning.trainer import TrainingError

    trainer = make_trainer(tmp_path)
    trainer.begin()
    trainer.learner.optimizer.parameters.data.fill_(float("nan"))
    with pytest.raises(TrainingError, match="update 1 gave a loss that is not a number"):
        trainer.train()


class StoreOfTwo(dict[str, int]):
    """What two ranks share, the other of which has finished every rollout before this one begins."""

    def add(self, key: str, count: int) -> int:
        self[key] = self.get(key, 1) + count
        return self[key]

    def delete_key(self, key: str) -> None:
        self.pop(key)


def test_a_rank_that_is_late_from_the_start_takes_one_step(tmp_path: pathlib.Path) -> None:
    trainer = make_trainer(tmp_path, dataclasses.replace(SETTINGS, halves=2))
    trainer.stragglers = Stragglers(StoreOfTwo(), 0, 2, sync_fraction=0.5, shortest=0.0)
    trainer.begin()
    for _ in range(3):
        trainer._iterate()
        assert trainer.source.rollout.steps == 1
    assert trainer.steps == 3 * SETTINGS.envs


@pytest.mark.parametrize(
    "fault", [galactic.Error(galactic.ErrorCode.IO, "trainer.pt", "is full"), KeyboardInterrupt()]
)
@pytest.mark.parametrize("fails", [(checkpoint, "save_policy"), (CheckpointFolder, "finish")])
def test_nothing_is_left_of_a_checkpoint_that_cannot_be_written(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, fault: BaseException, fails: Any
) -> None:
    trainer = saved_run(tmp_path)
    trainer.resume()

    def refuse(*_: object) -> None:
        raise fault

    before = sorted(trainer.checkpoints.folder.iterdir())
    monkeypatch.setattr(*fails, refuse)
    monkeypatch.setattr(trainer, "_keep_if_best", lambda means: None)
    with pytest.raises(type(fault)):
        trainer.save()
    assert sorted(trainer.checkpoints.folder.iterdir()) == before and len(before) == 2
