"""Bakes the worlds that the trainer's tests learn in: world.pack, and held_out.pack with other episodes.

    bake_worlds.py --bake PROGRAM --sources packs/sample -o FOLDER
"""

import argparse
import pathlib
import subprocess

RADII = "0.015,0.05,0.12"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bake", required=True)
    parser.add_argument("--sources", type=pathlib.Path, required=True)
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True)
    options = parser.parse_args()
    folder, sources = options.out, options.sources
    folder.mkdir(parents=True, exist_ok=True)

    def bake(output: str, *arguments: "str | pathlib.Path") -> pathlib.Path:
        file = folder / output
        command = [options.bake, *map(str, arguments), "-o", str(file), "--quiet"]
        subprocess.run(command, check=True)
        return file

    apartment = bake("apartment.pack", sources / "apartment.glb", "--radii", RADII)
    objects = bake("objects.pack", sources / "objects", "--as", "object", "--radii", RADII)
    robot = bake("robot.pack", sources / "robot/porter.urdf", "--recipe",
                 sources / "robot/robot.toml", "--radii", RADII)  # fmt: skip
    parts = (apartment, objects, robot)
    for world, seed, count in (("world", 1, 400), ("held_out", 77, 100)):
        episodes = bake(f"{world}_episodes.pack", *parts, "--as", "episodes", "--count", str(count),
                        "--seed", str(seed))  # fmt: skip
        bake(f"{world}.pack", *parts, episodes, "--as", "world")


if __name__ == "__main__":
    main()
