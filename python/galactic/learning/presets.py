"""Settings that are known to work, by the name of a preset or from the folder of another run."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from typing import Any

from galactic.learning.refusals import SettingsError, did_you_mean
from galactic.learning.saving.runs import settings_in
from galactic.learning.setting_options import overriding
from galactic.learning.settings import Settings

_BUMP = "bump bump-penalty=0.03"
_QUICK = {
    "steps": 6_000_000,
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
    # The two ranks wait for each other, so that a run can be repeated bit for bit.
    "sync_fraction": 1.0,
    "validate_every": 1_000_000,
}

PRESETS: Mapping[str, Mapping[str, Any]] = {
    # The defaults are table 3 of the paper.
    "paper": {},
    # Mobile Pick in minutes on two processors: the robot knows the way around walls and furniture
    # (geodesic), and feels that it is stuck (bump).
    "quick": {
        **_QUICK,
        "simulation": f"task=pick episode-steps=200 geodesic geodesic-weight=1 {_BUMP}",
        "network": "state",
    },
    # The same without a map: the robot has two planes of a laser scanner and a memory, and only its
    # critic knows the way. Meant for a --teacher trained with the preset `quick`; without a
    # teacher, training takes more steps.
    "quick-laser": {
        **_QUICK,
        "steps": 4_000_000,
        "simulation": "task=pick episode-steps=200 laser-beams=32 laser-heights=0.25,0.8 laser-range=4 "
        f"geodesic geodesic-weight=1 {_BUMP}",
        "network": "state",
        "recurrent": True,
        "critic_only": "geodesic",
    },
    # The same with the depth camera in the head instead of the scanner.
    "quick-depth": {
        **_QUICK,
        "steps": 4_000_000,
        "simulation": f"task=pick episode-steps=200 geodesic geodesic-weight=1 {_BUMP}",
        "network": "depth",
        "recurrent": True,
        "critic_only": "geodesic",
        "image_size": 64,
    },
}

# The presets that are meant for runs with a --teacher.
TAUGHT = ("quick-laser", "quick-depth")


WORDS = "|".join((*PRESETS, "RUN"))


def preset(name: str, **changes: Any) -> Settings:
    """The settings of the preset `name`, or of the run in the folder `name`, with changes: see
    overriding(). Settings of the preset that the changes leave without effect return to their
    defaults. Raises SettingsError for a change that has no effect."""
    chosen = _named(name)
    return Settings.effective({**vars(chosen), **overriding(chosen, changes)}, changes)


def _named(name: str) -> Settings:
    if name in PRESETS:
        return Settings(**PRESETS[name])
    folder = pathlib.Path(name)
    if os.sep in name or (name and folder.is_dir()):
        return settings_in(folder)
    hint = did_you_mean(name, PRESETS)
    known = f"; the presets are {', '.join(PRESETS)}, and folders of runs"
    raise SettingsError(f'"{name}" is not a preset{hint or known}')
