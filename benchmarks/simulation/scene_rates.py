#!/usr/bin/env python3
"""How fast a robot with automatic spheres is beside one with hand-placed ones, scene by scene.

    benchmarks/simulation/scene_rates.py ASSETS OUT [--scenes PATTERN] [--build BUILD] [--turns N] [--envs N]

Bakes the ReplicaCAD scenes whose names fit, YCB objects, Fetch once with the spheres that were fitted to it and once
with those placed by hand, and 99 episodes for each scene, which both robots play. What is in OUT already is not baked
again. Then play_workload runs with both robots in turns. Prints the processor time of a step of one env in nanoseconds,
the least of the turns, and which part of the rate with hand-placed spheres is left.
"""

import argparse
import pathlib
import subprocess
import sys

from workload import nanoseconds_of_step

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LOADS = ("random", "forward", "held")
EPISODES = 99
ROBOTS = ("hand", "automatic")


class Baker:
    def __init__(self, assets: pathlib.Path, out: pathlib.Path, tools: pathlib.Path) -> None:
        self.assets = assets
        self.out = out
        self.tools = tools

    def run(self, tool: str, *options: str | pathlib.Path) -> None:
        subprocess.run([self.tools / tool, *options], cwd=self.out, check=True)

    def bake(self, pack: str, *options: str | pathlib.Path) -> None:
        if not (self.out / pack).exists():
            self.run("galactic-bake", "-q", *options, "-o", pack)

    def bake_parts(self, pattern: str) -> list[str]:
        """Scenes, objects and both robots. Returns the names of the scenes."""
        dataset = self.assets / "replica_cad/replicaCAD.scene_dataset_config.json"
        urdf = self.assets / "robots/fetch/fetch_description/robots/fetch.urdf"
        published = self.assets / "galactic/data/replicacad_composite.collection.json"
        listed = subprocess.run(
            [self.tools / "galactic-bake", dataset, "--scenes", pattern, "--list"],
            check=True,
            capture_output=True,
            text=True,
        )
        names = listed.stdout.split()
        # It remembers itself which scenes are there.
        self.run(
            "galactic-bake",
            "-q",
            dataset,
            "--scenes",
            pattern,
            "--no-render-meshes",
            "-o",
            "dataset.pack",
        )
        self.bake(
            "objects.pack", self.assets / "ycb", "--as", "object", "--up", "z", "--no-render-meshes"
        )
        self.bake(
            "automatic.pack",
            urdf,
            "--recipe",
            ROOT / "packs/robots/fetch.toml",
            "--no-render-meshes",
        )
        self.bake("hand.pack", urdf, "--recipe", published, "--no-render-meshes")
        return names

    def bake_worlds(self, scene: str) -> None:
        pack = next(self.out.rglob(f"{scene}.pack"))
        self.bake(
            f"{scene}.episodes.pack",
            *(
                pack,
                "objects.pack",
                "automatic.pack",
                "--as",
                "episodes",
                "--count",
                str(EPISODES),
                "--solve",
                "0",
            ),
        )
        for robot in ROBOTS:
            parts = (pack, "objects.pack", f"{robot}.pack")
            world = f"{scene}.{robot}.world.pack"
            self.bake(world, *parts, f"{scene}.episodes.pack", "--as", "world")
            held = f"{scene}.{robot}.held_episodes.pack"
            if not (self.out / held).exists():
                self.run("held_episodes", world, held)
            self.bake(f"{scene}.{robot}.held_world.pack", *parts, held, "--as", "world")


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("assets", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--scenes", default="v3_sc1_staging_*", help="pattern with * and ?")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--envs", type=int, default=128)
    parser.add_argument("--steps", type=int, default=600)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    out = options.out.resolve()
    tools = options.build.resolve() / "bin"
    baker = Baker(options.assets.resolve(), out, tools)
    print("| scene | " + " | ".join(LOADS) + " |")
    print("|---" * (1 + len(LOADS)) + "|")
    shares: dict[str, list[float]] = {load: [] for load in LOADS}
    for scene in baker.bake_parts(options.scenes):
        baker.bake_worlds(scene)
        cells = []
        for load in LOADS:
            kind = "held_world" if load == "held" else "world"
            least = {robot: float("inf") for robot in ROBOTS}
            for _ in range(options.turns):
                for robot in ROBOTS:
                    world = out / f"{scene}.{robot}.{kind}.pack"
                    counts = (options.envs, options.steps)
                    took = nanoseconds_of_step(tools / "play_workload", world, load, *counts)
                    least[robot] = min(least[robot], took)
            shares[load].append(least["hand"] / least["automatic"])
            cells.append(
                f"{least['hand']:.0f}, {least['automatic']:.0f}: {100 * shares[load][-1]:.0f} %"
            )
        print(f"| {scene} | " + " | ".join(cells) + " |", flush=True)
    means = [f"{100 * sum(shares[load]) / len(shares[load]):.0f} %" for load in LOADS]
    print("| mean | " + " | ".join(means) + " |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
