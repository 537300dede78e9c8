#!/usr/bin/env python3
"""Checks of the sample apartment: regenerated, well-formed, closed, and true to its landmarks."""

import contextlib
import io
import json
import math
import pathlib
import struct
import sys
import tempfile
import unittest

_REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
_SAMPLE = _REPOSITORY / "packs" / "sample"
sys.dont_write_bytecode = True
sys.path.insert(0, str(_SAMPLE))

import geometry  # noqa: E402
import glb_reader  # noqa: E402
import layout  # noqa: E402
import make_apartment  # noqa: E402
import png  # noqa: E402

# Landmarks are written with six decimals.
_JSON_TOLERANCE = 1e-6
# Twice the area of the smallest triangle we accept, in square meters.
_SMALLEST_DOUBLE_AREA = 1e-8
_COMPONENT_BYTES = {5123: 2, 5126: 4}
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


def _without_image_bytes(document):
    """The JSON chunk, less the sizes that depend on how zlib compressed the images."""
    copy = json.loads(json.dumps(document))
    for image in copy["images"]:
        view = copy["bufferViews"][image["bufferView"]]
        del view["byteOffset"], view["byteLength"]
    del copy["buffers"][0]["byteLength"]
    return copy


def _geometry_end(document):
    first = min(image["bufferView"] for image in document["images"])
    return document["bufferViews"][first]["byteOffset"]


def _unmatched_half_edges(positions, triangles):
    """Half-edges, welded by position, that are not met by exactly one opposite."""
    counts = {}
    for triangle in triangles:
        corners = [positions[i] for i in triangle]
        for a, b in zip(corners, corners[1:] + corners[:1]):
            counts[a, b] = counts.get((a, b), 0) + 1
    return [(a, b) for (a, b), count in counts.items() if count != 1 or counts.get((b, a)) != 1]


def _double_area(a, b, c):
    n = geometry.cross(geometry.sub(b, a), geometry.sub(c, a))
    return math.sqrt(geometry.dot(n, n))


