"""The training loop: collect, update, report, save; the same on every rank."""

from __future__ import annotations

import collections
import math
import os
import pathlib
import signal
import time
from typing import Any, Callable, ContextManager, Optional, Union

import torch

from galactic import interrupts
from galactic.demonstrations import Demonstrations
from galactic.errors import Error
from galactic.learning import checkpoint, older
from galactic.learning.callbacks import CALLBACK, END, UPDATE, Callback, Moment
from galactic.learning.callbacks import VALIDATION as VALIDATED
from galactic.learning.checkpoint import CheckpointFolder, SavedPolicy, new_policy
from galactic.learning.collector import Collector, CollectorOptions
from galactic.learning.distributed import Group
from galactic.learning.environments import Environments
from galactic.learning.episode_sums import MEASURE, EpisodeSums, OwnNames
from galactic.learning.fitting import Observed
from galactic.learning.imitation import ImitationLearner, Streams, require_same
from galactic.learning.learner import Learner
from galactic.learning.networks import Policy, PolicyShape
from galactic.learning.own_networks import OwnNetwork
from galactic.learning.ppo import PpoLearner
from galactic.learning.privileges import columns_among, critic_columns, other_meaning
from galactic.learning.refusals import CheckpointError, refusing, require_types
from galactic.learning.reports.curves import VALIDATION, Curves, columns_of, write_json
from galactic.learning.reports.log import Log
from galactic.learning.reports.progress import ProgressLine, amount, duration
from galactic.learning.settings import Settings
from galactic.learning.teacher import Teacher

Validation = Callable[[Policy], EpisodeSums]
"""Runs the episodes for validation that are this rank's, and returns their sums."""


class TrainingError(ArithmeticError):
    """Training cannot go on: says at which update, what was found, what may help."""


