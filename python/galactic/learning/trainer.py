"""The training loop: collect, update, report, save; the same on every rank."""

from __future__ import annotations

import enum
import pathlib
import signal
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Any

import torch

from galactic import interrupts
from galactic.demonstrations import Demonstrations
from galactic.learning.policies.fitting import Observed
from galactic.learning.policies.networks import Policy, PolicyShape
from galactic.learning.policies.privileges import columns_among, critic_columns, other_meaning
from galactic.learning.ranks.distributed import Group
from galactic.learning.refusals import refusing
from galactic.learning.reports.curves import TABLE, write_json
from galactic.learning.reports.run_reports import RunReports
from galactic.learning.rollouts.collector import Collector, CollectorOptions
from galactic.learning.rollouts.environments import Environments
from galactic.learning.rollouts.episode_sums import EpisodeSums, OwnNames, RecentEpisodes
from galactic.learning.rollouts.rollout import RolloutSource
from galactic.learning.rollouts.stopwatch import RunClock
from galactic.learning.saving import checkpoint
from galactic.learning.saving.checkpoint import SavedPolicy, Score, new_policy
from galactic.learning.saving.run_folder import BEST, POLICY, CheckpointFolder
from galactic.learning.saving.trainer_state import TrainerState, state_of
from galactic.learning.settings import Settings
from galactic.learning.sums import over_ranks
from galactic.learning.updates.imitation import (
    DemonstrationSampler,
    ImitationLearner,
    require_same,
)
from galactic.learning.updates.learner import Learner
from galactic.learning.updates.ppo import PpoLearner
from galactic.learning.updates.teacher import Teacher
from galactic.learning.user_code.callbacks import END, UPDATE, Callback, Moment
from galactic.learning.user_code.callbacks import VALIDATION as VALIDATED
from galactic.learning.user_code.own_networks import OwnNetwork

Validation = Callable[[Policy], EpisodeSums]
"""Runs the episodes for validation that are this rank's, and returns their sums."""


class TrainingError(ArithmeticError):
    """Training cannot go on: says at which update, what was found, what may help."""


class _Ending(enum.Enum):
    """Why training ends behind an update."""

    NONE = 0
    """It goes on."""
    GOAL = 1
    """All steps that were asked for are done."""
    CALLBACK = 2
    """The callback asks for it."""
    CUT_OFF = 3
    """A signal does, and something is left to do."""


class _Owed(enum.Enum):
    """What a signal has put off, for the next part of the run to begin with."""

    NOTHING = 0
    VALIDATION = 1
    VALIDATION_AND_END = 2
    """And the end that the callback asked for before it."""


