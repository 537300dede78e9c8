#!/usr/bin/env python3
"""Write objects/*.glb: the movable objects of the sample world, with no input but these scripts."""

import argparse
import pathlib
import sys

import glb_writer
import household
import textures


def build_object(mesh):
    """Return the bytes of one object's GLB, with the materials and images that it uses."""
    used = {part.material for part in mesh.parts}
    materials = {name: m for name, m in textures.OBJECT_MATERIALS.items() if name in used}
    names = {m[0] for m in materials.values()}
    images = [(name, data) for name, data in textures.object_images() if name in names]
    return glb_writer.write(glb_writer.Node(mesh.name, mesh), images, materials, "make_objects.py")


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parent / "objects",
                        help="folder to write to (default: objects, beside this script)")
    out = parser.parse_args(arguments).out
    files = {f"{mesh.name}.glb": build_object(mesh) for mesh in household.all_meshes()}
    try:
        out.mkdir(parents=True, exist_ok=True)
        for name, data in files.items():
            (out / name).write_bytes(data)
    except OSError as error:
        print(f"make_objects: cannot write to {out}: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
