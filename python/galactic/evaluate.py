"""Evaluates a policy, or all that a run keeps: `python3 -m galactic.evaluate runs/pick/best.pt world.pack`."""

from __future__ import annotations

import argparse
import json
import pathlib
import sys
from collections.abc import Sequence
from typing import Any

import torch

from galactic import files
from galactic.learning import dynamics
from galactic.learning.command import (
    EXIT_CODES,
    OK,
    Parser,
    add_device_option,
    lost_output,
    named_path,
    told,
    whole,
)
from galactic.learning.homes import Homes
from galactic.learning.playing import evaluation
from galactic.learning.playing.judging import Judging, Terms, judging
from galactic.learning.ranks.distributed import device_of, threads_of
from galactic.learning.refusals import SettingsError
from galactic.learning.reports import pictures
from galactic.learning.reports.comparison import OF_SHARES
from galactic.learning.reports.curves import write_json
from galactic.learning.reports.progress import amount
from galactic.learning.reports.shares import percent, percent_of
from galactic.learning.saving import checkpoint
from galactic.learning.saving.run_folder import BEST, files_of, policies_in
from galactic.learning.user_code import own_code
from galactic.streams import put


def make_parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="python3 -m galactic.evaluate",
        description="Plays each episode of a world once with a policy, and says how well it did.",
        epilog=EXIT_CODES,
    )
    parser.add_argument(
        "policy",
        type=named_path,
        help="best.pt or policy.pt of a run, or its folder: each policy in it, a row of a table for each",
    )
    parser.add_argument("world", type=named_path, help="world pack")
    actions = parser.add_mutually_exclusive_group()
    actions.add_argument(
        "--sampled", action="store_true", help="sample actions, as in training (the default)"
    )
    actions.add_argument("--deterministic", action="store_true", help="take the likeliest actions")
    parser.add_argument(
        "--episodes",
        type=whole(0, 1 << 31),
        default=0,
        metavar="N",
        help="play the first N episodes; 0: all (0)",
    )
    parser.add_argument(
        "--seed",
        type=whole(0, 2**63 - 1),
        metavar="N",
        default=1,
        help="seed of everything random, such as sampled actions (1)",
    )
    parser.add_argument(
        "--threads",
        type=whole(0, 4096),
        metavar="N",
        default=0,
        help="number of threads; 0: one per processor (0)",
    )
    add_device_option(parser, "where the policy runs")
    parser.add_argument(
        "--camera-noise",
        action="store_true",
        help="let it see with the noise and jitter of its training, not images as they are",
    )
    parser.add_argument(
        "--robot-noise",
        action="store_true",
        help="let robots move and know their place with the noise and delay of its training, not exactly",
    )
    parser.add_argument(
        "--report", type=named_path, metavar="FILE.json", help="write the report to this file"
    )
    shown = parser.add_argument_group("Pictures of successes and failures, from behind the robot")
    shown.add_argument(
        "--contact-sheet",
        type=named_path,
        metavar="FILE.png",
        help="draw a row for each episode, from start to end",
    )
    shown.add_argument(
        "--video",
        type=named_path,
        metavar="FILE.mp4",
        help="show the same episodes moving; needs ffmpeg",
    )
    shown.add_argument(
        "--shown",
        type=whole(1, 1000),
        metavar="N",
        help="how many episodes the pictures show (8)",
    )
    parser.add_argument(
        "--network",
        metavar="FILE.py:CLASS|MODULE:CLASS",
        help="the class of a network of your own; needed for a policy that was trained with one, as no policy "
        "runs code by itself",
    )
    own = parser.add_argument_group("A task of your own, for what pays and what a success is")
    own.add_argument(
        "--task",
        metavar="FILE.py:CLASS|MODULE:CLASS",
        help="the class; needed for a policy that was trained with one, as no policy runs code by itself",
    )
    own.add_argument(
        "--task-options",
        metavar="OPTIONS",
        help="what it is made with, as NAME=VALUE separated by spaces (for a class of the training's "
        "name, those of the training)",
    )
    massive = parser.add_argument_group("The same episodes where things have mass")
    massive.add_argument(
        "--dynamics",
        type=named_path,
        metavar="WORLD.toml",
        help="play them with galactic-dynamics, too, which has to be installed: the recipe that "
        "the world was baked from",
    )
    massive.add_argument(
        "--dynamics-data",
        type=named_path,
        metavar="DIR",
        help="where files of the recipe are that are not beside it",
    )
    massive.add_argument(
        "--arm",
        choices=("motors", "kinematic"),
        help="what moves the arm there (motors)",
    )
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    options = make_parser().parse_args(arguments)
    return told("galactic.evaluate", lambda: _evaluate(options))


