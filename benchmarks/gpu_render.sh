#!/usr/bin/env bash
# Images per second of the OpenGL backend on a graphics processor, for batches of 128, 512 and 2048 envs:
# 128 x 128 pixels, color and depth, in the caller's memory.
#
#   benchmarks/gpu_render.sh [BUILD_FOLDER] [DEVICE]
#
# DEVICE as in RenderOptions::device: cuda:0, an index, a UUID; the first graphics processor without it.
# GALACTIC_RENDER_WORLD=world.pack draws a world that was baked instead of the home made in code.
# share_setup and share_copy are the processor's parts of the time (lists of instances and commands; copy
# to the caller), share_draw and share_readback those of the graphics processor, by timer queries. They
# overlap, so they may add up to more than 1; the largest is what bounds the rate.
set -euo pipefail
build=${1:-build/release}
program=$build/bin/render_gl
[ -x "$program" ] || {
  echo "gpu_render.sh: found no $program; build the target render_gl first" >&2
  exit 2
}
GALACTIC_RENDER_DEVICE=${2:-} "$program" --benchmark_filter='^gl/(128|512|2048)/' \
  --benchmark_min_time=2 --benchmark_counters_tabular=true
