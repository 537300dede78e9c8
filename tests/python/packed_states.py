"""The bytes of a VectorEnv's states, as python/galactic/saved_states.py says what they are."""

import json
import struct
import zlib

import numpy as np

HEADER = struct.Struct("<8sII")


def signed(text: bytes, rest: bytes) -> bytes:
    """What says of itself that it is whole. text: the list of arrays."""
    return HEADER.pack(b"GALENVS1", zlib.crc32(text + rest), len(text)) + text + rest


def packed(arrays: dict[str, np.ndarray]) -> bytes:
    listed = [[name, array.dtype.str, list(array.shape)] for name, array in arrays.items()]
    return signed(json.dumps(listed).encode(), b"".join(map(np.ndarray.tobytes, arrays.values())))


def unpacked(state: bytes) -> dict[str, np.ndarray]:
    magic, checksum, length = HEADER.unpack_from(state)
    assert magic == b"GALENVS1" and checksum == zlib.crc32(state[HEADER.size :])
    rest, arrays = state[HEADER.size + length :], {}
    for name, kind, shape in json.loads(state[HEADER.size : HEADER.size + length]):
        size = np.dtype(kind).itemsize * int(np.prod(shape))
        arrays[name] = np.frombuffer(rest[:size], kind).reshape(shape)
        rest = rest[size:]
    assert not rest
    return arrays
