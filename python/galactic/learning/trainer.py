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
"""Plays this rank's share of the validation episodes, and returns their sums."""


class TrainingError(ArithmeticError):
    """Training cannot go on. The message says at which update, what was found and what may help."""


class _Ending(enum.Enum):
    """Why training ends after an update."""

    NONE = 0
    """Training goes on."""
    GOAL = 1
    """All requested steps are done."""
    CALLBACK = 2
    """The callback asked to stop."""
    CUT_OFF = 3
    """A signal asked to stop, and something is left to do."""


class _Owed(enum.Enum):
    """What a signal has put off; the next part of the run does it first."""

    NOTHING = 0
    VALIDATION = 1
    VALIDATION_AND_END = 2
    """The callback had also asked to end the run."""


class Trainer:
    """A run: everything that `python3 -m galactic.train` does after it has read its command line.

    With `folder` None, nothing is written. `parts` are names and sizes of the parts of an
    observation, for users of the policy. `teacher`: see Teacher, with the file it comes from.
    `demonstrations`: what the policy learns from, instead of acting in `envs`. `network` makes the
    network of the settings, if that is user-defined. Every rank makes a Trainer, and calls the same
    methods.
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
            # The same layout as the pictures. For some other layers, torch rejects it.
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
        """The user's callback. All ranks have one or none; only the first rank calls the user's
        code."""
        self.steps = 0
        self.updates = 0
        self.best = Score()
        """The score of best.pt."""
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
        """Gives the policy the weights of another run's policy: see checkpoint.begin_with(). To be
        called before begin()."""
        saved = checkpoint.begin_with(
            self.policy, self.settings, self.shape, self.parts, file, self.network
        )
        other = other_meaning(dict(saved.parts), saved.meanings, self.meanings)
        if other:
            self.reports.progress.say(
                f"{file} learned with {other.option}={other.learned}, and this run has {other.found}: the same "
                "numbers mean something else, which it has to learn anew"
            )
        # The other run may have replaced the file between the reads of two ranks.
        self.learner.share_policy()

    def begin(self) -> None:
        """Starts at the first step."""
        self.source.reset()
        self.clock.start()

    def train(self, pause_at: int | None = None) -> bool:
        """Trains until `settings.steps` or `pause_at` steps are done, or until the callback or a
        signal asks to stop. Then it saves, and validates, unless a signal stopped it. A validation
        that a signal has put off comes first. Returns whether nothing was cut off. Raises
        TrainingError if the loss is not a number."""
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
            # Written within the context, so that a repeated signal does not interrupt it. The
            # previous part of the run may have been cut off after its last checkpoint, before its
            # report.
            self._write_report()
        return ending is not _Ending.CUT_OFF

    def _make_up(self, goal: int) -> _Ending:
        """Does what a signal has put off, if anything. Returns whether and why the run ends after
        that."""
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
        """One update, and whatever is due after it, by the number of steps done or because the run
        ends here."""
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
        """Calls the callback. Returns, on all ranks, whether it asks to end the run."""
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
        """One rollout and one update. Returns the losses and whether a signal asked any rank to
        stop."""
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
        """Whether something that happens every `every` steps, and at the end, is due after the
        steps since `before`."""
        is_next = every > 0 and self.steps // every > before // every
        return ending is not _Ending.NONE or is_next

    def _row(self, losses: dict[str, float]) -> dict[str, float]:
        """The values of a row of the curves."""
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
        """Validates the policy. Returns `ending`, or CALLBACK if the callback ends the run here."""
        assert self.validation is not None
        with self.stopwatch.time("validation"):
            sums = self.validation(self.policy).by_name(self.names)
            found = EpisodeSums.of(over_ranks(self.group, sums), self.names)
        row = self.reports.tell_validation(self.steps, found)
        self._keep_if_best(found.means())
        self._owed = _Owed.NOTHING
        return _Ending.CALLBACK if self._calls_stop(VALIDATED, lambda: row) else ending

    def _keep_if_best(self, means: Mapping[str, float]) -> None:
        """Writes best.pt if no earlier policy was better than this one, whose episodes had these
        means. An equal one replaces the earlier, since it was trained longer."""
        score = Score(means.get("success"), means.get("return"))
        if score.is_below(self.best):
            return
        self.best = score
        with self.group.together(OSError):
            if self.folder and self.group.rank == 0:
                checkpoint.save_policy(self._saved_policy(score), self.folder / BEST)

    def save(self) -> None:
        """Writes a checkpoint; all ranks call this after the same update. If one of them fails, all
        raise its Error or OSError, such as for a full disk."""
        if self.validation is None:
            self._keep_if_best(self.recent.figures())
        if self.checkpoints is None:
            return
        with self.stopwatch.time("reports"):
            try:
                self._write_checkpoint(self.checkpoints)
            except BaseException:
                # This includes Ctrl-C, which reaches all ranks.
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
        """Writes this rank's files of a checkpoint."""
        checkpoint.save(folder / f"rank-{self.group.rank}.pt", {}, self.source.state_dict())
        if self.group.rank == 0:
            checkpoint.save_policy(self._saved_policy(), folder / POLICY)
            optimizer = {"optimizer": self.learner.optimizer.state_dict()}
            # The rows that the file counts must be on the disk before it is.
            rows = self.reports.curves.keep()
            checkpoint.save(folder / "trainer.pt", self._state(rows).to_values(), optimizer)

    def resume(self) -> None:
        """Loads the latest checkpoint. The run goes on as it would have without the interruption,
        on a processor bit for bit. If one rank finds something wrong, all raise its error:
        CheckpointError, or Error if a file is missing."""
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
        """Reads the score of the existing best.pt, which may be newer than the checkpoint, so that
        no worse policy replaces it."""
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
        """Handles SIGINT and SIGTERM. Each Ctrl-C arrives exactly once, as launch() keeps ranks out
        of the terminal's process group; the second one stops at once. SIGTERM can arrive twice: job
        schedulers send it to all processes, and launch() passes its own on. So a repeated SIGTERM
        is ignored."""
        if self._interrupted and number == signal.SIGINT:
            raise KeyboardInterrupt
        if not self._interrupted:
            self._interrupted = True
            self.reports.progress.say("stopping after this update; Ctrl-C now stops without saving")


def _fitting(file: pathlib.Path, remedy: str) -> AbstractContextManager[None]:
    """A context for loading the contents of `file`."""
    return refusing(f"{file} does not fit this run", remedy)
