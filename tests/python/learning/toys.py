"""Small environments whose best policy is known, in the place of simulated homes."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence

import numpy as np

from galactic.learning.rollouts.environments import Observation, Step, Timeouts


class ReachAndGrasp:
    """A point on a plane has to go to a place and grasp there.

    State: the way to the place (2), time left (1), noise (1). Motions: 2, each moves the point by up to
    0.2. Grasping within 0.2 of the place is a success and pays 10, elsewhere it is a failure; time cuts
    off after `limit` steps. The way that was gained is paid, too. Random actions fail.
    """

    state_size = 4
    motions = 2
    decides_terminate = False
    measures: Sequence[str] = ()
    logs: Sequence[str] = ()
    parts: Sequence[tuple[str, int]] = ()
    meanings: Mapping[str, object] = {}
    progress = 0.0

    def __init__(self, count: int, halves: int = 1, seed: int = 1, first_env: int = 0,
                 limit: int = 20, images: Mapping[str, tuple[int, ...]] = {}):  # fmt: skip
        self.count = count
        self.images = images
        self.seed = seed
        self.limit = limit
        size = count // halves
        self.halves = [slice(size * half, size * (half + 1)) for half in range(halves)]
        self.envs = np.arange(first_env, first_env + count)
        self.episode = np.zeros(count, np.int64)
        self.age = np.zeros(count, np.int64)
        self.way = np.zeros((count, 2), np.float32)
        self._sent: dict[int, tuple[np.ndarray, Observation]] = {}

    def _uniform(self, which: np.ndarray) -> np.ndarray:
        """[k, 4] in [0, 1), of (env, episode) alone."""
        seeds = [(self.seed, self.envs[env], self.episode[env]) for env in which]
        rows = [np.random.default_rng(seed).random(4, np.float32) for seed in seeds]
        return np.array(rows, np.float32).reshape(-1, 4)

    def _begin(self, which: np.ndarray) -> None:
        self.way[which] = 2.0 * self._uniform(which)[:, :2] - 1.0
        self.age[which] = 0

    def _rows(self, envs: slice) -> np.ndarray:
        left = 1.0 - self.age[envs] / self.limit
        noise = np.sin(1e3 * self.way[envs, 0] + self.age[envs])
        return np.column_stack([self.way[envs], left, noise]).astype(np.float32)

    def _write(self, envs: slice, into: Observation) -> None:
        into.state.numpy()[:] = self._rows(envs)
        if into.rgb is not None and into.depth is not None:
            into.rgb.numpy()[:] = (127.0 + 100.0 * self.way[envs, :1, None, None]).astype(np.uint8)
            into.depth.numpy()[:] = 2.0 + self.way[envs, 1, None, None]

    def _cut(self, envs: slice, which: np.ndarray) -> Timeouts:
        return Timeouts(which, self._rows(envs)[which])

    def reset(self, into: Observation) -> None:
        self.episode[:] = 0
        self._begin(np.arange(self.count))
        self._write(slice(0, self.count), into)

    def observe(self, into: Observation) -> None:
        self._write(slice(0, self.count), into)

    def send(self, half: int, actions: np.ndarray, into: Observation) -> None:
        assert actions.shape[1] == 4 and half not in self._sent
        self._sent[half] = actions, into

    def recv(self, half: int) -> Step:
        (actions, into), envs = self._sent.pop(half), self.halves[half]
        before = np.linalg.norm(self.way[envs], axis=1)
        self.way[envs] -= 0.2 * np.clip(actions[:, :2], -1.0, 1.0)
        after = np.linalg.norm(self.way[envs], axis=1)
        self.age[envs] += 1
        grasped = actions[:, 2] > 0.5
        successes = grasped & (after < 0.2)
        truncated = ~grasped & (self.age[envs] >= self.limit)
        rewards = (before - after + 10.0 * successes).astype(np.float32)
        timeouts = None
        if truncated.any():
            index = np.flatnonzero(truncated)
            timeouts = self._cut(envs, index)
        ended = np.flatnonzero(grasped | truncated) + envs.start
        self.episode[ended] += 1
        self._begin(ended)
        self._write(envs, into)
        return Step(rewards, grasped, truncated, successes, grasped, timeouts)

    def save(self) -> bytes:
        file = io.BytesIO()
        np.savez(file, episode=self.episode, age=self.age, way=self.way)
        return file.getvalue()

    def restore(self, state: bytes) -> None:
        saved = np.load(io.BytesIO(state))
        self.episode[:], self.age[:], self.way[:] = saved["episode"], saved["age"], saved["way"]

    def close(self) -> None:
        pass


class Measured(ReachAndGrasp):
    """The same, which measures what the trainer knows of episodes, too, and names that it has already."""

    measures = ("kl", "validation_success", "steps")

    def recv(self, half: int) -> Step:
        ages, envs = self.age.copy(), self.halves[half]
        step = super().recv(half)
        ended = step.terminated | step.truncated
        if not ended.any():
            return step
        found = (step.terminated, step.successes, ages[envs] + 1)
        measured = {
            name: np.where(ended, values, 1e9).astype(np.float32)
            for name, values in zip(self.measures, found)
        }
        return step._replace(measures=measured)


class Look(ReachAndGrasp):
    """The same where the state does not tell the way: only an image of EDGE pixels does, in which the
    place stands out as a square, seen from the point."""

    EDGE = 36

    def __init__(self, count: int, **options: int):
        super().__init__(count, images={"depth": (self.EDGE, self.EDGE)}, **options)

    def _rows(self, envs: slice) -> np.ndarray:
        rows = super()._rows(envs)
        rows[:, :2] = 0.0
        return rows

    def _images(self, envs: slice) -> np.ndarray:
        pixels = np.arange(self.EDGE)
        # 2 m wide each way.
        near = [np.abs(pixels - (self.way[envs, axis, None] + 2.0) * self.EDGE / 4.0) < 4.0
                for axis in (0, 1)]  # fmt: skip
        return np.where(near[1][:, :, None] & near[0][:, None], 1.0, 9.0).astype(np.float32)

    def _write(self, envs: slice, into: Observation) -> None:
        super()._write(envs, into)
        assert into.depth is not None
        into.depth.numpy()[:] = self._images(envs)

    def _cut(self, envs: slice, which: np.ndarray) -> Timeouts:
        return super()._cut(envs, which)._replace(depth=self._images(envs)[which])


class Remember(ReachAndGrasp):
    """A sign is shown in the first step of four; in the last, grasping has to follow it.

    State: the sign (+1 or -1, 0 after the first step), steps left, nothing (2). Success pays 1, and
    comes in half of the episodes without memory.
    """

    def __init__(self, count: int, **options: int):
        super().__init__(count, limit=4, **options)

    def _rows(self, envs: slice) -> np.ndarray:
        sign = np.sign(self.way[envs, 0]) * (self.age[envs] == 0)
        rest = np.zeros_like(sign)
        return np.column_stack([sign, 4 - self.age[envs], rest, rest]).astype(np.float32)

    def recv(self, half: int) -> Step:
        (actions, into), envs = self._sent.pop(half), self.halves[half]
        self.age[envs] += 1
        ended = self.age[envs] >= self.limit
        right = (actions[:, 2] > 0.5) == (self.way[envs, 0] > 0.0)
        successes = ended & right
        which = np.flatnonzero(ended) + envs.start
        self.episode[which] += 1
        self._begin(which)
        self._write(envs, into)
        picks = ended & (actions[:, 2] > 0.5)
        return Step(successes.astype(np.float32), ended, np.zeros_like(ended), successes, picks)


class Uneven(ReachAndGrasp):
    """Whatever is done, every fourth env succeeds in three steps, and the others fail in `limit`; half of those
    pick."""

    def __init__(self, count: int, limit: int = 45, **options: int):
        super().__init__(count, limit=limit, **options)

    def is_quick(self, envs: slice) -> np.ndarray:
        return self.envs[envs] % 4 == 0

    def recv(self, half: int) -> Step:
        (actions, into), envs = self._sent.pop(half), self.halves[half]
        self.age[envs] += 1
        successes = self.is_quick(envs) & (self.age[envs] >= 3)
        ended = successes | (self.age[envs] >= self.limit)
        which = np.flatnonzero(ended) + envs.start
        self.episode[which] += 1
        self._begin(which)
        self._write(envs, into)
        picks = ended & (self.envs[envs] % 2 == 0)
        return Step(successes.astype(np.float32), ended, np.zeros_like(ended), successes, picks)
