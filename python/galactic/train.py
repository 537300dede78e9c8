"""Trains a policy: `python3 -m galactic.train world.pack -o runs/pick --preset quick`."""

from __future__ import annotations

import argparse
import dataclasses
import os
import pathlib
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from galactic import files
from galactic.learning.command import (
    EXIT_CODES,
    INTERRUPTED,
    OK,
    Parser,
    add_device_option,
    lost_output,
    named_path,
    told,
)
from galactic.learning.homes import require_options
from galactic.learning.policies.privileges import require_sensors
from galactic.learning.presets import TAUGHT, WORDS, preset
from galactic.learning.ranks.distributed import Group, device_of
from galactic.learning.ranks.job import Job, train_in_rank
from galactic.learning.ranks.launch import follow_launcher, launch
from galactic.learning.refusals import SettingsError
from galactic.learning.reports import log
from galactic.learning.reports.progress import amount
from galactic.learning.saving.run_folder import (
    BEST,
    CheckpointFolder,
    is_complete,
    require_no_run,
)
from galactic.learning.saving.runs import Run, run_in, with_network, with_task
from galactic.learning.setting_fields import option_name
from galactic.learning.setting_options import (
    add_options,
    given_options,
    option_lines,
    positive_integer,
    resumed,
)
from galactic.learning.settings import Settings
from galactic.learning.user_code import callbacks, own_tasks
from galactic.streams import put


def make_parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="python3 -m galactic.train",
        description="Trains a policy in the homes of a world.",
        epilog=f"{EXIT_CODES}; after the first Ctrl-C, the run was saved.",
    )
    parser.add_argument(
        "world", type=named_path, nargs="?", help="world pack; leave it out with --resume"
    )
    parser.add_argument(
        "-o",
        "--out",
        type=named_path,
        metavar="FOLDER",
        help="folder of the run",
    )
    parser.add_argument(
        "--preset",
        default=None,
        metavar=WORDS,
        help="settings to start from (paper, whose settings stand in parentheses), or the folder of a run that has them",
    )
    parser.add_argument(
        "--validation", type=named_path, metavar="WORLD", help="world with held-out episodes"
    )
    parser.add_argument(
        "--start-from",
        type=named_path,
        metavar="POLICY",
        help="begin with the weights of this best.pt or policy.pt from another task or world",
    )
    parser.add_argument(
        "--teacher",
        type=named_path,
        metavar="POLICY",
        help="learn at first what this best.pt or policy.pt would do, which may see sensors that the "
        "policy does not (--critic-only)",
    )
    parser.add_argument(
        "--demonstrations",
        type=named_path,
        nargs="+",
        default=(),
        metavar="FOLDER",
        help="imitate the expert of these, which galactic.demonstrate has made, instead of acting; --steps "
        "are then steps of theirs",
    )
    parser.add_argument(
        "--resume", action="store_true", help="continue from the latest checkpoint in FOLDER"
    )
    parser.add_argument(
        "--pause-at",
        type=positive_integer,
        metavar="STEPS",
        help="validate, save and end after so many steps of the run, for --resume to go on",
    )
    add_device_option(parser, "where the networks run", "there is one for each rank")
    parser.add_argument(
        "--log-to",
        metavar="FILE.py:NAME|MODULE:NAME",
        help="hand each row of curves.csv to what this function of yours returns for (folder, settings)",
    )
    parser.add_argument(
        "--callback",
        metavar="FILE.py:NAME|MODULE:NAME",
        help="what this function of yours returns for (folder, settings) is called after each update and validation, "
        "and at the end; it may add to the curves, and end the run",
    )
    parser.add_argument(
        "--print-settings",
        action="store_true",
        help="print all settings that a run with these options has, and do nothing else",
    )
    add_options(parser)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    given = sys.argv[1:] if arguments is None else list(arguments)
    parser = make_parser()
    options = parser.parse_args(given)
    if options.print_settings:
        return told("galactic.train", lambda: _print_settings(options))
    if options.out is None:
        parser.error("the following arguments are required: -o/--out")

    def train() -> int:
        if "RANK" in os.environ:
            follow_launcher()
        make_log = _log_maker(options)
        make_callback = None if options.callback is None else callbacks.maker(options.callback)
        run = _resumed_run(options) if options.resume else _new_run(options)
        if options.resume and is_complete(run, options.out):
            if os.environ.get("RANK", "0") == "0":
                put(sys.stderr, f"{options.out} is complete; give it more --steps to go on\n")
            return OK
        if "RANK" not in os.environ:
            device_of(options.device, 0, run.settings.ranks)
            files.require_folder(options.out)
            return _launched(run, options.out, [sys.executable, "-m", "galactic.train", *given])
        group = Group.join(options.device)
        try:
            job = Job(
                run,
                options.out,
                resumes=options.resume,
                pause_at=options.pause_at,
                notes=_notes_on(run, options),
                make_log=make_log,
                make_callback=make_callback,
            )
            return told("galactic.train", lambda: train_in_rank(job, group), group.may_tell)
        finally:
            group.leave()

    return told("galactic.train", train)


