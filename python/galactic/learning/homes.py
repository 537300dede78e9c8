"""Simulated homes as environments of the trainer."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import torch

import galactic
from galactic import task_runner
from galactic.learning.network_settings import CAMERA, CAMERA_NOISE
from galactic.learning.refusals import SettingsError
from galactic.learning.rollouts.environments import Observation, Step, Timeouts
from galactic.learning.setting_fields import option_name
from galactic.learning.settings import Settings
from galactic.learning.simulation_words import simulation_keywords
from galactic.learning.user_code.own_tasks import MakeTask
from galactic.sensors import meaning_of

SUCCESS = int(galactic.EpisodeEnd.SUCCESS)
# Names of the cameras, if there are two.
_EYE, _ONLOOKER = "eye", "onlooker"


def camera_options(settings: Settings) -> dict[str, Any]:
    """The options of galactic.Renderer that draw what the network sees."""
    color = "rgb" if "rgb" in settings.sight else None
    chosen = {option: getattr(settings, name) for option, name in CAMERA.items()}
    # The renderer draws depth unless told otherwise.
    depth = {} if "depth" in settings.sight else {"depth": False}
    return {"color": color, **depth, **chosen}


def exact_camera(settings: Settings) -> dict[str, Any]:
    """The same without the options that add noise."""
    options = camera_options(settings)
    return {name: value for name, value in options.items() if name not in CAMERA_NOISE}


def _as_typed(error: galactic.Error, keywords: Mapping[str, Any]) -> galactic.Error:
    """The same error; if it is about an option, under the name that the trainer's command line has
    for it."""
    where = error.where
    if where in CAMERA:
        where = option_name(CAMERA[where])
    elif where in keywords:
        where = f"--simulation: {where}"
    return galactic.Error(error.code, where, error.message)


def require_options(settings: Settings) -> None:
    """Raises SettingsError or Error for options of the simulation that are invalid in any world."""
    keywords = simulation_keywords(settings.simulation)
    try:
        galactic.Simulator.check_options(**keywords)
    except (TypeError, ValueError) as problem:
        raise SettingsError(f"--simulation: {problem}") from problem
    except galactic.Error as error:
        raise _as_typed(error, keywords) from error


def sizes_of(parts: Sequence[tuple[str, int]]) -> str:
    """Names and sizes of the parts of an observation, for a sentence."""
    return ", ".join(f"{name} ({size})" for name, size in parts)


class Homes:
    """A galactic.VectorEnv with the trainer's interface. Observations land in the rollout: the
    simulator's threads write them there directly, or by way of pinned memory if the rollout is on a
    GPU.

    `task` makes user-defined tasks, which replace the simulation's and receive `is_evaluation`.
    `onlooker`: options of an additional camera, whose color images are in `shown`. `device`: where
    networks run. On a CUDA device, images are drawn there, too, or by the processor if the device
    cannot draw (`drawn_by` says what draws them).

    Images drawn on a GPU do not stay there: Renderer.render() copies them to pinned memory, and
    recv() copies them back to the rollout on the GPU while the other half steps.
    Renderer.render_to_device() would avoid both copies, but it always draws all envs, although a
    step redraws only the few that begin an episode, and it does not support noise, which the
    processor adds.
    """

    def __init__(self, world: galactic.World, settings: Settings, threads: int, *,
                 rank: int = 0, ranks: int = 1, order: str = "shuffled",
                 task: MakeTask | None = None, is_evaluation: bool = False,
                 onlooker: Mapping[str, Any] | None = None,
                 device: torch.device = torch.device("cpu")):  # fmt: skip
        keywords = simulation_keywords(settings.simulation)
        images = camera_options(settings) if settings.sight else None
        # The prefix of the names of the network's images.
        self._eye = ""
        if onlooker is not None:
            images = {_ONLOOKER: {**onlooker, "depth": False}, **({_EYE: images} if images else {})}
            self._eye = f"{_EYE}_" if _EYE in images else ""
        self.shown: np.ndarray | None = None
        """The latest images of the onlooker, uint8 [n, height, width, 3]. If a step ended an
        episode, they show its end and not the beginning of the next one."""

        def made(**drawing: str) -> galactic.VectorEnv:
            return galactic.VectorEnv(
                world,
                settings.envs,
                images=None if images is None else _with_drawing(images, drawing),
                halves=2 if settings.halves == 2 else 1,
                copy=False,
                threads=threads,
                seed=settings.seed,
                order=order,
                rank=rank,
                ranks=ranks,
                is_evaluation=is_evaluation,
                **(keywords if task is None else {**keywords, "task": task}),
            )

        try:
            self.env = _drawing_on(device, made)
        except (TypeError, ValueError) as problem:
            if task_runner.has_raised(problem):
                raise
            raise SettingsError(f"--simulation: {problem}") from problem
        except galactic.Error as error:
            raise _as_typed(error, keywords) from error
        first = self.env.simulators[0]
        self.count = settings.envs
        self.images: Mapping[str, tuple[int, ...]] = self._shapes()
        parts = self.env.observation_parts
        self.parts = [(name, part.stop - part.start) for name, part in parts.items()]
        self.state_size = sum(size for _, size in self.parts)
        self.measures: Sequence[str] = self.env.measures
        self.logs: Sequence[str] = self.env.logs
        self.motions = first.action_count - 2
        self.meanings = meaning_of((name for name, _ in self.parts), first.options)
        self.decides_terminate = _decides_terminate(settings.terminate, first.options)
        self.halves: Sequence[slice] = [self.env.rows(half) for half in range(settings.halves)]
        self._landings = [_landing(half.stop - half.start) for half in self.halves]
        self._into: list[Observation | None] = [None] * settings.halves
        self._staged: list[Observation | None] = [None] * settings.halves

    @property
    def drawn_by(self) -> str | None:
        """What draws the images, in words; None without images."""
        for renderers in self.env.renderers[:1]:
            one = next(iter(renderers.values())) if isinstance(renderers, dict) else renderers
            return str(one.description)
        return None

    def restart(self, seed: int) -> None:
        """Returns the homes to the state in which they would be made with this seed."""
        self.env.reset(seed=seed)

    def reset(self, into: Observation) -> None:
        self._write(self.env.reset(seed=None)[0], into)

    def observe(self, into: Observation) -> None:
        self._write(self.env.observe(), into)

    def send(self, half: int, actions: np.ndarray, into: Observation) -> None:
        host = into if into.state.device.type == "cpu" else self._stage(half, into)
        self._into[half] = into
        landing = self._landings[half]
        for name, rows in host._asdict().items():
            if rows is not None:
                landing[self._named(name)] = rows.numpy()
        self.env.send(actions, half, landing)

    def recv(self, half: int) -> Step:
        seen, rewards, terminated, truncated, infos = self.env.recv(half)
        self._show(seen, infos)
        staged, into = self._staged[half], self._into[half]
        if staged is not None and into is not None:
            for host, device in zip(staged, into):
                if host is not None and device is not None:
                    device.copy_(host, non_blocking=True)
        timeouts = None
        if truncated.any():
            timeouts = self._timeouts(np.flatnonzero(truncated), infos["final_obs"])
        successes = self._landings[half]["endings"] == SUCCESS
        final = infos.get("final_info")
        picks = final["picked"] if final else np.zeros_like(successes)
        measures = {name: final[name] for name in self.measures} if final else {}
        logs = {name: infos["log"][name] for name in self.logs}
        ended = terminated, truncated, successes, picks
        return Step(rewards, *ended, timeouts, measures, logs, infos)

    def begin_episodes(self, episodes: Mapping[int, int], into: Observation) -> None:
        """Begins the episode with the given index in each of the given envs; the other envs do not
        change. Then writes the observations of all envs."""
        mask, numbers = np.zeros(self.count, np.bool_), np.full(self.count, -1, np.int64)
        for env, episode in episodes.items():
            mask[env], numbers[env] = True, episode
        seen, _ = self.env.reset(options={"reset_mask": mask, "episodes": numbers})
        self._write(seen, into)

    def playable_episodes(self) -> list[int]:
        """The world's episodes in which the robot can start."""
        skipped = set(self.env.simulators[0].skipped_episodes)
        return [e for e in range(self.env.world.episodes) if e not in skipped]

    @property
    def progress(self) -> float:
        """The share of the training that is over, 0 to 1, as user-defined tasks receive it."""
        return self.env.progress

    @progress.setter
    def progress(self, value: float) -> None:
        self.env.progress = value

    @property
    def are_limited(self) -> bool:
        """Whether episodes have a time limit."""
        return bool(self.env.simulators[0].options["episode_steps"])

    def endings(self, half: int) -> np.ndarray:
        """How episodes ended in the last step, as values of EpisodeEnd; [n]."""
        return self._landings[half]["endings"]

    def base_positions(self) -> np.ndarray:
        """The positions of the bases on the floor plane: x and z, meters, float32 [n, 2]."""
        return self.env.env_states().world_from_root.translation[:, [0, 2]]

    def collisions(self, env: int) -> tuple[int, int]:
        """How many steps of an env so far were refused, and in how many its robot slid."""
        half, row = divmod(env, self.count // len(self.halves))
        counted = self.env.simulators[half].statistics(row)
        return counted["refused"], counted["slid"]

    def save(self) -> bytes:
        return self.env.save_state()

    def restore(self, state: bytes) -> None:
        self.env.restore_state(state)

    def close(self) -> None:
        self.env.close()

    def _write(self, observations: Any, into: Observation) -> None:
        rows = observations if isinstance(observations, dict) else {"state": observations}
        for name, target in into._asdict().items():
            if target is not None:
                target.copy_(torch.from_numpy(np.array(rows[self._named(name)])))
        self._show(rows, {})

    def _named(self, name: str) -> str:
        """The env's name for a part of an Observation."""
        return name if name == "state" else f"{self._eye}{name}"

    def _show(self, seen: Any, infos: Mapping[str, Any]) -> None:
        """Keeps the images of the onlooker."""
        name = f"{_ONLOOKER}_rgb"
        if not isinstance(seen, dict) or name not in seen:
            return
        shown = seen[name].copy()
        if "final_obs" in infos:
            for env in np.flatnonzero(infos["_final_obs"]):
                shown[env] = infos["final_obs"][env][name]
        self.shown = shown

    def _timeouts(self, envs: np.ndarray, final: np.ndarray) -> Timeouts:
        """The last observations of some envs, from Gymnasium's array of objects."""
        rows = [final[env] for env in envs]
        if not isinstance(rows[0], dict):
            return Timeouts(envs, np.stack(rows))
        names = [name for name in Timeouts._fields[1:] if self._named(name) in rows[0]]
        return Timeouts(envs, **{n: np.stack([row[self._named(n)] for row in rows]) for n in names})

    def _shapes(self) -> dict[str, tuple[int, ...]]:
        """The shapes of the images that the network sees of one env."""
        shapes = {}
        for drawn in self.env.renderers[:1]:
            eye = drawn.get(_EYE) if isinstance(drawn, dict) else drawn
            shapes = {name: shape for name, (shape, _) in eye.shapes.items()} if eye else {}
        return shapes

    def _stage(self, half: int, into: Observation) -> Observation:
        """Pinned memory from which `into` is filled."""
        staged = self._staged[half]
        if staged is None:
            staged = Observation(
                **{name: _pinned(rows) for name, rows in into._asdict().items() if rows is not None}
            )
            self._staged[half] = staged
        return staged


def _with_drawing(images: Mapping[str, Any], drawing: Mapping[str, str]) -> dict[str, Any]:
    """The options of one camera, or of several by name, extended with `drawing`."""
    if _ONLOOKER in images:
        return {name: {**camera, **drawing} for name, camera in images.items()}
    return {**images, **drawing}


def _drawing_on(
    device: torch.device, made: Callable[..., galactic.VectorEnv]
) -> galactic.VectorEnv:
    """Calls `made` with Renderer options that draw on the networks' device, which differs between
    ranks."""
    if device.type != "cuda":
        return made()
    try:
        return made(device=f"cuda:{device.index or 0}")
    except galactic.Error as error:
        if error.code != galactic.ErrorCode.UNSUPPORTED or error.where != "render device":
            raise
    return made(backend="soft")


def _pinned(like: torch.Tensor) -> torch.Tensor:
    return torch.empty_like(like, device="cpu").pin_memory()


def _landing(envs: int) -> dict[str, np.ndarray]:
    """The arrays for the results of a half, except its observations."""
    return {
        "rewards": np.zeros(envs, np.float32),
        "terminations": np.zeros(envs, np.bool_),
        "truncations": np.zeros(envs, np.bool_),
        "endings": np.zeros(envs, np.uint8),
    }


def _decides_terminate(terminate: str, options: Mapping[str, Any]) -> bool:
    """Whether the policy decides when to terminate. In `auto` it does not if terminating has no
    effect: where a pick is a success, and where success is judged at each release."""
    if terminate == "auto":
        return options["task"] == "rearrange" and not options["no_terminate"]
    return terminate == "learned"