class Trainer:
    """A run: all that `python3 -m galactic.train` does after it has read its command line.

    `folder` None writes nothing. `parts` are names and sizes of the parts of an observation, for those
    who use the policy. `teacher`: see Teacher, with the file it comes from. `demonstrations`: what it learns
    from, instead of what it does in `envs`. `network` makes that of the settings, if it is one of the user's. Every rank makes one, and calls the same methods.
    """

    def __init__(self, settings: Settings, envs: Environments, group: Group,
                 folder: Optional[pathlib.Path], *, validation: Optional[Validation] = None,
                 teacher: Optional[tuple[SavedPolicy, pathlib.Path]] = None,
                 demonstrations: Optional[Demonstrations] = None,
                 network: Optional[OwnNetwork] = None,
                 title: str = "run"):  # fmt: skip
        self.settings = settings
        self.envs = envs
        self.group = group
        self.folder = folder
        self.validation = validation
        self.names = OwnNames(tuple(envs.measures), tuple(envs.logs))
        torch.manual_seed(settings.seed)
        self.parts: list[tuple[str, int]] = list(getattr(envs, "parts", []))
        self.meanings: dict[str, Any] = dict(getattr(envs, "meanings", {}))
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
        if envs.images:
            self.policy = self.policy.to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        self.learner: Learner
        self.source: Union[Collector, Streams]
        if demonstrations is not None:
            observed = Observed(self.parts, self.meanings, envs.motions)
            require_same(demonstrations, settings, observed, envs.images)
            self.learner = ImitationLearner(self.policy, settings, group)
            self.source = Streams(demonstrations, settings, self.policy, group)
        else:
            self.learner = PpoLearner(self.policy, settings, group, self._taught_by(teacher))
            self.source = self._collector()
        self.stragglers = group.stragglers(settings.sync_fraction, settings.shortest_rollout)
        self.stopwatch = self.source.stopwatch
        self.checkpoints = CheckpointFolder(folder, settings.keep) if folder else None
        self.curves = Curves(folder if group.rank == 0 else None, title, self.names)
        self.progress = ProgressLine(quiet=group.rank > 0)
        self.log: Optional[Log] = None
        """Who else takes rows of the curves."""
        self.callback: Optional[Callback] = None
        """What looks on: the same on all ranks, of which the first one calls it."""
        self.steps = 0
        self.updates = 0
        self.best: Optional[float] = None
        self._window: collections.deque[EpisodeSums] = collections.deque()
        # Envs of all ranks that have not finished an episode yet.
        self._waiting = settings.envs * group.size
        self._seconds_before = 0.0
        self._processor_seconds_before = 0.0
        self._started = time.perf_counter()
        self._logged = (0.0, 0)
        self._speed = 0.0
        self._interrupted = False
        # What a signal has put off: a validation, and the end that a callback asked for behind it.
        self._must_validate = False
        self._must_end = False
        # What the callback has said since the latest row.
        self._added: dict[str, float] = {}

    def _taught_by(self, teacher: Optional[tuple[SavedPolicy, pathlib.Path]]) -> Optional[Teacher]:
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

    @property
    def seconds(self) -> float:
        """Wall clock since the run began, over all its parts."""
        return self._seconds_before + time.perf_counter() - self._started

    @property
    def processor_seconds(self) -> float:
        """The same of this rank's processor time."""
        return self._processor_seconds_before + time.process_time()

    def start_from(self, file: pathlib.Path) -> None:
        """Gives the policy the weights of another run's: see checkpoint.begin_with(). Before begin()."""
        saved = checkpoint.begin_with(
            self.policy, self.settings, self.shape, self.parts, file, self.network
        )
        other = other_meaning(dict(saved.parts), saved.meanings, self.meanings)
        if other:
            self.progress.say(
                f"{file} learned with {other.option}={other.learned}, and this run has {other.found}: the same "
                "numbers mean something else, which it has to learn anew"
            )
        # Its run may have replaced the file while ranks read it, one after the other.
        self.learner.share_policy()

    def begin(self) -> None:
        """Starts at the first step."""
        self.source.reset()
        self._started = time.perf_counter()

    def train(self, pause_at: Optional[int] = None) -> bool:
        """Trains until `settings.steps` are done, or `pause_at` of them, or the callback or a signal asks to
        stop; validates in all cases but the last, saves in all. A validation that a signal has put off comes first.
        Returns whether all is done. Raises TrainingError when the loss is not a number."""
        settings = self.settings
        end = settings.steps if pause_at is None else min(pause_at, settings.steps)
        with interrupts.handled(self._interrupt):
            if self._must_validate:
                late = self._validate()
                if self._calls_stop(VALIDATED, lambda: late) or self._must_end:
                    end = self.steps
                self._must_end = False
                self._write_curves(is_last=True)
                if self.steps >= end:
                    self.save()
            while self.steps < end:
                before = self.steps
                losses, stop = self._iterate()
                is_stopped = self._calls_stop(UPDATE, lambda: self._values(losses))
                if is_stopped:
                    end = self.steps
                if self._validates and self._is_due(settings.validate_every, before, end):
                    self._must_validate = True
                if self._must_validate and not stop:
                    row = self._validate()
                    if self._calls_stop(VALIDATED, lambda: row):
                        end = self.steps
                is_last = stop or self.steps >= end
                self._must_end = self._must_validate and is_stopped
                if is_last or self.seconds - self._logged[0] >= settings.log_every:
                    self._log(losses, is_last=is_last)
                if stop or self._is_due(settings.checkpoint_every, before, end):
                    self.save()
                if stop:
                    break
            self._calls_stop(END, lambda: self._values({}))
            if self._added:
                self._add_row(self._values({}))
                self._write_curves(is_last=True)
            self.progress.close()
            # Here, too, a signal that comes again is not to end it. It may have been cut off behind its last
            # checkpoint the time before.
            self._write_report()
        return self.steps >= end and not self._must_validate

    def _calls_stop(self, kind: str, row: Callable[[], dict[str, float]]) -> bool:
        """Lets the callback know where the run is. Returns whether the run is to end, on all ranks."""
        if self.callback is None:
            return False
        stop = torch.zeros(1, device=self.group.device)
        if self.group.rank == 0:
            moment = Moment(kind, row(), self.policy)
            with self.stopwatch.time("reports"):
                self.callback(moment)
            self._added |= moment.added
            if moment.reason and kind != END:
                self.progress.say(f"--callback: {moment.reason}")
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
        shared = torch.tensor(
            [
                float(rollout.steps * self.settings.envs),
                float(self._interrupted),
                float(self.source.waiting),
                *self.source.episodes.numbers(self.names),
            ],
            dtype=torch.float64,
            device=self.group.device,
        )
        steps, stop, waiting, *episodes = self.group.sum(shared).tolist()
        self.stragglers.forget(update)
        self.steps += int(steps)
        self.updates += 1
        self._waiting = int(waiting)
        self._remember(EpisodeSums.of(episodes, self.names))
        if not all(abs(value) < float("inf") for value in losses.values()):
            raise TrainingError(
                f"update {self.updates} gave a loss that is not a number ({losses}); a lower "
                "--learning-rate or --max-grad-norm may help"
            )
        return losses, stop > 0.0

    def _is_due(self, every: int, before: int, end: int) -> bool:
        """What comes every so many steps, and at the end, after those that followed `before`."""
        return self.steps >= end or (every > 0 and self.steps // every > before // every)

    def _remember(self, sums: EpisodeSums) -> None:
        """Keeps the episodes of as few rollouts as cover the window."""
        self._window.append(sums)
        kept = sum(one.episodes for one in self._window)
        while kept - self._window[0].episodes >= self.settings.window:
            kept -= self._window.popleft().episodes

    def recent(self) -> EpisodeSums:
        """The latest episodes of training, `window` or a few more."""
        return EpisodeSums.total(self._window, self.names)

    def figures(self) -> dict[str, float]:
        """Success, return, length and what the task measures, means over recent(); none before every env
        has finished an episode: those that are over first are the short ones, successes most of all.
        """
        return {} if self._waiting else self.recent().means()

    def _add_row(self, values: dict[str, float]) -> None:
        values = {**values, **self._added}
        self._added.clear()
        self.curves.add(values)
        if self.log is not None:
            with self.stopwatch.time("reports"):
                self.log.add(values)

    def _values(self, losses: dict[str, float]) -> dict[str, float]:
        """A row of the curves."""
        seconds, steps = self._logged
        if self.steps > steps:
            self._speed = (self.steps - steps) / max(self.seconds - seconds, 1e-9)
        return {
            "steps": self.steps,
            "seconds": self.seconds,
            "updates": self.updates,
            "sps": self._speed,
            "episodes": self.recent().episodes,
            "learning_rate": self.learner.optimizer.learning_rate,
            **losses,
            **self.figures(),
        }

    def _log(self, losses: dict[str, float], is_last: bool = False) -> None:
        values, figures = self._values(losses), self.figures()
        self._logged = (self.seconds, self.steps)
        speed = values["sps"]
        self._add_row(values)
        left = (self.settings.steps - self.steps) / max(speed, 1e-9)
        if isinstance(self.source, Streams):
            goes = f"loss {losses['policy_loss']:.2f}"
        elif figures:
            goes = f"success {100.0 * figures['success']:.1f} %  return {figures['return']:.2f}"
        else:
            goes = "success -  return -"
        self.progress.show(
            f"{amount(self.steps)} of {amount(self.settings.steps)} steps  "
            f"{amount(speed)} steps/s  {goes}  {duration(left)} left"
            + "".join(f"  {one}" for one in _measured(figures))
        )
        self._write_curves(is_last=is_last)

    def _write_curves(self, *, is_last: bool) -> None:
        with self.stopwatch.time("reports"):
            shares = self.stopwatch.shares(self.seconds)
            self.curves.write(self.settings.to_dict(), shares, is_last=is_last)

    def _validate(self) -> dict[str, float]:
        """Returns the row of the curves."""
        assert self.validation is not None
        with self.stopwatch.time("validation"):
            sums = torch.tensor(
                self.validation(self.policy).numbers(self.names),
                dtype=torch.float64,
                device=self.group.device,
            )
            found = EpisodeSums.of(self.group.sum(sums).tolist(), self.names)
        means = found.means()
        named = {VALIDATION + name: value for name, value in means.items()}
        row = {"steps": self.steps, "seconds": self.seconds, **named}
        self._add_row(row)
        self.progress.say(
            f"validation after {amount(self.steps)} steps: success "
            f"{100.0 * means['success']:.1f} % of {found.episodes:.0f} episodes, return "
            f"{means['return']:.2f}" + "".join(f", {one}" for one in _measured(means))
        )
        self._keep_if_best(means["success"])
        self._must_validate = False
        return row

    def _keep_if_best(self, success: Optional[float]) -> None:
        """Writes best.pt when none was better; equal ones replace it, being trained longer."""
        if self.best is not None and (success is None or success < self.best):
            return
        self.best = success
        if self.folder and self.group.rank == 0:
            checkpoint.save_policy(self._saved_policy(success), self.folder / "best.pt")

    def save(self) -> None:
        """Writes a checkpoint; all ranks call it after the same update."""
        if self.validation is None:
            self._keep_if_best(self.figures().get("success"))
        if self.checkpoints is None:
            return
        with self.stopwatch.time("reports"):
            if self.group.rank == 0:
                self.checkpoints.begin(self.steps)
            self.group.wait_for_all()
            folder = self.checkpoints.unfinished(self.steps)
            checkpoint.save(folder / f"rank-{self.group.rank}.pt", {}, self.source.state_dict())
            if self.group.rank == 0:
                checkpoint.save_policy(self._saved_policy(None), folder / "policy.pt")
                optimizer = {"optimizer": self.learner.optimizer.state_dict()}
                checkpoint.save(folder / "trainer.pt", self._counters(), optimizer)
            self.group.wait_for_all()
            if self.group.rank == 0:
                self.checkpoints.finish(self.steps)

    def resume(self) -> None:
        """Takes up the latest checkpoint: what follows is what would have followed, on a processor
        bit for bit. Raises on all ranks what one of them finds wrong: CheckpointError, or Error where a
        file is missing."""
        assert self.checkpoints is not None
        fault = None
        try:
            self._take_up(self.checkpoints.latest(), self.checkpoints.without_latest)
        except (CheckpointError, Error) as error:
            fault = error
        self.group.raise_on_all(fault)

    def _take_up(self, folder: pathlib.Path, remedy: str) -> None:
        file = folder / "trainer.pt"
        counters, tensors = checkpoint.load(file, remedy)
        with _fitting(file, remedy):
            counters = older.trainer_values(counters)
            require_types(counters, _COUNTERS)
            if counters["ranks"] != self.group.size:
                raise CheckpointError(
                    f"{folder} is of {counters['ranks']} ranks, not {self.group.size}; start as many"
                )
            for said, known, found in (
                ("measured", self.names.measures, counters["measures"]),
                ("logged", self.names.logs, counters["logs"]),
            ):
                lost = [name for name in found if name not in known]
                if lost:
                    raise CheckpointError(
                        f"{folder} is of a task that {said} {lost[0]}, and the task does so no longer; put "
                        "its class back as it was, or begin another run"
                    )
            self._take_counters(counters)
            self.learner.optimizer.load_state_dict(tensors.get("optimizer", {}))
        file = folder / "policy.pt"
        saved = checkpoint.load_policy(file, remedy, self.network)
        with _fitting(file, remedy):
            self.policy.load_state_dict(saved.policy.state_dict())
        file = folder / f"rank-{self.group.rank}.pt"
        _, state = checkpoint.load(file, remedy)
        with _fitting(file, remedy):
            self.source.load_state_dict(older.rank_tensors(state))
        self.steps = saved.steps
        self._started = time.perf_counter()
        self._logged = (self.seconds, self.steps)

    def _take_counters(self, counters: dict[str, Any]) -> None:
        self.updates, self.best = counters["updates"], counters["best"]
        self.learner.rate.share = counters["rate_share"]
        self._must_validate = counters["must_validate"] and self._validates
        self._must_end = counters["must_end"] and counters["must_validate"]
        names = OwnNames(tuple(counters["measures"]), tuple(counters["logs"]))
        columns = (*columns_of(names), *map(str, counters["added_columns"]))
        rows = _rows(counters, "rows", len(columns), (float, int, type(None)))
        self.curves.take_up(rows, columns)
        require_types(counters["added"], dict.fromkeys(counters["added"], (float, int)))
        self._added = {
            name: value for name, value in counters["added"].items() if name.startswith(CALLBACK)
        }
        width = len(EpisodeSums().numbers(names))
        self._window.clear()
        for numbers in _rows(counters, "window", width, (float, int)):
            sums = EpisodeSums.of(numbers, names)
            sums.measures = {**dict.fromkeys(self.names.measures, math.nan), **sums.measures}
            sums.logs = {**dict.fromkeys(self.names.logs, math.nan), **sums.logs}
            self._window.append(sums)
        require_types(counters["stopwatch"], dict.fromkeys(counters["stopwatch"], (float, int)))
        self.stopwatch.seconds = dict(counters["stopwatch"])
        self._waiting, self._seconds_before = counters["waiting"], counters["seconds"]
        # This process has used some before it took up the run.
        self._processor_seconds_before = counters["processor_seconds"] - time.process_time()

    def _saved_policy(self, success: Optional[float]) -> SavedPolicy:
        return SavedPolicy(
            self.policy,
            self.settings,
            self.shape,
            self.parts,
            self.steps,
            success,
            self.meanings,
            self.network,
        )

    def _counters(self) -> dict[str, Any]:
        return {
            "ranks": self.group.size,
            "updates": self.updates,
            "best": self.best,
            "rate_share": self.learner.rate.share,
            "must_validate": self._must_validate,
            "must_end": self._must_end,
            "rows": self.curves.rows,
            "added_columns": self.curves.added,
            "added": self._added,
            "waiting": self._waiting,
            **self.names._asdict(),
            "window": [sums.numbers(self.names) for sums in self._window],
            "seconds": self.seconds,
            "processor_seconds": self.processor_seconds,
            "stopwatch": self.stopwatch.seconds,
        }

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
                "must_validate": self._must_validate,
                "updates": self.updates,
                "seconds": self.seconds,
                "processor_seconds": self.processor_seconds,
                "steps_per_second": self.steps / max(self.seconds, 1e-9),
                "best_success": self.best,
                "training": self.figures(),
                "validation": self.curves.latest_validation(),
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
            self.progress.say("stopping after this update; Ctrl-C now stops without saving")


# Of a trainer.pt: types that JSON gives its values.
_COUNTERS = {
    "ranks": int,
    "updates": int,
    "best": (float, int, type(None)),
    "rate_share": (float, int),
    "must_validate": bool,
    "must_end": bool,
    "rows": list,
    "added_columns": list,
    "added": dict,
    "waiting": int,
    "measures": list,
    "logs": list,
    "window": list,
    "seconds": (float, int),
    "processor_seconds": (float, int),
    "stopwatch": dict,
}


def _rows(values: dict[str, Any], name: str, width: int, kinds: Any) -> list[list[Any]]:
    """The table of that name; ValueError where a row has another width or kind of numbers."""
    for number, row in enumerate(values[name]):
        are_numbers = isinstance(row, list) and all(isinstance(one, kinds) for one in row)
        if not are_numbers or len(row) != width:
            raise ValueError(f"{name}[{number}]: found {row!r}, expected {width} numbers")
    return list(values[name])


def _fitting(file: pathlib.Path, remedy: str) -> ContextManager[None]:
    """Around taking over what `file` holds."""
    return refusing(f"{file} does not fit this run", remedy)


def _measured(means: dict[str, float]) -> list[str]:
    """What a task of one's own measures, for a line."""
    return [
        f"{name.removeprefix(MEASURE)} {value:.3g}"
        for name, value in means.items()
        if name.startswith(MEASURE)
    ]


def threads_of(wanted: int, local_ranks: int) -> int:
    """Of one rank; 0: its share of the processors that this process may use."""
    return wanted or max(1, len(os.sched_getaffinity(0)) // local_ranks)