SHOWN = 8
"""Default number of episodes in pictures."""


def _require_uses(options: argparse.Namespace) -> None:
    """Raises SettingsError for an option that would have no effect."""
    for option, value, user, what, remedy in (
        ("--shown", options.shown, _draws(options), "pictures", "--contact-sheet or --video"),
        ("--arm", options.arm, options.dynamics, "dynamics", "--dynamics"),
        ("--task-options", options.task_options, options.task, "a task of your own", "--task"),
        ("--dynamics-data", options.dynamics_data, options.dynamics, "dynamics", "--dynamics"),
    ):
        if value is not None and not user:
            raise SettingsError(f"{option} applies to {what} only; add {remedy}")
    if options.policy.is_dir():
        for option, value in (
            ("--contact-sheet", options.contact_sheet),
            ("--video", options.video),
            ("--dynamics", options.dynamics),
        ):
            if value is not None:
                raise SettingsError(
                    f"{option} is for one policy, and {options.policy} is a folder; name best.pt or a policy.pt in it"
                )
    if options.task is not None:
        own_code.named(options.task, "--task")
    if options.task and options.dynamics:
        raise SettingsError("--dynamics knows no task of your own; leave one of them out")
    if options.robot_noise and options.dynamics:
        raise SettingsError("--dynamics knows no noise nor delay of robots; leave one of them out")


def _evaluate(options: argparse.Namespace) -> int:
    _require_uses(options)
    # Playing may take long.
    _require_outputs(options)
    device, threads = device_of(options.device, 0, 1), threads_of(options.threads, 1)
    torch.set_num_threads(threads)
    if options.policy.is_dir():
        return _evaluate_run(options, threads, device)
    return _evaluate_policy(options, threads, device)


def _evaluate_run(options: argparse.Namespace, threads: int, device: torch.device) -> int:
    """Evaluates each policy in the folder of a run, as if it had been named."""
    names = {file: _name_in_run(file) for file in policies_in(options.policy)}
    width = max(map(len, names.values()))
    is_told = put(sys.stdout, _row("policy".ljust(width), *_COLUMNS))
    found: list[dict[str, object]] = []
    for file, name in names.items():
        saved = checkpoint.read_policy(file, options.network)
        judged = judging(saved, _terms(options, file, threads))
        _, results = _played(options, saved, judged, device)
        summary = evaluation.summary(results, judged.world)
        is_told &= put(sys.stdout, _row(name.ljust(width), *_cells(saved.steps, summary)))
        found.append({"policy": str(file), "trained_steps": saved.steps, **summary})
    is_told &= put(sys.stdout, f"(episodes: {len(results)}; {OF_SHARES})\n")
    if options.report:
        about = _about(options, device)
        write_json(options.report, {"run": str(options.policy), **about, "policies": found})
    if not is_told:
        raise lost_output()
    return OK


def _name_in_run(policy: pathlib.Path) -> str:
    """best.pt, or the steps of a checkpoint, as in the name of its folder."""
    return policy.name if policy.name == BEST else policy.parent.name


_COLUMNS = ("steps", "success", "picked", "return", "length", "spl")


def _cells(steps: int, summary: dict[str, Any]) -> list[str]:
    share = percent(summary["success"], summary["episodes"])
    rest = [f"{summary[name]:.4g}" for name in _COLUMNS[2:]]
    return [amount(steps), share, *rest]


def _row(name: str, steps: str, success: str, *rest: str) -> str:
    """A row of the table of a run, which is printed row by row."""
    line = f"{name}  {steps:8}  {success:23}  " + "  ".join(f"{one:7}" for one in rest)
    return line.rstrip() + "\n"


def _played(
    options: argparse.Namespace,
    saved: checkpoint.SavedPolicy,
    judged: Judging,
    device: torch.device,
) -> tuple[evaluation.Actor, list[evaluation.EpisodeResult]]:
    """Lets a policy play the episodes that are asked for, and closes the homes."""
    actor = evaluation.Actor(
        saved.policy.to(device),
        deterministic=options.deterministic,
        seed=options.seed,
        device=device,
    )
    episodes = judged.homes.playable_episodes()[: options.episodes or None]
    results = evaluation.Evaluator(judged.homes, actor).play(episodes)
    judged.homes.close()
    return actor, results


