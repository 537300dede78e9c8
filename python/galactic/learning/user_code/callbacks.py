"""Callbacks: user code that observes how a policy learns, adds to the curves, and may end the
run."""

from __future__ import annotations

import math
import numbers
import pathlib
from collections.abc import Callable, Mapping
from typing import Any

from galactic.learning.policies.networks import Policy
from galactic.learning.refusals import SettingsError
from galactic.learning.user_code import own_code

CALLBACK = "callback_"
"""The prefix of the columns that a callback adds; no other column has it."""
UPDATE, VALIDATION, END = "update", "validation", "end"


class Moment:
    """The state of a run when it calls a callback. `row` has the values of a row of the curves, by
    name; `policy` must not be changed."""

    def __init__(self, kind: str, row: Mapping[str, float], policy: Policy):
        self.kind = kind
        """`update`, `validation`, or `end`, which means that this part of the run is over and
        saved."""
        self.row = dict(row)
        self.policy = policy
        self.added: dict[str, float] = {}
        """The numbers given to log(), by the names of columns."""
        self.reason = ""
        """Why the run is to end; empty if it goes on."""

    def log(self, name: str, value: float) -> None:
        """Adds a number to the next row of the curves, in the column callback_NAME. Raises
        ValueError for an invalid name or value."""
        if not isinstance(name, str) or not name.isidentifier():
            raise ValueError(f"log(): found the name {name!r}, expected letters, digits and _")
        if not isinstance(value, numbers.Real) or math.isnan(value):
            raise ValueError(f"log(): {name} is {value!r}, expected a number")
        self.added[CALLBACK + name] = float(value)

    def stop(self, reason: str) -> None:
        """Ends the run here: it validates and saves as it does after its last step."""
        self.reason = str(reason) or "a callback stopped it"


Callback = Callable[[Moment], object]
"""What a run calls after each update, after each validation, and at the end."""
MakeCallback = Callable[[pathlib.Path, Mapping[str, Any]], Callback]
"""Makes a callback for a run in this folder, with these settings."""


def maker(text: str) -> MakeCallback:
    """The function or class that `text` names (own_code.named()), as a MakeCallback. Its file runs
    now. Exceptions of the file and of the callback reach the caller."""
    code = own_code.named(text, "--callback")
    make = own_code.factory_of(code, "what takes a moment of the run")

    def made(folder: pathlib.Path, settings: Mapping[str, Any]) -> Callback:
        callback = make(folder, settings)
        fault = own_code.mismatch(callback, (None,), {})
        if fault:
            raise SettingsError(
                f"--callback: what {code} returned cannot be called with a moment of the run: {fault}"
            )

        def call(moment: Moment) -> None:
            with own_code.goes_on(code, "when it was called; call stop() of the moment instead"):
                callback(moment)

        return call

    return made
