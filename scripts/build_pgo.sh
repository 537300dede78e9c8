#!/usr/bin/env bash
# build_pgo.sh [WORLD.pack [TARGET...]]: the run side and the Python package in build/pgo, or only galactic-run and these
# targets of them, optimized by what they do when they step, draw and sense the sample world, or WORLD. Works from any
# folder. With Clang 19, whose packages it installs.
#
# Builds twice, one and two minutes on two cores: programs that record, which play the world, then those to use. What the
# same programs recorded in the same world is taken from the user's cache: another record would count a little otherwise,
# and everything would be compiled anew by it.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
world=$(realpath -m -- "${1:-$galactic_root/build/release/sample/world.pack}")
targets=(galactic-run "${@:2}")
[ $# -gt 1 ] || targets=(all)
cd "$galactic_root"

recorder=build/pgo-record
bin=$recorder/bin
counts=$recorder/profile
# Where programs that record leave what they counted: all runs of one in one file.
export LLVM_PROFILE_FILE=$galactic_root/$counts/%m.profraw
records=${XDG_CACHE_HOME:-$HOME/.cache}/galactic/profiles

# What learning senses beside the robot's own state.
sensors=(--bump --target-goal --target-up --observe-current --near-objects 4 --geodesic --geodesic-weight 1)
laser=(--laser-beams 32 --laser-heights 0.25,0.4-0.8 --laser-noise 0.01)

# What has to be fast: code that the record does not reach counts as cold. Steps take most of the time in use, so they
# are played for longer than images are drawn.
record() {
  local run=("$bin/galactic-run" "$world" --envs 128 --quiet --threads)
  rm -rf "$counts"
  "${run[@]}" 1 --policy random --steps 30000 &&
    "${run[@]}" 1 --policy forward --steps 30000 &&
    "${run[@]}" 2 --policy random --steps 3000 &&
    "${run[@]}" 1 --policy forward --steps 3000 --slide published &&
    "${run[@]}" 1 --policy forward --steps 3000 --continuous-collision --body-transforms &&
    "${run[@]}" 1 --policy random --steps 3000 "${sensors[@]}" &&
    if_possible "${run[@]}" 1 --policy random --steps 3000 "${sensors[@]}" "${laser[@]}" &&
    if_possible "${run[@]}" 1 --policy scripted --steps 500 --task rearrange &&
    if_possible "${run[@]}" 1 --policy random --steps 8 --render rgbd --backend soft &&
    if_possible "${run[@]}" 1 --policy random --steps 8 --render depth --size 64 --backend soft &&
    "$bin/learned_policy" --benchmark_min_time=0.05 &&
    llvm-profdata-19 merge -o "$recorder/galactic.profdata" "$counts"/*.profraw
}

# The record of these programs, this script, this world and this kind of processor: made, where there is none.
recorded() {
  local key
  key=$({ cat "$bin/galactic-run" "$bin/learned_policy" scripts/build_pgo.sh "$world"; grep -m 1 flags /proc/cpuinfo; } | sha256sum)
  local kept=$records/${key%% *}.profdata
  if [ -f "$kept" ]; then
    cp "$kept" "$recorder/galactic.profdata"
    return
  fi
  record && mkdir -p "$records" && cp "$recorder/galactic.profdata" "$kept.$$" && mv "$kept.$$" "$kept"
}

# A robot may have no place for a laser, packs no meshes to draw: what cannot be played in this world (exit codes 3 and
# 5) is not recorded.
if_possible() {
  local code=0
  "$@" || code=$?
  [[ $code =~ ^(0|3|5)$ ]]
}

# play FOLDER: what 96 envs do by each slide rule, what they sense, and what they see.
play() {
  local rule played
  for rule in glide published; do
    played=$recorder/played/$(basename "$1")/$rule
    mkdir -p "$played"
    "$1/bin/galactic-run" "$world" --envs 96 --steps 300 --policy forward --slide "$rule" "${sensors[@]}" --quiet \
      --record "$played/run.rec" || return
    if_possible "$1/bin/galactic-run" "$world" --envs 16 --steps 100 --quiet --render rgbd --backend soft --size 64 \
      --frames "$played" --frame-every 50 || return
  done
}

# Every build has the same results, bit for bit: that of the preset `release`, too, where there is one.
compare() {
  rm -rf "$recorder/played"
  play "$recorder" && play build/pgo && diff -r "$recorder/played/pgo-record" "$recorder/played/pgo" || return
  [ -f build/release/build.ninja ] || return 0
  cmake --build --preset release --target galactic-run && play build/release &&
    diff -r "$recorder/played/release" "$recorder/played/pgo"
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
phase pgo-record "Stepping, drawing and sensing $world" recorded
phase pgo-configure "Configuring (preset pgo)" cmake --preset pgo
phase pgo-build "Building by that record" cmake --build --preset pgo --target "${targets[@]}"
phase pgo-compare "Comparing results" compare
