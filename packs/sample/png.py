"""Write and read 8-bit RGB PNG files with the standard library only."""

import struct
import zlib

_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def _chunk(kind, payload):
    body = kind + payload
    return struct.pack(">I", len(payload)) + body + struct.pack(">I", zlib.crc32(body))


def encode(width, height, rgb):
    """Return the PNG file of `rgb`, `width * height * 3` bytes, rows from the top."""
    if len(rgb) != width * height * 3:
        raise ValueError(f"expected {width * height * 3} bytes of RGB, got {len(rgb)}")
    stride = width * 3
    # Filter 0 on every row: the textures use few distinct colors, so plain
    # repeats compress better than differences.
    rows = b"".join(b"\0" + rgb[y * stride:(y + 1) * stride] for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (_SIGNATURE + _chunk(b"IHDR", header)
            + _chunk(b"IDAT", zlib.compress(rows, 9)) + _chunk(b"IEND", b""))


def _paeth(left, up, corner):
    estimate = left + up - corner
    by_left, by_up, by_corner = (abs(estimate - v) for v in (left, up, corner))
    if by_left <= by_up and by_left <= by_corner:
        return left
    return up if by_up <= by_corner else corner


def _unfilter(kind, row, previous, pixel_bytes):
    for i, value in enumerate(row):
        left = row[i - pixel_bytes] if i >= pixel_bytes else 0
        corner = previous[i - pixel_bytes] if i >= pixel_bytes else 0
        guess = (0, left, previous[i], (left + previous[i]) // 2,
                 _paeth(left, previous[i], corner))[kind]
        row[i] = (value + guess) & 255
    return row


def decode(data):
    """Return (width, height, rgb bytes) of an 8-bit RGB PNG without interlacing."""
    if data[:8] != _SIGNATURE:
        raise ValueError("not a PNG file")
    position, packed, shape = 8, b"", None
    while position < len(data):
        length, = struct.unpack_from(">I", data, position)
        kind = data[position + 4:position + 8]
        payload = data[position + 8:position + 8 + length]
        crc, = struct.unpack_from(">I", data, position + 8 + length)
        if crc != zlib.crc32(kind + payload):
            raise ValueError(f"bad checksum in the {kind!r} chunk")
        if kind == b"IHDR":
            shape = struct.unpack(">IIBBBBB", payload)
        elif kind == b"IDAT":
            packed += payload
        position += 12 + length
    width, height, depth, color, _, _, interlace = shape
    if (depth, color, interlace) != (8, 2, 0):
        raise ValueError("expected 8-bit RGB without interlacing")
    raw, stride = zlib.decompress(packed), width * 3
    rows, previous = [], bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        previous = _unfilter(raw[start], bytearray(raw[start + 1:start + 1 + stride]),
                             previous, 3)
        rows.append(bytes(previous))
    return width, height, b"".join(rows)
