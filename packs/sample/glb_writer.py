"""A small scene graph and its binary glTF 2.0 writer.

Every mesh has one primitive per material. A primitive's `extras.part_triangles` lists how many
triangles each of its closed parts has, in index order.
"""

import json
import struct

import shapes
import textures

_FLOAT, _USHORT = 5126, 5123
_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963


class Mesh:
    """A named list of shapes.Part; shared by all nodes that draw it."""

    def __init__(self, name, parts):
        self.name = name
        self.parts = list(parts)


class Node:
    """A node of the scene: translation, rotation (x, y, z, w) and scale, or a matrix."""

    def __init__(self, name, mesh=None, at=None, rotation=None, scale=None, matrix=None):
        self.name, self.mesh, self.children = name, mesh, []
        self.at, self.rotation, self.scale, self.matrix = at, rotation, scale, matrix

    def add(self, name, mesh=None, **transform):
        """Append a child node and return it."""
        child = Node(name, mesh, **transform)
        self.children.append(child)
        return child

    def add_part(self, name, mesh=None, **transform):
        """Append a child named after this node, as in "bookshelf/board_07", and return it."""
        return self.add(f"{self.name}/{name}", mesh, **transform)


def quaternion(axis, degrees):
    """The rotation (x, y, z, w), glTF's order, by `degrees` about "x", "y" or "z"."""
    s, c = shapes.sin_cos(degrees / 2)
    return tuple(s if axis == name else 0.0 for name in "xyz") + (c,)


def yaw(degrees):
    return quaternion("y", degrees)


