"""Ranks: how they are started and end, and that several learn what one does."""

from __future__ import annotations

import dataclasses
import datetime
import json
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
import torch
from torch.distributed import HashStore

import galactic
import galactic.learning.ranks.launch as launching
from galactic.learning.ranks.distributed import Group, RankLost, Stragglers
from galactic.learning.ranks.launch import launch
from galactic.learning.reports.curves import read_curves
from galactic.learning.saving import checkpoint
import ranks
from programs import needs_worlds
from trainers import SETTINGS, UPDATE, make_trainer

HERE = pathlib.Path(__file__).parent


def two_groups() -> list[Group]:
    """Two ranks that know of each other by what they keep in one place, and by nothing else."""
    both, store = [Group(rank, 2, torch.device("cpu")) for rank in (0, 1)], HashStore()
    for group in both:
        group._store = store
    return both


def taking(group: Group, fault: Exception | None = None) -> None:
    """A step of all ranks, which this one cannot take where there is a fault."""
    with group.together(OSError):
        if fault is not None:
            raise fault


def test_a_rank_that_ends_over_an_error_before_the_others_met_it_leaves_it_to_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def is_gone() -> None:
        raise RankLost("connection closed by peer")

    first, second = two_groups()
    monkeypatch.setattr(first, "wait_for_all", lambda: None)
    monkeypatch.setattr(second, "wait_for_all", is_gone)
    for step in range(2):
        second._store.set(f"fault/{step}/1", pickle.dumps(None).hex())
    with pytest.raises(OSError, match="disk full"):
        taking(first, OSError("disk full"))
    with pytest.raises(OSError, match="disk full"):
        taking(second)
    # Who said nothing before it was gone is missed, unless there is something to say here.
    taking(first)
    with pytest.raises(RankLost, match="by peer"):
        taking(second)
    _, alone = two_groups()
    monkeypatch.setattr(alone, "wait_for_all", is_gone)
    alone._store.set_timeout(datetime.timedelta(seconds=0.1))
    with pytest.raises(OSError, match="in use"):
        taking(alone, OSError("in use"))
    with pytest.raises(RankLost, match="by peer"):
        taking(alone)


