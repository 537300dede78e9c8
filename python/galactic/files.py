"""Files that appear whole or not at all, and folders that one process writes into."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import pathlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from galactic._core import ErrorCode
from galactic.errors import Error


def require_writable(file: pathlib.Path) -> None:
    """Raises galactic.Error where write_atomically() could not write `file`, and leaves it as it is:
    for outputs of long work, before it."""
    try:
        if file.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        temporary = _temporary(file)
        temporary.touch()
        temporary.unlink()
    except OSError as error:
        raise unwritable(file, error) from None


def unwritable(file: pathlib.Path, error: OSError) -> Error:
    """What there is to say where a file that is written atomically could not be."""
    why = error.strerror or str(error)
    message = f"cannot write the file: {why}; an existing file is left as it was"
    return Error(ErrorCode.IO, str(file), message)


def require_apart(
    outputs: Mapping[str, pathlib.Path | None], inputs: Iterable[pathlib.Path]
) -> None:
    """Raises galactic.Error where an output, by the option that names it, would replace one of the
    inputs or another output. None: there is no such file."""
    written: dict[pathlib.Path, str] = {}
    read = {file.resolve() for file in inputs}
    for option, file in outputs.items():
        if file is None:
            continue
        place = file.resolve()
        message = ""
        if place in read:
            message = "is also an input; write to another file"
        elif place in written:
            message = f"would be written twice: by {written[place]} and by {option}; give each its own name"
        if message:
            raise Error(ErrorCode.INVALID_INPUT, str(file), message)
        written[place] = option


def require_folder(folder: pathlib.Path) -> None:
    """Raises galactic.Error where a run could not keep its files in `folder`, and leaves the disk as it
    is: before there is work that would be lost."""
    remedy = "give another -o"
    missing: list[pathlib.Path] = []
    try:
        missing = [one for one in (folder, *folder.parents) if not one.exists()]
        if not missing and not folder.is_dir():
            message = f"is a file, expected a folder or nothing; {remedy}"
            raise Error(ErrorCode.IO, str(folder), message)
        folder.mkdir(parents=True, exist_ok=True)
        require_writable(folder / "settings.json")
    except OSError as error:
        message = f"cannot make the folder: {error.strerror}; {remedy}"
        raise Error(ErrorCode.IO, str(folder), message) from None
    finally:
        with contextlib.suppress(OSError):
            for one in missing:
                one.rmdir()


@contextlib.contextmanager
def alone_in(folder: pathlib.Path) -> Iterator[bool]:
    """Around writing into the folder of a run, which exists: raises galactic.Error where another process
    does. The lock ends with its process, however that ends; its file stays, and means nothing. Yields
    whether there is a lock: where the disk has none, nobody is refused, and nobody knows of others.
    """
    file = folder / ".lock"
    try:
        handle = open(file, "wb")
    except OSError as error:
        raise unwritable(file, error) from None
    with handle:
        is_locked = True
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            # The second is what disks say that lock by the ranges of POSIX, as NFS does.
            if error.errno in (errno.EWOULDBLOCK, errno.EACCES):
                message = (
                    "a run is under way in this folder; wait for its end, interrupt it, or give "
                    "another -o"
                )
                raise Error(ErrorCode.IO, str(folder), message) from None
            is_locked = False
        yield is_locked


def write_atomically(file: pathlib.Path, write: Callable[[Any], object], mode: str = "wb") -> None:
    """Calls write(handle) on a temporary file that then takes the name `file`: readers, and whoever
    comes after a crash, find the old contents or the new ones."""
    encoding = None if "b" in mode else "utf-8"
    with replacing(file) as temporary, open(temporary, mode, encoding=encoding) as handle:
        write(handle)


@contextlib.contextmanager
def replacing(file: pathlib.Path) -> Iterator[pathlib.Path]:
    """A place beside `file`, of the same extension, for what takes its name when the block has written
    it; for programs that write files by themselves, see write_atomically()."""
    temporary = _temporary(file)
    try:
        yield temporary
        sync(temporary)
        os.replace(temporary, file)
        sync(file.parent)
    except OSError as error:
        raise unwritable(file, error) from None
    finally:
        temporary.unlink(missing_ok=True)


def _temporary(file: pathlib.Path) -> pathlib.Path:
    return file.with_name(f".{os.getpid()}.{file.name}")


def sync(path: pathlib.Path) -> None:
    """Puts a file, or the names in a folder, on the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
