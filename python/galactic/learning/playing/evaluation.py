"""Evaluates a policy: plays each episode of a world exactly once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Protocol

import numpy as np
import torch

import galactic
from galactic.learning.encoders import Inputs
from galactic.learning.homes import Homes
from galactic.learning.policies.networks import Policy
from galactic.learning.reports.shares import interval
from galactic.learning.rollouts.environments import Observation, Step
from galactic.learning.rollouts.episode_sums import EpisodeSums
from galactic.learning.rollouts.noise import episode_noise
from galactic.learning.rollouts.rollout import Rollout

MOST_ENVS = 256


@dataclass
class EpisodeResult:
    """The result of one episode. `picked`: whether the target was in the hand at any time. `path`:
    how far the base moved over the floor, meters, without the last step. `straight`: the length of
    the straight lines from its start to where the robot first held something, and on to its last
    known place; no path through these places is shorter. `refused`, `slid`: steps in which the
    robot stayed where it was, or was pushed clear, because it would have hit something. `measures`:
    what a user-defined task measures of the episode. `logs`: means of what such a task logs in each
    step."""

    episode: int
    success: bool
    picked: bool
    ending: str
    reward: float
    length: int
    path: float
    straight: float
    refused: int
    slid: int
    measures: dict[str, float] = field(default_factory=dict)
    logs: dict[str, float] = field(default_factory=dict)

    @property
    def path_ratio(self) -> float:
        """Success weighted by path length, for one episode: 1 for the straight path, 0 for a
        failure."""
        if not self.success:
            return 0.0
        return self.straight / max(self.path, self.straight) if self.path > 0.0 else 1.0


class Player(Protocol):
    """Something that plays episodes, in many envs at a time."""

    def begin(self, envs: int) -> None:
        """Forgets everything, and prepares to act in `envs` envs."""

    def act(
        self, seen: Observation, starts: np.ndarray, episodes: np.ndarray, steps: np.ndarray
    ) -> np.ndarray:
        """The action for each env: float32 [n, motions + 2].

        Args:
            seen: rows of all envs.
            starts: bool [n], where an episode begins.
            episodes: int [n], which episode each env plays; NO_EPISODE where the actions do not
            count. steps: int [n], how many steps of its episode each env has done.
        """


NO_EPISODE = -1


class StepObserver(Protocol):
    """Something that observes how episodes are played."""

    def before_step(self, episodes: np.ndarray, seen: Observation, actions: np.ndarray) -> None:
        """Called before each step, with arguments and result of Player.act(). They are valid only
        during the call."""

    def after_step(self, step: Step) -> None:
        """Called after each step, with its results."""


class Actor:
    """A Player: a policy that acts without learning, with its memory of each env. Its samples
    depend on seed, episode and step, not on the env in which an episode is played. `device` is the
    policy's. `columns` are the columns of an observed row that the policy sees; None: all."""

    def __init__(self, policy: Policy, *, deterministic: bool, seed: int = 1,
                 device: torch.device = torch.device("cpu"),
                 columns: Sequence[int] | None = None):  # fmt: skip
        self.policy = policy
        self._columns = None if columns is None else torch.tensor(columns, device=device)
        self._deterministic = deterministic
        self._seed = seed
        self._device = device
        self.begin(0)

    def begin(self, envs: int) -> None:
        actions = self.policy.action.motions + 2
        self._hidden = self.policy.initial_hidden(envs, self._device)
        self._previous = torch.zeros(1, envs, actions, device=self._device)

    def act(
        self, seen: Observation, starts: np.ndarray, episodes: np.ndarray, steps: np.ndarray
    ) -> np.ndarray:
        self.policy.eval()
        with torch.inference_mode():
            state, rgb, depth = (
                None if rows is None else rows.to(self._device).unsqueeze(0) for rows in seen
            )
            assert state is not None
            if self._columns is not None:
                state = state.index_select(-1, self._columns)
            begun = torch.from_numpy(starts).to(self._device).unsqueeze(0)
            previous = self._previous * (~begun).unsqueeze(-1)
            outputs = self.policy.act(Inputs(state, rgb, depth, previous), self._hidden, begun)
            if self._deterministic:
                actions = outputs.actions.mode()
            else:
                noise = episode_noise(self._seed, episodes, steps, self.policy.action.motions)
                noise_rows = torch.from_numpy(noise).to(self._device).unsqueeze(0)
                actions = outputs.actions.sample(noise_rows)
            self._hidden = outputs.hidden
            self._previous = actions.clamp(-1.0, 1.0)
            return actions[0].cpu().numpy()

    def override_actions(self, actions: np.ndarray) -> None:
        """Tells the policy which actions were executed in the last step, float32 [n, motions + 2],
        if they were not all its own."""
        done = torch.from_numpy(actions).to(self._device).unsqueeze(0)
        self._previous = done.clamp(-1.0, 1.0)


