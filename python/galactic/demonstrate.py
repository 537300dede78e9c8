"""Makes demonstrations to learn from: `python3 -m galactic.demonstrate world.pack -o demos --preset quick`."""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
import pathlib
import sys
from collections.abc import Sequence

import torch

import galactic
from galactic import files
from galactic.demonstration_writer import EPISODES_OF_PART, EPISODES_WITH_IMAGES
from galactic.demonstrations import About, Demonstrations
from galactic.learning.command import (
    EXIT_CODES,
    INTERRUPTED,
    OK,
    Parser,
    add_device_option,
    lost_output,
    named_path,
    told,
    whole,
)
from galactic.learning.homes import Homes, exact_camera
from galactic.learning.network_settings import CAMERA
from galactic.learning.playing.demonstrating import acting, begin, make_parts
from galactic.learning.playing.evaluation import MOST_ENVS
from galactic.learning.playing.experts import Expert, LearnedExpert, RolledIn, ScriptedExpert
from galactic.learning.presets import WORDS, preset
from galactic.learning.ranks.distributed import device_of, threads_of
from galactic.learning.refusals import SettingsError
from galactic.learning.reports.progress import ProgressLine
from galactic.learning.reports.shares import percent
from galactic.learning.setting_options import add_options, given_options
from galactic.learning.settings import Settings
from galactic.learning.simulation_words import simulation_keywords
from galactic.learning.user_code import own_code, own_tasks
from galactic.streams import put

SCRIPTED = "scripted"

# Settings that demonstrations depend on.
_SETTINGS = (
    "seed",
    "simulation",
    "task",
    "task_options",
    "network",
    *dict.fromkeys(CAMERA.values()),
)
# The same for a network of one's own.
_OF_OWN_NETWORK = ("network_options", "sees")


def make_parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="python3 -m galactic.demonstrate",
        description="Has an expert play each episode of a world once, and keeps what it saw and did, for "
        "galactic.train --demonstrations. Run again, it makes what is missing.",
        epilog=EXIT_CODES,
    )
    parser.add_argument("world", type=named_path, help="world pack")
    parser.add_argument(
        "-o",
        "--out",
        type=named_path,
        required=True,
        metavar="FOLDER",
        help="folder of the demonstrations",
    )
    parser.add_argument(
        "--expert",
        default=SCRIPTED,
        metavar=f"{SCRIPTED}|POLICY",
        help="who acts: the scripted policy, which plans by all that the simulation knows, or the best.pt or "
        f"policy.pt of a run ({SCRIPTED})",
    )
    parser.add_argument(
        "--learner",
        type=named_path,
        metavar="POLICY",
        help="this best.pt or policy.pt plays the beginning of each episode, and the expert goes on where it "
        "has led, which may be a place to which no expert comes",
    )
    parser.add_argument(
        "--learner-steps",
        type=whole(1, 1 << 30),
        metavar="STEPS",
        help="the most that it plays; how many in an episode is random (half of an episode's limit)",
    )
    parser.add_argument(
        "--deterministic",
        action="store_true",
        help="an expert that is a policy takes its likeliest actions, instead of samples",
    )
    parser.add_argument(
        "--episodes",
        type=whole(1, 1 << 30),
        metavar="N",
        help="only the first N episodes of the world (all)",
    )
    parser.add_argument(
        "--preset",
        default=None,
        metavar=WORDS,
        help="settings to start from (the paper's, but without images: --network state)",
    )
    parser.add_argument(
        "--threads", type=whole(0, 4096), default=0, metavar="N", help="0: all processors (0)"
    )
    add_device_option(parser, "where policies run")
    add_options(parser, (*_SETTINGS, *_OF_OWN_NETWORK))
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    options = make_parser().parse_args(arguments)
    return told("galactic.demonstrate", lambda: _demonstrate(options))


