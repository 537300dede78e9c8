"""What older versions wrote, in today's form: called where files are read, so that nobody else knows of it. What is
no such thing passes as it is, for its reader to refuse."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, Mapping

import torch
from torch import Tensor

from galactic.demonstrations import About
from galactic.learning.policies.networks import PolicyShape
from galactic.learning.rollouts.episode_sums import LOG, MEASURE
from galactic.learning.settings import CAMERA, Settings


def settings_values(values: Any) -> Any:
    """Settings.to_dict(). What runs did before there were these settings they go on with, whatever the defaults
    are; of all others they take the defaults."""
    return _filled({"timeouts": "observed"}, values)


def demonstrations_about(about: About) -> About:
    """What a folder of demonstrations says of itself: of settings that there were not, it was made with the
    defaults."""
    known = {field.name: field.default for field in dataclasses.fields(Settings)}
    of_camera = {name: known[name] for name in CAMERA.values()}
    made_with = {**about.made_with, "settings": {**of_camera, **about.made_with["settings"]}}
    return dataclasses.replace(about, made_with=made_with)


def policy_values(values: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a policy.pt."""
    values = {"meanings": {}, "network_digest": "", "return": None, **values}
    if "settings" in values:
        values["settings"] = settings_values(values["settings"])
    if "shape" in values:
        values["shape"] = _filled(PolicyShape._field_defaults, values["shape"])
    return values


def trainer_values(values: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a trainer.pt, which once did not know who waits for an episode's end, nor of a paced rate, of
    processor time, of what a task or a callback says, of what a signal has put off, or of picks, and had the rows of the
    curves, which curves.csv has, too."""
    values = {
        "waiting": 0,
        "rate_share": 1.0,
        "processor_seconds": 0.0,
        "measures": [],
        "logs": [],
        "must_validate": False,
        "must_end": False,
        "added_columns": [],
        "added": {},
        **values,
    }
    if isinstance(values.get("rows"), list):
        values["row_count"] = len(values["rows"])
    measures, logs, window = values["measures"], values["logs"], values.get("window")
    if _are_names(measures) and _are_names(logs) and isinstance(window, list):
        own = [MEASURE + name for name in measures]
        own += ["steps", *(LOG + name for name in logs)] if logs else []
        values["window"] = [_by_name(row, own) for row in window]
    return values


def _by_name(row: Any, own: list[str]) -> Any:
    """A row of the window, which was a list once: of these, and of the task's `own`. Nobody counted at first in which
    episodes the target was picked: of those it is not known."""
    names = ["episodes", "successes", "picks", "returns", "lengths", *own]
    if isinstance(row, list) and len(row) == len(names) - 1:
        row = [*row[:2], math.nan, *row[2:]]
    is_old = isinstance(row, list) and len(row) == len(names)
    return {"steps": 0.0, **dict(zip(names, row))} if is_old else row


def _are_names(values: Any) -> bool:
    return isinstance(values, list) and all(isinstance(one, str) for one in values)


def rank_tensors(tensors: Mapping[str, Any]) -> dict[str, Any]:
    """The tensors of a rank-N.pt, which once did not know which envs wait for an episode's end: their first
    episodes are long over."""
    starts = tensors.get("starts")
    if "waits" in tensors or not isinstance(starts, Tensor):
        return dict(tensors)
    return {"waits": torch.zeros_like(starts, dtype=torch.bool), **tensors}


def run_values(values: Any) -> Any:
    """A run's settings.json."""
    blank = dict.fromkeys(("start_from", "teacher", "task_file", "network_file"))
    values = _filled({**blank, "demonstrations": []}, values)
    if isinstance(values, dict) and "settings" in values:
        values["settings"] = settings_values(values["settings"])
    return values


def report_values(values: Any) -> Any:
    """A run's report.json, which once did not know of what a signal has put off."""
    return _filled({"must_validate": False}, values)


def _filled(before: Mapping[str, Any], values: Any) -> Any:
    """What is missing is as it was `before`."""
    return {**before, **values} if isinstance(values, dict) else values
