"""Learning by imitation: makes the demonstrated actions the likeliest ones of a policy (behavioral
cloning: Pomerleau 1989; with a memory, as in Wijmans et al. 2020, over stretches of episodes)."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Callable, Mapping

import numpy as np
import torch
from torch import Tensor

from galactic._core import EpisodeEnd
from galactic.demonstrations import Demonstrations, require_alike
from galactic.hashing import hashed
from galactic.learning.homes import exact_camera
from galactic.learning.policies.fitting import Observed
from galactic.learning.policies.networks import Policy
from galactic.learning.ranks.distributed import Group
from galactic.learning.refusals import CheckpointError
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.rollouts.rollout import Rollout
from galactic.learning.rollouts.stopwatch import Stopwatch
from galactic.learning.saving.checkpoint import require_tensors
from galactic.learning.settings import Settings
from galactic.learning.sums import Sums, over_ranks
from galactic.learning.updates.learner import Learner
from galactic.learning.updates.schedules import learning_rate_at


@dataclasses.dataclass
class DemonstrationRollout(Rollout):
    """A rollout taken from demonstrations. Values, rewards and log-probabilities are not filled."""

    returns: Tensor = dataclasses.field(default_factory=lambda: torch.zeros(0))
    """[T, N]: the discounted return from that step to the end of the episode."""
    by_expert: Tensor = dataclasses.field(default_factory=lambda: torch.zeros(0, dtype=torch.bool))
    """[T, N] bool: the steps in which the expert acted, which are those to learn from."""
    last_hidden: Tensor = dataclasses.field(default_factory=lambda: torch.zeros(0))
    """[N, H]: the memory after the last step, which the learner fills."""


class DemonstrationSampler:
    """Fills rollouts with solved episodes: each of the N envs is replaced by a stream of episodes,
    one after the other. Each rank has its share of the episodes, and shuffles it anew for each
    pass."""

    PHASES = ("reading",)
    plays_episodes = False

    def __init__(
        self, demonstrations: Demonstrations, settings: Settings, policy: Policy, group: Group
    ):
        """Raises CheckpointError if there are fewer solved episodes than ranks."""
        solved = np.flatnonzero(demonstrations.endings == EpisodeEnd.SUCCESS)
        if len(solved) < group.size:
            raise CheckpointError(
                f"{_named(demonstrations)}: found {len(solved)} solved episodes, expected {group.size} at "
                "least, one for each rank; let galactic.demonstrate make more"
            )
        self._demonstrations = demonstrations
        self._share = solved[group.rank :: group.size]
        self._digest = _digest_of(demonstrations)
        self._seed = settings.seed
        self._returns = _returns_of(demonstrations, settings.gamma)
        self._device = group.device
        self.episodes = EpisodeSums()
        self.waiting = settings.envs
        """All envs count as waiting for their first end of an episode, as no episodes are
        played."""
        self.stopwatch = Stopwatch()
        about = demonstrations.about
        images = {name: about.images[name] for name in settings.sight}
        empty = Rollout.empty(
            settings.horizon,
            settings.envs,
            about.state_size,
            about.motions + 2,
            images,
            policy.hidden_size,
            group.device,
        )
        self.rollout = DemonstrationRollout(
            **vars(empty),
            returns=torch.zeros_like(empty.rewards),
            by_expert=torch.zeros_like(empty.ends),
            last_hidden=empty.rewards.new_zeros(settings.envs, policy.hidden_size),
        )
        # `_begun` is the number of episodes that all streams have begun, over all passes. `_at` has
        # a row for each stream: the number of its episode in this count, and how many steps of it
        # are done. `_orders` is the order of the share in a pass, by the number of the pass.
        self._begun = 0
        self._at = np.zeros((settings.envs, 2), np.int64)
        self._orders: dict[int, np.ndarray] = {}

    def reset(self) -> None:
        """Begins a first episode in each stream."""
        streams = len(self._at)
        self._at[:, 0] = np.arange(streams)
        self._at[:, 1] = 0
        self._begun = streams

    def collect(
        self, update: int, should_stop: Callable[[int], bool] = lambda step: False
    ) -> DemonstrationRollout:
        """The next `horizon` steps of each stream; overwritten by the next call."""
        rollout = self.rollout
        with self.stopwatch.time("reading"):
            if rollout.steps:
                self._begin_again()
            self._fill(self._next_rows())
            rollout.steps = len(rollout.actions)
        return rollout

    def state_dict(self) -> dict[str, Tensor]:
        """All that the next collect() depends on."""
        state = {
            "digest": self._digest,
            "begun": torch.tensor(self._begun),
            "at": torch.from_numpy(self._at.copy()),
            "previous": self._previous_after().cpu(),
        }
        first = self.rollout.first_hidden
        if first is not None:
            state["hidden"] = (self.rollout.last_hidden if self.rollout.steps else first).cpu()
        return state

    def load_state_dict(self, state: dict[str, Tensor]) -> None:
        """Raises ValueError unless `state` fits this number of streams and these demonstrations."""
        require_tensors(state, self.state_dict())
        if not torch.equal(state["digest"], self._digest):
            raise ValueError(
                f"{_named(self._demonstrations)}: found other demonstrations than those with which the run "
                "began; put those back"
            )
        begun, at = int(state["begun"]), state["at"].numpy()
        lengths = [self._length(int(number)) for number in at[:, 0] if 0 <= number < begun]
        if len(lengths) < len(at) or (at[:, 1] < 0).any() or (at[:, 1] >= lengths).any():
            raise ValueError("found places that are in no episode")
        self._begun = begun
        self._at[:] = at
        if self.rollout.first_hidden is not None:
            self.rollout.first_hidden.copy_(state["hidden"])
        self.rollout.first_previous.copy_(state["previous"])
        self.rollout.steps = 0

    def _begin_again(self) -> None:
        rollout = self.rollout
        rollout.first_previous.copy_(self._previous_after())
        if rollout.first_hidden is not None:
            rollout.first_hidden.copy_(rollout.last_hidden)
        rollout.steps = 0

    def _previous_after(self) -> Tensor:
        """[N, A]: the action before the next step; where an episode begins, it is not used."""
        rollout = self.rollout
        return rollout.actions[-1] if rollout.steps else rollout.first_previous

    def _length(self, number: int) -> int:
        return int(self._demonstrations.lengths[self._episode(number)])

    def _next_rows(self) -> np.ndarray:
        """int64 [T, N]: the rows of the next steps among all demonstrations. Marks in the rollout
        where episodes begin."""
        starts = np.zeros(self.rollout.actions.shape[:2], np.bool_)
        rows = np.empty(starts.shape, np.int64)
        horizon, streams = rows.shape
        demonstrations = self._demonstrations
        for stream in range(streams):
            step = 0
            while step < horizon:
                number, position = self._at[stream]
                episode = self._episode(int(number))
                count = min(int(demonstrations.lengths[episode]) - position, horizon - step)
                first = demonstrations.first_rows[episode] + position
                rows[step : step + count, stream] = np.arange(first, first + count)
                starts[step, stream] = position == 0
                step += count
                self._at[stream, 1] += count
                if self._at[stream, 1] == demonstrations.lengths[episode]:
                    self._at[stream] = self._begun, 0
                    self._begun += 1
        self.rollout.starts[:horizon] = torch.from_numpy(starts).to(self._device)
        return rows

    def _fill(self, rows: np.ndarray) -> None:
        rollout, horizon = self.rollout, len(rows)
        for name in ("state", "rgb", "depth", "actions", "by_expert"):
            target = getattr(rollout, name)
            if target is not None:
                source = torch.from_numpy(self._demonstrations.take(name, rows))
                target[:horizon].copy_(source)
        rollout.returns.copy_(torch.from_numpy(self._returns[rows]))

    def _episode(self, number: int) -> int:
        """The demonstration that is number `number` in the sequence of all passes over the
        share."""
        share = self._share
        one, place = divmod(number, len(share))
        if one not in self._orders:
            keys = hashed(self._seed ^ 0x73686F77, share, np.full_like(share, one), 1)[:, 0]
            # Keep no order older than the previous pass: streams are seldom further apart.
            self._orders = {p: order for p, order in self._orders.items() if p + 1 >= one}
            self._orders[one] = share[np.argsort(keys, kind="stable")]
        return int(self._orders[one][place])


def _digest_of(demonstrations: Demonstrations) -> Tensor:
    """uint8 [32]: SHA-256 of everything in the demonstrations that is learned, except images."""
    digest = hashlib.sha256()
    for array in (demonstrations.lengths, demonstrations.endings):
        digest.update(array.tobytes())
    every = np.arange(demonstrations.steps)
    for name in ("state", "actions", "by_expert", "rewards"):
        digest.update(demonstrations.take(name, every).tobytes())
    return torch.from_numpy(np.frombuffer(digest.digest(), np.uint8).copy())


def _returns_of(demonstrations: Demonstrations, gamma: float) -> np.ndarray:
    """float32 [steps of all demonstrations]: the discounted return from each step on."""
    steps = demonstrations.steps
    rewards = demonstrations.take("rewards", np.arange(steps)).astype(np.float64)
    returns = rewards.copy()
    ends = np.zeros(steps, np.bool_)
    ends[demonstrations.first_rows + demonstrations.lengths - 1] = True
    for step in range(steps - 2, -1, -1):
        if not ends[step]:
            returns[step] += gamma * returns[step + 1]
    return returns.astype(np.float32)


class ImitationLearner(Learner):
    """Makes the actions of the expert likelier, and fits the values to the returns of its
    episodes."""

    def update(self, rollout: Rollout, update: int, progress: float) -> dict[str, float]:
        assert isinstance(rollout, DemonstrationRollout)
        settings = self.settings
        self.optimizer.learning_rate = learning_rate_at(settings, progress)
        shown = rollout.by_expert[: rollout.steps]
        kept = rollout.returns[: rollout.steps][shown]
        kept = kept.double()
        moments = over_ranks(
            self.group,
            {"steps": kept.numel(), "first": kept.sum(), "second": kept.square().sum()},
        )
        steps = max(moments["steps"], 1.0)
        per_mini_batch = steps / settings.mini_batches
        sums = Sums()
        for chosen in self._mini_batches(rollout, update):
            sums.add(self._step(rollout, chosen, per_mini_batch))
        self._absorb_observations(rollout)
        rounds = settings.epochs * settings.mini_batches
        report = over_ranks(self.group, sums.by_name())
        norm = report.pop("grad_norm")
        report = {name: total / (steps * settings.epochs) for name, total in report.items()}
        report["grad_norm"] = norm / (rounds * self.group.size)
        variance = moments["second"] / steps - (moments["first"] / steps) ** 2
        report["explained_variance"] = 1.0 - 2.0 * report["value_loss"] / max(variance, 1e-12)
        if self.policy.action.log_std is not None:
            report["log_std"] = float(self.policy.action.log_std.mean())
        return report

    def _step(
        self, rollout: DemonstrationRollout, chosen: Tensor, steps_of_all: float
    ) -> dict[str, Tensor]:
        """One step of the optimizer. Returns policy_loss, value_loss and entropy, summed over the
        expert's steps, and grad_norm, the norm of the gradient."""
        steps = rollout.steps
        self.optimizer.clear()
        outputs = self._outputs(rollout, chosen)
        weights = rollout.by_expert[:steps, chosen].float()
        surprise = -(outputs.actions.log_prob(rollout.actions[:steps, chosen]) * weights).sum()
        error = (outputs.values - rollout.returns[:steps, chosen]).square()
        value_loss = 0.5 * (error * weights).sum()
        norm = self._descend(
            (surprise + self.settings.value_coefficient * value_loss) / steps_of_all
        )
        if outputs.hidden is not None:
            rollout.last_hidden[chosen] = outputs.hidden.detach().float()
        with torch.no_grad():
            entropy = (outputs.actions.entropy() * weights).sum()
        return {
            "policy_loss": surprise.detach(),
            "value_loss": value_loss.detach(),
            "entropy": entropy,
            "grad_norm": norm,
        }


def require_same(demonstrations: Demonstrations, settings: Settings, observed: Observed,
                 images: Mapping[str, tuple[int, ...]]) -> None:  # fmt: skip
    """Raises Error if the observations or actions of a run, whose network sees `images`, differ
    from those of its demonstrations. These may have additional images."""
    about = demonstrations.about
    camera = about.camera
    if images and camera is not None:
        drawn = ("color", "depth")
        seen = {name: value for name, value in exact_camera(settings).items() if name not in drawn}
        camera = {**seen, **{name: camera[name] for name in drawn if name in camera}}
    wanted = dataclasses.replace(
        about,
        parts=list(observed.parts),
        meanings=dict(observed.meanings),
        motions=observed.motions,
        images={**about.images, **images},
        camera=camera,
    )
    require_alike(wanted, about, demonstrations.folders[0])


def _named(demonstrations: Demonstrations) -> str:
    return ", ".join(map(str, demonstrations.folders))