class Trainer:
    """A run: all that `python3 -m galactic.train` does after it has read its command line.

    `folder` None writes nothing. `parts` are names and sizes of the parts of an observation, for those
    who use the policy. `teacher`: see Teacher, with the file it comes from. `demonstrations`: what it learns
    from, instead of what it does in `envs`. `network` makes that of the settings, if it is one of the user's. Every
    rank makes one, and calls the same methods.
    """

    def __init__(self, settings: Settings, envs: Environments, group: Group,
                 folder: pathlib.Path | None, *, validation: Validation | None = None,
                 teacher: tuple[SavedPolicy, pathlib.Path] | None = None,
                 demonstrations: Demonstrations | None = None,
                 network: OwnNetwork | None = None,
                 title: str = "run"):  # fmt: skip
        self.settings = settings
        self.envs = envs
        self.group = group
        self.folder = folder
        self.validation = validation
        self.names = OwnNames(tuple(envs.measures), tuple(envs.logs))
        torch.manual_seed(settings.seed)
        self.parts: list[tuple[str, int]] = list(envs.parts)
        self.meanings: dict[str, Any] = dict(envs.meanings)
        self.shape = PolicyShape(
            envs.state_size,
            envs.motions,
            envs.decides_terminate,
            settings.normalize,
            settings.closeup,
            settings.second_closeup,
            critic_columns(settings.critic_only, self.parts),
        )
        self.network = network
        self.policy = new_policy(settings, self.shape, self.parts, network).to(group.device)
        for layer in self.policy.modules():
            # As pictures lie in memory. Torch refuses it for parameters of some other layers.
            if envs.images and isinstance(layer, torch.nn.Conv2d):
                layer.to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        self.learner: Learner
        self.source: RolloutSource
        if demonstrations is not None:
            observed = Observed(self.parts, self.meanings, envs.motions)
            require_same(demonstrations, settings, observed, envs.images)
            self.learner = ImitationLearner(self.policy, settings, group)
            self.source = DemonstrationSampler(demonstrations, settings, self.policy, group)
        else:
            self.learner = PpoLearner(self.policy, settings, group, self._taught_by(teacher))
            self.source = self._collector()
        self.stragglers = group.stragglers(settings.sync_fraction, settings.shortest_rollout)
        self.stopwatch = self.source.stopwatch
        self.clock = RunClock()
        self.checkpoints = CheckpointFolder(folder, settings.keep) if folder else None
        self.reports = RunReports(
            settings,
            folder,
            title,
            self.names,
            self.clock,
            self.stopwatch,
            is_heard=group.rank == 0,
        )
        self.callback: Callback | None = None
        """What looks on: the same on all ranks, of which the first one calls it."""
        self.steps = 0
        self.updates = 0
        self.best = Score()
        """Of best.pt."""
        self.recent = RecentEpisodes(self.names, settings.window, settings.envs * group.size)
        self._interrupted = False
        self._owed = _Owed.NOTHING

    def _taught_by(self, teacher: tuple[SavedPolicy, pathlib.Path] | None) -> Teacher | None:
        if teacher is None:
            return None
        return Teacher(*teacher, Observed(self.parts, self.meanings, self.envs.motions), self.group)

    def _collector(self) -> Collector:
        settings = self.settings
        options = CollectorOptions(
            settings.horizon,
            settings.seed,
            settings.gamma,
            self.group.rank * settings.envs,
            settings.cuda_graphs,
            settings.timeouts != "ends",
            columns_among(["time"], self.parts) if settings.timeouts == "endless" else (),
        )
        precision = self.learner.precision
        return Collector(self.envs, self.policy, options, precision, self.group.device)

    def start_from(self, file: pathlib.Path) -> None:
        """Gives the policy the weights of another run's: see checkpoint.begin_with(). Before begin()."""
        saved = checkpoint.begin_with(
            self.policy, self.settings, self.shape, self.parts, file, self.network
        )
        other = other_meaning(dict(saved.parts), saved.meanings, self.meanings)
        if other:
            self.reports.progress.say(
                f"{file} learned with {other.option}={other.learned}, and this run has {other.found}: the same "
                "numbers mean something else, which it has to learn anew"
            )
        # Its run may have replaced the file while ranks read it, one after the other.
        self.learner.share_policy()

    def begin(self) -> None:
        """Starts at the first step."""
        self.source.reset()
        self.clock.start()

    def train(self, pause_at: int | None = None) -> bool:
        """Trains until `settings.steps` are done, or `pause_at` of them, or the callback or a signal asks to
        stop; validates in all cases but the last, saves in all. A validation that a signal has put off comes first.
        Returns whether all is done. Raises TrainingError when the loss is not a number."""
        steps = self.settings.steps
        goal = steps if pause_at is None else min(pause_at, steps)
        with interrupts.handled(self._interrupt):
            ending = self._make_up(goal)
            while ending is _Ending.NONE:
                ending = self._advance(goal)
            self._calls_stop(END, lambda: self._row({}))
            if self.reports.added:
                self.reports.add_row(self._row({}))
                self.reports.write(is_last=True)
            self.reports.progress.close()
            # Here, too, a signal that comes again is not to end it. It may have been cut off behind its last
            # checkpoint the time before.
            self._write_report()
        return ending is not _Ending.CUT_OFF

    def _make_up(self, goal: int) -> _Ending:
        """Does what a signal has put off, if there is anything. Returns whether nothing comes after that."""
        owed = self._owed
        if owed is _Owed.NOTHING:
            return self._ending_at(goal)
        ending = self._validate(self._ending_at(goal))
        if owed is _Owed.VALIDATION_AND_END:
            ending = _Ending.CALLBACK
        self.reports.write(is_last=True)
        if ending is not _Ending.NONE:
            self.save()
        return ending

    def _advance(self, goal: int) -> _Ending:
        """One update, and what is due behind it: by how many steps are done, and where this is the end."""
        before = self.steps
        losses, is_interrupted = self._iterate()
        ending = self._ending_at(goal)
        if self._calls_stop(UPDATE, lambda: self._row(losses)):
            ending = _Ending.CALLBACK
        if self._validates and self._is_due(self.settings.validate_every, before, ending):
            if not is_interrupted:
                ending = self._validate(ending)
            elif ending is _Ending.CALLBACK:
                self._owed = _Owed.VALIDATION_AND_END
            else:
                self._owed = _Owed.VALIDATION
        if is_interrupted and (ending is _Ending.NONE or self._owed is not _Owed.NOTHING):
            ending = _Ending.CUT_OFF
        is_last = ending is not _Ending.NONE
        if is_last or self.reports.are_due:
            self._log(losses, is_last=is_last)
        if self._is_due(self.settings.checkpoint_every, before, ending):
            self.save()
        return ending

    def _ending_at(self, goal: int) -> _Ending:
        return _Ending.GOAL if self.steps >= goal else _Ending.NONE

    def _calls_stop(self, kind: str, row: Callable[[], dict[str, float]]) -> bool:
        """Lets the callback know where the run is. Returns whether the run is to end, on all ranks."""
        if self.callback is None:
            return False
        stop = torch.zeros(1, device=self.group.device)
        if self.group.rank == 0:
            moment = Moment(kind, row(), self.policy)
            with self.stopwatch.time("reports"):
                self.callback(moment)
            self.reports.added |= moment.added
            if moment.reason and kind != END:
                self.reports.progress.say(f"--callback: {moment.reason}")
                stop += 1.0
        return bool(self.group.sum(stop) > 0.0)

    @property
    def _validates(self) -> bool:
        return self.validation is not None and self.settings.validate_every > 0

    def _iterate(self) -> tuple[dict[str, float], bool]:
        """One rollout and one update. Returns the losses and whether some rank was told to stop."""
        horizon, update = self.settings.horizon, self.updates
        self.envs.progress = self.steps / self.settings.steps
        rollout = self.source.collect(
            update, lambda step: self.stragglers.should_stop(update, step, horizon)
        )
        if rollout.steps == horizon:
            self.stragglers.finished(update)
        with self.stopwatch.time("update"):
            losses = self.learner.update(rollout, update, self.steps / self.settings.steps)
        shared = over_ranks(
            self.group,
            {
                "rollout_steps": rollout.steps * self.settings.envs,
                "interrupted": self._interrupted,
                "waiting": self.source.waiting,
                **self.source.episodes.by_name(self.names),
            },
        )
        self.stragglers.forget(update)
        self.steps += int(shared["rollout_steps"])
        self.updates += 1
        self.recent.add(EpisodeSums.of(shared, self.names), int(shared["waiting"]))
        if not all(abs(value) < float("inf") for value in losses.values()):
            raise TrainingError(
                f"update {self.updates} gave a loss that is not a number ({losses}); a lower "
                "--learning-rate or --max-grad-norm may help"
            )
        return losses, shared["interrupted"] > 0.0

    def _is_due(self, every: int, before: int, ending: _Ending) -> bool:
        """What comes every so many steps, and at the end, after those that followed `before`."""
        is_next = every > 0 and self.steps // every > before // every
        return ending is not _Ending.NONE or is_next

    def _row(self, losses: dict[str, float]) -> dict[str, float]:
        """What a row of the curves has."""
        return {
            "steps": self.steps,
            "seconds": self.clock.seconds,
            "updates": self.updates,
            "sps": self.reports.speed(self.steps),
            "episodes": self.recent.total().episodes,
            "learning_rate": self.learner.optimizer.learning_rate,
            **losses,
            **self.recent.figures(),
        }

    def _log(self, losses: dict[str, float], is_last: bool = False) -> None:
        self.reports.tell_update(
            self._row(losses),
            self.recent.figures(),
            imitates=not self.source.plays_episodes,
            is_last=is_last,
        )

    def _validate(self, ending: _Ending) -> _Ending:
        """Returns `ending`, or that the callback ends the run here."""
        assert self.validation is not None
        with self.stopwatch.time("validation"):
            sums = self.validation(self.policy).by_name(self.names)
            found = EpisodeSums.of(over_ranks(self.group, sums), self.names)
        row = self.reports.tell_validation(self.steps, found)
        self._keep_if_best(found.means())
        self._owed = _Owed.NOTHING
        return _Ending.CALLBACK if self._calls_stop(VALIDATED, lambda: row) else ending

    def _keep_if_best(self, means: Mapping[str, float]) -> None:
        """Writes best.pt, for a policy whose episodes had these means, when none was better; equal ones replace it,
        being trained longer."""
        score = Score(means.get("success"), means.get("return"))
        if score.is_below(self.best):
            return
        self.best = score
        with self.group.together(OSError):
            if self.folder and self.group.rank == 0:
                checkpoint.save_policy(self._saved_policy(score), self.folder / BEST)

    def save(self) -> None:
        """Writes a checkpoint; all ranks call it after the same update. Raises on all ranks what keeps one of them from
        it: Error or OSError, as where the disk is full."""
        if self.validation is None:
            self._keep_if_best(self.recent.figures())
        if self.checkpoints is None:
            return
        with self.stopwatch.time("reports"):
            try:
                self._write_checkpoint(self.checkpoints)
            except BaseException:
                # Also Ctrl-C, which comes to all ranks.
                if self.group.rank == 0:
                    self.checkpoints.give_up(self.steps)
                raise

    def _write_checkpoint(self, checkpoints: CheckpointFolder) -> None:
        with self.group.together(OSError):
            if self.group.rank == 0:
                checkpoints.begin(self.steps)
        with self.group.together(OSError):
            self._write_into(checkpoints.unfinished(self.steps))
        with self.group.together(OSError):
            if self.group.rank == 0:
                checkpoints.finish(self.steps)

    def _write_into(self, folder: pathlib.Path) -> None:
        """This rank's files of a checkpoint."""
        checkpoint.save(folder / f"rank-{self.group.rank}.pt", {}, self.source.state_dict())
        if self.group.rank == 0:
            checkpoint.save_policy(self._saved_policy(), folder / POLICY)
            optimizer = {"optimizer": self.learner.optimizer.state_dict()}
            # Those that it counts are there before it is.
            rows = self.reports.curves.keep()
            checkpoint.save(folder / "trainer.pt", self._state(rows).to_values(), optimizer)

    def resume(self) -> None:
        """Takes up the latest checkpoint: what follows is what would have followed, on a processor
        bit for bit. Raises on all ranks what one of them finds wrong: CheckpointError, or Error where a
        file is missing."""
        assert self.checkpoints is not None
        with self.group.together():
            self._take_up(self.checkpoints.latest(), self.checkpoints.without_latest)

    def _take_up(self, folder: pathlib.Path, remedy: str) -> None:
        file = folder / "trainer.pt"
        values, tensors = checkpoint.load(file, remedy)
        with _fitting(file, remedy):
            state = state_of(values, self.group.size, self.names, folder)
            self._take_up_state(state)
            self.learner.optimizer.load_state_dict(tensors.get("optimizer", {}))
        file = folder / POLICY
        saved = checkpoint.load_policy(file, remedy, self.network)
        with _fitting(file, remedy):
            self.policy.load_state_dict(saved.policy.state_dict())
        file = folder / f"rank-{self.group.rank}.pt"
        _, tensors = checkpoint.load(file, remedy)
        with _fitting(file, remedy):
            self.source.load_state_dict(tensors)
        self._take_up_best()
        self._take_up_curves(state)
        self.steps = saved.steps
        self.clock.start()
        self.reports.begin_at(self.steps)

    def _take_up_best(self) -> None:
        """The best.pt that is there may be of after the checkpoint: a worse one is not to take its place."""
        assert self.folder is not None
        file = self.folder / BEST
        if file.exists():
            self.best = checkpoint.read_score(
                file, "move it away, and the run keeps the best policy from here on"
            )

    def _take_up_curves(self, state: TrainerState) -> None:
        assert self.folder is not None
        with _fitting(self.folder / TABLE, "move it away, and the curves begin anew"):
            self.reports.take_up(state.row_count, state.added_columns, state.added)

    def _take_up_state(self, state: TrainerState) -> None:
        self.updates = state.updates
        self.learner.rate.share = state.rate_share
        self._owed = _Owed.NOTHING
        if state.must_validate and self._validates:
            self._owed = _Owed.VALIDATION_AND_END if state.must_end else _Owed.VALIDATION
        self.recent.take_up(state.window, state.waiting)
        self.stopwatch.seconds = dict(state.stopwatch)
        self.clock.take_up(state.seconds, state.processor_seconds)

    def _saved_policy(self, score: Score = Score()) -> SavedPolicy:
        return SavedPolicy(
            self.policy,
            self.settings,
            self.shape,
            self.parts,
            self.steps,
            score.success,
            self.meanings,
            self.network,
            score.mean_return,
        )

    def _state(self, row_count: int) -> TrainerState:
        return TrainerState(
            ranks=self.group.size,
            updates=self.updates,
            rate_share=self.learner.rate.share,
            must_validate=self._owed is not _Owed.NOTHING,
            must_end=self._owed is _Owed.VALIDATION_AND_END,
            row_count=row_count,
            added_columns=self.reports.curves.added,
            added=self.reports.added,
            waiting=self.recent.waiting,
            measures=list(self.names.measures),
            logs=list(self.names.logs),
            window=self.recent.rows(),
            seconds=self.clock.seconds,
            processor_seconds=self.clock.processor_seconds,
            stopwatch=self.stopwatch.seconds,
        )

    def _write_report(self) -> None:
        if not self.folder or self.group.rank > 0:
            return
        write_json(
            self.folder / "report.json",
            {
                "settings": self.settings.to_dict(),
                "ranks": self.group.size,
                "device": str(self.group.device),
                "parameters": self.learner.optimizer.parameters.numel(),
                "steps": self.steps,
                "must_validate": self._owed is not _Owed.NOTHING,
                "updates": self.updates,
                "seconds": self.clock.seconds,
                "processor_seconds": self.clock.processor_seconds,
                "steps_per_second": self.steps / max(self.clock.seconds, 1e-9),
                "best_success": self.best.success,
                "best_return": self.best.mean_return,
                "training": self.recent.figures(),
                "validation": self.reports.curves.latest_validation(),
                "timing": self.stopwatch.tables(
                    self.updates, self.settings.horizon, self.source.PHASES
                ),
            },
        )

    def _interrupt(self, number: int) -> None:
        """Ctrl-C comes as often as it is typed: launch() keeps ranks out of the group of the terminal. What ends a
        job sends one SIGTERM to all of its processes, and those that have ranks pass theirs on."""
        if self._interrupted and number == signal.SIGINT:
            raise KeyboardInterrupt
        if not self._interrupted:
            self._interrupted = True
            self.reports.progress.say("stopping after this update; Ctrl-C now stops without saving")


def _fitting(file: pathlib.Path, remedy: str) -> AbstractContextManager[None]:
    """Around taking over what `file` holds."""
    return refusing(f"{file} does not fit this run", remedy)