class SampleApartment(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        out = pathlib.Path(cls._folder.name)
        if make_apartment.main(["--out", str(out)]) != 0:
            raise RuntimeError("the generator failed")
        cls.glb = (out / "apartment.glb").read_bytes()
        cls.truth = json.loads((out / "landmarks.json").read_text(encoding="utf-8"))
        cls.document, cls.blob = glb_reader.load(cls.glb)
        cls.parts = glb_reader.world_parts(cls.document, cls.blob)

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def _mesh_parts(self):
        for mesh in self.document["meshes"]:
            for i, part in enumerate(glb_reader.mesh_parts(self.document, self.blob, mesh)):
                yield (f"{mesh['name']}[{i}]",) + part

    # Against the committed files.

    def test_the_committed_glb_has_the_same_structure_and_geometry(self):
        committed, blob = glb_reader.load((_SAMPLE / "apartment.glb").read_bytes())
        self.assertEqual(_without_image_bytes(committed), _without_image_bytes(self.document))
        end = _geometry_end(self.document)
        self.assertEqual(_geometry_end(committed), end)
        self.assertTrue(blob[:end] == self.blob[:end], "the geometry's bytes differ")

    def test_the_committed_images_have_the_same_pixels(self):
        committed, blob = glb_reader.load((_SAMPLE / "apartment.glb").read_bytes())
        self.assertEqual(len(committed["images"]), len(self.document["images"]))
        for ours, theirs in zip(self.document["images"], committed["images"]):
            pictures = []
            for document, data, image in ((self.document, self.blob, ours), (committed, blob, theirs)):
                view = document["bufferViews"][image["bufferView"]]
                start = view["byteOffset"]
                pictures.append(png.decode(data[start:start + view["byteLength"]]))
            self.assertTrue(pictures[0] == pictures[1], f"image {ours['name']} differs")

    def test_the_committed_landmarks_are_the_same(self):
        committed = json.loads((_SAMPLE / "landmarks.json").read_text(encoding="utf-8"))
        self._assert_alike(committed, self.truth, "landmarks")

    def _assert_alike(self, a, b, where):
        if isinstance(a, float) or isinstance(b, float):
            self.assertAlmostEqual(a, b, delta=2 * _JSON_TOLERANCE, msg=where)
        elif isinstance(a, dict):
            self.assertEqual(list(a), list(b), where)
            for key in a:
                self._assert_alike(a[key], b[key], f"{where}.{key}")
        elif isinstance(a, list):
            self.assertEqual(len(a), len(b), where)
            for i, (x, y) in enumerate(zip(a, b)):
                self._assert_alike(x, y, f"{where}[{i}]")
        else:
            self.assertEqual(a, b, where)

    def test_two_runs_write_the_same_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(make_apartment.main(["--out", folder]), 0)
            self.assertTrue((pathlib.Path(folder) / "apartment.glb").read_bytes() == self.glb)

    def test_a_folder_that_cannot_be_written_is_exit_code_2(self):
        errors = io.StringIO()
        with tempfile.NamedTemporaryFile() as file, contextlib.redirect_stderr(errors):
            self.assertEqual(make_apartment.main(["--out", file.name]), 2)
        self.assertIn("cannot write to", errors.getvalue())

    # The container.

    def test_buffer_views_and_accessors_are_aligned_and_in_range(self):
        views = self.document["bufferViews"]
        end = 0
        for view in views:
            self.assertEqual(view["byteOffset"] % 4, 0, view)
            self.assertGreaterEqual(view["byteOffset"], end, view)
            end = view["byteOffset"] + view["byteLength"]
        self.assertLessEqual(end, len(self.blob))
        self.assertEqual(self.document["buffers"][0]["byteLength"], len(self.blob))
        for accessor in self.document["accessors"]:
            view = views[accessor["bufferView"]]
            size = _COMPONENT_BYTES[accessor["componentType"]]
            element = size * _COMPONENTS[accessor["type"]]
            stride = view.get("byteStride", element)
            self.assertEqual(accessor["byteOffset"] % size, 0)
            self.assertEqual(stride % size, 0)
            last = accessor["byteOffset"] + stride * (accessor["count"] - 1) + element
            self.assertGreater(accessor["count"], 0)
            self.assertLessEqual(last, view["byteLength"])

    def test_numbers_are_finite_and_indices_in_range(self):
        for mesh in self.document["meshes"]:
            for primitive in mesh["primitives"]:
                counts = set()
                for name, index in primitive["attributes"].items():
                    rows = glb_reader.accessor_rows(self.document, self.blob, index)
                    counts.add(len(rows))
                    self.assertTrue(all(math.isfinite(v) for row in rows for v in row), (mesh["name"], name))
                    if name == "NORMAL":
                        for row in rows:
                            self.assertAlmostEqual(geometry.dot(row, row), 1.0, delta=1e-5)
                self.assertEqual(len(counts), 1, mesh["name"])
                indices = glb_reader.accessor_rows(self.document, self.blob, primitive["indices"])
                self.assertEqual(set(indices), set(range(counts.pop())), mesh["name"])
                self.assertEqual(3 * sum(primitive["extras"]["part_triangles"]), len(indices))

    def test_position_bounds_match_the_positions(self):
        for mesh in self.document["meshes"]:
            for primitive in mesh["primitives"]:
                index = primitive["attributes"]["POSITION"]
                rows = glb_reader.accessor_rows(self.document, self.blob, index)
                for key, choose in (("min", min), ("max", max)):
                    stated = struct.unpack("<3f", struct.pack("<3f", *self.document["accessors"][index][key]))
                    self.assertEqual(stated, tuple(choose(r[k] for r in rows) for k in range(3)), mesh["name"])

    def test_names_are_unique_and_every_mesh_and_material_is_used(self):
        for kind in ("nodes", "meshes", "materials", "images"):
            names = [entry["name"] for entry in self.document[kind]]
            self.assertEqual(len(names), len(set(names)), kind)
        used = {n["mesh"] for n in self.document["nodes"] if "mesh" in n}
        self.assertEqual(used, set(range(len(self.document["meshes"]))))
        used = {p["material"] for m in self.document["meshes"] for p in m["primitives"]}
        self.assertEqual(used, set(range(len(self.document["materials"]))))

    # The surfaces.

    def test_every_part_is_closed(self):
        for name, _, positions, triangles in self._mesh_parts():
            self.assertEqual(_unmatched_half_edges(positions, triangles), [], name)

    def test_a_missing_or_flipped_triangle_would_be_noticed(self):
        _, _, positions, triangles = next(self._mesh_parts())
        self.assertEqual(len(_unmatched_half_edges(positions, triangles[1:])), 3)
        flipped = [triangles[0][::-1]] + triangles[1:]
        self.assertEqual(len(_unmatched_half_edges(positions, flipped)), 3)

    def test_every_part_winds_outwards(self):
        for name, triangles in self.parts:
            self.assertGreater(geometry.signed_volume(triangles), 0.0, name)

    def test_no_triangle_is_degenerate(self):
        for name, triangles in self.parts:
            for triangle in triangles:
                self.assertGreater(_double_area(*triangle), _SMALLEST_DOUBLE_AREA, name)

    def test_normals_point_to_the_front_of_their_triangles(self):
        for mesh in self.document["meshes"]:
            for primitive in mesh["primitives"]:
                rows = {name: glb_reader.accessor_rows(self.document, self.blob, index)
                        for name, index in primitive["attributes"].items()}
                indices = glb_reader.accessor_rows(self.document, self.blob, primitive["indices"])
                for i in range(0, len(indices), 3):
                    a, b, c = (rows["POSITION"][k] for k in indices[i:i + 3])
                    front = geometry.cross(geometry.sub(b, a), geometry.sub(c, a))
                    for k in indices[i:i + 3]:
                        self.assertGreater(geometry.dot(front, rows["NORMAL"][k]), 0.0, mesh["name"])

    def test_only_the_entrance_handle_reaches_out_of_the_building(self):
        for name, triangles in self.parts:
            if name == "door_entrance/leaf":
                continue
            for k in range(3):
                values = [v[k] for t in triangles for v in t]
                self.assertGreater(min(values), layout.OUTSIDE.low[k] - _JSON_TOLERANCE, name)
                self.assertLess(max(values), layout.OUTSIDE.high[k] + _JSON_TOLERANCE, name)

    def test_furniture_stays_inside_its_room(self):
        roots = {self.document["nodes"][i]["name"]: i for i in self.document["nodes"][0]["children"]}
        checked = 0
        for room, box in layout.ROOMS.items():
            names, stack = set(), [roots[room]]
            while stack:
                node = self.document["nodes"][stack.pop()]
                names.add(node["name"])
                stack += node.get("children", [])
            for name, triangles in self.parts:
                if name in names:
                    checked += 1
                    for k in range(3):
                        values = [v[k] for t in triangles for v in t]
                        self.assertGreater(min(values), box.low[k] - 2 * _JSON_TOLERANCE, name)
                        self.assertLess(max(values), box.high[k] + 2 * _JSON_TOLERANCE, name)
        self.assertGreater(checked, 200)

    # The landmarks.

    def test_landmarks_answer_both_ways_for_every_radius(self):
        for radius in layout.RADII:
            answers = [p["free"][str(radius)] for p in self.truth["points"]]
            share = sum(answers) / len(answers)
            self.assertTrue(0.1 <= share <= 0.9, f"radius {radius}: {share:.0%} free")

    def test_a_free_sphere_is_clear_of_all_triangles(self):
        for point in self.truth["points"]:
            distance, _ = geometry.clearance(point["position"], self.parts)
            self.assertAlmostEqual(distance, point["clearance"], delta=_JSON_TOLERANCE, msg=point["name"])
            for radius, free in point["free"].items():
                if free:
                    self.assertGreater(distance, float(radius), point["name"])

    def test_the_bookshelf_column_has_ten_boards_in_order(self):
        boards = self.truth["bookshelf"]["boards"]
        self.assertEqual(len(boards), 10)
        column, = (c for c in self.truth["columns"] if (c["x"], c["z"])
                   == (self.truth["bookshelf"]["x"], self.truth["bookshelf"]["z"]))
        heights = [y for y, _ in column["crossings"]]
        for board in boards:
            for key in ("bottom", "top"):
                self.assertLess(min(abs(y - board[key]) for y in heights), 2 * _JSON_TOLERANCE, board)
        for below, above in zip(boards, boards[1:]):
            self.assertGreater(above["bottom"] - below["top"], 2 * layout.RADII[1])


if __name__ == "__main__":
    unittest.main()
