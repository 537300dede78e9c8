"""What a task of one's own sees: its envs, as they are now."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from numbers import Integral
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic._core import Renderer, Simulator, World
from galactic.cameras import Cameras, LazyImages
from galactic.env_states import EnvStates
from galactic.hashing import hashed


class Draws:
    """What the random numbers of n envs are derived from, besides the seed."""

    def __init__(self, numbers: NDArray[np.int64]) -> None:
        self._numbers = numbers
        self.begun = np.zeros(len(numbers), np.int64)
        """(n,), how many episodes that were not named each env has begun."""
        self.keys = np.zeros(len(numbers), np.int64)
        """(n,), a different key for each possible episode."""
        self.ages = np.zeros(len(numbers), np.int64)
        """(n,), steps done in the episode."""
        self.begin_first()

    @property
    def are_drawn(self) -> NDArray[np.bool_]:
        """bool (n,): true where the episode was drawn, and not named."""
        return self.keys >= 0

    def begin_first(self) -> None:
        """Call when all envs begin their first episodes."""
        self.begun[:] = -1
        self.begin_next(np.arange(len(self._numbers)))

    def begin_next(self, which: NDArray[np.int64]) -> None:
        """Call when the envs `which` are about to begin their next episodes."""
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
        """Call when the envs `rows` were restored to the state of envs that had these values. As in
        Simulator.restore_state(), they have random numbers of their own unless the episode was
        named."""
        own = (self._numbers[rows] << 32) + begun
        self.begun[rows], self.keys[rows], self.ages[rows] = (
            begun,
            np.where(keys < 0, keys, own),
            ages,
        )

    def begin_named(self, which: NDArray[np.int64], episodes: NDArray[np.int64]) -> None:
        """Call when the envs `which` are about to begin these episodes of the world, which were
        named."""
        # No env has a number below 0.
        self.keys[which] = -1 - episodes
        self.ages[which] = 0


class TaskEnvs:
    """The n envs of a Task: all envs of a VectorEnv, or one of its halves.

    Arrays show the current state, after the latest step or the beginning of episodes.
    `observations`, `actions`, `rewards` and `endings` are views, which the next step overwrites:
    copy what you keep.
    """

    def __init__(
        self,
        world: World,
        simulator: Simulator,
        cameras: Cameras,
        is_evaluation: bool = False,
    ) -> None:
        self.world = world
        self.simulator = simulator
        """The simulator, for everything that is not here; do not step or reset it."""
        self.num_envs = simulator.num_envs
        options = simulator.options
        first = options["rank"] * self.num_envs
        self.numbers: NDArray[np.int64] = np.arange(first, first + self.num_envs)
        """int64 (n,): numbers of the envs, counted over all halves and ranks."""
        self.seed: int = options["seed"]
        self.steps = 0
        """Steps since these envs were made, or reset with a seed. An evaluation counts its own
        steps only."""
        self.is_evaluation = is_evaluation
        """Whether policies are judged here: in validations, in galactic.evaluate and its pictures,
        and in a VectorEnv with is_evaluation=True."""
        self.progress = 1.0 if is_evaluation else 0.0
        """How much of the training is over, from 0 to 1: for curricula. In galactic.train, the
        fraction of --steps that all ranks together have done, also in a resumed run; in a
        VectorEnv, its `progress`. 1 in evaluations, which use the task as it is at the end of
        training, and in galactic.demonstrate."""
        self._actions = np.zeros((self.num_envs, simulator.action_count), np.float32)
        self.actions: NDArray[np.float32] = self._actions.view()
        """float32 (n, action_count): the actions of the latest step, as they were given."""
        self.actions.flags.writeable = False
        self.draws = Draws(self.numbers)
        self._states: EnvStates | None = None
        self._cameras = cameras
        self._images = LazyImages(cameras)

    @property
    def observations(self) -> Mapping[str, NDArray[np.float32]]:
        """The simulator's observations by part, each float32 (n, size): docs/simulation.md lists
        the parts."""
        rows = self.simulator.observations
        return {name: rows[:, part] for name, part in self.simulator.observation_parts.items()}

    @property
    def states(self) -> EnvStates:
        """Where everything is: robots, objects, goals."""
        if self._states is None:
            self._states = self.simulator.env_states()
        return self._states

    @property
    def images(self) -> Mapping[str, NDArray[Any]]:
        """The images of the Task's cameras, (n, height, width, ...), named as in a VectorEnv's
        observations, and drawn on demand. In step() and measure(), they show the state in which
        episodes end.
        """
        return self._images.look()

    @property
    def renderers(self) -> Mapping[str, Renderer]:
        """The renderers of the Task's cameras, by name ("" for a single camera): for their lenses,
        the places from which the `images` were drawn, and the names of what they show."""
        return self._cameras.renderers

    @property
    def rewards(self) -> NDArray[np.float32]:
        """float32 (n,): the rewards of the simulation's own task for the latest step."""
        return self.simulator.rewards

    @property
    def endings(self) -> NDArray[np.uint8]:
        """uint8 (n,): how the simulation's own task ended episodes in that step, as EpisodeEnd."""
        return self.simulator.endings

    def uniform(self, name: str, count: int = 1) -> NDArray[np.float64]:
        """Random numbers in [0, 1), float64 (n, count). They depend on the seed, the env's number,
        how many episodes it has begun, the steps of the current episode, and `name`, which says
        what they are for. They are the same for any number of envs, halves and ranks, and in a
        resumed run. In an episode that the caller of reset() has named, its index replaces the
        env's number and the count of its episodes, so that evaluations of two policies draw the
        same numbers. Each name gives one draw per step; choose() draws for the next episode.
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
        """Sets `actions` of the envs `rows`. For the code that drives the task, not for tasks."""
        self._actions[rows] = actions

    def forget(self, which: NDArray[np.int64] | slice = slice(None)) -> None:
        """Marks what is known about the states of the envs `which` as out of date. For the code
        that drives the task, not for tasks."""
        self._states = None
        self._images.forget(which)
