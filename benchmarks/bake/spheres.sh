#!/bin/sh
# All tables of sphere sets in docs/objects_and_robots.md, and the processor time of whole bakes.
#
#   benchmarks/bake/spheres.sh ASSETS [BIN]
#
# ASSETS holds ycb/, gso/ and robots/ (fetch, stretch, galactic_URDF) as published; BIN the release build's programs.
set -eu
assets=$1
bin=${2:-build/release/bin}
root=$(cd "$(dirname "$0")/../.." && pwd)
fetch=$assets/robots/fetch/fetch_description/robots/fetch.urdf
pack=$(mktemp)
trap 'rm -f "$pack"' EXIT

echo "Objects, on the plane under them and without it"
"$bin/fit_spheres" --z-up "$assets"/ycb/*/*.obj
"$bin/fit_spheres" --z-up --no-support "$assets"/ycb/*/*.obj

tradeoff() {
  echo "$1"
  shift
  "$bin/robot_tradeoff" "$@"
}
tradeoff Fetch "$fetch" --recipe "$root/packs/robots/fetch.toml" --ground 0 \
  --by-hand "$assets/galactic/data/replicacad_composite.collection.json"
tradeoff Stretch "$assets"/robots/stretch/SE3/*.urdf --recipe "$root/packs/robots/stretch.toml"
tradeoff Spot "$assets/robots/galactic_URDF/spot_arm/urdf/spot_arm.urdf" --recipe "$root/packs/robots/spot.toml"
tradeoff Porter "$root/packs/sample/robot/porter.urdf" --recipe "$root/packs/sample/robot/robot.toml"

bake() {
  echo "$1: a whole bake; the last line is its processor time, user and system"
  shift
  (
    "$bin/galactic-bake" "$@" --no-render-meshes -j 1 -o "$pack" | tail -n 1
    times
  )
}
bake Fetch "$fetch" --recipe "$root/packs/robots/fetch.toml"
bake Porter "$root/packs/sample/robot/porter.urdf" --recipe "$root/packs/sample/robot/robot.toml"
