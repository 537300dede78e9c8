#!/usr/bin/env bash
# build_pgo.sh [WORLD.pack]: the run side and the Python package in build/pgo, optimized by what they do when they step,
# draw and sense the sample world, or WORLD. Works from any folder. With Clang 19, whose packages it installs.
#
# Builds twice, two minutes each on two cores: programs that record, which play the world, then those to use.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
world=$(realpath -- "${1:-$galactic_root/build/release/sample/world.pack}")
cd "$galactic_root"

recorder=build/pgo-record
bin=$recorder/bin
counts=$recorder/profile

# What has to be fast: code that the record does not reach counts as cold. Steps take most of the time in use, so they
# are played for longer than images are drawn.
record() {
  local run=("$bin/galactic-run" "$world" --envs 128 --threads 1 --quiet)
  rm -rf "$counts"
  "${run[@]}" --policy random --steps 30000 &&
    "${run[@]}" --policy forward --steps 30000 &&
    "${run[@]}" --policy forward --steps 3000 --slide published &&
    "${run[@]}" --policy forward --steps 3000 --continuous-collision --body-transforms &&
    "${run[@]}" --policy random --steps 3000 --laser-beams 64 --near-objects 4 --bump --target-goal &&
    "${run[@]}" --policy scripted --steps 500 &&
    "${run[@]}" --policy random --steps 8 --render rgbd --backend soft &&
    "${run[@]}" --policy random --steps 8 --render depth --size 64 --backend soft &&
    "$bin/learned_policy" --benchmark_min_time=0.05 &&
    llvm-profdata-19 merge -o "$recorder/galactic.profdata" "$counts"/*.profraw
}

# play FOLDER RULE: what 96 envs that drive into everything do by a slide rule, and what they see.
play() {
  local played=$recorder/played/$(basename "$1")-$2
  mkdir -p "$played"
  "$1/bin/galactic-run" "$world" --envs 96 --steps 300 --policy forward --slide "$2" --quiet --record "$played/run.rec" \
    --render rgbd --backend soft --size 64 --frames "$played" --frame-every 100
}

# Every build has the same results, bit for bit.
compare() {
  local rule
  rm -rf "$recorder/played"
  for rule in glide published; do
    play "$recorder" "$rule" && play build/pgo "$rule" &&
      diff -r "$recorder/played/pgo-record-$rule" "$recorder/played/pgo-$rule" || return
  done
}

if [ $# -gt 0 ] && [ ! -f "$world" ]; then
  echo "build_pgo.sh: found no file \"$1\", expected a pack of a world" >&2
  exit 2
fi
phase pgo-setup "Installing packages" scripts/setup.sh clang-19 libclang-rt-19-dev lld-19 llvm-19
[ -f "$world" ] || scripts/quickstart.sh
phase pgo-record-configure "Configuring (preset pgo-record)" cmake --preset pgo-record
phase pgo-record-build "Building programs that record" \
  cmake --build --preset pgo-record --target galactic-run learned_policy
phase pgo-record "Stepping, drawing and sensing $world" record
phase pgo-configure "Configuring (preset pgo)" cmake --preset pgo
phase pgo-build "Building by that record" cmake --build --preset pgo
phase pgo-compare "Comparing results" compare
