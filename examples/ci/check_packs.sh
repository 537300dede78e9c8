#!/usr/bin/env bash
# Bakes packs and checks them, as a CI job does. Copy it into your repository and change the part between the
# two lines; see docs/ci.md.
#
#     check_packs.sh [--update] OUT [NAME...]
#
# OUT receives packs, reports and the JUnit report. NAMEs choose from the bakes; without them all are made, and
# the world. --update writes the golden reports instead of comparing with them.
# From the environment: GALACTIC_BIN, the folder of the tools (else they are on the PATH), and GOLDEN, the
# folder of the golden reports.
# The exit code is that of the first step that failed; the steps after it run nevertheless.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
golden=${GOLDEN:-$root/examples/ci/golden}

# ---------------------------------------------------------------------------------------------------- change
names=(apartment objects porter crate)
declare -A bakes=(
  [apartment]="packs/sample/apartment.glb --check-columns 0"
  [objects]="packs/sample/objects --as object"
  [porter]="packs/sample/robot/porter.urdf --recipe packs/sample/robot/robot.toml"
  [crate]="packs/golden/crate.obj --as object"
)
# What goes into the world, and how its episodes are sampled.
world=(apartment objects porter)
episodes="--count 20 --seed 7"
# Packs that have to be what they were, in what is simulated.
declare -A golden_packs=([crate]=packs/golden/crate.pack)
# ---------------------------------------------------------------------------------------------------- change

update=false
if [ "${1:-}" = --update ]; then
  update=true
  shift
fi
if [ $# -lt 1 ]; then
  echo "usage: check_packs.sh [--update] OUT [NAME...]" >&2
  exit 1
fi
mkdir -p "$1" || exit 2
out=$(cd "$1" && pwd)
shift
chosen=("$@")
[ $# -gt 0 ] || chosen=("${names[@]}")
failed=0

# step TITLE COMMAND...: remembers the first failure.
step() {
  local title=$1 code=0
  shift
  printf '== %s\n' "$title"
  "$@" || code=$?
  [ "$code" -eq 0 ] || printf '   failed with exit code %d\n' "$code"
  [ "$failed" -ne 0 ] || failed=$code
}

tool() {
  local name=$1
  shift
  "${GALACTIC_BIN:+$GALACTIC_BIN/}$name" "$@"
}

# bake NAME ARGUMENT...: makes OUT/NAME.pack and compares its report, or keeps it.
bake() {
  local name=$1
  shift
  step "bake $name" tool galactic-bake "$@" -o "$out/$name.pack" --quiet --report "$out/$name.json"
  if [ "$update" = true ]; then
    keep_report "$name"
  else
    step "compare the report of $name" tool galactic-pack diff "$golden/$name.json" "$out/$name.json"
  fi
}

# keep_report NAME: as the golden one, which says nothing of this machine.
keep_report() {
  local text
  text=$(<"$out/$1.json") && printf '%s\n' "${text//"$out/"/}" >"$golden/$1.json"
}

cd "$root" || exit 2
for name in "${chosen[@]}"; do
  if [ -z "${bakes[$name]:-}" ]; then
    echo "check_packs.sh: $name is none of ${names[*]}" >&2
    exit 1
  fi
  # Arguments are separated by blanks.
  # shellcheck disable=SC2086
  bake "$name" ${bakes[$name]}
done
if [ $# -eq 0 ]; then
  parts=()
  for name in "${world[@]}"; do parts+=("$out/$name.pack"); done
  # shellcheck disable=SC2086
  bake episodes "${parts[@]}" --as episodes $episodes
  step "link world" tool galactic-bake "${parts[@]}" "$out/episodes.pack" --as world -o "$out/world.pack" --quiet
fi
step "check packs" tool galactic-pack check "$out" --junit "$out/packs.xml"
for name in "${chosen[@]}"; do
  [ -n "${golden_packs[$name]:-}" ] || continue
  step "compare $name" tool galactic-pack diff --content-only "${golden_packs[$name]}" "$out/$name.pack"
done
exit "$failed"
