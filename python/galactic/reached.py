"""What steps led to, where their episodes ended, too."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def reached(
    observations: Array | Mapping[str, Array], infos: Mapping[str, Any]
) -> Array | dict[str, Array]:
    """What a step of VectorEnv led to, for those who learn from single steps, as from a replay buffer.

    observations, infos: as step() or recv() returned them. Returns a copy of `observations`, of the same shapes and
    types, that has of each env whose episode ended the last observation (final_obs) in place of the first one of
    the next episode.
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
