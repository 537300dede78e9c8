#!/usr/bin/env bash
# All that is to be known of the CUDA and the OpenGL backend on a graphics processor, in less than eight minutes:
# images per second, where the time goes, whether the images are those of the processor, and how fast simulation and
# training are with them.
#
#   benchmarks/render/gpu_render.sh [BUILD_FOLDER] [DEVICE] [SECONDS]
#
# DEVICE as in RenderOptions::device: cuda:0, a UUID; the first graphics processor without it. SECONDS for each
# measurement (0.5). Build the targets render_gl and galactic-run first; with the Python package and torch, training is
# measured, too. With the DEVICE "software", gl draws on the processor; the tests' stand-in for CUDA's driver then lets
# the whole script be tried without a device (docs/rendering/cuda.md). Variables:
#
#   GALACTIC_RENDER_WORLD   draw, simulate and train in this world instead of drawing the home made in code
#   GALACTIC_RENDER_VIEWS   sizes of the batches, of 8, 128, 512, 2048 and 8192 ("128|512|2048|8192")
#   GALACTIC_RENDER_STEPS   steps of the simulation (50)
#   GALACTIC_RENDER_TRAIN   options of benchmarks/learning/training_speed.py ("--updates 4")
#   PYTHON                  the interpreter that has torch (python3)
#
# What is printed, by views and pixels along an edge:
# same_as_soft: compares the images of cuda with those of the processor, byte by byte.
# cuda_read, cuda_stay: read back, or left on the device.
# cuda_shares: the same with a wait after each kernel, and what part of the time each took.
# gl_read: read back. share_setup and share_copy are the processor's parts of the time (lists of instances and commands; copy
# to the caller), share_draw and share_readback those of the graphics processor, by timer queries. They overlap, so they
# may add up to more than 1; the largest is what bounds the rate.
# gl_stay: OpenGL's images in CUDA's memory.
#
# Exit code: 0; 2 where a program is missing; 7 where images differ or the sanitizer finds something.
set -uo pipefail
build=${1:-build/release}
device=${2:-}
seconds=${3:-0.5}
views=${GALACTIC_RENDER_VIEWS:-128|512|2048|8192}
world=${GALACTIC_RENDER_WORLD:-}
program=$build/bin/render_gl
runner=$build/bin/galactic-run
for needed in "$program" "$runner"; do
  [ -x "$needed" ] || {
    echo "gpu_render.sh: found no $needed; build the targets render_gl and galactic-run first" >&2
    exit 2
  }
done
export GALACTIC_RENDER_DEVICE=$device
code=0
log=$(mktemp)
trap 'rm -f "$log"' EXIT

heading() { printf '\n== %s (%d s)\n' "$1" "$SECONDS"; }

# limited SECONDS COMMAND...: what takes longer is cut off, so that all of it takes less than eight minutes.
limited() {
  timeout "$@"
  local status=$?
  [ "$status" != 124 ] || echo "gpu_render.sh: cut off after $1 s"
  return "$status"
}

# measure SECONDS FILTER
measure() {
  limited "$1" "$program" --benchmark_filter="$2" --benchmark_min_time="$seconds" --benchmark_counters_tabular=true
}

# Prints what a check prints, and remembers that it failed.
check() {
  if ! "$@" >"$log" 2>&1 || grep -q 'ERROR OCCURRED' "$log"; then code=7; fi
  cat "$log"
}

heading "The same images as on the processor"
check measure 45 '^same_as_soft/'

heading "compute-sanitizer"
if command -v compute-sanitizer >/dev/null; then
  for tool in memcheck racecheck; do
    check limited 30 compute-sanitizer --tool "$tool" --error-exitcode 7 \
      "$program" --benchmark_filter='^same_as_soft/8/' --benchmark_min_time=0.01
  done
else
  echo "not on this machine; NVIDIA's toolkit has it"
fi

for name in cuda_read cuda_stay cuda_shares gl_read gl_stay; do
  heading "$name"
  measure 35 "^$name/($views)/(64|128)/"
done

heading "With the simulation"
if [ -n "$world" ]; then
  for backend in cuda gl; do
    for envs in ${views//|/ }; do
      wish=$device
      # It has no software driver.
      [ "$backend $device" = "cuda software" ] && wish=""
      limited 12 "$runner" "$world" --policy random --steps "${GALACTIC_RENDER_STEPS:-50}" --envs "$envs" --render rgbd \
        --backend "$backend" ${wish:+--device "$wish"} || echo "gpu_render.sh: $backend does not draw $envs envs here"
    done
  done
else
  echo "GALACTIC_RENDER_WORLD names no world"
fi

heading "With training"
if [ -z "$world" ]; then
  echo "GALACTIC_RENDER_WORLD names no world"
elif ! PYTHONPATH=$build/python "${PYTHON:-python3}" -c 'import galactic, torch' 2>"$log"; then
  tail -n 1 "$log"
else
  # shellcheck disable=SC2086 # several words
  PYTHONPATH=$build/python limited 90 "${PYTHON:-python3}" "$(dirname "$0")/../learning/training_speed.py" "$world" \
    ${GALACTIC_RENDER_TRAIN:---updates 4} || echo "gpu_render.sh: training failed"
fi
heading "Done"
exit "$code"