def _demonstrate(options: argparse.Namespace) -> int:
    _require_uses(options)
    settings, task = _settings(options)
    device = device_of(options.device, 0, 1)
    threads = threads_of(options.threads, 1)
    torch.set_num_threads(threads)
    homes = Homes(galactic.World(options.world), settings, threads, task=task)
    # Policies learn from the demonstrations for the task as it is at the end of training.
    homes.progress = 1.0
    _require_limit(homes)
    expert = _expert(options, homes, settings, device)
    episodes = homes.playable_episodes()[: options.episodes]
    if not episodes:
        message = "has no episode in which the robot can start; take another world"
        raise galactic.Error(galactic.ErrorCode.INVALID_INPUT, str(options.world), message)
    about = _about(options, homes, settings, len(episodes))
    folder: pathlib.Path = options.out
    files.require_folder(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with files.alone_in(folder):
        begin(folder, about)
        size = _episodes_of_part(settings)
        parts = [episodes[first : first + size] for first in range(0, len(episodes), size)]
        progress = ProgressLine()
        try:
            make_parts(folder, parts, homes, expert, settings.seed, progress)
        except KeyboardInterrupt:
            progress.say("interrupted; the same command makes what is missing")
            return INTERRUPTED
        finally:
            progress.close()
    homes.close()
    made = Demonstrations(folder)
    solved = [one for one in made if one.is_solved]
    steps = sum(int(one.by_expert.sum()) for one in solved)
    share = percent(len(solved) / len(made), len(made))
    text = f"{folder}: {len(solved):,} of {len(made):,} episodes are solved, {share}, by {steps:,} steps of the expert\n"
    if not put(sys.stdout, text):
        raise lost_output()
    return OK


def _episodes_of_part(settings: Settings) -> int:
    return EPISODES_WITH_IMAGES if settings.sight else EPISODES_OF_PART


def _settings(options: argparse.Namespace) -> tuple[Settings, own_tasks.MakeTask | None]:
    """The settings of the homes to play in, and a function that makes the task, if it is one's
    own."""
    given = given_options(options)
    own_tasks.require_use(given)
    if options.preset is None:
        chosen = preset("paper", **{"network": "state", **given})
    else:
        chosen = preset(options.preset, **given)
    envs = min(_episodes_of_part(chosen), MOST_ENVS)
    settings = dataclasses.replace(chosen, envs=envs, halves=1, mini_batches=1, critic_only="")
    if not settings.task:
        return settings, None
    name = own_code.named(settings.task, "--task")
    make = own_tasks.maker(name, settings.task_options)
    simulation = own_tasks.simulation_below(make(), chosen.simulation, given.get("simulation", ""))
    return dataclasses.replace(settings, task=str(name), simulation=simulation), make


def _expert(
    options: argparse.Namespace, homes: Homes, settings: Settings, device: torch.device
) -> Expert:
    expert: Expert
    if options.expert == SCRIPTED:
        expert = ScriptedExpert(homes)
    else:
        expert = LearnedExpert(
            acting(pathlib.Path(options.expert), homes, settings, options.deterministic, device)
        )
    if options.learner is None:
        return expert
    learner = acting(options.learner, homes, settings, False, device)
    return RolledIn(learner, expert, _learner_steps(options, homes), settings.seed)


def _learner_steps(options: argparse.Namespace, homes: Homes) -> int:
    """The largest number of steps that a learner plays in an episode."""
    limit = int(homes.env.simulators[0].options["episode_steps"])
    return options.learner_steps or max(1, limit // 2)


def _about(options: argparse.Namespace, homes: Homes, settings: Settings, episodes: int) -> About:
    has_learner = options.learner is not None
    is_learned = options.expert != SCRIPTED
    keywords = simulation_keywords(settings.simulation)
    task_file = own_code.named(options.setting_task, "--task").file if settings.task else None
    if settings.task:
        del keywords["task"]  # VectorEnv takes the class instead
    names = (*_SETTINGS, *(_OF_OWN_NETWORK if settings.has_own_network else ()))
    read = {
        "world": options.world,
        "expert": pathlib.Path(options.expert) if is_learned else None,
        "learner": options.learner,
        "task": task_file,
    }
    return About(
        world=str(options.world.resolve()),
        episodes=episodes,
        expert=str(pathlib.Path(options.expert).resolve()) if is_learned else SCRIPTED,
        parts=homes.parts,
        options=keywords,
        camera=exact_camera(settings) if settings.sight else None,
        meanings=homes.meanings,
        images=dict(homes.images),
        motions=homes.motions,
        made_with={
            "learner": str(options.learner.resolve()) if has_learner else None,
            "learner_steps": _learner_steps(options, homes) if has_learner else None,
            "deterministic": options.deterministic,
            "settings": {name: getattr(settings, name) for name in names},
            "sha256": {name: _sha256(file) for name, file in read.items() if file is not None},
        },
    )


def _sha256(file: pathlib.Path) -> str:
    """The hash of a file's content. That of a world pack covers the content of all its packs."""
    return hashlib.sha256(file.read_bytes()).hexdigest()


def _require_uses(options: argparse.Namespace) -> None:
    if not options.expert:
        raise SettingsError(f"--expert is empty; name a policy, or {SCRIPTED}")
    if options.learner_steps is not None and options.learner is None:
        raise SettingsError("--learner-steps goes with --learner; name one, or leave it out")
    if options.deterministic and options.expert == SCRIPTED:
        raise SettingsError("--deterministic is for an --expert that is a policy; leave it out")


def _require_limit(homes: Homes) -> None:
    """Raises SettingsError if an episode might never end, for example because the expert has given
    up."""
    if not homes.are_limited:
        raise SettingsError(
            "--simulation: found episode-steps=0, which lets episodes go on without end; give them a limit"
        )


if __name__ == "__main__":
    sys.exit(main())
