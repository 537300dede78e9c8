"""The observations to which steps led, including the last ones of episodes that ended."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def reached(
    observations: Array | Mapping[str, Array], infos: Mapping[str, Any]
) -> Array | dict[str, Array]:
    """The observations to which a step of VectorEnv led, for learning from single steps, as with a
    replay buffer.

    observations, infos: as step() or recv() returned them. Returns a copy of `observations`, with
    the same shapes and types. For each env whose episode ended, it has that episode's last
    observation (final_obs) in place of the next episode's first.
    """
    if isinstance(observations, Mapping):
        return {name: _reached(part, infos, name) for name, part in observations.items()}
    return _reached(observations, infos)


def _reached(observations: Array, infos: Mapping[str, Any], name: str | None = None) -> Array:
    after = np.array(observations)
    if "final_obs" not in infos:
        return after
    ended = np.flatnonzero(infos["_final_obs"])
    if not len(ended):
        return after
    last = infos["final_obs"][ended]
    after[ended] = np.stack([row if name is None else row[name] for row in last])
    return after
