"""Files that appear completely or not at all, and folders into which only one process writes."""

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
    """Raises galactic.Error if write_atomically() could not write `file`, which stays as it is.
    Call this for the outputs of long work before the work begins."""
    try:
        if file.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        temporary = _temporary(file)
        temporary.touch()
        temporary.unlink()
    except OSError as error:
        raise unwritable(file, error) from None


def unwritable(file: pathlib.Path, error: OSError) -> Error:
    """The error for a file that could not be written atomically."""
    why = error.strerror or str(error)
    message = f"cannot write the file: {why}; an existing file is left as it was"
    return Error(ErrorCode.IO, str(file), message)


def require_apart(
    outputs: Mapping[str, pathlib.Path | None], inputs: Iterable[pathlib.Path]
) -> None:
    """Raises galactic.Error if an output would replace one of the inputs or another output.
    `outputs`: files by the options that name them; None if there is no such file."""
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
    """Raises galactic.Error if a run could not write its files in `folder`. Leaves the disk as it
    is. Call this before there is work that would be lost."""
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
    """A context for writing into the folder of a run, which must exist. Raises galactic.Error if
    another process is writing into it. The lock ends with its process, however that ends; its file
    stays, and means nothing. Yields whether there is a lock: on a disk without locks, no process is
    refused, and none knows about others.
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
            # The second is reported by file systems that use POSIX range locks, such as NFS.
            if error.errno in (errno.EWOULDBLOCK, errno.EACCES):
                message = (
                    "a run is under way in this folder; wait for its end, interrupt it, or give "
                    "another -o"
                )
                raise Error(ErrorCode.IO, str(folder), message) from None
            is_locked = False
        yield is_locked


def write_atomically(file: pathlib.Path, write: Callable[[Any], object], mode: str = "wb") -> None:
    """Calls write(handle) on a temporary file that then takes the name `file`. Readers, even after
    a crash, find either the old contents or the new ones."""
    encoding = None if "b" in mode else "utf-8"
    with replacing(file) as temporary, open(temporary, mode, encoding=encoding) as handle:
        write(handle)


@contextlib.contextmanager
def replacing(file: pathlib.Path) -> Iterator[pathlib.Path]:
    """Yields a path beside `file`, with the same extension. After the block has written to that
    path, the new file takes the name `file`. For programs that write files by themselves; see
    write_atomically()."""
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
    """Flushes a file, or the names in a folder, to the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
