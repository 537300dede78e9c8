"""The vector environment of Gymnasium 1.x over a batch of simulated homes."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from enum import Enum
from typing import Any, Literal, NoReturn

import numpy as np
from numpy.typing import NDArray

from galactic import saved_states, spaces
from galactic._core import Renderer, Simulator, World
from galactic.cameras import options_of_cameras, options_of_half
from galactic.env_states import EnvStates, joined
from galactic.batch_part import BatchPart, Observations, StepResult
from galactic.task import Placements, Task
from galactic.task_runner import made_by
from galactic.turns import Row, Turns, batch_of, part_of, step_of_batch
from galactic.vector_env_arguments import (
    Actions,
    check_places,
    distinct_envs,
    env_numbers,
    episodes_to_begin,
    own_task_of,
    progress_of,
    require,
    require_envs,
    require_simulator_options,
)

try:
    from gymnasium.vector import VectorEnv as _Base
except ImportError:
    _Base = object

try:
    from gymnasium.vector import AutoresetMode
except ImportError:

    class AutoresetMode(Enum):  # type: ignore[no-redef]
        """When envs whose episodes ended begin the next ones."""

        NEXT_STEP = "NextStep"
        SAME_STEP = "SameStep"
        DISABLED = "Disabled"


Paths = str | os.PathLike | Sequence[str | os.PathLike]


class VectorEnv(_Base):
    """`num_envs` environments of one world, stepped together: Gymnasium 1.x's vector API.

    A subclass of gymnasium.vector.VectorEnv if that is installed; otherwise a class with the same
    methods.

    When an episode ends, the next one begins in the same step (`metadata["autoreset_mode"]` is
    SAME_STEP). The observation is then the first of the next episode, and `infos` has

    - final_obs: object array (num_envs,), the last observation of each env whose episode ended,
    - final_info: {"episode": {"r", "l"}, "ending", "success", "picked", "episode_index"}, arrays
      (num_envs,): return and length of the episode, how it ended (EpisodeEnd), whether the hand
      held the target at any time in it, and its index in the world. With images also
      "world_from_camera", float32 (num_envs, 4, 4): the camera poses of the images in final_obs, as
      Renderer has them for the images of a step. With a task of your own also its `measures`,
      float32 (num_envs,),
    - episode: the same {"r", "l"} again, and "t", the seconds that the episode took, as in
      Gymnasium's RecordEpisodeStatistics,

    each with a mask, bool (num_envs,), that has the same name with "_" in front. In steps in which
    no episode ends, `infos` has none of them. If a task of your own logs something in each step
    (Task.logs), it is in infos["log"], a dictionary of float32 (num_envs,), with masks of the envs
    that are not idle. With `events=True`, infos["events"] has, in the same form, what happened in
    the step, bool (num_envs,): refused (something kept the robot from moving), slid (something
    pushed it aside), touched (either), grasped, dropped (the released object was placed), and
    restored (no place was found for the released object, which is back where it was).

    Observations are one flat float32 array (num_envs, observation_size), or with
    `observation="dict"` a dictionary of its named parts (docs/simulation.md lists them). With
    images, they are a dictionary with "state" (the flat array) or the parts, and

    - rgb: uint8 (num_envs, height, width, 3),
    - depth: float32 (num_envs, height, width), meters, 0 where nothing is visible,
    - semantics: int32 (num_envs, height, width).

    With several cameras, each name is prefixed with its camera's name: hand_rgb, hand_depth and so
    on, and also hand_world_from_camera.

    Two halves of the batch can take turns, each working on threads of its own while the other's
    results are used: `halves=2`, `send()` and `recv()`. What the envs do does not depend on this.

    Args:
        world: a World, or the path or paths of its packs.
        num_envs: number of environments; with two halves, an even number.
        observation: "flat" or "dict".
        images: options of galactic.Renderer, such as {"width": 128, "height": 128}; or the options
            of several cameras by name, such as {"head": {}, "hand": {"camera": "gripper_link"}},
            where the name is the Renderer's `camera` unless `camera` or `world_from_camera` is
            given; or None for no images.
        actions: "box": one float32 array in [-1, 1], (num_envs, action_count). "paper": a
            dictionary of "continuous", float32 (num_envs, action_count - 2) for joints, forward,
            turn and, if the base drives sideways, sideways; and "discrete", 0 or 1, (num_envs, 2)
            for hand and terminate.
        halves: 1, or 2 to use send() and recv() in turns.
        copy: whether each step's results are new arrays. Otherwise each step overwrites the arrays
            of the previous step, unless results are written to `out`.
        render_mode: None, or "rgb_array" for render().
        task: the name of one of the simulation's tasks, such as "pick"; or, for a task of your own,
            a class that inherits from galactic.Task, or any function without arguments that makes a
            task.
        is_evaluation: TaskEnvs.is_evaluation for such a task: whether policies are judged here, so
            that the task should be as at the end of training (`progress` is 1).
        events: whether `infos` have "events".
        threads, seed, order, rank, ranks, options: as for galactic.Simulator. body_transforms=True
            lets you draw the `simulators` with a Renderer of your own, even without images.
    """

    metadata: dict[str, Any] = {
        "render_modes": ["rgb_array"],
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }
    spec = None
    #: True until the env is made: Gymnasium closes an env that is deleted, even if its constructor
    #: failed.
    closed = True

    def __init__(
        self,
        world: World | Paths,
        num_envs: int = 128,
        *,
        observation: Literal["flat", "dict"] = "flat",
        images: Mapping[str, Any] | None = None,
        actions: Literal["box", "paper"] = "box",
        halves: Literal[1, 2] = 1,
        copy: bool = True,
        render_mode: str | None = None,
        task: str | Callable[[], Task] | None = None,
        is_evaluation: bool = False,
        events: bool = False,
        threads: int = 0,
        seed: int = 1,
        order: str = "shuffled",
        rank: int = 0,
        ranks: int = 1,
        **options: Any,
    ) -> None:
        require(observation in ("flat", "dict"), "observation", observation, '"flat" or "dict"')
        require(actions in ("box", "paper"), "actions", actions, '"box" or "paper"')
        require(halves in (1, 2), "halves", halves, "1 or 2")
        require_envs(num_envs, halves)
        require(isinstance(copy, bool), "copy", copy, "True or False")
        require(isinstance(is_evaluation, bool), "is_evaluation", is_evaluation, "True or False")
        require(isinstance(events, bool), "events", events, "True or False")
        cameras = options_of_cameras("images", images)
        require(render_mode in (None, "rgb_array"), "render_mode", render_mode, '"rgb_array"')
        require_simulator_options(options)
        self._world = world if isinstance(world, World) else World(world)
        self.num_envs = num_envs
        self._broken_off = np.zeros(num_envs, np.int64)
        self.render_mode = render_mode
        self._render_threads = threads
        self._is_evaluation = is_evaluation
        self._images = images
        options |= {"threads": threads, "seed": seed, "order": order}
        own_task = own_task_of(task)
        self.has_own_task = own_task is not None
        """Whether its task is one of the caller's own, and not one of the simulation's."""
        if task is not None and own_task is None:
            options["task"] = task
        if cameras or render_mode is not None:
            options["body_transforms"] = True
        # Half h of batch r is batch 2 r + h of twice as many batches: the same envs as without
        # halves.
        self._parts = [
            BatchPart(
                self._world,
                {
                    **options,
                    "envs": num_envs // halves,
                    "rank": halves * rank + half,
                    "ranks": halves * ranks,
                },
                by_parts=observation == "dict",
                cameras=options_of_half("images", cameras, half, halves, num_envs),
                copy=copy,
                task=None if own_task is None else made_by(own_task),
                is_evaluation=is_evaluation,
                events=events,
            )
            for half in range(halves)
        ]
        self._turns = Turns(self._parts)
        self._onlookers: list[Renderer] = []
        first = self._parts[0]
        self.single_observation_space = first.observation_space
        self.observation_space = spaces.batch_space(first.observation_space, num_envs)
        self._actions = Actions(actions, first.simulator.action_count)
        self.single_action_space = self._actions.space
        self.action_space = spaces.batch_space(self.single_action_space, num_envs)
        self.closed = False

    def __repr__(self) -> str:
        return f"<galactic.VectorEnv of {self.num_envs} envs>"

    @property
    def world(self) -> World:
        """The world of the envs."""
        self._require_open()
        return self._world

    @property
    def observation_parts(self) -> dict[str, slice]:
        """Where the parts are in an env's flat observation: the simulator's parts, followed by
        those of a task of your own."""
        self._require_open()
        return self._parts[0].observation_parts

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of the measures of a task of your own in final_info."""
        self._require_open()
        return self._parts[0].measures

    @property
    def logs(self) -> tuple[str, ...]:
        """Names of what a task of your own logs in infos["log"]."""
        self._require_open()
        return self._parts[0].logs

    @property
    def placements(self) -> Placements:
        """How many states place() of a task of your own has returned for episodes since this env
        was made, and how many of them were `refused`, so that the episode began where the world has
        it."""
        self._require_idle()
        counts = [part.placements for part in self._parts]
        return Placements(*(sum(column) for column in zip(*counts)))

    @property
    def broken_off(self) -> NDArray[np.int64]:
        """int64 (num_envs,), a copy: how often each env has continued from a state other than the
        one its last step led to, because of reset(), set_states() or restore_state(). For code that
        records observations and actions step by step.
        """
        return self._broken_off.copy()

    @property
    def is_evaluation(self) -> bool:
        """The constructor's argument `is_evaluation`; see the class."""
        return self._is_evaluation

    @property
    def progress(self) -> float:
        """How much of the training is over, from 0 to 1, for the curriculum of a task of your own:
        0 until you set it, and always 1 in an evaluation. It is saved with the state of all envs.
        """
        self._require_open()
        return self._parts[0].progress

    @progress.setter
    def progress(self, value: float) -> None:
        self._require_idle()
        progress = progress_of(value, self._is_evaluation)
        for part in self._parts:
            part.progress = progress

    @property
    def simulators(self) -> tuple[Simulator, ...]:
        """The simulator of each half: for its statistics and states. Simulators do not know about a
        task of your own."""
        self._require_open()
        return tuple(part.simulator for part in self._parts)

    @property
    def renderers(self) -> tuple[Any, ...]:
        """The renderers of each half's images, for information about cameras and names: a Renderer
        or, with several cameras, a dictionary of Renderers by the cameras' names; () without
        images."""
        self._require_open()
        drawing = [part.renderers for part in self._parts if part.renderers]
        return tuple(one.get("", one) for one in drawing)

    @property
    def images(self) -> Mapping[str, Any] | None:
        """The options of the cameras, as they were given."""
        return self._images

    @property
    def halves(self) -> int:
        """The number of halves: 1, or 2 that take turns."""
        return len(self._turns)

    @property
    def unwrapped(self) -> VectorEnv:
        """This env itself, which wraps nothing."""
        return self

    @property
    def idle(self) -> NDArray[np.bool_]:
        """bool (num_envs,), a copy: which envs have played their share of the episodes, with
        order="partition"; they stay as they are. When all envs are idle, each episode has been
        played once."""
        self._require_idle()
        return np.concatenate([simulator.idle for simulator in self.simulators])

    def env_states(self) -> EnvStates:
        """The states of all envs in arrays, as copies: for rewards and observations of your own.

        If an episode ended in the last step, the env's state is the one in which the next episode
        begins."""
        self._require_idle()
        return joined([simulator.env_states() for simulator in self.simulators])

    def episode_noise(self) -> dict[str, NDArray[np.float32]]:
        """The noise and delay that each env's episode has drawn from the ranges in the options,
        each float32 (num_envs,): see Simulator.episode_noise(). For critics that may know them, and
        for logs. Renderer.episode_noise() of `renderers` gives the noise of images."""
        self._require_idle()
        return batch_of([simulator.episode_noise() for simulator in self.simulators])

    def set_states(self, states: EnvStates, envs: Iterable[int] | None = None) -> NDArray[np.bool_]:
        """Makes all envs, or those with the numbers `envs` in that order, continue from states that
        you give, as if an episode had begun there. Simulator.set_states() documents what is used as
        it is, and what is refused. observe() returns the new observations.

        Returns bool (n,): true where an env has its state. Raises the exceptions of
        Simulator.set_states(); nothing has then changed."""
        self._require_idle()
        chosen = np.arange(self.num_envs) if envs is None else distinct_envs(envs, self.num_envs)
        self._parts[0].simulator.check_states(states)
        if len(chosen) != len(states.episode):
            raise ValueError(f"there are {len(states.episode)} states, expected {len(chosen)}")
        for part in self._parts:
            part.require_whole()
        were_set = np.zeros(len(chosen), np.bool_)
        try:
            for number, part in enumerate(self._parts):
                rows = self.rows(number)
                here = np.flatnonzero((chosen >= rows.start) & (chosen < rows.stop))
                were_set[here] = part.set_states(states.select(here), chosen[here] - rows.start)
        except BaseException:  # such as a task's: no half goes on alone
            for part in self._parts:
                part.is_cut_off = True
            raise
        self._broken_off[chosen[were_set]] += 1
        return were_set

    def rows(self, half: int) -> slice:
        """The rows of a half's envs."""
        self._require_half(half)
        size = self.num_envs // self.halves
        return slice(half * size, (half + 1) * size)

    def buffers(self, steps: int) -> dict[str, NDArray[Any]]:
        """Arrays for a rollout, [time, env, ...], to be passed to step() row by row.

        Observations ("state", and "rgb", "depth", "semantics" with images) have `steps` + 1 rows,
        because of the observation before the first step. "rewards" (float32), "terminations" and
        "truncations" (bool), and "endings" (uint8) have `steps` rows.
        """
        self._require_open()
        shapes = self._parts[0].landing_shapes()
        after = {"rewards", "terminations", "truncations", "endings"}
        return {
            name: np.zeros((steps + (name not in after), self.num_envs, *shape), dtype)
            for name, (shape, dtype) in shapes.items()
        }

    def reset(
        self, *, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """Begins episodes.

        Args:
            seed: resets everything, as if the env had just been made with this seed. With None,
                each env begins its next episode; in the first call, the envs are at the start of
                their first.
            options: None, or a dictionary with one or both of
                "reset_mask": bool (num_envs,), the envs that begin an episode; the others stay;
                "episodes": int (num_envs,), the index of the episode that each env begins, or
                negative for its own next episode. Raises IndexError for an episode that the world
                does not have, and ValueError for one in which the robot cannot start
                (Simulator.skipped_episodes); then no env begins an episode.

        Returns:
            The observations of all envs, and an empty dictionary.
        """
        self._require_idle()
        mask, episodes = episodes_to_begin(seed, options, self.num_envs)
        rows = [self.rows(number) for number in range(self.halves)]
        for part, envs in zip(self._parts, rows):
            part.simulator.check_episodes(episodes[envs])
        done: list[BatchPart] = []
        try:
            for part, envs in zip(self._parts, rows):
                part.reset(seed, mask[envs], episodes[envs])
                done.append(part)
        except BaseException:
            for part in done:
                part.is_cut_off = True
            raise
        self._broken_off[mask] += 1
        if seed is not None and _Base is not object:
            super().reset(seed=seed)
        return self.observe(), {}

    def observe(self, out: Row | None = None) -> Observations:
        """The observations of all envs now, written to `out` as in step()."""
        self._require_idle()
        self._check_out(out, self.num_envs)
        places = [part_of(out, self.rows(number)) for number in range(self.halves)]
        seen = [part.observe(into) for part, into in zip(self._parts, places)]
        return batch_of(seen)

    def step(self, actions: Any, out: Row | None = None) -> StepResult:
        """Steps all envs once.

        Args:
            actions: as in `action_space`; see the class.
            out: arrays to which results are written, instead of new arrays: any of "state" (the
                flat observation), "rgb", "depth", "semantics", "rewards", "terminations",
                "truncations" and "endings", each a contiguous array [num_envs, ...] of exactly the
                result's type, such as the rows of buffers(). Images are drawn there directly; other
                results are copied once.

        Returns:
            Observations, rewards float32 (num_envs,), terminations and truncations bool
            (num_envs,), and infos. With one half, results that were written to `out` are those
            arrays themselves.

        Raises ValueError or TypeError for actions or `out` arrays of another shape or type; no env
        has then stepped. If something else raises an exception, such as a task of your own or
        Ctrl-C, the step is cut off: you must reset() all envs or call restore_state() before
        anything else.
        """
        self._require_idle()
        rows = self._actions.rows(actions, self.num_envs)
        self._check_out(out, self.num_envs)
        if self.halves == 1:
            return self._parts[0].step(rows, out)
        halves = [self.rows(half) for half in range(self.halves)]
        results = self._turns.step(
            [rows[half] for half in halves], [part_of(out, half) for half in halves]
        )
        return step_of_batch(self._parts, results)

    def send(self, actions: Any, half: int = 0, out: Row | None = None) -> None:
        """Begins a step of one half and returns at once.

        Args:
            actions: actions of the half's envs; they must not change until recv().
            half: index of the half.
            out: as in step(), with the rows of the half's envs.

        Raises the same exceptions as step(); no step is then under way.
        """
        self._require_half(half)
        self._require_idle(half)
        envs = self.num_envs // self.halves
        rows = self._actions.rows(actions, envs)
        self._check_out(out, envs)
        self._turns.begin(half, rows, out)

    def recv(self, half: int = 0) -> StepResult:
        """Waits for the step that send() began, and returns its results for the half's envs. If
        Ctrl-C ends the wait, the step stays under way, and the next call returns its results."""
        self._require_half(half)
        return self._turns.end(half)

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """A picture of each env, uint8 (240, 320, 3), from behind the robot; None without a
        render_mode."""
        self._require_idle()
        if self.render_mode is None:
            return None
        if not self._onlookers:
            look: dict[str, Any] = {"width": 320, "height": 240, "depth": False, "camera": "follow"}
            self._onlookers = [
                Renderer(one, threads=self._render_threads, **look) for one in self.simulators
            ]
        return tuple(frame for one in self._onlookers for frame in one.render()["rgb"])

    def save_state(self, envs: Iterable[int] | None = None) -> bytes:
        """Everything on which later steps depend, and the sums of the episodes under way, as bytes:
        of all envs, or of those with the numbers `envs`, in that order."""
        self._require_idle()
        if envs is None:
            return saved_states.state_of_all(self._parts)
        return saved_states.state_of(self._parts, env_numbers(envs, self.num_envs))

    def restore_state(self, state: bytes, envs: Iterable[int] | None = None) -> None:
        """Continues, bit for bit, from a state that a VectorEnv of the same world and options
        saved; observe() returns the new observations. Raises Error and changes nothing if the bytes
        are not such a state.

        A state of all envs is for a VectorEnv with the same number of envs and halves. A state of
        some envs can be restored to the same number of envs in any VectorEnv with the same seed,
        and a state of one env to any number of envs, to try many plans. It is restored to the envs
        with the numbers `envs`, or to all. These envs keep their own future random numbers and
        episodes, and a task of your own keeps its `steps` and `progress`.
        """
        self._require_idle()
        chosen = None if envs is None else distinct_envs(envs, self.num_envs)
        saved_states.restore(self._parts, state, chosen)
        self._broken_off[slice(None) if chosen is None else chosen] += 1

    def close(self, **kwargs: Any) -> None:
        """Waits for steps that are under way, whose results recv() still returns, and frees
        simulators, renderers and the world, unless they are referenced elsewhere. Results that were
        returned stay valid; everything else raises RuntimeError from now on."""
        if not self.closed:
            self._turns.close()
            self._parts, self._onlookers = [], []
            del self._world
        self.closed = True

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            "a galactic.VectorEnv cannot be pickled or copied: make one in each process, and give it "
            "what save_state() returned"
        )

    def _require_idle(self, *halves: int) -> None:
        """Raises RuntimeError if these halves, or all halves if none is given, cannot begin
        anything."""
        self._require_open()
        self._turns.require_idle(*halves)

    def _require_open(self) -> None:
        if self.closed:
            raise RuntimeError("this env is closed; make another one")

    def _require_half(self, half: int) -> None:
        if half not in range(self.halves):
            raise IndexError(f"there is no half {half}; the last is {self.halves - 1}")

    def _check_out(self, out: Row | None, envs: int) -> None:
        if out is not None:
            check_places(out, self._parts[0].landing_shapes(), envs)
