#!/usr/bin/env python3
"""Runs the programs with less and less memory than they need.

    limit_memory.py FOLDER_OF_PROGRAMS WORLD PACKS

WORLD is a world pack, PACKS the folder of the golden packs. Each program does something that needs memory, under
limits of its address space from what --version gets along with up to what is enough. Where it does not succeed, it
says so in one line PROGRAM: WHERE: MESSAGE, and that memory is what it lacks; it never ends by a signal or in an
internal error. Where it knows beforehand what it needs, at least one of the refusals says how much.
"""

import base64
import json
import pathlib
import re
import resource
import struct
import subprocess
import sys
import tempfile

STEP = 1.25
MEGABYTE = 1 << 20
MOST = 16384 * MEGABYTE
REPORTED = ("arm.pack", "crate.pack", "crate-older.pack", "policy.pack", "room-cell.pack", "room-column.pack")
# A file that cannot be read or mapped, or what is not supported.
CODES = (2, 5)


def run(command: list[str], limit: int) -> "subprocess.CompletedProcess[str]":
    def set_limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

    with tempfile.TemporaryDirectory() as folder:
        return subprocess.run(command, capture_output=True, text=True, preexec_fn=set_limit, cwd=folder, timeout=120)


def faults_of(command: list[str], knows: str) -> list[str]:
    """What a program says wrong. `knows`: what it can tell the need of, if anything."""
    limit = 8 * MEGABYTE
    # The loader's own errors are none of ours.
    while run([command[0], "--version"], limit).returncode != 0:
        limit = int(limit * STEP)
    name = pathlib.Path(command[0]).name
    # Of many scenes, the one that is too large.
    needing = f"{command[1]}: available memory" if name == "galactic-bake" else "available memory"
    faults, refused, foretold = [], 0, False
    while limit < MOST:
        done = run(command, limit)
        if done.returncode == 0:
            print(f"{name}: enough with {limit / MEGABYTE:.0f} MB, refused {refused} times")
            if knows and not foretold:
                faults.append(f"{name} never said how much {knows} need")
            return faults if refused else [f"{name} never lacked memory"]
        refused += 1
        line = done.stderr.strip()
        told = re.fullmatch(rf"{name}: [^\n]+: [^\n]+", line) and re.search("memory| [GM]B ", line) and "internal" not in line
        if done.returncode not in CODES or not told:
            faults.append(f"{name} with {limit / MEGABYTE:.0f} MB ended with {done.returncode}: {line!r}")
        foretold = foretold or re.search(rf": {re.escape(needing)}: \d+ {knows} need \d+\.\d [GM]B", line) is not None
        limit = int(limit * STEP)
    return [*faults, f"{name} never had enough memory"]


def write_instances(path: pathlib.Path, edge: int, instances: int) -> None:
    """A small file that places many triangles: a wavy square of edge x edge quads, again and again."""
    row = edge + 1
    positions = [(0.1 * x, 0.01 * (x * z % 7), 0.1 * z) for z in range(row) for x in range(row)]
    quads = [z * row + x for z in range(edge) for x in range(edge)]
    indices = [corner for at in quads for corner in (at, at + row, at + 1, at + 1, at + row, at + row + 1)]
    data = b"".join(struct.pack("<3f", *p) for p in positions) + struct.pack(f"<{len(indices)}H", *indices)
    split = 12 * len(positions)
    extents = [[side(p[axis] for p in positions) for axis in range(3)] for side in (min, max)]
    scene = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(instances))}],
        "nodes": [{"mesh": 0}] * instances,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [
            {
                "byteLength": len(data),
                "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode(),
            }
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": split},
            {"buffer": 0, "byteOffset": split, "byteLength": len(data) - split},
        ],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": len(positions),
                "type": "VEC3",
                "min": extents[0],
                "max": extents[1],
            },
            {"bufferView": 1, "componentType": 5123, "count": len(indices), "type": "SCALAR"},
        ],
    }
    path.write_text(json.dumps(scene))


def main() -> int:
    programs, world, packs = (pathlib.Path(text).resolve() for text in sys.argv[1:4])
    images = ["--envs", 32, "--steps", 1, "--threads", 1, "--render", "depth", "--size", 2048, "--backend", "soft"]
    commands = [
        ["envs", "galactic-run", world, "--envs", 65536, "--steps", 1, "--threads", 1],
        ["images of 2048 x 2048 pixels", "galactic-run", world, *images],
        # Where the system gives no more threads, those that it gives go on.
        ["", "galactic-run", world, "--envs", 4096, "--steps", 2, "--threads", 64],
        ["", "galactic-pack", "picture", packs / "crate.pack", "--size", 2048, "-o", "crate.png"],
        ["", "galactic-pack", "report", *[packs / name for name in REPORTED], "-o", "report.html"],
        ["columns", "galactic-bake", packs / "room.obj", "--spacing", 0.002, "--check-columns", 0, "-q", "-o", "room.pack"],
    ]
    with tempfile.TemporaryDirectory() as folder:
        placed = pathlib.Path(folder) / "placed.gltf"
        write_instances(placed, 50, 400)
        coarse = ["--spacing", 0.24, "--radii", 0.12, "--check-columns", 0, "--no-render-meshes", "-j", 1, "-q"]
        commands.append(["triangles", "galactic-bake", placed, *coarse, "-o", "placed.pack"])
        return report(programs, commands)


def report(programs: pathlib.Path, commands: list[list]) -> int:
    faults = []
    for knows, program, *words in commands:
        if (programs / program).exists():
            faults += faults_of([str(programs / program), *map(str, words)], knows)
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
