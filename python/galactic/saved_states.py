"""States of a VectorEnv as bytes: of all its envs, or of some, which can be restored to any others.

A batch has one part, or two parts: its halves. A state is a header (_HEADER), a list of arrays as
JSON, [[name, type, shape], ...] with types as numpy describes them in its files, and then the
arrays, little-endian, one after the other. A state of all envs has what BatchPart.save_state()
returns, with the number of the part appended to each name. A state of some envs has

    envs                       their number: n
    simulator_0, simulator_1   states of the envs that were in each part's simulator, if any
    places_0, places_1         int64: which of the n envs these are
    returns, lengths, task_... arrays (n, ...): BatchPart.save_rows()
"""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from galactic._core import ErrorCode
from galactic.errors import Error
from galactic.batch_part import BatchPart, Piece

Array = NDArray[Any]

_MAGIC = b"GALENVS1"
#: _MAGIC, the CRC-32 of everything after the header, and the number of bytes of the list of arrays.
_HEADER = struct.Struct("<8sII")


def state_of_all(parts: Sequence[BatchPart]) -> bytes:
    return _packed(
        {
            f"{name}_{number}": array
            for number, part in enumerate(parts)
            for name, array in part.save_state().items()
        }
    )


def state_of(parts: Sequence[BatchPart], envs: NDArray[np.int64]) -> bytes:
    """The state of the envs with these numbers, in this order."""
    arrays: dict[str, Array] = {"envs": np.array(len(envs))}
    order, owned = [], []
    for number, (part, places, rows) in enumerate(_by_part(parts, envs)):
        simulator, own = part.save_rows(rows)
        order.append(places)
        owned.append(own)
        if len(rows):
            arrays[f"simulator_{number}"] = np.frombuffer(simulator, np.uint8)
            arrays[f"places_{number}"] = places
    back = np.argsort(np.concatenate(order))
    joined = {name: np.concatenate([one[name] for one in owned])[back] for name in owned[0]}
    return _packed({**arrays, **joined})


def restore(parts: Sequence[BatchPart], state: bytes, envs: NDArray[np.int64] | None) -> None:
    """Restores a state to all envs, or to those with these numbers. Raises Error and changes
    nothing if the state does not fit."""
    found = _unpacked(state)
    count = sum(part.simulator.num_envs for part in parts)
    if "envs" in found:
        _restore_some(parts, found, np.arange(count) if envs is None else envs)
    elif envs is None:
        _restore_all(parts, found)
    else:
        raise _refused("is of all envs; leave out envs, or give what save_state(envs=...) returned")


def _restore_all(parts: Sequence[BatchPart], found: Mapping[str, Array]) -> None:
    there = sum(name.startswith("simulator_") for name in found)
    if there != len(parts):
        raise _refused(
            f"halves: found {there}, expected {len(parts)}; restore it in an env of as many"
        )
    count = sum(part.simulator.num_envs for part in parts)
    sizes = [array.size for name, array in found.items() if name.startswith("returns_")]
    if sizes == len(parts) * sizes[:1] and 0 < sum(sizes) != count:
        raise _refused(
            f"is of {sum(sizes)} envs, expected {count}; restore it in an env of as many"
        )
    arrays = [
        {name[: -len(end)]: array for name, array in found.items() if name.endswith(end)}
        for end in (f"_{part}" for part in range(len(parts)))
    ]
    # A part that was cut off has no state to go back to.
    before = [None if part.is_cut_off else part.save_state() for part in parts]
    try:
        for part, saved in zip(parts, arrays):
            part.restore_state(saved)
    except BaseException:
        _put_back(parts, before)
        raise


def _restore_some(
    parts: Sequence[BatchPart], found: Mapping[str, Array], envs: NDArray[np.int64]
) -> None:
    pieces, own = _pieces_of(found)
    count = sum(len(piece.places) for piece in pieces)
    if count not in (1, len(envs)):
        raise _refused(f"has {count} envs, expected {len(envs)}, or one that becomes all of them")
    of_saved = np.zeros(len(envs), np.int64) if count == 1 else np.arange(count)
    works: list[_Work] = []
    for part in parts:
        part.require_whole()
    for part, places, rows in _by_part(parts, envs):
        saved = {name: array[of_saved[places]] for name, array in own.items()}
        part.check_rows(saved, rows)
        if len(rows):
            row_of = dict(zip(places.tolist(), rows.tolist()))
            taken = [
                Piece(piece.state, rows.tolist())
                if count == 1
                else Piece(piece.state, [row_of.get(place) for place in piece.places])
                for piece in pieces
            ]
            taken = [piece for piece in taken if any(row is not None for row in piece.places)]
            works.append(_Work(part, taken, saved, rows))
    # What one part accepts, all accept: with a single piece, nothing is refused after something has
    # been changed.
    before = [work.part.save_state() for work in works] if len(pieces) > 1 else []
    try:
        for part, taken, saved, rows in works:
            part.restore_rows(taken, saved, rows)
    except BaseException:
        _put_back([work.part for work in works], before)
        raise


