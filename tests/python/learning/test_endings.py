"""How runs end that do not come to their end: by Ctrl-C while they load, with the terminal, with who has
launched them, for lack of disk; and that a folder has one run at a time."""

from __future__ import annotations

import contextlib
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import galactic
from galactic import files, train
from galactic.learning.presets import preset
import galactic.learning.ranks.launch as launching
from galactic.learning.ranks.launch import LAUNCHER, launch
from galactic.learning.saving import checkpoint
from galactic.learning.saving.runs import Run
from programs import (
    SMALL,
    SMALL_OF_ANY_RANKS,
    UPDATE,
    WORLD,
    call,
    command,
    files_of_at_most,
    needs_worlds,
    run,
)
from trainers import make_trainer


def wait_for(holds: Callable[[], Any], process: subprocess.Popen[str] | None = None) -> None:
    while not holds():
        assert process is None or process.poll() is None
        time.sleep(0.02)


@pytest.fixture
def endless_torch(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """A folder in which programs that load torch leave a file each, and load on and on."""
    place = tmp_path / "stand_in"
    place.mkdir()
    (place / "torch.py").write_text(
        "import os, pathlib, time\n"
        "(pathlib.Path(__file__).parent / f'loads-{os.getpid()}').touch()\n"
        "time.sleep(600)\n",
        encoding="utf-8",
    )
    monkeypatch.setenv("PYTHONPATH", f"{place}:{os.environ.get('PYTHONPATH', '')}")
    return place


def loading(place: pathlib.Path) -> int:
    return len(list(place.glob("loads-*")))


@pytest.mark.parametrize("program", ["train", "evaluate", "export"])
@pytest.mark.parametrize("run_as", [["-B", "-m"], ["-Bm"]])
def test_ctrl_c_while_a_program_loads_ends_it_in_silence(
    endless_torch: pathlib.Path, program: str, run_as: list[str]
) -> None:
    process = subprocess.Popen(
        [sys.executable, *run_as, f"galactic.{program}"], stderr=subprocess.PIPE, text=True
    )
    wait_for(lambda: loading(endless_torch), process)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert (process.returncode, said) == (130, "")


def test_who_imports_the_package_handles_interrupts_himself(tmp_path: pathlib.Path) -> None:
    """Also in a program of his own that Python finds by -m."""
    package = tmp_path / "own"
    package.mkdir()
    (package / "__init__.py").write_text("import galactic\n", encoding="utf-8")
    (package / "work.py").write_text(
        "import os, signal\ntry: os.kill(os.getpid(), signal.SIGINT)\n"
        "except KeyboardInterrupt: os._exit(9)\n",
        encoding="utf-8",
    )
    path = f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"
    done = subprocess.run(
        [sys.executable, "-B", "-m", "own.work"], env={**os.environ, "PYTHONPATH": path}, timeout=60
    )
    assert done.returncode == 9


@contextlib.contextmanager
def interrupted_when(holds: Callable[[], Any]) -> Iterator[None]:
    """An interrupt of this process, once that holds."""

    def interrupt() -> None:
        wait_for(holds)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    yield
    thread.join()


def test_ctrl_c_while_ranks_load_ends_them_in_silence(
    endless_torch: pathlib.Path, capfd: Any
) -> None:
    with interrupted_when(lambda: loading(endless_torch) == 2):
        assert launch(2, command("train")) == 130
    assert capfd.readouterr().err == ""


def test_ctrl_c_before_anything_is_saved_is_told(
    endless_torch: pathlib.Path, monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path, capfd: Any
) -> None:
    """By the launcher, as ranks that are loading say nothing."""
    monkeypatch.delenv("RANK", raising=False)
    words = ["none.pack", "-o", str(tmp_path / "run"), *SMALL_OF_ANY_RANKS, "--ranks", "2"]
    with interrupted_when(lambda: loading(endless_torch) == 2):
        assert train.main(words) == 130
    first, last = capfd.readouterr().err.splitlines()
    assert first.endswith("none.pack: 2 ranks of 16 envs, 6 M steps; starting ...")
    assert last == f"galactic.train: interrupted before anything was saved in {tmp_path / 'run'}"


@pytest.mark.parametrize("saved", ["checkpoints/000000001024/policy.pt", "best.pt"])
def test_ctrl_c_where_something_was_saved_before_is_not_told_so(
    monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path, capsys: Any, saved: str
) -> None:
    (tmp_path / saved).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / saved).touch()
    monkeypatch.setattr(train, "launch", lambda ranks, command: 130)
    run = Run(pathlib.Path("none.pack"), None, preset("quick"))
    assert train._launched(run, tmp_path, []) == 130
    said = capsys.readouterr().err.splitlines()[-1]
    assert said == f"galactic.train: interrupted; no further checkpoint was saved in {tmp_path}"