def _evaluate_policy(options: argparse.Namespace, threads: int, device: torch.device) -> int:
    saved = checkpoint.read_policy(options.policy, options.network)
    pack = dynamics.packed(options.policy, options.network) if options.dynamics else b""
    judged = judging(saved, _terms(options, options.policy, threads))
    if options.dynamics:
        _tell_what_is_left_out(judged.homes)
    actor, results = _played(options, saved, judged, device)
    summary = evaluation.summary(results, judged.world)
    is_told = put(sys.stdout, _text(summary))
    there = None
    if options.dynamics:
        there = _play_there(options, pack)
        is_told &= put(sys.stdout, _text(dict(dynamics.told(there))))
    if options.report:
        policy = {"policy": str(options.policy), "trained_steps": saved.steps}
        report = {**policy, **_about(options, device), **summary}
        write_json(options.report, {**report, **({"dynamics": there} if there else {})})
    if _draws(options) and results:
        chosen = pictures.choose(results, options.shown or SHOWN)
        films = pictures.film(judged.world, judged.settings, actor, chosen, threads, judged.task)
        if options.contact_sheet:
            pictures.write_contact_sheet(films, options.contact_sheet)
        if options.video:
            pictures.write_video(films, options.video)
    if not is_told:
        raise lost_output()
    return OK


def _draws(options: argparse.Namespace) -> bool:
    return bool(options.contact_sheet or options.video)


def _require_outputs(options: argparse.Namespace) -> None:
    """Raises Error if an output that is asked for cannot be made or cannot be written."""
    if _draws(options):
        pictures.require_tools(video=bool(options.video))
    if options.dynamics:
        dynamics.require_tool()
    outputs = {
        "--report": options.report,
        "--contact-sheet": options.contact_sheet,
        "--video": options.video,
    }
    recipe = [options.dynamics] if options.dynamics else []
    own = (("--task", options.task), ("--network", options.network))
    code_files = [own_code.named(name, option).file for option, name in own if name is not None]
    code = [file for file in code_files if file is not None]
    is_run = options.policy.is_dir()
    policies = files_of(options.policy) if is_run else [options.policy]
    files.require_apart(outputs, [*policies, options.world, *recipe, *code])
    for file in outputs.values():
        if file:
            files.require_writable(file)
    if options.contact_sheet:
        pictures.require_png(options.contact_sheet)
    if options.video:
        pictures.require_video(options.video)


def _terms(options: argparse.Namespace, policy: pathlib.Path, threads: int) -> Terms:
    return Terms(
        policy=policy,
        world=options.world,
        seed=options.seed,
        episodes=options.episodes,
        threads=threads,
        camera_noise=options.camera_noise,
        robot_noise=options.robot_noise,
        task=options.task,
        task_options=options.task_options,
    )


def _about(options: argparse.Namespace, device: torch.device) -> dict[str, object]:
    """What a report is about, besides the policy."""
    task = {"task": options.task, "task_options": options.task_options} if options.task else {}
    return {
        "world": str(options.world),
        "deterministic": options.deterministic,
        "seed": options.seed,
        "camera_noise": options.camera_noise,
        "robot_noise": options.robot_noise,
        "device": str(device),
        **task,
        **({"network": options.network} if options.network else {}),
    }


def _tell_what_is_left_out(homes: Homes) -> None:
    """Warns if the world's task has noise and delay that the dynamics leave out."""
    noise = dynamics.noise_left_out(homes.env.simulators[0].options)
    if noise:
        message = f"robots there move without the noise and delay of the world's task ({noise})"
        put(sys.stderr, f"galactic.evaluate: --dynamics: {message}\n")


def _play_there(options: argparse.Namespace, pack: bytes) -> dict[str, object]:
    return dynamics.play(
        dynamics.DynamicsRun(
            policy=options.policy,
            pack=pack,
            world=options.world,
            recipe=options.dynamics,
            data=options.dynamics_data,
            arm=options.arm or "motors",
            deterministic=options.deterministic,
            seed=options.seed,
            episodes=options.episodes,
            threads=options.threads,
        )
    )


def _text(summary: dict[str, Any]) -> str:
    lines = []
    for name, value in summary.items():
        if name in ("each", "success_interval"):
            continue
        shown = f"{value:.4g}" if isinstance(value, float) else json.dumps(value)
        if name == "success":
            shown = percent_of(summary["success"], summary["episodes"])
        lines.append(f"{name:10} {shown}\n")
    return "".join(lines)


if __name__ == "__main__":
    sys.exit(main())
