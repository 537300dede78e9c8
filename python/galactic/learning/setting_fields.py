"""What defines a setting: its default, range, explanation and possible values, and how values are
typed."""

from __future__ import annotations

import dataclasses
import numbers
import re
from collections.abc import Sequence
from typing import Any

from galactic.learning.refusals import SettingsError
from galactic.learning.setting_scopes import Scope

# A number, or a range from which each episode draws one.
Drawn = float | tuple[float, float]

# The limits of settings that define none of their own.
MOST_WHOLE = 2**53
MOST_NUMBER = 1e9


def setting(default: Any, group: str, text: str, *, low: float | None = None,
            high: float | None = None, choices: Sequence[str] = (),
            may_change: bool = False, may_be_own: bool = False, may_be_range: bool = False,
            scope: Scope | None = None, is_of_acting: bool = False) -> Any:  # fmt: skip
    """A field of Settings. `may_change`: a resumed run may change the value. `may_be_own`: besides
    the choices, the value can name the user's own code (own_code.named()). `may_be_range`: the
    value is a Drawn. `scope`: when the setting has an effect; None: always. `is_of_acting`: the
    setting has no effect in a run that imitates demonstrations."""
    if high is None and isinstance(default, (int, float)) and not isinstance(default, bool):
        high = MOST_WHOLE if isinstance(default, int) else MOST_NUMBER
    return dataclasses.field(
        default=default,
        metadata={
            "group": group,
            "text": text,
            "low": low,
            "high": high,
            "choices": tuple(choices),
            "may_change": may_change,
            "may_be_own": may_be_own,
            "may_be_range": may_be_range,
            "scope": scope,
            "is_of_acting": is_of_acting,
        },
    )


_KINDS = {
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    str: "text",
    tuple: "three numbers",
}


def _is_a(value: Any, kind: type) -> bool:
    """Whether a value, which may come from a file, has a setting's type. A whole number counts as a
    number."""
    if isinstance(value, bool) or kind in (bool, str):
        return isinstance(value, kind)
    if kind is tuple:
        return isinstance(value, tuple) and len(value) == 3 and all(_is_a(v, float) for v in value)
    return isinstance(value, numbers.Integral if kind is int else numbers.Real)


def require_valid(field: dataclasses.Field[Any], value: Any) -> None:
    """Raises SettingsError for a value that a setting cannot have."""
    low, high = field.metadata["low"], field.metadata["high"]
    choices = field.metadata["choices"]
    kind = type(field.default)
    if field.metadata["may_be_range"] and isinstance(value, tuple):
        _require_range(field.name, value, low, high)
        return
    if not _is_a(value, kind):
        raise SettingsError(f"{field.name}: found {value!r}, expected {_KINDS[kind]}")
    may_be_own = field.metadata["may_be_own"]
    if choices and value not in choices and not (may_be_own and ":" in value):
        own = ", or FILE.py:CLASS or MODULE:CLASS" if may_be_own else ""
        raise SettingsError(f'{field.name} is "{value}"; it can be {", ".join(choices)}{own}')
    if low is None or high is None:
        return
    for number in value if kind is tuple else (value,):
        # A comparison with NaN is false.
        if not low <= number <= high:
            is_whole = isinstance(field.default, int)
            wanted = f"from {low} to {high}" if is_whole else f"from {low:g} to {high:g}"
            raise SettingsError(f"{field.name}: found {number}, expected a number {wanted}")


def _require_range(name: str, value: tuple[Any, ...], low: float, high: float) -> None:
    are_numbers = len(value) == 2 and all(_is_a(end, float) for end in value)
    # A comparison with NaN is false.
    if not are_numbers or not low <= value[0] <= value[1] <= high:
        raise SettingsError(
            f"{name}: found {value!r}, expected a number from {low:g} to {high:g}, or a range within, its "
            "lower end first"
        )


def option_name(name: str) -> str:
    """The name of a setting on the command line."""
    return "--" + name.replace("_", "-")


def typed(value: Any) -> Any:
    """The value of a setting as one types it: three numbers separated by commas, a range with a "-"
    between its ends, anything else unchanged."""
    if not isinstance(value, tuple):
        return value
    return ("-" if len(value) == 2 else ",").join(f"{number:.9g}" for number in value)


def ends_of(text: str) -> list[str]:
    """Both ends of a typed range, or else the whole text. A "-" after a digit or a point separates
    the ends."""
    return re.split(r"(?<=[0-9.])-", text)
