#!/usr/bin/env bash
# The world of the published physics' measurements, for batch_steps: Fetch with its 29 hand-placed
# spheres, a ReplicaCAD scene, 99 episodes of 30 objects with the published boxes and sphere rules.
#
#   benchmarks/simulation/make_published_world.sh ASSETS OUT_FOLDER [BIN_FOLDER]
#
# docs/internals/simulation_speed.md says what ASSETS holds, and where it comes from.
# Leaves OUT_FOLDER/world.pack, and held_world.pack with the target of each episode in the hand.
set -euo pipefail
assets=$(cd "$1" && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
bin=$(cd "${3:-$(dirname "${BASH_SOURCE[0]}")/../../build/release/bin}" && pwd)
published=$assets/published_physics
collection=$assets/galactic/data/replicacad_composite.collection.json

# Two of the nine objects come without a mesh: their published boxes stand in for it.
mkdir -p "$out/boxes"
python3 - "$collection" "$out/boxes" <<'PYTHON'
import json, pathlib, sys

for item in json.load(open(sys.argv[1]))["collection"]["freeObjects"]:
    if item["name"] not in ("004_sugar_box", "008_pudding_box"):
        continue
    low, high = item["collisionBox"]["min"], item["collisionBox"]["max"]
    corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1])
               for z in (low[2], high[2])]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    lines = ["v %r %r %r" % corner for corner in corners] + ["f %d %d %d %d" % face for face in faces]
    pathlib.Path(sys.argv[2], item["name"] + ".obj").write_text("\n".join(lines) + "\n")
PYTHON

cd "$out"
"$bin/galactic-bake" -q "$published/scene.ply" --up y -o scene.pack
"$bin/galactic-bake" -q "$assets/ycb" boxes --as object --up z --collection "$collection" -o objects.pack
"$bin/galactic-bake" -q "$assets/robots/fetch/fetch_description/robots/fetch.urdf" \
  --recipe "$collection" -o robot.pack
"$bin/galactic-bake" -q "$published/episodes.episode_set.json" --only "$published/good_episodes.txt" \
  --scene-name Baked_sc1_staging_01=scene -o episodes.pack
"$bin/galactic-bake" -q scene.pack objects.pack robot.pack episodes.pack --as world -o world.pack
"$bin/held_episodes" world.pack held_episodes.pack
"$bin/galactic-bake" -q scene.pack objects.pack robot.pack held_episodes.pack --as world -o held_world.pack
