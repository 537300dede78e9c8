"""Options of the simulation as the words of Settings.simulation: "task=pick no-distractors"."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any

import galactic
from galactic.learning.refusals import SettingsError
from galactic.learning.setting_fields import ends_of

# Arguments of VectorEnv that are not options of the simulation, and options that VectorEnv sets
# itself.
CHOSEN_BY_TRAINER = {
    *set(inspect.signature(galactic.VectorEnv).parameters) - {"task"},
    "envs",
    "auto_reset",
    "body_transforms",
}


def simulation_keyword(word: str) -> str:
    """The keyword of galactic.Simulator that a word of Settings.simulation names: no_terminate of
    "no-terminate" and of "no-terminate=false"."""
    return word.partition("=")[0].lstrip("-").replace("-", "_")


def simulation_keywords(text: str) -> dict[str, Any]:
    """Settings.simulation as keywords of galactic.Simulator: "task=pick no-distractors" is
    {"task": "pick", "no_distractors": True}."""
    keywords: dict[str, Any] = {}
    for word in text.split():
        _, equals, value = word.partition("=")
        keyword = simulation_keyword(word)
        if not keyword:
            raise SettingsError(f'--simulation: found "{word}", expected NAME=VALUE or NAME')
        if keyword in CHOSEN_BY_TRAINER:
            raise SettingsError(
                f"{keyword} is not for --simulation; the trainer chooses it (see --envs, --seed)"
            )
        keywords[keyword] = value if equals else True
    return keywords


def word_of(name: str, value: Any) -> str:
    """An option of the simulation, as one types it."""
    name = name.replace("_", "-")
    if isinstance(value, bool):
        return name if value else f"{name}=false"
    if not isinstance(value, Sequence) or isinstance(value, str):
        return f"{name}={value}"
    if name != "laser-heights":  # a range
        return f"{name}={_dashed(value)}"
    parts = [_dashed(part) if isinstance(part, Sequence) else str(part) for part in value]
    return f"{name}={','.join(parts)}"


def _dashed(ends: Sequence[Any]) -> str:
    return "-".join(map(str, ends))


def latest_words(words: str) -> str:
    """Words of Settings.simulation without repetitions: the last word of each name, in the place of
    the first."""
    return " ".join({simulation_keyword(word): word for word in words.split()}.values())


def is_robot_noise(word: str) -> bool:
    """Whether a word of Settings.simulation adds noise to the robots. A word that switches off the
    noise of a world does not."""
    if simulation_keyword(word) not in galactic.Simulator.NOISE_OPTIONS:
        return False
    try:
        return any(float(end) != 0.0 for end in ends_of(word.partition("=")[2]))
    except ValueError:  # no number, which the simulation refuses
        return False
