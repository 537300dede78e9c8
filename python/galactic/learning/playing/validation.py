"""Validations: from time to time, a run plays episodes that were held out of its training."""

from __future__ import annotations

import dataclasses

import galactic
from galactic.learning.homes import Homes, sizes_of
from galactic.learning.playing import evaluation
from galactic.learning.policies.networks import Policy
from galactic.learning.policies.privileges import other_meaning, parts_of_actor
from galactic.learning.ranks.distributed import Group
from galactic.learning.refusals import SettingsError
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.saving.runs import Run
from galactic.learning.trainer import Validation
from galactic.learning.user_code.own_tasks import MakeTask


def validation_of(
    run: Run, trained: Homes, threads: int, group: Group, task: MakeTask | None
) -> Validation | None:
    """A function that plays this rank's share of the held-out episodes, with sampled actions as in
    training. `trained` are the homes of the training. Raises galactic.Error if a policy trained
    there could not play in the validation world."""
    settings = run.settings
    if run.validation is None or not settings.validate_every:
        return None
    envs = min(settings.envs, evaluation.MOST_ENVS)
    held_out = dataclasses.replace(settings.without_noise(), envs=envs, halves=1, mini_batches=1)
    homes = Homes(
        galactic.World(run.validation),
        held_out,
        threads,
        task=task,
        is_evaluation=True,
        device=group.device,
    )
    if homes.parts != trained.parts:
        raise galactic.Error(
            galactic.ErrorCode.INVALID_INPUT,
            str(run.validation),
            f"gives observations of {sizes_of(homes.parts)}, and {run.world} of "
            f"{sizes_of(trained.parts)}; validate in a world with the same robot",
        )
    seen = dict(parts_of_actor(settings.critic_only, trained.parts))
    other = other_meaning(seen, trained.meanings, homes.meanings)
    if other:
        message = (
            f"found {other.option}={other.found}, expected {other.learned} as in {run.world}: the same "
            "numbers mean something else; validate in a world whose task has the same"
        )
        raise galactic.Error(galactic.ErrorCode.INVALID_INPUT, str(run.validation), message)
    if not homes.are_limited:
        raise SettingsError(
            "--simulation: episode-steps is 0, and a validation of episodes without a limit may never "
            "end; limit them, or leave out --validation"
        )
    playable = homes.playable_episodes()
    if not playable:
        message = "has no episode in which the robot can start; validate in another world"
        raise galactic.Error(galactic.ErrorCode.INVALID_INPUT, str(run.validation), message)
    episodes = playable[: settings.validation_episodes or None][group.rank :: group.size]

    def validate(policy: Policy) -> EpisodeSums:
        # Without this, noise would continue from the previous validation, whose state a resumed run
        # does not have.
        homes.restart(settings.seed)
        actor = evaluation.Actor(
            policy, deterministic=False, seed=settings.seed, device=group.device
        )
        player = evaluation.Evaluator(homes, actor)
        return evaluation.sums_of(player.play(episodes, details=False))

    return validate
