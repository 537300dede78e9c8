"""What happened to each env in a step, as infos, on request."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from galactic._core import Simulator

# For each event, its name in Simulator.counts().
_COUNTED = {
    "refused": "refused",
    "slid": "slid",
    "grasped": "grasps",
    "dropped": "drops",
    "restored": "restored",
}


class StepEvents:
    """The events in the envs of a simulator between the beginning and the end of a step."""

    def __init__(self, simulator: Simulator) -> None:
        self._simulator = simulator
        self.begin()

    def begin(self) -> None:
        """Call before a step."""
        self._before = self._simulator.counts()

    def infos(self, playing: NDArray[np.bool_]) -> dict[str, Any]:
        """The events of the step that has been done, as infos. `playing`: the envs that are not
        idle."""
        now = self._simulator.counts()
        events = {
            event: now[counted] > self._before[counted] for event, counted in _COUNTED.items()
        }
        events["touched"] = events["refused"] | events["slid"]
        return masked({"events": masked(events, playing)}, playing)


def masked(infos: Mapping[str, Any], mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Infos, each with a mask of its own, so that changing one mask changes no other."""
    both: dict[str, Any] = {}
    for name, values in infos.items():
        both[name] = values
        both[f"_{name}"] = mask.copy()
    return both
