#!/usr/bin/env python3
"""Checks of the sample objects: regenerated, closed, standing on the ground, small enough to hold."""

import contextlib
import io
import json
import math
import pathlib
import sys
import tempfile
import unittest

_REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
_SAMPLE = _REPOSITORY / "packs" / "sample"
sys.dont_write_bytecode = True
sys.path.insert(0, str(_SAMPLE))

import geometry  # noqa: E402
import glb_reader  # noqa: E402
import make_objects  # noqa: E402
import png  # noqa: E402

_NAMES = ["apple", "book", "bottle", "bowl", "cereal_box", "mug", "plate", "soup_can"]
# Between the fingers of the sample robot, meters.
_GRIPPER_OPENING = 0.09
# Positions are floats: half a unit in the last place below 0.25 m.
_FLOAT_ROUNDING = 2e-8


def _without_image_bytes(document):
    """The JSON chunk, less the sizes that depend on how zlib compressed the images."""
    copy = json.loads(json.dumps(document))
    for image in copy.get("images", []):
        view = copy["bufferViews"][image["bufferView"]]
        del view["byteOffset"], view["byteLength"]
    del copy["buffers"][0]["byteLength"]
    return copy


def _geometry_end(document, blob):
    views = [document["bufferViews"][i["bufferView"]] for i in document.get("images", [])]
    return min((view["byteOffset"] for view in views), default=len(blob))


def _pixels(document, blob):
    pictures = []
    for image in document.get("images", []):
        view = document["bufferViews"][image["bufferView"]]
        pictures.append(png.decode(blob[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]))
    return pictures


class SampleObjects(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls._folder.name)
        if make_objects.main(["--out", str(cls.out)]) != 0:
            raise RuntimeError("the generator failed")
        cls.objects = {n: glb_reader.load((cls.out / f"{n}.glb").read_bytes()) for n in _NAMES}

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def _parts(self):
        for name, (document, blob) in self.objects.items():
            for mesh in document["meshes"]:
                for i, (_, positions, triangles) in enumerate(glb_reader.mesh_parts(document, blob, mesh)):
                    yield f"{name}[{i}]", positions, triangles

    def test_the_folder_holds_these_objects_and_nothing_else(self):
        for folder in (self.out, _SAMPLE / "objects"):
            self.assertEqual(sorted(p.name for p in folder.iterdir()), [f"{n}.glb" for n in _NAMES])

    def test_the_committed_files_are_what_the_generator_makes(self):
        for name, (document, blob) in self.objects.items():
            committed, stored = glb_reader.load((_SAMPLE / "objects" / f"{name}.glb").read_bytes())
            self.assertEqual(_without_image_bytes(committed), _without_image_bytes(document), name)
            end = _geometry_end(document, blob)
            self.assertEqual(_geometry_end(committed, stored), end, name)
            self.assertTrue(stored[:end] == blob[:end], f"{name}: the geometry's bytes differ")
            self.assertTrue(_pixels(committed, stored) == _pixels(document, blob), name)

    def test_two_runs_write_the_same_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(make_objects.main(["--out", folder]), 0)
            for name in _NAMES:
                again = (pathlib.Path(folder) / f"{name}.glb").read_bytes()
                self.assertTrue(again == (self.out / f"{name}.glb").read_bytes(), name)

    def test_a_folder_that_cannot_be_written_is_exit_code_2(self):
        errors = io.StringIO()
        with tempfile.NamedTemporaryFile() as file, contextlib.redirect_stderr(errors):
            self.assertEqual(make_objects.main(["--out", file.name]), 2)
        self.assertIn("cannot write to", errors.getvalue())

    def test_every_material_is_used_and_lists_are_never_empty(self):
        for name, (document, _) in self.objects.items():
            used = {p["material"] for mesh in document["meshes"] for p in mesh["primitives"]}
            self.assertEqual(used, set(range(len(document["materials"]))), name)
            empty = [key for key, value in document.items() if value == []]
            self.assertEqual(empty, [], name)

    def test_every_part_is_closed_and_winds_outwards(self):
        checked = 0
        for name, positions, triangles in self._parts():
            corners = [[positions[i] for i in t] for t in triangles]
            edges = [(a, b) for t in corners for a, b in zip(t, t[1:] + t[:1])]
            self.assertEqual(len(edges), len(set(edges)), name)
            self.assertEqual({(b, a) for a, b in edges}, set(edges), name)
            self.assertGreater(geometry.signed_volume(corners), 0.0, name)
            checked += 1
        self.assertGreaterEqual(checked, len(_NAMES))

    def test_every_object_stands_on_the_ground_and_fits_the_gripper(self):
        for name, (document, blob) in self.objects.items():
            points = [p for m in document["meshes"] for _, ps, _ in glb_reader.mesh_parts(document, blob, m)
                      for p in ps]
            low = [min(p[k] for p in points) for k in range(3)]
            high = [max(p[k] for p in points) for k in range(3)]
            self.assertLess(abs(low[1]), _FLOAT_ROUNDING, name)
            sizes = [b - a for a, b in zip(low, high)]
            self.assertLess(max(sizes), 0.25, name)
            self.assertLess(min(sizes), _GRIPPER_OPENING, name)
            self.assertTrue(all(math.isfinite(v) for v in sizes), name)


if __name__ == "__main__":
    unittest.main()
