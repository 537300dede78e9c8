"""Tasks of one's own: what pays, what ends an episode, and what is observed beside."""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from numbers import Integral
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galactic._core import Simulator, World
from galactic.env_states import EnvStates
from galactic.hashing import hashed


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


class Draws:
    """What the random numbers of n envs follow from, beside the seed."""

    def __init__(self, numbers: NDArray[np.int64]) -> None:
        self._numbers = numbers
        self.begun = np.zeros(len(numbers), np.int64)
        """(n,), how many episodes each env has begun of which nobody has named one."""
        self.keys = np.zeros(len(numbers), np.int64)
        """(n,), one for each episode that there may be."""
        self.ages = np.zeros(len(numbers), np.int64)
        """(n,), steps of the episode."""
        self.begin_first()

    @property
    def are_drawn(self) -> NDArray[np.bool_]:
        """bool (n,): where chance has chosen the episode, and nobody has named it."""
        return self.keys >= 0

    def begin_first(self) -> None:
        """All envs begin their first episodes."""
        self.begun[:] = -1
        self.begin_next(np.arange(len(self._numbers)))

    def begin_next(self, which: NDArray[np.int64]) -> None:
        """The envs `which` are about to begin their next episodes."""
        self.begun[which] += 1
        self.keys[which] = (self._numbers[which] << 32) + self.begun[which]
        self.ages[which] = 0

    def restore(
        self,
        begun: NDArray[np.int64],
        keys: NDArray[np.int64],
        ages: NDArray[np.int64],
        rows: NDArray[np.int64],
    ) -> None:
        """The envs `rows` are where others were that had these: as Simulator.restore_state() has it, with
        random numbers of their own where nobody has named the episode."""
        own = (self._numbers[rows] << 32) + begun
        self.begun[rows], self.keys[rows], self.ages[rows] = (
            begun,
            np.where(keys < 0, keys, own),
            ages,
        )

    def begin_named(self, which: NDArray[np.int64], episodes: NDArray[np.int64]) -> None:
        """The envs `which` are about to begin these episodes of the world, which somebody has named."""
        # No env has a number below 0.
        self.keys[which] = -1 - episodes
        self.ages[which] = 0


class TaskEnvs:
    """The n envs that a Task is about: all of a VectorEnv, or one of its halves.

    Arrays show what is now, after the latest step or beginning. `observations`, `actions`, `rewards` and
    `endings` are views, which have other contents after the next step: copy what you keep.
    """

    def __init__(self, world: World, simulator: Simulator, is_evaluation: bool = False) -> None:
        self.world = world
        self.simulator = simulator
        """For what is not here; it must not be stepped or reset."""
        self.num_envs = simulator.num_envs
        options = simulator.options
        first = options["rank"] * self.num_envs
        self.numbers: NDArray[np.int64] = np.arange(first, first + self.num_envs)
        """int64 (n,): numbers of the envs over all halves and ranks."""
        self.seed: int = options["seed"]
        self.steps = 0
        """Steps since these envs were made, or reset with a seed; in an evaluation few, whatever came before."""
        self.is_evaluation = is_evaluation
        """Whether policies are judged by what happens here: in validations, in galactic.evaluate and its
        pictures, and in a VectorEnv that was made so."""
        self.progress = 1.0 if is_evaluation else 0.0
        """How much of the training is over, from 0 to 1: for curricula. In galactic.train the share of --steps
        that all ranks together have done, of a resumed run, too; in a VectorEnv its `progress`. 1 in
        evaluations, which are about the task at its end, and in galactic.demonstrate."""
        self._actions = np.zeros((self.num_envs, simulator.action_count), np.float32)
        self.actions: NDArray[np.float32] = self._actions.view()
        """float32 (n, action_count): those of the latest step, as they were given."""
        self.actions.flags.writeable = False
        self.draws = Draws(self.numbers)
        self._states: EnvStates | None = None

    @property
    def observations(self) -> Mapping[str, NDArray[np.float32]]:
        """What the simulator observes, by parts, each float32 (n, size): docs/simulation.md lists them."""
        rows = self.simulator.observations
        return {name: rows[:, part] for name, part in self.simulator.observation_parts.items()}

    @property
    def states(self) -> EnvStates:
        """Where everything is: robots, objects, goals."""
        if self._states is None:
            self._states = self.simulator.env_states()
        return self._states

    @property
    def rewards(self) -> NDArray[np.float32]:
        """float32 (n,): what the simulation's own task paid for the latest step."""
        return self.simulator.rewards

    @property
    def endings(self) -> NDArray[np.uint8]:
        """uint8 (n,): how the simulation's own task ended episodes in it, as EpisodeEnd."""
        return self.simulator.endings

    def uniform(self, name: str, count: int = 1) -> NDArray[np.float64]:
        """Random numbers in [0, 1), float64 (n, count). They depend on the seed, the env's number, how many
        episodes it has begun, the steps of this one, and `name`, which says what they are for: the same
        for any number of envs, halves and ranks, and in a resumed run. In an episode that the caller of
        reset() has named, its index takes the place of the first two, so that evaluations of two policies
        draw the same. Of one name there is one draw in a step; choose() draws for the next episode.
        """
        is_whole = isinstance(count, Integral) and not isinstance(count, bool)
        if not is_whole or count < 0:
            raise ValueError(f"count is {count!r}, expected how many numbers each env draws")
        salt = self.seed ^ (zlib.crc32(name.encode()) << 32)
        bits = hashed(salt & (2**64 - 1), self.draws.keys, self.draws.ages, count)
        return (bits >> np.uint64(11)).astype(np.float64) * 2.0**-53

    def take_actions(
        self, actions: NDArray[np.float32] | float, rows: NDArray[np.int64] | slice = slice(None)
    ) -> None:
        """What `actions` of the envs `rows` is from now on: for who drives the task, not for tasks."""
        self._actions[rows] = actions

    def forget(self) -> None:
        """What was known of the states is of before: the same."""
        self._states = None


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
