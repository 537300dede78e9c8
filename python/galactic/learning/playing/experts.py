"""Experts that demonstrate, and the recorder of their demonstrations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

import galactic
from galactic.demonstration_writer import EpisodeRecorder
from galactic.demonstrations import Demonstration
from galactic.hashing import hashed
from galactic.learning.homes import Homes
from galactic.learning.playing.evaluation import NO_EPISODE, Actor, EpisodeResult, Player
from galactic.learning.rollouts.environments import Observation, Step


class Expert(Player, Protocol):
    """A player from which others learn."""

    acted: np.ndarray
    """bool [n]: in which envs the expert itself acted last, and not the learner that led to where
    the expert begins."""

    def override_actions(self, actions: np.ndarray) -> None:
        """Tells the expert which actions were executed in the last step, float32 [n, motions + 2],
        if they were not all its own."""


class ScriptedExpert:
    """The scripted policy, which plans with the full state of the simulation."""

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

    def override_actions(self, actions: np.ndarray) -> None:
        pass  # it reads the state of the simulation anew in each step


class LearnedExpert:
    """A trained policy as an expert."""

    def __init__(self, policy: Actor):
        self._policy = policy
        self.acted = np.zeros(0, np.bool_)

    def begin(self, envs: int) -> None:
        self._policy.begin(envs)

    def act(
        self, seen: Observation, starts: np.ndarray, episodes: np.ndarray, steps: np.ndarray
    ) -> np.ndarray:
        self.acted = episodes != NO_EPISODE
        return self._policy.act(seen, starts, episodes, steps)

    def override_actions(self, actions: np.ndarray) -> None:
        self._policy.override_actions(actions)


class RolledIn:
    """An expert that takes over from a learner: the learner plays the first 0 to `most` steps of an
    episode, a number drawn by a hash of the episode, and the expert plays the rest. So the
    demonstrations show what to do after the learner's own mistakes, which no expert makes (Ross et
    al. 2011; one switch in an episode: Ross and Bagnell 2014)."""

    def __init__(self, learner: Actor, expert: Expert, most: int, seed: int):
        self._learner = learner
        self._expert = expert
        self._most = most
        # Independent of the random numbers with which a policy's actions are sampled.
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
        done = np.where(self.acted[:, np.newaxis], by_expert, actions)
        self.override_actions(done)
        return done

    def override_actions(self, actions: np.ndarray) -> None:
        self._learner.override_actions(actions)
        self._expert.override_actions(actions)


class Recorder:
    """A StepObserver that records what an expert saw and did."""

    def __init__(self, expert: Expert, homes: Homes):
        self._expert = expert
        self._recorder = EpisodeRecorder(homes.env.observation_parts)
        self._ended: dict[int, Demonstration] = {}

    def before_step(self, episodes: np.ndarray, seen: Observation, actions: np.ndarray) -> None:
        rows = {name: rows.numpy() for name, rows in seen._asdict().items() if rows is not None}
        self._recorder.before_step(rows, actions, self._expert.acted, episodes != NO_EPISODE)

    def after_step(self, step: Step) -> None:
        ended = self._recorder.after_step(step.rewards, step.infos)
        self._ended |= {one.episode: one for one in ended}

    def demonstrations(self, results: Sequence[EpisodeResult]) -> list[Demonstration]:
        """The demonstrations of the episodes with these results, in the same order."""
        return [self._ended[result.episode] for result in results]
