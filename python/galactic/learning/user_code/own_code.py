"""User code, by its name on the command line: `reach.py:Reach`, or `lab.tasks:Reach`."""

from __future__ import annotations

import ast
import contextlib
import hashlib
import importlib
import importlib.util
import inspect
import json
import os
import pathlib
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from galactic.learning.refusals import SettingsError, did_you_mean

RUN = "settings.json"
"""The file that defines a run, in its folder."""
_OWN = "galactic_own_"
"""The prefix of the names of modules that are loaded from the user's files."""
_PLACES = (_OWN, "galactic.task_runner", "galactic.learning.user_code.")
"""Prefixes of the names of modules that are the user's, or that call user code."""
_NAMED: set[str] = set()
"""The names of the user's other modules: those that options have named, or that define what was
named."""
COPIES = {"--task": "task.py", "--network": "network.py"}
"""The names of the copies, beside RUN, of the files that options name."""


class CodeName(NamedTuple):
    """The name of a class or function, the file or module that holds it, and the option that named
    it."""

    place: str
    name: str
    option: str

    @property
    def file(self) -> pathlib.Path | None:
        """The file; None for a module."""
        return pathlib.Path(self.place) if self.place.endswith(".py") else None

    def __str__(self) -> str:
        """A text that named() can read, without the folder of a file: runs are moved, and files are
        copied."""
        return f"{self.file.name if self.file else self.place}:{self.name}"


def named(text: str, option: str) -> CodeName:
    """Parses `FILE.py:NAME` or `MODULE:NAME`. Raises SettingsError for any other text."""
    place, colon, name = text.rpartition(":")
    is_module = all(part.isidentifier() for part in place.split("."))
    if not colon or not name.isidentifier() or not (place.endswith(".py") or is_module):
        raise SettingsError(f'{option}: found "{text}", expected FILE.py:NAME or MODULE:NAME')
    return CodeName(place, name, option)


def members_of(code: CodeName, siblings: pathlib.Path | None = None) -> dict[str, Any]:
    """The members of the file or module, by name. It runs now, and its exceptions reach the caller;
    if it tries to end the program, SettingsError is raised. `siblings`: the folder of the modules
    that a file imports, if they are not beside it."""
    with goes_on(
        code, 'when it was imported; put what a program does behind: if __name__ == "__main__"'
    ):
        return vars(_module_of(code, siblings))


@contextlib.contextmanager
def goes_on(code: CodeName, when: str) -> Iterator[None]:
    """A context for code that must not end the program. Raises SettingsError if it tries."""
    try:
        yield
    except SystemExit as end:
        raise SettingsError(f"{code.option}: {code} ended the program {when}") from end


def has_raised(error: BaseException) -> bool:
    """Whether the error was raised by user code, or by code that calls it and checks what it
    returns."""
    frames = (frame for frame, _ in traceback.walk_tb(error.__traceback__))
    modules = [str(frame.f_globals.get("__name__", "")) for frame in frames]
    return any(module in _NAMED or module.startswith(_PLACES) for module in modules)


def _remember(module: str) -> None:
    """Registers a user module for has_raised(). Modules of galactic, whose classes can be named,
    too, are not registered."""
    if module.partition(".")[0] != "galactic":
        _NAMED.add(module)


def class_of(code: CodeName, base: type, base_name: str, siblings: pathlib.Path | None) -> Any:
    """The class that `code` names. Raises SettingsError unless it inherits from `base`."""
    members = members_of(code, siblings)
    found = members.get(code.name)
    if isinstance(found, type) and issubclass(found, base):
        _remember(found.__module__)
        return found
    if code.name in members:
        raise SettingsError(f"{code.option}: {code} is no class that inherits from {base_name}")
    known = [
        name
        for name, value in members.items()
        if isinstance(value, type) and issubclass(value, base) and value is not base
    ]
    it_has = f"; it has {', '.join(known)}" if known else f"; it has no {base_name}"
    hint = did_you_mean(code.name, known) or it_has
    raise SettingsError(f"{code.option}: {code.place} has no {code.name}{hint}")


def factory_of(code: CodeName, what: str) -> Callable[..., Any]:
    """The function or class that `code` names. It is called with a folder and settings, and must
    return `what`. Its file runs now; exceptions of the file reach the caller."""
    found = members_of(code).get(code.name)
    if not callable(found):
        fault = f"{code.place} has no {code.name}" if found is None else f"{code} is no function"
        raise SettingsError(f"{code.option}: {fault}; name one that takes a folder and settings")
    fault = mismatch(found, ("folder", {}), {})
    if fault:
        raise SettingsError(
            f"{code.option}: {code} cannot be called with a folder and settings: {fault}"
        )
    make: Callable[..., Any] = found

    def product_of(folder: pathlib.Path, settings: Mapping[str, Any]) -> Any:
        with goes_on(code, f"when it was called; return {what}"):
            made = make(folder, settings)
        if not callable(made):
            raise SettingsError(
                f"{code.option}: {code} returned a {type(made).__name__}, expected {what}"
            )
        return made

    return product_of