def product(a, b):
    """The quaternion that turns by b, then by a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def _corner_normals(part):
    """One unit normal per corner of every face, averaged over the faces across soft edges."""
    areas = [shapes.area_vector(part.points, f) for f in part.faces]
    units = [shapes.unit(a) for a in areas]
    around = {}
    for index, face in enumerate(part.faces):
        for p in face:
            around.setdefault(p, []).append(index)
    result = []
    for index, face in enumerate(part.faces):
        corners = []
        for p in face:
            total = [0.0, 0.0, 0.0]
            for other in around[p]:
                if shapes.dot(units[index], units[other]) >= part.crease:
                    for k in range(3):
                        total[k] += areas[other][k]
            corners.append(shapes.unit(total))
        result.append(corners)
    return result


def _clean(value):
    """Round to 6 decimals (a micrometer) and drop the sign of zero."""
    return round(value, 6) + 0.0


def _primitive_arrays(parts):
    """Return (positions, normals, uvs, indices, triangles per part) of parts of one material."""
    positions, normals, uvs, indices, part_triangles = [], [], [], [], []
    for part in parts:
        known, first = {}, len(indices)
        for face, face_uvs, face_normals in zip(part.faces, part.uvs, _corner_normals(part)):
            corner_ids = []
            for p, uv, normal in zip(face, face_uvs, face_normals):
                key = (p, tuple(map(_clean, uv)), tuple(map(_clean, normal)))
                if key not in known:
                    known[key] = len(positions)
                    positions.append(tuple(map(_clean, part.points[p])))
                    uvs.append(key[1])
                    normals.append(key[2])
                corner_ids.append(known[key])
            for i in range(1, len(corner_ids) - 1):
                indices += [corner_ids[0], corner_ids[i], corner_ids[i + 1]]
        part_triangles.append((len(indices) - first) // 3)
    return positions, normals, uvs, indices, part_triangles


class _Buffers:
    """Four growing streams; every accessor is a slice of one of them."""

    def __init__(self):
        self.streams = {name: bytearray() for name in ("index", "position", "normal", "uv")}
        self.accessors = []

    def add(self, stream, kind, rows, bounds=False):
        data = self.streams[stream]
        scalar = kind == "SCALAR"
        accessor = {"bufferView": list(self.streams).index(stream), "byteOffset": len(data),
                    "componentType": _USHORT if scalar else _FLOAT, "count": len(rows), "type": kind}
        for row in rows:
            data += struct.pack("<H", row) if scalar else struct.pack(f"<{len(row)}f", *row)
        data += bytes(-len(data) % 4)
        if bounds:
            for name, choose in (("min", min), ("max", max)):
                accessor[name] = [choose(row[k] for row in rows) for k in range(3)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def _mesh_json(mesh, material_ids, buffers):
    primitives = []
    by_material = {}
    for part in mesh.parts:
        by_material.setdefault(part.material, []).append(part)
    for material, parts in by_material.items():
        positions, normals, uvs, indices, part_triangles = _primitive_arrays(parts)
        if len(positions) > 65535:
            raise ValueError(f"mesh {mesh.name} has more than 65535 vertices of {material}")
        primitives.append({
            "attributes": {"POSITION": buffers.add("position", "VEC3", positions, bounds=True),
                           "NORMAL": buffers.add("normal", "VEC3", normals),
                           "TEXCOORD_0": buffers.add("uv", "VEC2", uvs)},
            "indices": buffers.add("index", "SCALAR", indices),
            "material": material_ids[material],
            "extras": {"part_triangles": part_triangles}})
    return {"name": mesh.name, "primitives": primitives}


def _node_json(node, document, mesh_ids, mesh_list):
    entry = {"name": node.name}
    document["nodes"].append(entry)
    index = len(document["nodes"]) - 1
    if node.mesh is not None:
        if id(node.mesh) not in mesh_ids:
            mesh_ids[id(node.mesh)] = len(mesh_list)
            mesh_list.append(node.mesh)
        entry["mesh"] = mesh_ids[id(node.mesh)]
    for key, value in (("translation", node.at), ("rotation", node.rotation),
                       ("scale", node.scale), ("matrix", node.matrix)):
        if value is not None:
            entry[key] = [round(v, 9) + 0.0 for v in value]
    if node.children:
        entry["children"] = [_node_json(c, document, mesh_ids, mesh_list) for c in node.children]
    return index


def _material_json(name, material, image_names):
    image, color, metallic, roughness, _ = material
    surface = {"baseColorFactor": list(color) + [1.0]}
    if image is not None:
        surface["baseColorTexture"] = {"index": image_names.index(image)}
    surface.update(metallicFactor=metallic, roughnessFactor=roughness)
    return {"name": name, "pbrMetallicRoughness": surface}


def write(root, images, materials=textures.MATERIALS, script="make_apartment.py"):
    """Return the bytes of the GLB of the tree under `root`.

    images: [(name, PNG bytes)]; materials: those of the file, laid out as textures.MATERIALS;
    script: the file that made it, named inside.
    """
    names = [name for name, _ in images]
    material_list = [_material_json(name, m, names) for name, m in materials.items()]
    document = {"asset": {"version": "2.0", "generator": f"galactic packs/sample/{script}"},
                "scene": 0, "scenes": [{"name": root.name, "nodes": [0]}], "nodes": [],
                "meshes": [], "materials": material_list,
                "textures": [{"name": n, "sampler": 0, "source": i} for i, n in enumerate(names)],
                "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}]}
    mesh_list = []
    _node_json(root, document, {}, mesh_list)
    buffers, material_ids = _Buffers(), {m: i for i, m in enumerate(materials)}
    document["meshes"] = [_mesh_json(m, material_ids, buffers) for m in mesh_list]
    document["accessors"] = buffers.accessors

    blob, views = bytearray(), []
    for name, data in buffers.streams.items():
        view = {"name": name, "buffer": 0, "byteOffset": len(blob), "byteLength": len(data),
                "target": _ELEMENT_ARRAY_BUFFER if name == "index" else _ARRAY_BUFFER}
        if name != "index":
            view["byteStride"] = 8 if name == "uv" else 12
        views.append(view)
        blob += data
    document["images"] = []
    # Images come last: the geometry's bytes then do not depend on zlib's version.
    for name, data in images:
        document["images"].append({"name": name, "mimeType": "image/png", "bufferView": len(views)})
        views.append({"name": name, "buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        blob += data + bytes(-len(data) % 4)
    document["bufferViews"] = views
    document["buffers"] = [{"byteLength": len(blob)}]
    if not images:
        # glTF has no empty lists.
        for key in ("images", "textures", "samplers"):
            del document[key]

    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(blob)
    return (struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(blob), b"BIN\0") + bytes(blob))
