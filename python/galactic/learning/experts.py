"""Who demonstrates, and what is kept of it."""

from __future__ import annotations

from typing import Mapping, Protocol, Sequence

import numpy as np

import galactic
from galactic.demonstrations import Demonstration
from galactic.hashing import hashed
from galactic.learning.environments import Observation
from galactic.learning.evaluation import NO_EPISODE, EpisodeResult, Player
from galactic.learning.homes import Homes


class Expert(Player, Protocol):
    """Whom others learn from."""

    acted: np.ndarray
    """bool [n]: in which envs it was the expert who acted last, and not who led to where it begins."""


class ScriptedExpert:
    """The scripted policy, which plans by all that the simulation knows."""

    def __init__(self, homes: Homes):
        (self._simulator,) = homes.env.simulators
        self.begin(homes.count)

    def begin(self, envs: int) -> None:
        self._policy = galactic.ScriptedPolicy(self._simulator)
        self.acted = np.zeros(envs, np.bool_)

    def act(
        self, seen: Observation, starts: np.ndarray, episodes: np.ndarray, steps: np.ndarray
    ) -> np.ndarray:
        self.acted = episodes != NO_EPISODE
        return self._policy.act(self.acted)


class LearnedExpert:
    """A policy that has learned before."""

    def __init__(self, policy: Player):
        self._policy = policy
        self.acted = np.zeros(0, np.bool_)

    def begin(self, envs: int) -> None:
        self._policy.begin(envs)

    def act(
        self, seen: Observation, starts: np.ndarray, episodes: np.ndarray, steps: np.ndarray
    ) -> np.ndarray:
        self.acted = episodes != NO_EPISODE
        return self._policy.act(seen, starts, episodes, steps)


class RolledIn:
    """An expert that begins where a learner has led: the learner plays the first steps of an episode, none
    of them or up to `most` by a hash of the episode, and the expert the rest. So it shows what to do after
    the learner's own mistakes, which no expert makes (Ross et al. 2011; one switch in an episode: Ross and
    Bagnell 2014)."""

    def __init__(self, learner: Player, expert: Expert, most: int, seed: int):
        self._learner = learner
        self._expert = expert
        self._most = most
        # Not the numbers that a policy's actions are sampled with.
        self._seed = seed ^ 0x726F6C6C
        self.acted = np.zeros(0, np.bool_)

    def begin(self, envs: int) -> None:
        self._learner.begin(envs)
        self._expert.begin(envs)

    def act(
        self, seen: Observation, starts: np.ndarray, episodes: np.ndarray, steps: np.ndarray
    ) -> np.ndarray:
        actions = self._learner.act(seen, starts, episodes, steps)
        bits = hashed(self._seed, episodes, np.zeros_like(episodes), 1)[..., 0]
        by_learner = steps < (bits % np.uint64(self._most + 1)).astype(np.int64)
        shown = np.where(by_learner, NO_EPISODE, episodes)
        by_expert = self._expert.act(seen, starts, shown, steps)
        self.acted = self._expert.acted
        return np.where(self.acted[:, np.newaxis], by_expert, actions)


class Recorder:
    """A Witness that keeps what an expert saw and did."""

    def __init__(self, expert: Expert):
        self._expert = expert
        self._steps: list[Mapping[str, np.ndarray]] = []

    def sees(self, episodes: np.ndarray, seen: Observation, actions: np.ndarray) -> None:
        playing = episodes != NO_EPISODE
        images = {
            name: rows.numpy()[playing]
            for name, rows in (("rgb", seen.rgb), ("depth", seen.depth))
            if rows is not None
        }
        if "depth" in images:
            images["depth"] = images["depth"].astype(np.float16)
        self._playing = playing
        self._steps.append(
            {
                "episodes": episodes[playing],
                "state": seen.state.numpy()[playing],
                "actions": _as_executed(actions[playing]),
                "by_expert": self._expert.acted[playing],
                **images,
            }
        )

    def hears(self, rewards: np.ndarray) -> None:
        self._steps[-1] = {**self._steps[-1], "rewards": rewards[self._playing]}

    def demonstrations(self, results: Sequence[EpisodeResult]) -> list[Demonstration]:
        """Those of the episodes whose results are given, in their order."""
        if not results:
            return []
        arrays = {
            name: np.concatenate([step[name] for step in self._steps]) for name in self._steps[0]
        }
        episodes = arrays.pop("episodes")
        order = np.argsort(episodes, kind="stable")
        first = np.searchsorted(episodes[order], [result.episode for result in results])
        kept = []
        for result, begin in zip(results, first):
            rows = order[begin : begin + result.length]
            ending = galactic.EpisodeEnd.__members__[result.ending.upper()]
            kept.append(
                Demonstration(
                    result.episode, ending, **{name: all[rows] for name, all in arrays.items()}
                )
            )
        return kept


def _as_executed(actions: np.ndarray) -> np.ndarray:
    """As the simulation takes them: samples of a policy may be outside of its limits."""
    return np.clip(actions, -1.0, 1.0)
