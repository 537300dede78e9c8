"""The setup in which a policy is judged: homes as in its training, but in another world, with the
requested task and noise."""

from __future__ import annotations

import dataclasses
import pathlib
import shlex
from typing import NamedTuple

import galactic
from galactic.learning.homes import Homes, sizes_of
from galactic.learning.playing.evaluation import MOST_ENVS
from galactic.learning.policies.fitting import other_meaning_of
from galactic.learning.refusals import CheckpointError, SettingsError
from galactic.learning.saving.checkpoint import SavedPolicy
from galactic.learning.settings import Settings
from galactic.learning.user_code import own_code
from galactic.learning.user_code.own_tasks import MakeTask, maker


@dataclasses.dataclass(frozen=True)
class Terms:
    """How the policy in one file is judged in the world in another. `episodes`: how many to play,
    from the first on, 0 for all. `camera_noise`, `robot_noise`: whether to use the noise of its
    training. `task`, `task_options`: the values of --task and --task-options; None for the
    simulation's task."""

    policy: pathlib.Path
    world: pathlib.Path
    seed: int = 1
    episodes: int = 0
    threads: int = 1
    camera_noise: bool = False
    robot_noise: bool = False
    task: str | None = None
    task_options: str | None = None


class Judging(NamedTuple):
    """The homes in which the policy plays, and what they were made from."""

    world: galactic.World
    settings: Settings
    task: MakeTask | None
    homes: Homes


def judging(saved: SavedPolicy, terms: Terms) -> Judging:
    """Prepares a judging. Raises SettingsError for terms that have no effect, and CheckpointError
    if the policy could not act in that world as it learned to."""
    task = _task(terms, saved.settings)
    world = galactic.World(terms.world)
    settings = dataclasses.replace(
        _with_noise_asked_for(terms, saved.settings),
        envs=max(1, min(MOST_ENVS, terms.episodes or world.episodes)),
        halves=1,
        mini_batches=1,
        seed=terms.seed,
    )
    homes = _homes(terms, world, settings, task)
    _require_fit(saved, homes, terms)
    return Judging(world, settings, task, homes)


def _task(terms: Terms, settings: Settings) -> MakeTask | None:
    """What makes the requested task; None for the simulation's."""
    if terms.task:
        name = own_code.named(terms.task, "--task")
        given = terms.task_options
        # The options of the training apply if the class is the same.
        if given is None and str(name).rpartition(":")[2] == settings.task.rpartition(":")[2]:
            given = settings.task_options
        return maker(name, given or "", own_code.siblings_of(name))
    if not settings.task:
        return None
    place = own_code.place_beside(terms.policy, "--task", settings.task)
    raise SettingsError(
        f"{terms.policy} was trained with a task of its own; if you trust it, add --task "
        f"{shlex.quote(place)}"
    )


def _with_noise_asked_for(terms: Terms, settings: Settings) -> Settings:
    """The settings with the requested noise of the training, and without the rest of it."""
    judged = settings
    for option, is_asked, plain, its_own in (
        (
            "--camera-noise",
            terms.camera_noise,
            Settings.without_camera_noise,
            "--depth-noise and the like",
        ),
        (
            "--robot-noise",
            terms.robot_noise,
            Settings.without_robot_noise,
            "--motion-noise and the like",
        ),
    ):
        if is_asked and plain(settings) == settings:
            raise SettingsError(
                f"{option}: {terms.policy} was trained without such noise; leave it out, or play the "
                f"policy's pack with galactic-run {its_own}"
            )
        if not is_asked:
            judged = plain(judged)
    return judged


def _homes(terms: Terms, world: galactic.World, settings: Settings,
           task: MakeTask | None) -> Homes:  # fmt: skip
    """The homes of the policy's training. Errors in their options are reported as the policy's, as
    the user did not type them here."""
    try:
        return Homes(world, settings, terms.threads, task=task, is_evaluation=True)
    except SettingsError as error:
        if task is not None:
            raise
        raise CheckpointError(
            f"{terms.policy} was trained with options that this version does not have: {error}; "
            "take another policy, or train one"
        ) from error
    except galactic.Error as error:
        where = f"{terms.policy} in {terms.world}: {error.where}"
        raise galactic.Error(error.code, where, error.message) from error


def _require_fit(saved: SavedPolicy, homes: Homes, terms: Terms) -> None:
    """Raises CheckpointError if the homes do not fit the observations or the training of the
    policy."""
    if homes.parts != saved.parts:
        raise CheckpointError(
            f"{terms.policy} was trained on observations of {sizes_of(saved.parts)}, and "
            f"{terms.world} gives {sizes_of(homes.parts)}; evaluate it on worlds with the same robot"
            + (", by a task that observes the same" if terms.task else "")
        )
    other = other_meaning_of(saved, homes.meanings)
    if other:
        raise CheckpointError(
            f"{terms.policy} learned with {other.option}={other.learned}, found {other.found} in "
            f"{terms.world}, where the same numbers mean something else; evaluate it on worlds whose task "
            "has the same"
        )
    if not homes.are_limited:
        raise CheckpointError(
            f"{terms.policy} was trained in episodes without a limit (episode-steps=0), of which an "
            "evaluation may never end; export it, and play it with galactic-run --episode-steps N"
        )
