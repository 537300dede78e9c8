"""Settings that are known to work, by name."""

from __future__ import annotations

import dataclasses
from typing import Any, Mapping

from galactic.learning.settings import Settings, SettingsError, did_you_mean, overriding

# A blind policy stays at half of the episodes: it needs to see walls, to know the way around them
# (geodesic), and to feel that it is stuck (bump).
_WAY = "geodesic geodesic-weight=1 bump bump-penalty=0.03"
_QUICK = {
    "ranks": 2,
    "envs": 512,
    "halves": 1,
    "log_std": "parameter",
    "final_log_std": -1.5,
    "normalize": True,
    "closeup": 0.2,
    "learning_rate": 1e-3,
    "horizon": 32,
    "epochs": 2,
    "mini_batches": 4,
    # Two ranks of one machine wait for each other: a run repeats itself, bit for bit.
    "sync_fraction": 1.0,
}

PRESETS: Mapping[str, Mapping[str, Any]] = {
    # Table 3 of the paper, which are the defaults.
    "paper": {},
    # Mobile Pick in minutes on two processors, without a camera: a laser sees the walls.
    "quick": {
        **_QUICK,
        "steps": 12_000_000,
        "simulation": "task=pick episode-steps=200 laser-beams=24 laser-heights=0.25,0.8 "
        f"laser-range=4 {_WAY}",
        "network": "state",
        "validate_every": 2_000_000,
    },
    # The same with the head's depth camera in place of the laser.
    "quick-depth": {
        **_QUICK,
        "steps": 6_000_000,
        "simulation": f"task=pick episode-steps=200 {_WAY}",
        "network": "depth",
        "image_size": 64,
        "validate_every": 1_000_000,
    },
}


def preset(name: str, **changes: Any) -> Settings:
    """The settings of a preset, with changes: see overriding()."""
    if name not in PRESETS:
        hint = did_you_mean(name, PRESETS) or f"; the presets are {', '.join(PRESETS)}"
        raise SettingsError(f'"{name}" is not a preset{hint}')
    chosen = Settings(**PRESETS[name])
    return dataclasses.replace(chosen, **overriding(chosen, changes))