class _Work(NamedTuple):
    """What is restored to the envs `rows` of one part."""

    part: BatchPart
    pieces: list[Piece]
    saved: dict[str, Array]
    rows: NDArray[np.int64]


def _by_part(
    parts: Sequence[BatchPart], envs: NDArray[np.int64]
) -> list[tuple[BatchPart, NDArray[np.int64], NDArray[np.int64]]]:
    """Each part, with the places in `envs` of those that are in it, and their numbers within the
    part."""
    size = parts[0].simulator.num_envs
    found = []
    for number, part in enumerate(parts):
        places = np.flatnonzero(envs // size == number)
        found.append((part, places, envs[places] - number * size))
    return found


def _pieces_of(found: Mapping[str, Array]) -> tuple[list[Piece], dict[str, Array]]:
    """The states of simulators with the places of their envs, and the other arrays, whose first
    axis is as long as there are envs."""
    pieces = [
        Piece(found[f"simulator_{number}"].tobytes(), found[f"places_{number}"].tolist())
        for number in range(2)
        if f"simulator_{number}" in found and f"places_{number}" in found
    ]
    of_pieces = ("envs", "simulator_", "places_")
    own = {name: array for name, array in found.items() if not name.startswith(of_pieces)}
    places = [place for piece in pieces for place in piece.places]
    count = len(places)
    if (
        not _is_number(found["envs"], count)
        # Exactly as many, so that a state cannot claim more envs than it holds.
        or set(map(str, places)) != set(map(str, range(count)))
        or any(array.shape[:1] != (count,) for array in own.values())
    ):
        raise _refused("does not have as many envs as it says; give what save_state() returned")
    return pieces, own


def _is_number(array: Array, number: int) -> bool:
    return array.ndim == 0 and array.dtype.kind in "iu" and int(array) == number


def _put_back(parts: Sequence[BatchPart], before: Sequence[dict[str, Array] | None]) -> None:
    for part, kept in zip(parts, before):
        part.is_cut_off = True
        if kept is not None:
            part.restore_state(kept)


def _packed(arrays: Mapping[str, Array]) -> bytes:
    kept = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
    listed = [
        (name, np.lib.format.dtype_to_descr(array.dtype), np.shape(arrays[name]))
        for name, array in kept.items()
    ]
    text = json.dumps(listed).encode()
    body = b"".join([text, *(array.tobytes() for array in kept.values())])
    return _HEADER.pack(_MAGIC, zlib.crc32(body), len(text)) + body


def _unpacked(state: bytes) -> dict[str, Array]:
    """The state's arrays, read-only. Raises Error if the bytes are not exactly a state."""
    found = bytes(memoryview(state))
    if len(found) < _HEADER.size or not found.startswith(_MAGIC):
        raise _refused(
            f"found {len(found)} bytes that do not begin as a state does; give what save_state() returned"
        )
    _, checksum, length = _HEADER.unpack_from(found)
    if zlib.crc32(memoryview(found)[_HEADER.size :]) != checksum:
        raise _refused("does not have the checksum that it states; it is damaged")
    at = _HEADER.size + length
    arrays: dict[str, Array] = {}
    try:
        for name, described, shape in json.loads(found[_HEADER.size : at]):
            kind = _type_of(described)
            # Bytes of Python objects would be addresses, and a size of -1 would take whatever is
            # left.
            if kind.hasobject or min(shape, default=0) < 0:
                raise ValueError(f"found {name} as {kind} {shape}, expected numbers in a shape")
            arrays[name] = np.ndarray(shape, kind, found, at)
            at += arrays[name].nbytes
    except Exception as problem:  # whatever is wrong with content whose checksum is right
        raise _refused(f"cannot be read ({problem}); give what save_state() returned") from problem
    if at != len(found):
        raise _refused(f"found {len(found)} bytes, expected {at}; it is damaged")
    return arrays


def _type_of(described: Any) -> np.dtype[Any]:
    """The type that dtype_to_descr() described; its tuples have become lists."""
    if isinstance(described, str):
        return np.dtype(described)
    return np.dtype([(name, _type_of(of), *map(tuple, shape)) for name, of, *shape in described])


def _refused(message: str) -> Error:
    return Error(ErrorCode.INVALID_INPUT, "saved state", message)
