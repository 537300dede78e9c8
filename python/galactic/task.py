"""Tasks of your own: what is rewarded, what ends an episode, and what else is observed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galactic.env_states import EnvStates
from galactic.task_envs import TaskEnvs


class Outcome(NamedTuple):
    """The result of a step of n envs."""

    rewards: NDArray[np.floating]
    """(n,), finite."""
    successes: NDArray[np.bool_] | None = None
    """(n,), true where the episode is solved and ends; None: nowhere."""
    failures: NDArray[np.bool_] | None = None
    """(n,), true where the episode ends in failure. Where both are true, it is solved."""
    logs: Mapping[str, NDArray[np.floating]] | None = None
    """What the task logs of the step: an array (n,) of finite numbers for each of the Task's
    `logs`."""


class Placements(NamedTuple):
    """How many states Task.place() returned, and how many of them were refused."""

    asked: int
    """Number of episodes for which there was a state."""
    refused: int
    """How many of these episodes began where the world has them, because Simulator.set_states()
    refused the state."""


class Task:
    """A task of your own, on top of the simulation's: inherit from this class, and give your class
    to a VectorEnv (`task=Reach`) or the trainer (`--task reach.py:Reach`).

    A VectorEnv makes one task for each of its halves, by calling what it was given without
    arguments. It calls prepare(), place() and begin() once the envs stand at the start of their
    first episodes. In each step it calls step() and then, if episodes ended, measure(), choose(),
    place() and begin(). It calls observe() whenever observations are needed.

    Everything is done for n envs at once, in arrays whose first axis is the env. Store nothing but
    `memory` from one call to the next: it is saved with the state of the envs, so that runs can be
    resumed and results are the same for any number of halves.
    """

    base: str = "none"
    """The simulation's task beneath this one. Its rewards are in TaskEnvs.rewards. When it ends an
    episode, the episode ends that way unless step() reports another ending for the same env. "none"
    gives no rewards and ends episodes only after `episode_steps`."""

    options: Mapping[str, Any] = {}
    """Options of the simulation, as keywords of Simulator. Options that are given elsewhere
    override them."""

    images: Mapping[str, Any] | None = None
    """Cameras that the task uses, as in VectorEnv(images=...). Their images are in TaskEnvs.images,
    and are not part of an observation."""

    parts: Mapping[str, int] = {}
    """Names and sizes of what observe() appends to the observation, in this order."""

    measures: Sequence[str] = ()
    """Names of what measure() returns for each episode."""

    logs: Sequence[str] = ()
    """Names of what step() returns for each step in Outcome.logs. The values are in infos["log"]
    and, as means over steps, in the curves of galactic.train."""

    memory: dict[str, NDArray[Any]]
    """What the task remembers about each env: arrays (n, ...) by name, made in prepare(), written
    in begin() and step()."""

    def prepare(self, envs: TaskEnvs) -> None:
        """Makes `memory`, before any episode has begun."""

    def choose(self, envs: TaskEnvs, which: NDArray[np.int64]) -> NDArray[np.integer] | None:
        """Returns which episodes of the world the envs `which` begin next: whole numbers, -1 for
        the env's own next episode. None leaves the choice to the order of the VectorEnv. An episode
        in which the robot cannot start (Simulator.skipped_episodes) raises ValueError. With
        order="partition", envs never run out of episodes that are named here."""
        return None

    def place(
        self, envs: TaskEnvs, which: NDArray[np.int64], states: EnvStates
    ) -> EnvStates | None:
        """Returns the states in which the episodes of the envs `which` begin. `states` has copies
        of the world's start states, (len(which),), which you may change and return, as
        Simulator.set_states() takes them. None leaves everything as it is.
        `states.hold(envs.world)` puts targets into hands. A state is refused if no floor is near
        the base, if the robot would stand in something, or if a held object is not in the hand. The
        env then begins where the world has it: begin() sees where, and VectorEnv.placements counts
        such envs. Resting objects stay exactly where they are put, even inside other things.
        """
        return None

    def begin(self, envs: TaskEnvs, which: NDArray[np.int64]) -> None:
        """Called when episodes begin in the envs `which`."""

    def step(self, envs: TaskEnvs) -> Outcome:
        """Returns the outcome of the step that was just done. Values for idle envs are ignored."""
        raise NotImplementedError(f"{type(self).__name__} has no step()")

    def measure(
        self, envs: TaskEnvs, which: NDArray[np.int64]
    ) -> Mapping[str, NDArray[np.floating]]:
        """Returns measures of the episodes that this step ended in the envs `which`: the
        `measures`, each (len(which),). They are in final_info, in the report of galactic.evaluate
        and, as means, in the curves of galactic.train."""
        return {}

    def observe(self, envs: TaskEnvs) -> Mapping[str, NDArray[np.floating]]:
        """Returns the `parts`, each (n, size), computed from `envs` and `memory`, which it must not
        change."""
        return {}
