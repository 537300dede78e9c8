"""Read back a GLB of the writer's kind: used by the landmarks and by the tests."""

import json
import struct

_FORMATS = {5126: ("f", 4), 5123: ("H", 2)}
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


def load(data):
    """Return (document, binary chunk) of the bytes of a GLB file."""
    magic, version, total = struct.unpack_from("<4sII", data, 0)
    if magic != b"glTF" or version != 2 or total != len(data):
        raise ValueError(f"not a whole glTF 2.0 binary: {magic!r}, version {version}, "
                         f"{total} bytes announced, {len(data)} found")
    json_size, json_kind = struct.unpack_from("<I4s", data, 12)
    bin_size, bin_kind = struct.unpack_from("<I4s", data, 20 + json_size)
    if json_kind != b"JSON" or bin_kind != b"BIN\0" or 28 + json_size + bin_size != total:
        raise ValueError("expected one JSON chunk and one BIN chunk, filling the file")
    return json.loads(data[20:20 + json_size]), data[28 + json_size:]


def accessor_rows(document, blob, index):
    """Return the rows of an accessor: tuples, or plain numbers for SCALAR."""
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    letter, size = _FORMATS[accessor["componentType"]]
    width = _COMPONENTS[accessor["type"]]
    stride = view.get("byteStride", size * width)
    start = view["byteOffset"] + accessor["byteOffset"]
    rows = [struct.unpack_from(f"<{width}{letter}", blob, start + i * stride)
            for i in range(accessor["count"])]
    return [r[0] for r in rows] if width == 1 else rows


def _local_matrix(node):
    """Three rows of four: the node's transform into its parent's frame."""
    if "matrix" in node:
        m = node["matrix"]
        return [[m[column * 4 + row] for column in range(4)] for row in range(3)]
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    t, s = node.get("translation", (0, 0, 0)), node.get("scale", (1, 1, 1))
    rotation = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
                (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
                (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    return [[rotation[r][c] * s[c] for c in range(3)] + [t[r]] for r in range(3)]


def _times(a, b):
    rows = []
    for r in range(3):
        row = [a[r][0] * b[0][c] + a[r][1] * b[1][c] + a[r][2] * b[2][c] for c in range(4)]
        row[3] += a[r][3]
        rows.append(row)
    return rows


def apply(matrix, p):
    return tuple(m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3] for m in matrix)


def placed_nodes(document):
    """Yield (node, world_from_node) for every node that draws a mesh, in depth-first order."""
    identity = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]
    stack = [(i, identity) for i in reversed(document["scenes"][document["scene"]]["nodes"])]
    while stack:
        index, parent = stack.pop()
        node = document["nodes"][index]
        world_from_node = _times(parent, _local_matrix(node))
        if "mesh" in node:
            yield node, world_from_node
        stack += [(c, world_from_node) for c in reversed(node.get("children", []))]


def mesh_parts(document, blob, mesh):
    """Yield (material name, positions, triangles) for every closed part of a mesh."""
    for primitive in mesh["primitives"]:
        positions = accessor_rows(document, blob, primitive["attributes"]["POSITION"])
        indices = accessor_rows(document, blob, primitive["indices"])
        triangles = [tuple(indices[i:i + 3]) for i in range(0, len(indices), 3)]
        material = document["materials"][primitive["material"]]["name"]
        start = 0
        for count in primitive["extras"]["part_triangles"]:
            yield material, positions, triangles[start:start + count]
            start += count


def world_parts(document, blob):
    """Return [(node name, [triangle of three world points])], one entry per closed part."""
    result = []
    for node, world_from_node in placed_nodes(document):
        for _, positions, triangles in mesh_parts(document, blob, document["meshes"][node["mesh"]]):
            result.append((node["name"], [tuple(apply(world_from_node, positions[i]) for i in t)
                                          for t in triangles]))
    return result
