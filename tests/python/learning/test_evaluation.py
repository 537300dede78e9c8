"""Evaluations: what they find out about episodes, and what that costs."""

from __future__ import annotations

import numpy as np
import pytest

import galactic
from galactic.learning.homes import Homes
from galactic.learning.playing.evaluation import NO_EPISODE, Actor, Evaluator, summary
from galactic.learning.presets import preset
from galactic.learning.rollouts.environments import Observation, Step
from policies import untrained
from programs import WORLD, needs_worlds

pytestmark = needs_worlds


class Walked:
    """A StepObserver that asks each env where its robot is, and adds up how far it went over the floor."""

    def __init__(self, homes: Homes):
        self._homes = homes
        self._episodes = np.zeros(0, int)
        self._before: list[np.ndarray] = []
        self.paths: dict[int, float] = {}
        self.steps = 0

    def _place(self, env: int) -> np.ndarray:
        x, _, z = self._homes.env.simulators[0].env_state(env).world_from_root.translation
        return np.array([x, z])

    def before_step(self, episodes: np.ndarray, seen: Observation, actions: np.ndarray) -> None:
        self._episodes = episodes.copy()
        self._before = [self._place(env) for env in range(len(episodes))]

    def after_step(self, step: Step) -> None:
        self.steps += 1
        for env, episode in enumerate(self._episodes):
            if episode != NO_EPISODE:
                self.paths.setdefault(episode, 0.0)
                # But for the last step, behind which the env is in the next episode.
                if not step.terminated[env] and not step.truncated[env]:
                    way = self._place(env) - self._before[env]
                    self.paths[episode] += float(np.linalg.norm(way))


def test_paths_are_those_of_the_robots_and_all_envs_are_asked_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    settings = preset("quick", envs=8, halves=1, mini_batches=1)
    homes = Homes(galactic.World(WORLD), settings, 1, is_evaluation=True)
    asked = [0]
    env_states = homes.env.env_states

    def counted() -> galactic.EnvStates:
        asked[0] += 1
        return env_states()

    monkeypatch.setattr(homes.env, "env_states", counted)
    walked, actor = Walked(homes), Actor(untrained(settings).policy, deterministic=False)
    episodes = homes.playable_episodes()[:20]
    results = Evaluator(homes, actor).play(episodes, observer=walked)
    assert {one.episode: one.path for one in results} == walked.paths
    assert sum(one.path > 0.5 for one in results) > 10
    # Once in a step, and once where episodes begin.
    assert walked.steps < asked[0] <= walked.steps + len(episodes) + 1
    assert Evaluator(homes, actor).play(episodes[:2], details=False)[0].path == 0.0


def test_no_episodes_have_no_length() -> None:
    told = summary([], galactic.World(WORLD))
    names = ("episodes", "success", "picked", "return", "length", "spl", "path", "refused", "slid")
    assert {name: told[name] for name in names} == dict.fromkeys(names, 0)
    assert told["success_interval"] == [0.0, 1.0]
    assert told["each"] == []
