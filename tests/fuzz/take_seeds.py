#!/usr/bin/env python3
"""Makes seeds for the fuzz targets from real files: OUT/TARGET/NAME for each small file that a target reads.

    tests/fuzz/take_seeds.py OUT [FOLDER...]

Without folders they are packs/ and, where they are, the assets of the tests (GALACTIC_ASSETS). Seeds of
assets are for searches by hand and stay where they are made; the corpora in the sources have files of this
project only.
"""

import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Larger inputs make a fuzzer slow.
MOST_BYTES = 65536
MESHES = (".obj", ".ply", ".stl", ".glb", ".gltf", ".dae", ".fbx", ".off")
DATASET_FILES = (
    ".scene_dataset_config.json",
    ".scene_instance.json",
    ".object_config.json",
    ".stage_config.json",
    ".ao_config.json",
)


def seeds_of(path: pathlib.Path) -> list[tuple[str, bytes]]:
    """The targets that read such a file, and what comes before its bytes."""
    name, suffix = path.name.lower(), path.suffix.lower()
    seeds = []
    if suffix in MESHES:
        first = bytes([ord("0") + MESHES.index(suffix)])
        seeds += [("fuzz_mesh_import", first), ("fuzz_mesh_reader", first)]
    if suffix in (".urdf", ".srdf"):
        seeds += [("fuzz_urdf", b""), ("fuzz_urdf_reader", b"")]
    if suffix in (".xml", ".mjcf"):
        seeds += [("fuzz_mjcf", b""), ("fuzz_mjcf_reader", b"")]
    if suffix in (".png", ".jpg", ".jpeg"):
        seeds.append(("fuzz_image", b"0"))
    if suffix == ".toml":
        seeds.append(("fuzz_recipe", b"0" if path.parent.name == "worlds" else b"1"))
    if suffix == ".pack":
        seeds.append(("fuzz_pack", b"0"))
    if name.endswith((".episode_set.json", ".json.gz")):
        seeds.append(("fuzz_episode_set", b""))
    # The target takes the byte modulo 5, and 5 goes into "2" (50).
    seeds += [
        ("fuzz_scene_dataset", bytes([ord("2") + n])) for n, end in enumerate(DATASET_FILES) if name.endswith(end)
    ]
    return seeds


def main() -> int:
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 1
    out = pathlib.Path(sys.argv[1])
    assets = pathlib.Path(os.environ.get("GALACTIC_ASSETS", ROOT.parent / "shared/assets"))
    folders = [pathlib.Path(text) for text in sys.argv[2:]] or [ROOT / "packs", assets]
    counts: dict[str, int] = {}
    for path in sorted(path for folder in folders for path in folder.rglob("*")):
        if not path.is_file() or path.stat().st_size > MOST_BYTES:
            continue
        for target, first in seeds_of(path):
            number = counts[target] = counts.get(target, 0) + 1
            (out / target).mkdir(parents=True, exist_ok=True)
            (out / target / f"{number}_{path.name}").write_bytes(first + path.read_bytes())
    for target, count in sorted(counts.items()):
        print(f"{target}: {count}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
