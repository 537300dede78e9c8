"""Random numbers without a stream whose state must be stored: every number is a hash of what it is
for, as in the simulator."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)


def _mixed(bits: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The finalizer of SplitMix64 (Steele, Lea, Flood 2014), in place."""
    bits ^= bits >> np.uint64(30)
    bits *= np.uint64(0xBF58476D1CE4E5B9)
    bits ^= bits >> np.uint64(27)
    bits *= np.uint64(0x94D049BB133111EB)
    bits ^= bits >> np.uint64(31)
    return bits


def hashed(
    seed: int, keys: NDArray[np.integer], steps: NDArray[np.integer], count: int
) -> NDArray[np.uint64]:
    """uint64 [..., count] for keys and steps that broadcast to [...]."""
    with np.errstate(over="ignore"):
        start = _mixed(np.array([seed], np.uint64) + _GOLDEN)
        key = _mixed(start + keys.astype(np.uint64) * _GOLDEN)
        row = _mixed(key + steps.astype(np.uint64) * _GOLDEN)
        return _mixed(row[..., None] + np.arange(1, count + 1, dtype=np.uint64) * _GOLDEN)
