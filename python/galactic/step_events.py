"""What happened to each env in a step, as infos: for those who ask."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic._core import Simulator

# Of each event, what Simulator.counts() counts of it.
_COUNTED = {
    "refused": "refused",
    "slid": "slid",
    "grasped": "grasps",
    "dropped": "drops",
    "restored": "restored",
}


class StepEvents:
    """What the envs of a simulator have counted between the beginning and the end of a step."""

    def __init__(self, simulator: Simulator) -> None:
        self._simulator = simulator
        self.begin()

    def begin(self) -> None:
        """A step comes."""
        self._before = self._simulator.counts()

    def infos(self, playing: NDArray[np.bool_]) -> dict[str, Any]:
        """Of the step that has been done, as infos; `playing`: the envs that are not idle."""
        now = self._simulator.counts()
        events = {
            event: now[counted] > self._before[counted] for event, counted in _COUNTED.items()
        }
        events["touched"] = events["refused"] | events["slid"]
        return masked({"events": masked(events, playing)}, playing)


def masked(infos: Mapping[str, Any], mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Infos, each beside a mask of its own: who changes one of them changes no other."""
    both: dict[str, Any] = {}
    for name, values in infos.items():
        both[name] = values
        both[f"_{name}"] = mask.copy()
    return both
