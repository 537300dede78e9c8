"""Random numbers that depend on (seed, env, step) only, or in evaluations on (seed, episode, step).

A sample of an action must not depend on the rank, half-batch or order in which an env is stepped,
and a resumed run must continue with the same numbers (galactic/hashing.py).
"""

from __future__ import annotations

import numpy as np

from galactic.hashing import hashed
from galactic.learning.policies.distributions import DECISIONS


def noise_of(seed: int, keys: np.ndarray, steps: np.ndarray, motions: int) -> np.ndarray:
    """float32 [..., motions + 2]: standard normal numbers, then two uniform in
    [0, 1), for each pair of `keys` and `steps`, whole numbers that broadcast to [...]."""
    pairs = (motions + 1) // 2
    bits = hashed(seed, keys, steps, pairs + 1)
    # Two numbers from each hash, of 24 bits each, as many as a float in [0, 1) holds.
    scale = np.float32(2.0**-24)
    first = (bits >> np.uint64(40)).astype(np.float32) * scale
    second = ((bits >> np.uint64(8)) & np.uint64(0xFFFFFF)).astype(np.float32) * scale
    noise = np.empty(bits.shape[:-1] + (motions + DECISIONS,), np.float32)
    # Box and Muller; 1 - u is never 0.
    radius = np.sqrt(-2.0 * np.log1p(-first[..., :pairs]))
    angle = second[..., :pairs] * np.float32(2.0 * np.pi)
    noise[..., 0:motions:2] = radius * np.cos(angle)
    noise[..., 1:motions:2] = (radius * np.sin(angle))[..., : motions // 2]
    noise[..., motions] = first[..., pairs]
    noise[..., motions + 1] = second[..., pairs]
    return noise


def action_noise(seed: int, envs: range, steps: range, motions: int) -> np.ndarray:
    """The noise of rollouts: float32 [steps, envs, motions + 2], see noise_of().

    `envs` are numbered over all ranks, `steps` from the beginning of the run.
    """
    return noise_of(seed, _numbers(envs)[None, :], _numbers(steps)[:, None], motions)


def episode_noise(seed: int, episodes: np.ndarray, steps: np.ndarray, motions: int) -> np.ndarray:
    """The noise of evaluations and validations: float32 [n, motions + 2], for each of `episodes`
    and the number of its steps done. It differs from the noise of rollouts with the same seed, with
    which the policy learned."""
    return noise_of(seed ^ 0x706C6179, episodes, steps, motions)


def mini_batch_envs(seed: int, epoch: int, envs: range, parts: int) -> np.ndarray:
    """Splits the envs of a rank into mini-batches, differently in each epoch; int64 [parts, n].

    Of each group of `parts` consecutive envs, one goes into each mini-batch. So all mini-batches of
    all ranks have the same size, and R ranks of N envs have the same mini-batches as one rank of R
    N. `epoch` counts from the start of the run; the returned numbers are relative to `envs`.
    """
    blocks = range(envs.start // parts, envs.stop // parts)
    keys = hashed(seed ^ 0x6D696E69, _numbers(blocks), np.array([epoch]), parts)
    place = np.argsort(keys, axis=1, kind="stable")
    return (place + np.arange(len(blocks))[:, None] * parts).T.copy()


def _numbers(of: range) -> np.ndarray:
    return np.arange(of.start, of.stop, dtype=np.uint64)
