#!/usr/bin/env bash
# Installs what is needed, builds the tools, bakes the sample apartment, opens it in the runtime and
# draws it. Works from any folder; what it makes is in build/release.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
cd "$galactic_root"

bin=build/release/bin
out=build/release/sample
pack=$out/world.pack
radii=(0.015 0.05 0.12)

# From west to east: coffee table, armchair, the ten boards of the bookshelf, the loft.
slice=-4,1.5,3.9,1.5

draw() {
  local radius
  "$bin/galactic-pack" picture "$pack" -o "$out/plans.png"
  for radius in "${radii[@]}"; do
    "$bin/galactic-pack" picture "$pack" --radius "$radius" -o "$out/plan-r$radius.png"
  done
  "$bin/galactic-pack" picture "$pack" --slice "$slice" --radius 0.015 -o "$out/slice.png"
  "$bin/galactic-pack" export "$pack" --radius 0.05 --surface -o "$out/surfaces.ply"
}

phase setup "Installing packages" scripts/setup.sh
phase quickstart-configure "Configuring (preset release)" cmake --preset release
phase quickstart-build "Building the tools" \
  cmake --build --preset release --target galactic-bake galactic-run galactic-pack

heading "Baking packs/sample/apartment.glb"
mkdir -p "$out"
"$bin/galactic-bake" packs/sample/apartment.glb -o "$pack" --radii "$(IFS=,; echo "${radii[*]}")"

heading "Opening it in the runtime"
"$bin/galactic-run" --pack "$pack"

phase quickstart-draw "Drawing it" draw

cat <<END

Look at these, in $out/:
  plans.png         the apartment from above, once for each of the three sphere radii: the brighter,
                    the more free height a sphere's centre has; dark is blocked. North is up.
  plan-r0.05.png    the same for one radius, larger (also plan-r0.015.png and plan-r0.12.png).
  slice.png         the apartment cut open from west to east: coffee table, armchair, the ten boards
                    of the bookshelf, and on the right the loft, free above and below.
  surfaces.ply      the floors and ceilings that the spheres can touch, for any mesh viewer.
  world.pack        the pack itself. Try:
    $bin/galactic-pack column $pack --at 0.3,1.5
    $bin/galactic-run --pack $pack --bench
END
