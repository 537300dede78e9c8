#!/usr/bin/env bash
# Instructions and simulated cache misses per env-step on the workload of batch_steps. They depend on no neighbor, so
# they compare builds on a busy machine. Needs valgrind.
#
#   benchmarks/simulation/count_instructions.sh WORLDS [BUILD_FOLDER]...
#
# WORLDS: what make_published_world.sh made. LOADS, ENVS and STEPS in the environment choose what is played.
# The caches: 32 kB of the first level for data, 1 MB of the second, as the last that is simulated.
set -euo pipefail
worlds=$1
shift
[ $# -gt 0 ] || set -- build/release
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
printf '%-9s%6s  %12s %8s %8s  %s\n' load envs instructions L1 L2 build
for envs in ${ENVS:-128 4096}; do
  for load in ${LOADS:-random forward held}; do
    world=$worlds/world.pack
    [ "$load" = held ] && world=$worlds/held_world.pack
    for build in "$@"; do
      played=$(valgrind --tool=callgrind --callgrind-out-file="$out/callgrind" --cache-sim=yes \
        --D1=32768,8,64 --LL=1048576,16,64 --toggle-collect='galactic::published_workload::playMeasured*' \
        "$build/bin/play_workload" "$world" "$load" "$envs" "${STEPS:-300}" 2>/dev/null)
      # Ir Dr Dw I1mr D1mr D1mw ILmr DLmr DLmw
      sed -n 's/^summary: //p' "$out/callgrind" | awk -v load="$load" -v envs="$envs" -v build="$build" -v \
        steps="${played%% *}" '{
          printf "%-9s%6d  %12.0f %8.1f %8.1f  %s\n", load, envs, $1 / steps, ($5 + $6) / steps, ($8 + $9) / steps, build}'
      echo "$played" | sed 's/^[^,]*, /                                                /'
    done
  done
done
