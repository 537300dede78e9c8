"""Settings as command-line options, and as the tables of docs/learning.md."""

from __future__ import annotations

import argparse
import dataclasses
import math
import re
import shlex
from collections.abc import Collection, Mapping
from typing import Any

from galactic.learning.refusals import SettingsError
from galactic.learning.setting_fields import MOST_WHOLE, Drawn, ends_of, option_name, typed
from galactic.learning.settings import Settings
from galactic.learning.simulation_words import latest_words


def add_options(parser: argparse.ArgumentParser, names: Collection[str] | None = None) -> None:
    """Adds an option for each setting, or for those in `names`. The options have no default: a
    setting that is not given keeps the preset's value."""
    groups: dict[str, Any] = {}
    for field in dataclasses.fields(Settings):
        if names is not None and field.name not in names:
            continue
        title = field.metadata["group"]
        group = groups.setdefault(title, parser.add_argument_group(title))
        keywords: dict[str, Any] = {"default": argparse.SUPPRESS, "dest": "setting_" + field.name}
        default = "" if field.default == "" else f" ({typed(field.default)})"
        keywords["help"] = (field.metadata["text"] + default).replace("%", "%%")
        if isinstance(field.default, bool):
            keywords["action"] = argparse.BooleanOptionalAction
        else:
            readers = {int: _integer, float: _real, str: str, tuple: _three}
            is_drawn = field.metadata["may_be_range"]
            keywords["type"] = _drawn if is_drawn else readers[type(field.default)]
            plain = "N,N,N" if isinstance(field.default, tuple) else field.name.upper()
            name = "N|LOW-HIGH" if is_drawn else plain
            own = ("FILE.py:CLASS", "MODULE:CLASS") if field.metadata["may_be_own"] else ()
            keywords["metavar"] = "|".join((*field.metadata["choices"], *own)) or name
        group.add_argument(option_name(field.name), **keywords)


def given_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The settings that the command line gives."""
    prefix = "setting_"
    return {
        name[len(prefix) :]: value
        for name, value in vars(arguments).items()
        if name.startswith(prefix)
    }


def overriding(before: Settings, given: Mapping[str, Any]) -> dict[str, Any]:
    """The changes that `given` makes to the settings `before`. Options of the simulation that
    `given` does not name stay as they are."""
    if "simulation" not in given:
        return dict(given)
    return {**given, "simulation": latest_words(f"{before.simulation} {given['simulation']}")}


def resumed(before: Settings, given: Mapping[str, Any]) -> Settings:
    """The settings of a resumed run. Rejects changes that would make it a different run."""
    given = overriding(before, given)
    fields = {field.name: field for field in dataclasses.fields(Settings)}
    for name, value in given.items():
        old = getattr(before, name)
        if value != old and not fields[name].metadata["may_change"]:
            raise SettingsError(
                f"the run began with {option_name(name)} {_shown(old)}, and cannot continue with "
                f"{typed(value)}; "
                "begin a new one"
            )
    return dataclasses.replace(before, **given)


def _shown(value: Any) -> Any:
    """Like typed(), but readable within a sentence."""
    return "(nothing)" if value == "" else typed(value)


def option_lines(settings: Settings) -> str:
    """The settings as one types them, one option per line, in their groups. A comment after each
    changed option gives its default. Empty settings are left out."""
    lines: list[str] = []
    group = ""
    for field in dataclasses.fields(Settings):
        value = getattr(settings, field.name)
        if field.metadata["group"] != group:
            group = field.metadata["group"]
            lines += [*([""] if lines else []), f"# {group}"]
        option = option_name(field.name)
        if isinstance(value, bool):
            line = option if value else f"--no-{option[2:]}"
        else:
            line = f"{option} {shlex.quote(str(typed(value)))}"
        if value != field.default:
            line += (
                f"  # default: {typed(field.default)}"
                if field.default != ""
                else "  # default: nothing"
            )
        lines += [line] if value != "" else []
    return "\n".join(lines) + "\n"


def positive_integer(text: str) -> int:
    """The type of an option that takes a number of steps, as `--steps` does."""
    value = _integer(text)
    if not 1 <= value <= MOST_WHOLE:
        raise argparse.ArgumentTypeError(f'found "{text}", expected 1 to {MOST_WHOLE}')
    return value


def _integer(text: str) -> int:
    """A whole number; accepts 2e6 and 2_000_000, too."""
    if re.fullmatch(r"-?[0-9]+(_[0-9]+)*", text):
        return int(text)
    value = _real(text, "a whole number")
    if value != int(value):
        raise argparse.ArgumentTypeError(f'found "{text}", expected a whole number')
    return int(value)


def _real(text: str, wanted: str = "a number") -> float:
    """A finite number, without spaces around it."""
    if re.fullmatch(r"[-+0-9._eE]+", text):
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if math.isfinite(value):
            return value
    raise argparse.ArgumentTypeError(f'found "{text}", expected {wanted}')


def _three(text: str) -> tuple[float, ...]:
    """Three numbers separated by commas."""
    wanted = "three numbers with commas between, such as 0.1,0,-0.2"
    parts = text.split(",")
    if len(parts) != 3:
        raise argparse.ArgumentTypeError(f'found "{text}", expected {wanted}')
    return tuple(_real(part, wanted) for part in parts)


def _drawn(text: str) -> Drawn:
    """A number, or the two ends of a range."""
    wanted = "a number, or a range such as 0.1-0.3"
    ends = [_real(end, wanted) for end in ends_of(text)]
    if len(ends) > 2:
        raise argparse.ArgumentTypeError(f'found "{text}", expected {wanted}')
    return ends[0] if len(ends) == 1 else (ends[0], ends[1])


def markdown_tables() -> str:
    """The tables of docs/learning.md."""
    lines: list[str] = []
    group = ""
    for field in dataclasses.fields(Settings):
        if field.metadata["group"] != group:
            group = field.metadata["group"]
            lines += [*([""] if lines else []), f"**{group}**", ""]
            lines += ["| option | default | what |", "|---|---|---|"]
        default = f"`{typed(field.default)}`" if field.default != "" else ""
        lines.append(f"| `{option_name(field.name)}` | {default} | {field.metadata['text']} |")
    return "\n".join(lines) + "\n"
