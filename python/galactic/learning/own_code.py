"""Code of one's own, by what the command line calls it: `reach.py:Reach`, or `lab.tasks:Reach`."""

from __future__ import annotations

import contextlib
import hashlib
import importlib
import importlib.util
import os
import pathlib
import sys
from collections.abc import Iterator
from typing import Any, NamedTuple, Optional

from galactic.learning.settings import SettingsError


class CodeName(NamedTuple):
    """A class or a function, the file or the module that it is in, and the option that named it."""

    place: str
    name: str
    option: str

    @property
    def file(self) -> Optional[pathlib.Path]:
        """The file; None for a module."""
        return pathlib.Path(self.place) if self.place.endswith(".py") else None

    def __str__(self) -> str:
        """What can be read again, without the folder of a file: runs are moved, files are copied."""
        return f"{self.file.name if self.file else self.place}:{self.name}"


def named(text: str, option: str) -> CodeName:
    """Of `FILE.py:NAME` or `MODULE:NAME`. Raises SettingsError for another text."""
    place, colon, name = text.rpartition(":")
    is_module = all(part.isidentifier() for part in place.split("."))
    if not colon or not name.isidentifier() or not (place.endswith(".py") or is_module):
        raise SettingsError(f'{option}: found "{text}", expected FILE.py:NAME or MODULE:NAME')
    return CodeName(place, name, option)


def members_of(code: CodeName, siblings: Optional[pathlib.Path] = None) -> dict[str, Any]:
    """What the file or module has by name. It runs now; what it raises is the caller's, unless it ends the
    program. `siblings`: where modules are that a file imports, if not beside it."""
    with goes_on(
        code, 'when it was imported; put what a program does behind: if __name__ == "__main__"'
    ):
        return vars(_module_of(code, siblings))


@contextlib.contextmanager
def goes_on(code: CodeName, when: str) -> Iterator[None]:
    """Around code that has no say in whether the program ends. Raises SettingsError where it ends it."""
    try:
        yield
    except SystemExit as end:
        raise SettingsError(f"{code.option}: {code} ended the program {when}") from end


def _module_of(code: CodeName, siblings: Optional[pathlib.Path]) -> Any:
    if code.file is None:
        try:
            return importlib.import_module(code.place)
        except ModuleNotFoundError as error:
            if error.name not in _with_parents(code.place):
                raise  # of what the module imports
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
        return sys.modules[name]  # another one would have other classes, which pickle refuses
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
    """Another one for each file, and for what it says now; none that anything else could be imported by."""
    digest = hashlib.sha256(os.fsencode(file.resolve()) + b"\0" + file.read_bytes()).hexdigest()
    return f"galactic_own_{file.stem}_{digest[:16]}"


def _with_parents(module: str) -> list[str]:
    """a, a.b and a.b.c of a.b.c."""
    parts = module.split(".")
    return [".".join(parts[: count + 1]) for count in range(len(parts))]
