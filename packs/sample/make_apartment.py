#!/usr/bin/env python3
"""Write apartment.glb and landmarks.json: the sample world, with no input but these scripts."""

import argparse
import json
import pathlib
import sys

import glb_writer
import landmarks
import rooms
import shell
import textures


def build_scene():
    """Return the root node of the apartment."""
    root = glb_writer.Node("apartment")
    rooms.furnish(shell.build(root))
    return root


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent,
                        help="folder to write to (default: the folder of this script)")
    out = parser.parse_args(arguments).out
    glb = glb_writer.write(build_scene(), textures.images())
    truth = json.dumps(landmarks.derive(glb), indent=1, allow_nan=False) + "\n"
    try:
        out.mkdir(parents=True, exist_ok=True)
        (out / "apartment.glb").write_bytes(glb)
        (out / "landmarks.json").write_text(truth, encoding="utf-8")
    except OSError as error:
        print(f"make_apartment: cannot write to {out}: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
