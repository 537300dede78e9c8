#!/usr/bin/env python3
"""What thousands of homes cost: start-up, memory, and the rate of steps beside that of a few homes.

    benchmarks/simulation/many_homes.py ASSETS OUT [--homes N] [--few N] [--envs N,N...] [--build BUILD] [--turns N]

Makes homes of the staged ReplicaCAD apartments: each piece of furniture is moved by up to 30 cm along X and Z, and one
in five is left out. Bakes them with YCB objects, Fetch and ten episodes for each home, and a world of the first few of
them. What is in OUT already is not baked again. Then galactic-run steps both worlds in turns, with all threads, and
with random actions. Prints the least time of each, and the most memory that a process needed.
"""

import argparse
import json
import os
import pathlib
import random
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
EPISODES_OF_A_HOME = 10
FARTHEST = 0.3
LEFT_OUT = 0.2

RECIPE = """
[bake]
radii = [0.015, 0.05, 0.12]
[[scenes]]
dataset = "replica_cad/replicaCAD.scene_dataset_config.json"
scenes = {scenes}
[[objects]]
files = "{assets}/ycb"
up = "z"
[robot]
files = "{assets}/robots/fetch/fetch_description/robots/fetch.urdf"
recipe = "{root}/packs/robots/fetch.toml"
[episodes]
count = {episodes}
objects = 10
"""


def furnished_anew(apartment: dict, draw: random.Random) -> dict:
    kept = []
    for piece in apartment["object_instances"]:
        if draw.random() < LEFT_OUT:
            continue
        x, y, z = piece["translation"]
        moved = (x + draw.uniform(-FARTHEST, FARTHEST), y, z + draw.uniform(-FARTHEST, FARTHEST))
        kept.append({**piece, "translation": moved})
    return {**apartment, "object_instances": kept}


def make_dataset(assets: pathlib.Path, dataset: pathlib.Path, homes: int) -> None:
    """The same dataset with other scene instances; meshes are links."""
    source = assets / "replica_cad"
    apartments = sorted((source / "configs/scenes").glob("v3_sc1_staging_*.scene_instance.json"))
    for file in source.rglob("*"):
        link = dataset / file.relative_to(source)
        if file.is_dir() or "configs/scenes" in file.as_posix() or link.exists():
            continue
        link.parent.mkdir(parents=True, exist_ok=True)
        link.symlink_to(file)
    (dataset / "configs/scenes").mkdir(parents=True, exist_ok=True)
    draw = random.Random(5)
    for n in range(homes):
        apartment = json.loads(apartments[n % len(apartments)].read_text())
        instance = json.dumps(furnished_anew(apartment, draw))
        (dataset / f"configs/scenes/home_{n:05}.scene_instance.json").write_text(instance)


def bake(assets: pathlib.Path, out: pathlib.Path, tools: pathlib.Path, homes: int) -> pathlib.Path:
    recipe = out / f"homes_{homes}.toml"
    names = [f"home_{n:05}" for n in range(homes)]
    count = EPISODES_OF_A_HOME * homes
    recipe.write_text(
        RECIPE.format(scenes=json.dumps(names), assets=assets, root=ROOT, episodes=count)
    )
    world = out / f"homes_{homes}.pack"
    command = (tools / "galactic-bake", recipe, "-o", world, "--cache", out / "cache")
    subprocess.run(command, cwd=out, check=True, stdout=sys.stderr)
    return world


def run(tools: pathlib.Path, world: pathlib.Path, envs: int) -> dict[str, float]:
    report = world.with_suffix(".json")
    command = (tools / "galactic-run", world, "--envs", str(envs), "--steps", "500", "--quiet")
    process = subprocess.Popen((*command, "--report", report))
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{world}: galactic-run failed")
    figures = json.loads(report.read_text())
    return {
        "open, s": figures["seconds"]["open"],
        "make envs, s": figures["seconds"]["create"],
        "step, ns": 1e9 / figures["steps_per_second"],
        "memory, MB": usage.ru_maxrss / 1000,
    }


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("assets", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--homes", type=int, default=1000)
    parser.add_argument("--few", type=int, default=20)
    parser.add_argument("--envs", default="1024,4096,16384")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--turns", type=int, default=3)
    options = parser.parse_args()
    out = options.out.resolve()
    assets = options.assets.resolve()
    tools = options.build.resolve() / "bin"
    make_dataset(assets, out / "replica_cad", max(options.homes, options.few))
    worlds = [bake(assets, out, tools, homes) for homes in (options.few, options.homes)]
    for envs in map(int, options.envs.split(",")):
        least: list[dict[str, float]] = [{} for _ in worlds]
        for _ in range(options.turns):
            for known, world in zip(least, worlds):
                for name, value in run(tools, world, envs).items():
                    known[name] = min(value, known.get(name, value))
        print(f"{envs} envs", flush=True)
        for known, world in zip(least, worlds):
            figures = ", ".join(f"{name} {value:.4g}" for name, value in known.items())
            print(f"  {world.stem}: {figures}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
