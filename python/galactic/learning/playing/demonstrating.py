"""Makes demonstrations: begins their folder, plays the parts that are missing, and loads policies
that act as experts."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import time

import numpy as np
import torch

import galactic
from galactic import demonstrations, files
from galactic.demonstration_writer import write_part
from galactic.demonstrations import About, Demonstrations
from galactic.hashing import hashed
from galactic.learning.homes import Homes
from galactic.learning.network_settings import CAMERA, CAMERA_NOISE
from galactic.learning.playing.evaluation import Actor, Evaluator
from galactic.learning.playing.experts import Expert, Recorder
from galactic.learning.policies.fitting import Observed, columns_of
from galactic.learning.refusals import CheckpointError, SettingsError
from galactic.learning.reports.progress import ProgressLine, duration
from galactic.learning.saving import checkpoint
from galactic.learning.saving.checkpoint import SavedPolicy
from galactic.learning.setting_fields import option_name, typed
from galactic.learning.settings import Settings
from galactic.learning.user_code import own_networks


def begin(folder: pathlib.Path, about: About) -> None:
    """Writes the index that describes the demonstrations, or checks that the existing one describes
    the same."""
    file = folder / demonstrations.INDEX
    if not file.exists():
        if demonstrations.parts_in(folder):
            raise SettingsError(
                f"{folder} holds parts of demonstrations, but no {demonstrations.INDEX} that says which; "
                "choose another folder"
            )
        text = demonstrations.text_of(about)
        files.write_atomically(file, lambda handle: handle.write(text), "w")
        return
    found = demonstrations.read_about(folder)
    wanted = demonstrations.about_of(demonstrations.text_of(about), file)
    if found != wanted:
        raise SettingsError(
            f"{folder} holds other demonstrations ({_difference(found, wanted)}); choose another folder, or "
            "give the same options to go on"
        )


def _difference(found: About, wanted: About) -> str:
    """The first difference between two descriptions."""
    ones, others = dataclasses.asdict(found), dataclasses.asdict(wanted)
    for made in (ones, others):
        # The settings, compared by name below, give clearer messages.
        del made["options"], made["camera"]
        made.update(made.pop("made_with"))
        made.update(made.pop("settings", {}))
        made.update({f"sha256 of the {name}": sum for name, sum in made.pop("sha256", {}).items()})
    for name, value in others.items():
        if ones.get(name) != value:
            return f"{name}: found {ones.get(name)}, expected {value}"
    return "made with something more"


def make_parts(folder: pathlib.Path, parts: list[list[int]], homes: Homes, expert: Expert, seed: int,
               progress: ProgressLine) -> None:  # fmt: skip
    """Plays and writes the parts that are missing."""
    begun, evaluator = time.monotonic(), Evaluator(homes, expert)
    missing = [
        (number, episodes)
        for number, episodes in enumerate(parts)
        if not os.path.lexists(demonstrations.part_folder(folder, number))
    ]
    endings = Demonstrations(folder).endings
    solved, played = int((endings == galactic.EpisodeEnd.SUCCESS).sum()), len(endings)
    for count, (number, episodes) in enumerate(missing):
        # The noise of a part must not depend on which parts were made before it.
        homes.restart(int(hashed(seed, np.array(number), np.array(0), 1)[0] >> np.uint64(32)))
        recorder = Recorder(expert, homes)
        results = evaluator.play(episodes, details=False, observer=recorder)
        write_part(demonstrations.part_folder(folder, number), recorder.demonstrations(results))
        played += len(results)
        solved += sum(result.success for result in results)
        spent = time.monotonic() - begun
        left = spent / (count + 1) * (len(missing) - count - 1)
        progress.show(
            f"{len(parts) - len(missing) + count + 1} of {len(parts)} parts  "
            f"{100.0 * solved / played:.1f} % solved  {duration(left)} left"
        )


def acting(file: pathlib.Path, homes: Homes, settings: Settings, deterministic: bool,
           device: torch.device) -> Actor:  # fmt: skip
    """The policy in a file, ready to act in these homes, on this device."""
    own = own_networks.own_network(settings.network) if settings.has_own_network else None
    saved = checkpoint.load_policy(file, network=own)
    _require_sight(saved, file, settings)
    observed = Observed(homes.parts, homes.meanings, homes.motions)
    columns = columns_of(saved, file, observed, "take another policy")
    return Actor(
        saved.policy.to(device),
        deterministic=deterministic,
        seed=settings.seed,
        device=device,
        columns=columns,
    )


def _require_sight(saved: SavedPolicy, file: pathlib.Path, settings: Settings) -> None:
    """Raises CheckpointError if a policy that sees images would see different ones here."""
    needed = saved.settings.sight
    if set(needed) - set(settings.sight):
        seeing = f" --sees {saved.settings.sees}" if saved.settings.has_own_network else ""
        raise CheckpointError(
            f"{file} sees images ({', '.join(needed)}), which the network {settings.network} does not; give "
            f"--network {saved.settings.network}{seeing}, or take another policy"
        )
    for name in dict.fromkeys(CAMERA.values()) if needed else ():
        found, wanted = getattr(settings, name), getattr(saved.settings, name)
        if found != wanted and name not in CAMERA_NOISE:
            raise CheckpointError(
                f"{file} learned with {option_name(name)} {typed(wanted)}, found {typed(found)} here; give both "
                "the same, or take another policy"
            )
