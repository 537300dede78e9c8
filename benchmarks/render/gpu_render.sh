#!/usr/bin/env bash
# Images per second of the CUDA and the OpenGL backend on a graphics processor: color and depth, read back to the
# processor and left on the device, for batches of 128, 512, 2048 and 8192 envs. Takes some five minutes.
#
#   benchmarks/render/gpu_render.sh [BUILD_FOLDER] [DEVICE] [SECONDS]
#
# DEVICE as in RenderOptions::device: cuda:0, a UUID; the first graphics processor without it. SECONDS for each
# measurement (1). GALACTIC_RENDER_WORLD=world.pack draws a world that was baked instead of the home made in code.
#
# cuda_read, cuda_stay: by views and pixels along an edge; read back, or left on the device.
# cuda_shares: the same with a wait after each kernel, and what part of the time each took.
# gl: 128 x 128 pixels, read back. share_setup and share_copy are the processor's parts of the time (lists of
# instances and commands; copy to the caller), share_draw and share_readback those of the graphics processor, by timer
# queries. They overlap, so they may add up to more than 1; the largest is what bounds the rate.
# gl_stay: OpenGL's images in CUDA's memory.
set -euo pipefail
build=${1:-build/release}
program=$build/bin/render_gl
[ -x "$program" ] || {
  echo "gpu_render.sh: found no $program; build the target render_gl first" >&2
  exit 2
}
export GALACTIC_RENDER_DEVICE=${2:-}
for backend in 'cuda_(read|stay|shares)/' 'gl/(128|512|2048)/' 'gl_stay/'; do
  "$program" --benchmark_filter="^$backend" --benchmark_min_time="${3:-1}" --benchmark_counters_tabular=true
done