def mismatch(found: Any, positional: tuple[Any, ...], keywords: Mapping[str, Any]) -> str:
    """Why `found` cannot be called with these arguments; "" if it can, or if it is compiled and has
    no signature."""
    try:
        signature = inspect.signature(found)
    except ValueError:
        return ""
    try:
        signature.bind(*positional, **keywords)
    except TypeError as error:
        return str(error)
    return ""


_WORDS = {"true": "True", "false": "False", "none": "None"}


def keywords_of(options: str, option: str) -> dict[str, Any]:
    """The value of `option` as keyword arguments: "radius=0.2 kind=near dense=false" is {"radius":
    0.2, "kind": "near", "dense": False}. Numbers, lists and other Python literals are converted;
    anything else is text."""
    keywords: dict[str, Any] = {}
    for word in options.split():
        name, equals, value = word.partition("=")
        name = name.lstrip("-").replace("-", "_")
        if not equals or not name.isidentifier():
            raise SettingsError(f'{option}: found "{word}", expected NAME=VALUE')
        try:
            keywords[name] = ast.literal_eval(_WORDS.get(value.lower(), value))
        except (ValueError, SyntaxError, TypeError, MemoryError, RecursionError):
            keywords[name] = value
    return keywords


def copy_beside(policy: pathlib.Path, option: str) -> pathlib.Path | None:
    """The run's copy of the file that `option` named, for a policy in the folder of a run or of one
    of its checkpoints; None if there is none."""
    parents, copy = policy.absolute().parents, COPIES[option]
    for folder in [
        parents[0],
        *(parents[2:3] if parents[1:2] and parents[1].name == "checkpoints" else []),
    ]:
        if (folder / RUN).is_file() and (folder / copy).is_file():
            return folder / copy
    return None


def place_beside(policy: pathlib.Path, option: str, trained: str) -> str:
    """The value to suggest for `option` for a policy that was trained with the class `trained`. The
    policy may be a stranger's, so the name of its class is checked."""
    copy = copy_beside(policy, option)
    _, _, name = trained.rpartition(":")
    return f"{copy}:{name}" if copy and name.isidentifier() else "FILE.py:CLASS"


def siblings_of(code: CodeName) -> pathlib.Path | None:
    """The folder of the modules that a run's copy of a file imports: the folder of the original.
    None if `code` is not such a copy."""
    if code.file is None or code.file.name != COPIES.get(code.option):
        return None
    try:
        run = json.loads((code.file.parent / RUN).read_text(encoding="utf-8"))
        return pathlib.Path(run[f"{code.file.stem}_file"]).parent
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _module_of(code: CodeName, siblings: pathlib.Path | None) -> Any:
    if code.file is None:
        try:
            module = importlib.import_module(code.place)
            _remember(module.__name__)
            return module
        except ModuleNotFoundError as error:
            if error.name not in _with_parents(code.place):
                raise  # a module that this one imports is missing
            raise SettingsError(
                f"{code.option}: there is no module {code.place}; install it, name its folder in PYTHONPATH, or "
                "name a file (FILE.py:NAME)"
            ) from error
    if not code.file.is_file():
        raise SettingsError(
            f"{code.option}: {code.file} is no file; name the one that {code.name} is in"
        )
    folder = str((siblings or code.file.parent).resolve())
    if folder not in sys.path:
        sys.path.append(folder)
    name = _module_name(code.file)
    if name in sys.modules:
        return sys.modules[
            name
        ]  # a second module would have different classes, which pickle rejects
    spec = importlib.util.spec_from_file_location(name, code.file)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def _module_name(file: pathlib.Path) -> str:
    """A module name that is unique to this file and its present contents, and that no import
    statement would use."""
    digest = hashlib.sha256(os.fsencode(file.resolve()) + b"\0" + file.read_bytes()).hexdigest()
    return f"{_OWN}{file.stem}_{digest[:16]}"


def _with_parents(module: str) -> list[str]:
    """a, a.b and a.b.c of a.b.c."""
    parts = module.split(".")
    return [".".join(parts[: count + 1]) for count in range(len(parts))]