class Evaluator:
    """Has a player play episodes in `homes`, which must have one half."""

    def __init__(self, homes: Homes, player: Player):
        self._homes = homes
        self._player = player
        self._seen = rows_of(homes)
        self._holding = homes.env.simulators[0].observation_parts["is_holding"].start
        self._played: list[_Played | None] = []

    def play(self, episodes: Sequence[int], *, details: bool = True,
             observer: StepObserver | None = None) -> list[EpisodeResult]:  # fmt: skip
        """Plays each of `episodes` once, and returns their results in the same order. Without
        `details`, paths and collisions are left out, which is faster."""
        homes, waiting = self._homes, list(reversed(episodes))
        results: dict[int, EpisodeResult] = {}
        self._played = [None] * homes.count
        starts = np.ones(homes.count, bool)
        self._start(starts, waiting, details)
        self._player.begin(homes.count)
        while any(self._played):
            none = _Played(NO_EPISODE)
            played = [(one or none).result for one in self._played]
            keys = np.array([result.episode for result in played])
            ages = np.array([result.length for result in played])
            actions = self._player.act(self._seen, starts, keys, ages)
            if observer is not None:
                observer.before_step(keys, self._seen, actions)
            homes.send(0, actions, self._seen)
            step = homes.recv(0)
            if observer is not None:
                observer.after_step(step)
            ended = step.terminated | step.truncated
            self._follow(step, ended, details)
            for one in (p for p, over in zip(self._played, ended) if p is not None and over):
                results[one.result.episode] = one.result
            if ended.any():
                self._start(ended, waiting, details)
            starts = ended.copy()
        return [results[episode] for episode in episodes]

    def _start(self, where: np.ndarray, waiting: list[int], details: bool) -> None:
        """Begins the next waiting episodes in the envs `where` one ended; when none are left, these
        envs idle."""
        homes, wanted = self._homes, dict[int, int]()
        for env in np.flatnonzero(where):
            self._played[env] = None
            if waiting:
                wanted[int(env)] = waiting.pop()
        homes.begin_episodes(wanted, self._seen)
        places = homes.base_positions() if details and wanted else None
        for env, episode in wanted.items():
            self._played[env] = _Played(episode)
            if places is not None:
                self._played[env] = _Played(episode, places[env], homes.collisions(env))

    def _follow(self, step: Step, ended: np.ndarray, details: bool) -> None:
        places = self._homes.base_positions() if details else None
        holds = self._seen.state[:, self._holding].numpy() != 0.0
        for env, one in enumerate(self._played):
            if one is None:
                continue
            result = one.result
            result.reward += float(step.rewards[env])
            result.length += 1
            for name, row in step.logs.items():
                mean = result.logs.get(name, 0.0)
                result.logs[name] = mean + (float(row[env]) - mean) / result.length
            if ended[env]:
                result.success, result.picked = bool(step.successes[env]), bool(step.picks[env])
                result.ending = galactic.EpisodeEnd(self._homes.endings(0)[env]).name.lower()
                result.measures = {name: float(row[env]) for name, row in step.measures.items()}
                if details:
                    one.finish(self._homes.collisions(env))
            elif places is not None:
                # Only before the end: after it, the env is in the next episode already.
                one.follow(places[env], bool(holds[env]))


class _Played:
    """An episode that is being played in one env."""

    def __init__(self, episode: int, place: np.ndarray | None = None,
                 collisions: tuple[int, int] = (0, 0)):  # fmt: skip
        self.result = EpisodeResult(episode, False, False, "", 0.0, 0, 0.0, 0.0, 0, 0)
        self._collisions = collisions
        self._place = place
        # Where the current straight line begins, and the length of the completed ones.
        self._corner = place
        self._behind = 0.0
        self._has_held = False

    def follow(self, place: np.ndarray, holds: bool) -> None:
        """Takes the present position of the base, and whether the hand holds something."""
        self.result.path += float(np.linalg.norm(place - self._place))
        self._place = place
        self.result.straight = self._behind + float(np.linalg.norm(place - self._corner))
        if holds and not self._has_held:
            self._has_held = True
            self._corner, self._behind = place, self.result.straight

    def finish(self, collisions: tuple[int, int]) -> None:
        """Takes the collisions counted up to the end of the episode."""
        self.result.refused = collisions[0] - self._collisions[0]
        self.result.slid = collisions[1] - self._collisions[1]


def rows_of(homes: Homes) -> Observation:
    """Memory for the observations of all envs."""
    actions = homes.motions + 2
    return Rollout.empty(0, homes.count, homes.state_size, actions, homes.images).row(
        0, slice(None)
    )


def sums_of(results: Sequence[EpisodeResult]) -> EpisodeSums:
    """The sums of the results, for the curves."""
    first = results[0] if results else None
    measures, logs = (first.measures, first.logs) if first else ({}, {})
    steps = float(sum(result.length for result in results))
    return EpisodeSums(
        float(len(results)),
        float(sum(result.success for result in results)),
        float(sum(result.picked for result in results)),
        sum(result.reward for result in results),
        steps,
        {name: sum(result.measures[name] for result in results) for name in measures},
        steps,
        {name: sum(result.logs[name] * result.length for result in results) for name in logs},
    )


def summary(results: Sequence[EpisodeResult], world: galactic.World) -> dict[str, Any]:
    """The report of galactic.evaluate: means, counts of the endings, and every episode with the
    names of its scene and of its target object."""
    table = world.episode_table()
    endings: dict[str, int] = {}
    for result in results:
        endings[result.ending] = endings.get(result.ending, 0) + 1
    sums = sums_of(results)
    # Without episodes, all means are 0.
    count, steps = max(sums.episodes, 1.0), max(sums.steps, 1.0)
    measures = {name: total / count for name, total in sums.measures.items()}
    logs = {name: total / steps for name, total in sums.logs.items()}
    success = sums.successes / count
    return {
        "episodes": len(results),
        "success": success,
        "success_interval": list(interval(success, len(results))),
        "picked": sums.picks / count,
        "return": sums.returns / count,
        "length": sums.lengths / count,
        "spl": sum(result.path_ratio for result in results) / count,
        "path": sum(result.path for result in results) / count,
        "refused": sum(result.refused for result in results) / steps,
        "slid": sum(result.slid for result in results) / steps,
        **({"measures": measures} if measures else {}),
        **({"logs": logs} if logs else {}),
        "endings": dict(sorted(endings.items())),
        "each": [
            {
                **asdict(result),
                "scene": world.scenes[table.scene[result.episode]],
                "target": world.objects[table.target_kind[result.episode]],
            }
            for result in results
        ],
    }
