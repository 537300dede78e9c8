"""Tasks of one's own: what pays, what ends an episode, and what is observed beside."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galactic.env_states import EnvStates
from galactic.task_envs import TaskEnvs


class Outcome(NamedTuple):
    """What a step of n envs came to."""

    rewards: NDArray[np.floating]
    """(n,), finite."""
    successes: NDArray[np.bool_] | None = None
    """(n,), where the episode is solved and ends; None for nowhere."""
    failures: NDArray[np.bool_] | None = None
    """(n,), where it ends for worse. Where both are true, it is solved."""
    logs: Mapping[str, NDArray[np.floating]] | None = None
    """What there is to say of the step, the Task's `logs`, each (n,), finite."""


class Placements(NamedTuple):
    """What came of the states that Task.place() returned."""

    asked: int
    """For how many episodes there was one."""
    refused: int
    """How many of these began where the world has them, as Simulator.set_states() refused the state."""


class Task:
    """A task of one's own, over the simulation's: inherit from it, and give the class to a VectorEnv
    (`task=Reach`) or the trainer (`--task reach.py:Reach`).

    A VectorEnv makes one for each of its halves, by calling what it was given without arguments. It
    calls prepare(), place() and begin() once the envs stand at the start of their first episodes; with each
    step step(), then, where episodes ended, measure(), choose(), place() and begin(); and observe()
    whenever somebody looks.

    All is done for n envs at once, in arrays whose first axis is the env. Nothing but `memory` may be
    kept from one call to the next: it is saved with the state of the envs, so that runs can be resumed,
    and it is what makes results the same for any number of halves.
    """

    base: str = "none"
    """The simulation's task below. Its rewards are in TaskEnvs.rewards, and how it ends episodes
    counts, unless step() says otherwise of the same env. "none" pays nothing and ends episodes after
    `episode_steps` alone."""

    options: Mapping[str, Any] = {}
    """Options of the simulation, as keywords of Simulator, that hold unless others are given."""

    images: Mapping[str, Any] | None = None
    """Cameras that the task looks through, as VectorEnv(images=...) has them: what they see is in
    TaskEnvs.images, and no part of an observation."""

    parts: Mapping[str, int] = {}
    """Names and sizes of what observe() adds to the observation, in this order, behind all else."""

    measures: Sequence[str] = ()
    """Names of what measure() says of each episode."""

    logs: Sequence[str] = ()
    """Names of what step() says of each step, in Outcome.logs. It is in infos["log"], and as a mean over steps
    in the curves of galactic.train."""

    memory: dict[str, NDArray[Any]]
    """What the task remembers of each env, arrays (n, ...) by name: made in prepare(), written in
    begin() and step()."""

    def prepare(self, envs: TaskEnvs) -> None:
        """Makes `memory`, for episodes of which none has begun yet."""

    def choose(self, envs: TaskEnvs, which: NDArray[np.int64]) -> NDArray[np.integer] | None:
        """Which episodes of the world the envs `which` begin next, whole numbers, -1 for the next of
        the env's own; None leaves it to the order of the VectorEnv. An episode in which the robot cannot
        start (Simulator.skipped_episodes) is a ValueError. Episodes that are named here have no end with
        order="partition"."""
        return None

    def place(
        self, envs: TaskEnvs, which: NDArray[np.int64], states: EnvStates
    ) -> EnvStates | None:
        """Where the episodes of the envs `which` begin. `states` are those of the world, (len(which),): copies,
        to be changed and returned, as Simulator.set_states() takes them; None leaves all as it is.
        `states.hold(envs.world)` puts targets into hands. Where a state is refused, as no floor is near the base,
        the robot would stand in something, or what is held is not in the hand, the env begins where the world
        has it: begin() sees where, and VectorEnv.placements counts them. Objects that rest are taken as they
        are, in whatever they are.
        """
        return None

    def begin(self, envs: TaskEnvs, which: NDArray[np.int64]) -> None:
        """Takes in that episodes begin in the envs `which`."""

    def step(self, envs: TaskEnvs) -> Outcome:
        """What the step that was just done came to. What is said of idle envs does not count."""
        raise NotImplementedError(f"{type(self).__name__} has no step()")

    def measure(
        self, envs: TaskEnvs, which: NDArray[np.int64]
    ) -> Mapping[str, NDArray[np.floating]]:
        """What there is to say of the episodes that this step ended in the envs `which`: the `measures`,
        each (len(which),). They are in final_info, in the report of galactic.evaluate, and as means in the
        curves of galactic.train."""
        return {}

    def observe(self, envs: TaskEnvs) -> Mapping[str, NDArray[np.floating]]:
        """The `parts`, each (n, size): of `envs` and `memory`, which it leaves as they are."""
        return {}