def test_a_rank_that_is_ahead_is_not_taken_for_one_that_fails_now(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first one fails in the second step before the second one has read what was said in the first step."""
    both, is_ahead = two_groups(), threading.Event()
    barrier, read = threading.Barrier(2), both[1]._said_by_all
    steps = 0

    def wait_in_the_first() -> None:
        nonlocal steps
        steps += 1
        if steps == 2:
            is_ahead.set()
        barrier.wait(10.0)

    def read_late(*arguments: Any) -> Any:
        assert is_ahead.wait(10.0)
        return read(*arguments)

    monkeypatch.setattr(both[0], "wait_for_all", wait_in_the_first)
    monkeypatch.setattr(both[1], "wait_for_all", lambda: barrier.wait(10.0))
    monkeypatch.setattr(both[1], "_said_by_all", read_late)

    def failed_in(group: Group) -> tuple[int, str]:
        for step, fault in enumerate((None, OSError("disk full") if group.rank == 0 else None)):
            try:
                taking(group, fault)
            except OSError as error:
                return step, str(error)
        return -1, ""

    with ThreadPoolExecutor(2) as threads:
        assert list(threads.map(failed_in, both)) == [(1, "disk full")] * 2


@needs_worlds
def test_what_is_refused_in_one_rank_ends_both_with_its_words(tmp_path: pathlib.Path) -> None:
    """In every step before they learn and where they save, and the same ranks go on when nothing is refused."""
    script = str(HERE / "ranks_that_fail.py")
    assert launch(2, [sys.executable, "-B", script, str(tmp_path)]) == 0
    first, second = (
        json.loads((tmp_path / f"rank-{rank}.json").read_text("utf-8")) for rank in range(2)
    )
    assert first == second == {
        "parts in 0": "SettingsError: no validation",
        "parts in 1": "SettingsError: no validation",
        "take in 0": "OSError: disk full",
        "callback in 0": "SettingsError: no callback",
        "callback in 1": "SettingsError: no callback",
        "log in 0": "SettingsError: no log",
        "log in 1": "SettingsError: no log",
        "begin in 0": "Error: run: is full",
        "settings": "False",
        "run": "0",
        "resume in 0": "CheckpointError: no optimizer",
        "resume in 1": "CheckpointError: no optimizer",
        "best in 0": "Error: best.pt: is full",
        "room in 0": "OSError: no room",
        "save in 0": "Error: rank.pt: is full",
        "save in 1": "Error: rank.pt: is full",
        "finish in 0": "OSError: no names",
        "resumed": "0",
    }  # fmt: skip


def test_ranks_tell_once_what_went_wrong() -> None:
    first, second = two_groups()
    assert first.may_tell(OSError("disk full")) and not second.may_tell(OSError("disk full"))
    assert second.may_tell(OSError("no memory")) and not second.may_tell(RankLost("of the first"))
    # One that ended without a word is missed, once.
    first, second = two_groups()
    assert first.may_tell(RankLost("peer at 1")) and not second.may_tell(RankLost("peer at 2"))


@pytest.mark.parametrize(
    "number, code, advice",
    [
        (signal.SIGKILL, galactic.ErrorCode.UNSUPPORTED, "memory is lacking: take fewer --envs"),
        (signal.SIGSEGV, galactic.ErrorCode.INTERNAL, "please report it"),
    ],
)
def test_a_rank_that_a_signal_ends_is_missed_in_words(
    number: signal.Signals, code: galactic.ErrorCode, advice: str
) -> None:
    """The other one fails on its own account, as those do that lose a rank."""
    work = (
        "import os, time\n"
        f"if os.environ['RANK'] == '1': os.kill(os.getpid(), {int(number)})\n"
        "time.sleep(0.5)\n"
        "exit(4)"
    )
    message = f"^rank 1: was ended by {number.name}; .*{advice}"
    with pytest.raises(galactic.Error, match=message) as refused:
        launch(2, [sys.executable, "-c", work])
    assert refused.value.code == code


def test_no_rank_is_left_behind_where_not_all_can_start(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[Any] = []
    start = subprocess.Popen

    def start_one(*arguments: Any, **keywords: Any) -> Any:
        if started:
            raise OSError("no more processes")
        started.append(start(*arguments, **keywords))
        return started[0]

    monkeypatch.setattr(subprocess, "Popen", start_one)
    with pytest.raises(OSError, match="no more processes"):
        launch(2, [sys.executable, "-c", "import time; time.sleep(60)"])
    assert started[0].wait(timeout=10) == -signal.SIGKILL


@pytest.mark.parametrize("chosen, keeps", [({}, True), ({"MALLOC_MMAP_MAX_": "65536"}, False)])
def test_a_rank_keeps_the_memory_that_tensors_leave_unless_told_otherwise(
    monkeypatch: pytest.MonkeyPatch, chosen: dict[str, str], keeps: bool
) -> None:
    for name in ("MALLOC_MMAP_MAX_", "MALLOC_TRIM_THRESHOLD_"):
        monkeypatch.delenv(name, raising=False)
    for name, value in chosen.items():
        monkeypatch.setenv(name, value)
    # Pages that the system gave for tensors of 64 MiB, when those before have made room: up to 16 of them, as it happens.
    work = """
import resource, sys, torch
for n in range(40):
    if n == 30:
        before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    torch.full((1 << 24,), 1.0)
few = resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before < 100
sys.exit(7 if few else 8)
"""
    assert launch(1, [sys.executable, "-c", work]) == (7 if keeps else 8)


def test_a_rank_that_is_asked_to_end_was_interrupted() -> None:
    assert launch(1, [sys.executable, "-c", "import os; os.kill(os.getpid(), 15)"]) == 130


@pytest.fixture(scope="module")
def two(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """What two ranks have left that did all that ranks.py has for them. Each is to start from another policy."""
    folder = tmp_path_factory.mktemp("two")
    for rank in range(2):
        trainer = make_trainer(None, dataclasses.replace(SETTINGS, seed=1 + rank))
        trainer.begin()
        trainer.train(UPDATE)
        checkpoint.save_policy(trainer._saved_policy(), folder / f"before-{rank}.pt")
    assert launch(2, [sys.executable, "-B", str(HERE / "ranks.py"), str(folder)]) == 0
    return folder


def test_two_ranks_are_one_of_twice_the_envs(tmp_path: pathlib.Path, two: pathlib.Path) -> None:
    ranks.train(Group.alone(), tmp_path, 32)
    first = torch.load(two / "parameters-0.pt")
    second = torch.load(two / "parameters-1.pt")
    whole = torch.load(tmp_path / "parameters-0.pt")
    assert torch.equal(first, second)
    start = torch.load(tmp_path / "start.pt")
    moved = (whole - start).abs().max()
    # Sums in another order, carried through eight updates.
    assert moved > 0.01 and (first - whole).abs().max() < 1e-3 * moved
    one, both = (read_curves(folder / "curves.csv") for folder in (tmp_path, two))
    assert len(one) == len(both) == 8
    for row, other in zip(one, both):
        # Measured ones differ.
        for name in row.keys() - {"seconds", "sps"}:
            assert row[name] == pytest.approx(other[name], rel=1e-3, abs=1e-4), name
    assert one[-1]["measure_steps"] == one[-1]["length"] > 1.0


def test_ranks_start_from_one_policy_whatever_becomes_of_its_file(two: pathlib.Path) -> None:
    before, *after = (torch.load(two / f"{name}.pt") for name in ("before-0", "after-0", "after-1"))
    wanted = before["policy"]
    assert "normalize.center" in wanted
    for found in after:
        assert found.keys() == wanted.keys()
        assert all(torch.equal(found[name], value) for name, value in wanted.items())


def test_stragglers_are_stopped_and_their_steps_counted(two: pathlib.Path) -> None:
    steps = [torch.load(two / f"steps-{rank}.pt") for rank in range(2)]
    assert steps[0]["rollouts"] == [16, 16, 16]
    # Not before a quarter of the rollout, nor as late as its end.
    assert all(4 <= length < 16 for length in steps[1]["rollouts"]), steps
    total = sum(steps[0]["rollouts"]) + sum(steps[1]["rollouts"])
    assert steps[0]["steps"] == steps[1]["steps"] == 16 * total
    assert torch.equal(steps[0]["parameters"], steps[1]["parameters"])


def test_a_rank_that_fails_is_noticed_whichever_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that wait for it are ended."""
    monkeypatch.setattr(launching, "GRACE", 0.2)
    for failing in range(3):
        commands = [["false"] if rank == failing else ["sleep", "100"] for rank in range(3)]
        processes = [subprocess.Popen(command) for command in commands]
        with launching._PassedOn(processes) as signals:
            assert launching._wait(processes, signals) == (failing, 1)
        assert all(process.returncode is not None for process in processes)


@pytest.mark.parametrize(
    "codes, wanted",
    [
        ((4, 2, 4), (1, 2)),
        ((5, 4, 4), (0, 5)),
        ((4, 0, 130), (2, 130)),
        ((4, 4, 0), (0, 4)),
        ((0, 0, 0), (0, 0)),
        ((2, -9, 4), (1, -9)),
    ],
)
def test_the_code_of_a_run_is_that_of_the_rank_that_failed_and_not_of_those_that_lost_it(
    codes: tuple[int, ...], wanted: tuple[int, int]
) -> None:
    assert launching._failure(dict(enumerate(codes))) == wanted


def test_ranks_that_lose_another_one_may_be_over_before_it() -> None:
    work = "import os, time\nif os.environ['RANK'] == '0': time.sleep(1); exit(2)\nexit(4)"
    assert launch(3, [sys.executable, "-c", work]) == 2


@pytest.mark.parametrize(
    "fraction, ranks, enough",
    [(0.6, 3, 2), (0.6, 2, 2), (0.6, 5, 3), (0.5, 2, 1), (0.07, 100, 7), (0.0, 4, 1), (0.99, 8, 8)],
)
def test_as_many_ranks_are_waited_for_as_the_fraction_says(
    fraction: float, ranks: int, enough: int
) -> None:
    store = HashStore()
    all_of_them = [Stragglers(store, rank, ranks, fraction, 0.0) for rank in range(ranks)]
    for done, rank in enumerate(all_of_them):
        assert all_of_them[-1].should_stop(0, 16, 32) == (done >= enough)
        rank.finished(0)


def test_the_curves_of_ranks_wait_for_the_envs_of_all(two: pathlib.Path) -> None:
    for rank in range(2):
        updates = torch.load(two / f"figures-{rank}.pt")
        assert updates == [False, False, False, False, True]