def _launched(run: Run, folder: pathlib.Path, command: Sequence[str]) -> int:
    """Starts ranks to do the work. They need seconds before they print anything."""
    settings, checkpoints = run.settings, CheckpointFolder(folder, run.settings.keep)
    ranks = "1 rank" if settings.ranks == 1 else f"{settings.ranks} ranks"
    put(
        sys.stderr,
        f"{run.world}: {ranks} of {settings.envs} envs, {amount(settings.steps)} steps; starting ...\n",
    )
    before = checkpoints.complete()
    code = launch(settings.ranks, command)
    # Ranks that were still loading have ended silently.
    if code == INTERRUPTED and not checkpoints.complete() and not (folder / BEST).exists():
        put(sys.stderr, f"galactic.train: interrupted before anything was saved in {folder}\n")
    elif code == INTERRUPTED and checkpoints.complete() == before:
        put(
            sys.stderr,
            f"galactic.train: interrupted; no further checkpoint was saved in {folder}\n",
        )
    return code


def _log_maker(options: argparse.Namespace) -> log.MakeTaker | None:
    """The function that --log-to names, in the one rank that uses it. Also called before there are
    ranks, to report what is wrong with it."""
    is_used = options.log_to is not None and os.environ.get("RANK", "0") == "0"
    return log.maker(options.log_to) if is_used else None


def _notes_on(run: Run, options: argparse.Namespace) -> list[str]:
    """Notes on a new run whose options are allowed but seldom intended."""
    if options.preset not in TAUGHT or run.teacher is not None or run.demonstrations:
        return []
    return [
        f"the preset {options.preset} is made for a --teacher; without one, give it more --steps"
    ]


def _print_settings(options: argparse.Namespace) -> int:
    """Prints the settings of a new run with these options, whatever its world."""
    if options.resume:
        raise SettingsError(
            "--print-settings is for a new run; one that is resumed has its own in settings.json"
        )
    run = _run_of(options, pathlib.Path())
    if not put(sys.stdout, option_lines(run.settings)):
        raise lost_output()
    return OK


def _new_run(options: argparse.Namespace) -> Run:
    if options.world is None:
        raise SettingsError("which world? Name a world pack, or --resume a run")
    require_no_run(options.out)
    return _run_of(options, options.world.resolve())


def _run_of(options: argparse.Namespace, world: pathlib.Path) -> Run:
    given = given_options(options)
    for name in ("teacher_weight", "teacher_share"):
        if name in given and options.teacher is None:
            raise SettingsError(
                f"{option_name(name)} goes with --teacher; name one, or leave it out"
            )
    own_tasks.require_use(given)
    settings = preset("paper" if options.preset is None else options.preset, **given)
    settings.require_pace()
    if options.demonstrations:
        _require_imitation(options, given)
    run = Run(
        world,
        _absolute(options.validation),
        settings,
        _absolute(options.start_from),
        _absolute(options.teacher),
        demonstrations=[folder.resolve() for folder in options.demonstrations],
    )
    run = with_task(run, given.get("simulation", "")) if settings.task else run
    # Errors that do not depend on the world are reported once, before ranks open it.
    require_options(run.settings)
    if not settings.task:
        require_sensors(settings.critic_only)
    return with_network(run) if settings.has_own_network else run


def _require_imitation(options: argparse.Namespace, given: Mapping[str, Any]) -> None:
    """Raises SettingsError for options that a run with --demonstrations does not use."""
    of_acting = [
        option_name(field.name)
        for field in dataclasses.fields(Settings)
        if field.metadata["is_of_acting"] and field.name in given
    ]
    for option in [*(["--teacher"] if options.teacher is not None else []), *of_acting]:
        raise SettingsError(
            f"{option} is for a run that acts, and not for one with --demonstrations; leave one of them out"
        )


def _resumed_run(options: argparse.Namespace) -> Run:
    policies = options.start_from or options.teacher or options.demonstrations
    if options.world or options.preset or options.validation or policies:
        raise SettingsError(
            "a resumed run keeps its world, its preset, its weights, its teacher and its demonstrations; leave them out"
        )
    run = run_in(options.out)
    settings = resumed(run.settings, given_options(options))
    done = CheckpointFolder(options.out, settings.keep).steps
    if settings.steps != run.settings.steps and settings.steps < done:
        raise SettingsError(_behind("--steps", settings.steps, done) + "begin another run")
    if options.pause_at is not None and options.pause_at < done:
        raise SettingsError(_behind("--pause-at", options.pause_at, done) + "leave it out")
    return dataclasses.replace(run, settings=settings)


def _behind(option: str, found: int, done: int) -> str:
    return f"{option}: found {found:,}, and the run has done {done:,} steps; take more, or "


def _absolute(path: pathlib.Path | None) -> pathlib.Path | None:
    return None if path is None else path.resolve()


if __name__ == "__main__":
    sys.exit(main())