def test_ctrl_c_before_all_ranks_have_started_reaches_all_of_them(
    endless_torch: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capfd: Any
) -> None:
    start = subprocess.Popen
    started: list[Any] = []

    def start_one(*arguments: Any, **keywords: Any) -> Any:
        os.kill(os.getpid(), signal.SIGINT)
        started.append(start(*arguments, **keywords))
        return started[-1]

    monkeypatch.setattr(subprocess, "Popen", start_one)
    assert launch(2, command("train")) == 130
    assert [process.returncode for process in started] == [130, 130]
    assert capfd.readouterr().err == ""


def has_ended(process: int) -> bool:
    """Also if nobody has asked yet how."""
    return state_of(process) in ("", "Z")


def state_of(process: int) -> str:
    """A letter of Linux's; none where there is no such process."""
    try:
        stat = pathlib.Path(f"/proc/{process}/stat").read_text(encoding="utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return ""
    return stat.rpartition(")")[2].split()[0]


def ranks_of(process: subprocess.Popen[str]) -> list[int]:
    file = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
    return [int(word) for word in file.read_text(encoding="utf-8").split()]


@contextlib.contextmanager
def run_of_two_ranks(folder: pathlib.Path) -> Iterator[subprocess.Popen[str]]:
    """A long one, which has come to learn."""
    process = subprocess.Popen(
        command("train", WORLD, "-o", folder, *SMALL_OF_ANY_RANKS, "--ranks", 2),
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        wait_for((folder / "curves.csv").is_file, process)
        yield process
    finally:
        process.kill()
        process.communicate()


def is_free(folder: pathlib.Path) -> bool:
    try:
        with files.alone_in(folder):
            return True
    except galactic.Error:
        return False


@needs_worlds
def test_a_folder_has_one_run_at_a_time_and_ranks_end_with_their_launcher(
    tmp_path: pathlib.Path,
) -> None:
    folder = tmp_path / "run"
    with run_of_two_ranks(folder) as process:
        before = (folder / "settings.json").read_bytes()
        done = call("train", "-o", folder, "--resume", "--steps", 10**9)
        assert done.returncode == 2
        assert done.stderr == (
            f"galactic.train: {folder}: a run is under way in this folder; wait for its end, "
            "interrupt it, or give another -o\n"
        )
        # As where two have been started at once, and neither has seen the other's settings.
        (folder / "settings.json").unlink()
        again = call("train", WORLD, "-o", folder, *SMALL_OF_ANY_RANKS)
        assert again.returncode == 2 and again.stderr == done.stderr
        assert not (folder / "settings.json").exists()
        (folder / "settings.json").write_bytes(before)
        ranks = ranks_of(process)
        assert len(ranks) == 2 and not any(map(has_ended, ranks))
        process.kill()
        process.wait()
        wait_for(lambda: all(map(has_ended, ranks)))
        # The lock ends with the last of their threads, though its file is there.
        assert (folder / ".lock").is_file()
        wait_for(lambda: is_free(folder))


class Signals:
    """Sends this process signals, each when the ranks have told of the one before by a file each."""

    def __init__(self, folder: pathlib.Path, ranks: int, *numbers: signal.Signals):
        self._folder, self._ranks = folder, ranks
        self._thread = threading.Thread(target=self._send, args=[numbers])

    def __enter__(self) -> None:
        self._thread.start()

    def __exit__(self, *_: object) -> None:
        self._thread.join()

    def _send(self, numbers: tuple[signal.Signals, ...]) -> None:
        for count, number in enumerate(numbers):
            wait_for(lambda: len(list(self._folder.glob(f"*-{count}"))) == self._ranks)
            os.kill(os.getpid(), number)


STUBBORN = """
import os, pathlib, signal, sys, time

def tell(number, frame):
    tell.count += 1
    (pathlib.Path(sys.argv[1]) / f"{os.environ['RANK']}-{tell.count}").touch()

tell.count = -1
signal.signal(signal.SIGINT, tell)
signal.signal(signal.SIGTERM, tell)
signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
tell(0, None)
"""
"""Ranks that end by no signal, of which they tell by a file each."""


@pytest.mark.parametrize("first", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("hurry, more", [(0.1, 0), (600.0, 1)])
def test_a_second_ctrl_c_ends_ranks_that_are_stuck_and_a_third_at_once(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capfd: Any, first: signal.Signals,
    hurry: float, more: int
) -> None:  # fmt: skip
    monkeypatch.setattr(launching, "HURRY", hurry)
    work = STUBBORN + "while True: time.sleep(600)"
    with Signals(tmp_path, 2, first, *[signal.SIGINT] * (1 + more)):
        assert launch(2, [sys.executable, "-c", work, str(tmp_path)]) == 130
    assert capfd.readouterr().err == "ranks that did not end were killed\n"


def test_ranks_that_save_have_their_time_however_often_a_job_is_ended(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, capfd: Any
) -> None:
    """Here until they have had the third signal, and one more second."""
    monkeypatch.setattr(launching, "HURRY", 0.0)
    work = STUBBORN + "while tell.count < 3: time.sleep(0.01)\ntime.sleep(1)\nexit(130)"
    with Signals(tmp_path, 2, *[signal.SIGTERM] * 3):
        assert launch(2, [sys.executable, "-c", work, str(tmp_path)]) == 130
    assert capfd.readouterr().err == ""


def test_a_rank_that_was_stopped_goes_on_to_its_end(tmp_path: pathlib.Path, capfd: Any) -> None:
    work = STUBBORN + (
        "print(os.getpid(), file=open(sys.argv[1] + '/rank', 'w'), flush=True)\n"
        "os.kill(os.getpid(), signal.SIGSTOP)\nexit(130 if tell.count == 1 else 9)"
    )
    rank = tmp_path / "rank"

    def end_it() -> None:
        wait_for(lambda: rank.is_file() and rank.read_text("utf-8").endswith("\n"))
        wait_for(lambda: state_of(int(rank.read_text("utf-8"))) == "T")
        os.kill(os.getpid(), signal.SIGTERM)

    thread = threading.Thread(target=end_it)
    thread.start()
    assert launch(1, [sys.executable, "-c", work, str(tmp_path)]) == 130
    thread.join()
    assert capfd.readouterr().err == ""


@needs_worlds
def test_a_terminal_that_closes_ends_a_run_that_saves(tmp_path: pathlib.Path) -> None:
    """The system says so, and then the shell once more."""
    with run_of_two_ranks(tmp_path / "run") as process:
        process.send_signal(signal.SIGHUP)
        time.sleep(0.05)
        process.send_signal(signal.SIGHUP)
        _, said = process.communicate(timeout=120)
    assert process.returncode == 130 and "stopped and saved after" in said
    assert list((tmp_path / "run").glob("checkpoints/[0-9]*/rank-1.pt"))


@needs_worlds
def test_a_signal_to_all_processes_of_a_job_ends_a_run_that_saves(tmp_path: pathlib.Path) -> None:
    """As systemd and Slurm send it: ranks get it twice, from there and from who has launched them."""
    with run_of_two_ranks(tmp_path / "run") as process:
        for one in (*ranks_of(process), process.pid):
            os.kill(one, signal.SIGTERM)
        _, said = process.communicate(timeout=120)
    assert process.returncode == 130 and "stopped and saved after" in said
    assert list((tmp_path / "run").glob("checkpoints/[0-9]*/rank-1.pt"))


def signaled(
    program: str, folder: pathlib.Path, number: signal.Signals, handler: signal.Handlers
) -> subprocess.CompletedProcess[str]:
    """A program that sends itself a signal in its work, where it reads a task of one's own. `handler`: what it finds
    there for the signal."""
    task = folder / "task.py"
    text = f"import os\nos.kill(os.getpid(), {int(number)})\nraise ValueError('goes on')\n"
    task.write_text(text, encoding="utf-8")
    words = [WORLD, "-o", folder / "out"]
    if program == "evaluate":
        words = [folder / "best.pt", WORLD]
        checkpoint.save_policy(make_trainer(None)._saved_policy(), folder / "best.pt")
    return subprocess.run(
        command(program, *words, "--task", f"{task}:Own"),
        preexec_fn=lambda: signal.signal(number, handler),
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("program", ["demonstrate", "evaluate", "train"])
def test_what_ends_a_program_in_its_work_is_told(
    tmp_path: pathlib.Path, program: str, number: signal.Signals
) -> None:
    done = signaled(program, tmp_path, number, signal.SIG_DFL)
    assert (done.returncode, done.stderr) == (130, f"galactic.{program}: interrupted\n")


def test_a_program_goes_on_where_a_hangup_is_to_be_ignored(tmp_path: pathlib.Path) -> None:
    done = signaled("evaluate", tmp_path, signal.SIGHUP, signal.SIG_IGN)
    assert done.returncode == 3 and done.stderr.endswith("ValueError: goes on\n")


@pytest.mark.parametrize("is_ignored, ends", [(False, True), (True, False)])
def test_a_hangup_is_passed_on_unless_it_is_to_be_ignored(is_ignored: bool, ends: bool) -> None:
    work = "import os, signal, sys, time\nos.kill(os.getppid(), signal.SIGHUP)\ntime.sleep(1)\n"
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN if is_ignored else signal.SIG_DFL)
    try:
        assert launch(1, [sys.executable, "-c", work]) == (130 if ends else 0)
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_rank_whose_launcher_was_over_before_it_asked_ends(tmp_path: pathlib.Path) -> None:
    work = (
        "from galactic.learning.ranks.launch import follow_launcher\nfollow_launcher()\nprint('on')"
    )
    # Its parent is this process, which is not the first of the system.
    for launcher, code in (({LAUNCHER: "1"}, -signal.SIGKILL), ({}, 0)):
        done = subprocess.run(
            [sys.executable, "-B", "-c", work], env={**os.environ, **launcher}, timeout=120
        )
        assert done.returncode == code


@needs_worlds
def test_a_full_disk_is_one_sentence_and_leaves_what_was_saved(tmp_path: pathlib.Path) -> None:
    folder = tmp_path / "run"
    small = [*SMALL, "--steps", 9 * UPDATE, "--checkpoint-every", UPDATE]
    done = call("train", WORLD, "-o", folder, *small, "--pause-at", UPDATE)
    assert done.returncode == 0, done.stderr
    saved = {file: file.read_bytes() for file in folder.rglob("*.pt")}
    # Room for reports, and none for networks.
    with files_of_at_most(100_000):
        full = call("train", "-o", folder, "--resume")
    assert full.returncode == 2, full.stderr
    (told,) = [line for line in full.stderr.splitlines() if "cannot write" in line]
    assert told.startswith("galactic.train: ") and ".pt: cannot write the file: File too" in told
    assert full.stderr.splitlines()[-1] == told and "frame" not in full.stderr
    assert {file: file.read_bytes() for file in folder.rglob("*.pt")} == saved
    again = call("train", "-o", folder, "--resume", "--pause-at", 2 * UPDATE)
    assert again.returncode == 0 and f"going on after {UPDATE} steps" in again.stderr


@needs_worlds
def test_a_full_disk_is_the_same_in_two_ranks(tmp_path: pathlib.Path) -> None:
    """Whichever of them is over first."""
    words = ["train", WORLD, "-o", tmp_path / "run", *SMALL_OF_ANY_RANKS, "--ranks", 2]
    with files_of_at_most(100_000):
        full = run(*words, "--steps", 9 * UPDATE, "--checkpoint-every", 2 * UPDATE)
    assert full.returncode == 2, full.stderr
    assert full.stderr.count("galactic.train: ") == full.stderr.count("cannot write the file") == 1


def test_a_folder_is_locked_once(tmp_path: pathlib.Path) -> None:
    with files.alone_in(tmp_path):
        with pytest.raises(galactic.Error, match="a run is under way in this folder; wait"):
            with files.alone_in(tmp_path):
                pass
    with files.alone_in(tmp_path):
        pass
