#!/usr/bin/env bash
# Installs what is needed, builds the tools, bakes the sample world (apartment, objects, robot,
# episodes), opens it in the runtime and draws it. Works from any folder; what it makes is in
# build/release.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
cd "$galactic_root"

bin=build/release/bin
out=build/release/sample
sources=packs/sample
world=$out/world.pack
apartment=$out/apartment.pack
objects=$out/objects.pack
robot=$out/robot.pack
episodes=$out/episodes.pack
radii=(0.015 0.05 0.12)

# From west to east: coffee table, armchair, the ten boards of the bookshelf, the loft.
slice=-4,1.5,3.9,1.5

draw() {
  local radius
  "$bin/galactic-pack" picture "$apartment" -o "$out/plans.png"
  for radius in "${radii[@]}"; do
    "$bin/galactic-pack" picture "$apartment" --radius "$radius" -o "$out/plan-r$radius.png"
  done
  "$bin/galactic-pack" picture "$apartment" --slice "$slice" --radius 0.015 -o "$out/slice.png"
  "$bin/galactic-pack" export "$apartment" --radius 0.05 --surface -o "$out/surfaces.ply"
  "$bin/galactic-pack" picture "$objects" -o "$out/objects.png"
  "$bin/galactic-pack" picture "$robot" -o "$out/robot.png"
  "$bin/galactic-pack" view "$world" -o "$out/world.html"
  "$bin/galactic-run" "$world" --envs 4 --steps 500 --policy scripted --view "$out/run.html"
}

phase setup "Installing packages" scripts/setup.sh --to-use
phase quickstart-configure "Configuring (preset release)" cmake --preset release
phase quickstart-build "Building the tools" \
  cmake --build --preset release --target galactic-bake galactic-run galactic-pack

heading "Baking apartment, objects and robot of $sources"
mkdir -p "$out"
comma_radii=$(IFS=,; echo "${radii[*]}")
"$bin/galactic-bake" "$sources/apartment.glb" -o "$apartment" --radii "$comma_radii"
"$bin/galactic-bake" "$sources/objects" --as object -o "$objects" --radii "$comma_radii"
"$bin/galactic-bake" "$sources/robot/porter.urdf" --recipe "$sources/robot/robot.toml" -o "$robot" \
  --radii "$comma_radii"

heading "Drawing episodes, and linking all packs to a world"
"$bin/galactic-bake" "$apartment" "$objects" "$robot" --as episodes --count 100 --seed 1 -o "$episodes"
"$bin/galactic-bake" "$apartment" "$objects" "$robot" "$episodes" --as world -o "$world"

heading "Opening it in the runtime, and stepping 1024 homes with random actions"
"$bin/galactic-run" "$world"
"$bin/galactic-run" "$world" --envs 1024 --steps 500 --policy random

heading "Solving 32 episodes with a plan"
"$bin/galactic-run" "$world" --envs 32 --steps 500 --policy scripted

phase quickstart-draw "Drawing it" draw

cat <<END

Look at these, in $out/:
  run.html          four robots tidying up: a page for any browser. Space plays.
  world.html        all of the world, to look around in and to take apart.
  plans.png         the apartment from above, once for each of the three sphere radii: the brighter,
                    the more free height a sphere's center has; dark is blocked. North is up.
  plan-r0.05.png    the same for one radius, larger (also plan-r0.015.png and plan-r0.12.png).
  slice.png         the apartment cut open from west to east: coffee table, armchair, the ten boards
                    of the bookshelf, and on the right the loft, free above and below.
  surfaces.ply      the floors and ceilings that the spheres can touch, for any mesh viewer.
  objects.png       the movable objects with the spheres and boxes that stand for them.
  robot.png         the robot, folded as it starts, with its spheres.
  world.pack        the world: it lists apartment.pack, objects.pack, robot.pack and episodes.pack
                    beside it. Try:
    $bin/galactic-pack column $apartment --at 0.3,1.5
    $bin/galactic-pack info $episodes
    $bin/galactic-run $apartment --bench
    $bin/galactic-run $world --steps 1000 --policy forward --record $out/run.rec
    $bin/galactic-run $world --policy replay:$out/run.rec
END
