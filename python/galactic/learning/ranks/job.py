"""What each rank of a run does, from opening the world to printing the last line."""

from __future__ import annotations

import contextlib
import dataclasses
import pathlib
from collections.abc import Sequence
from typing import NamedTuple

import torch

import galactic
from galactic.demonstrations import Demonstrations
from galactic.learning.command import INTERRUPTED, OK
from galactic.learning.homes import Homes
from galactic.learning.packs import content
from galactic.learning.playing.validation import validation_of
from galactic.learning.ranks.distributed import Group, local_ranks, threads_of, where_words
from galactic.learning.reports import log
from galactic.learning.saving import checkpoint
from galactic.learning.saving.run_folder import TEACHER, begin_folder, take_folder
from galactic.learning.saving.runs import Run, network_of, task_of
from galactic.learning.trainer import Trainer, Validation
from galactic.learning.user_code import callbacks
from galactic.learning.user_code.own_networks import OwnNetwork


class _Parts(NamedTuple):
    """What one rank needs to train."""

    envs: Homes
    validation: Validation | None
    teacher: tuple[checkpoint.SavedPolicy, pathlib.Path] | None
    demonstrations: Demonstrations | None
    network: OwnNetwork | None


@dataclasses.dataclass(frozen=True)
class Job:
    """What the ranks of a run are to do. `notes`: lines to print at the beginning of a new run.
    Only the first rank has `make_log`; all ranks have `make_callback`."""

    run: Run
    folder: pathlib.Path
    resumes: bool = False
    pause_at: int | None = None
    notes: Sequence[str] = ()
    make_log: log.MakeTaker | None = None
    make_callback: callbacks.MakeCallback | None = None


def train_in_rank(job: Job, group: Group) -> int:
    """Trains as one of the ranks. All ranks take the same steps in the same order. An error in one
    of them before training begins ends all of them, and nothing is written into the run's folder
    before the last of these steps. Returns the exit code."""
    with group.together():
        parts = _parts_of(job, group)
    trainer = _trainer_of(job, group, parts)
    # No rank writes to the folder before all have checked it for a run and have loaded what they
    # need.
    group.wait_for_all()
    with contextlib.ExitStack() as held:
        with group.together(OSError):
            if group.rank == 0:
                take_folder(job.folder, held, resumes=job.resumes)
        if job.resumes:
            trainer.resume()
        with group.together():
            _begin_callback(job, trainer)
        with group.together():
            _begin_log(job, trainer, held)
        say = trainer.reports.progress.say
        with group.together(OSError):
            if group.rank == 0:
                resumes = job.resumes
                begin_folder(job.run, job.folder, parts.teacher, resumes=resumes, say=say)
        say(where_words(group, parts.envs.drawn_by))
        undisturbed = _carry_out(job, trainer)
    parts.envs.close()
    return _tell_end(job, trainer, undisturbed)


def _parts_of(job: Job, group: Group) -> _Parts:
    """Opens what the run names, and sets the number of threads."""
    run, settings = job.run, job.run.settings
    threads = threads_of(settings.simulation_threads, local_ranks())
    sharing = 1 if settings.network == "state" else 0
    torch.set_num_threads(threads_of(settings.torch_threads or sharing, local_ranks()))
    kept = job.folder if job.resumes else None
    task, network = task_of(run, kept), network_of(run, kept)
    shown = Demonstrations(*run.demonstrations) if run.demonstrations else None
    # With demonstrations, nobody acts in the envs, so one per half is enough.
    played = (
        dataclasses.replace(settings, envs=settings.halves, mini_batches=1) if shown else settings
    )
    envs = Homes(
        galactic.World(run.world),
        played,
        threads,
        rank=group.rank,
        ranks=group.size,
        task=task,
        device=group.device,
    )
    validation = validation_of(run, envs, threads, group, task)
    return _Parts(envs, validation, _teacher_of(run, kept), shown, network)


def _teacher_of(
    run: Run, kept: pathlib.Path | None
) -> tuple[checkpoint.SavedPolicy, pathlib.Path] | None:
    """The teacher and its file. A resumed run reads the copy in its folder `kept`."""
    if run.teacher is None:
        return None
    file, remedy = run.teacher, ""
    if kept is not None:
        file = kept / TEACHER
        remedy = f"put back this copy of {run.teacher}, or begin another run"
    without = "give another --teacher, of the network state"
    return checkpoint.load_policy(file, remedy, without=without), file


def _trainer_of(job: Job, group: Group, parts: _Parts) -> Trainer:
    trainer = Trainer(
        job.run.settings,
        parts.envs,
        group,
        job.folder,
        validation=parts.validation,
        teacher=parts.teacher,
        demonstrations=parts.demonstrations,
        network=parts.network,
        title=job.folder.resolve().name,
    )
    if job.run.start_from and not job.resumes:
        trainer.start_from(job.run.start_from)
    return trainer


def _begin_callback(job: Job, trainer: Trainer) -> None:
    """Sets the callback: the user's code in the first rank, and a stand-in in the others, so that
    all ranks take the same steps."""
    if job.make_callback is None:
        return
    if trainer.group.rank == 0:
        trainer.callback = job.make_callback(job.folder, trainer.settings.to_dict())
    else:
        trainer.callback = lambda moment: None


def _begin_log(job: Job, trainer: Trainer, held: contextlib.ExitStack) -> None:
    """Passes rows of the curves to the user's function until `held` is closed."""
    if job.make_log is None:
        return
    take = job.make_log(job.folder, trainer.settings.to_dict())
    trainer.reports.log = log.Log(take, trainer.reports.progress.say)
    held.callback(trainer.reports.log.close)


def _carry_out(job: Job, trainer: Trainer) -> bool:
    """Trains as far as requested. Returns whether no signal cut it off."""
    say = trainer.reports.progress.say
    if job.resumes:
        say(f"going on after {trainer.steps:,} steps")
    else:
        for note in job.notes:
            say(note)
        if trainer.network is not None and trainer.group.rank == 0:
            _tell_of_no_export(trainer)
        trainer.begin()
    return trainer.train(job.pause_at)


def _tell_end(job: Job, trainer: Trainer, undisturbed: bool) -> int:
    """Prints where the results are, or how to continue. Returns the exit code."""
    say = trainer.reports.progress.say
    if trainer.steps < trainer.settings.steps or not undisturbed:
        say(
            f"{'paused' if undisturbed else 'stopped'} and saved after {trainer.steps:,} steps; go on "
            f"with python3 -m galactic.train -o {job.folder} --resume"
        )
        return OK if undisturbed else INTERRUPTED
    page = "curves.html, " if (job.folder / "curves.html").exists() else ""
    say(f"{job.folder}: {page}curves.csv, report.json, best.pt")
    return OK


def _tell_of_no_export(trainer: Trainer) -> None:
    """Warns, before hours of training, of a network that cannot become a pack."""
    fault = content.fault_of(trainer.policy)
    if fault:
        trainer.reports.progress.say(
            f"--network: galactic.export can make no pack of {trainer.settings.network}, which Python alone will play: "
            f"{fault}"
        )
