#!/usr/bin/env bash
# check_arm64.sh [TEST...]: whether the run side does on 64-bit ARM what it does here, bit for bit. Builds it with Debian's
# cross compiler, in build/arm64, plays and draws the sample world on both, emulated there, and compares recordings and
# images; then runs the named test programs, or those of what is computed. Works from any folder. Changes nothing of the
# system but for the packages of compiler and emulator: libraries for ARM go to build/arm64-root.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
cd "$galactic_root"

root=$galactic_root/build/arm64-root
out=build/arm64/compared
world=build/release/sample/world.pack
tests=("$@")
[ $# -gt 0 ] || tests=(batch_determinism_tests collision_tests follow_tests image_noise_tests kinematics_tests motion_tests
  planning_scene_tests policy_tests ray_caster_tests robot_noise_tests saved_state_tests sensors_tests soft_renderer_tests
  task_tests)
libraries=(libc6-dev libstdc++-12-dev libfmt-dev libexpected-dev libflatbuffers-dev libxxhash-dev libcli11-dev libpng-dev
  zlib1g-dev nlohmann-json3-dev libgtest-dev libgmock-dev)

# Packages of another architecture, without a word to the package manager of this system.
fetch_root() {
  local state=$root/var/apt package
  [ ! -f "$root/complete" ] || return 0
  rm -rf "$root"
  mkdir -p "$state/lists/partial" "$state/archives/partial"
  touch "$state/status"
  local apt=(apt-get -qq -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o Dir::State="$state"
    -o Dir::State::status="$state/status" -o Dir::Cache="$state" -o Debug::NoLocking=1 -o APT::Sandbox::User="$(id -un)")
  "${apt[@]}" update
  "${apt[@]}" install -y --download-only --no-install-recommends "${libraries[@]}"
  for package in "$state"/archives/*.deb; do dpkg-deb -x "$package" "$root"; done
  rm -rf "$state"
  touch "$root/complete"
}

arm() { qemu-aarch64 -L "$root" "build/arm64/bin/$1" "${@:2}"; }
here() { "build/release/bin/$1" "${@:2}"; }

# compare NAME OPTION...: of runs with these options, recordings and images.
compare() {
  local name=$1 machine
  shift
  for machine in here arm; do
    rm -rf "$out/$name-$machine"
    mkdir -p "$out/$name-$machine"
    "$machine" galactic-run "$world" --envs 12 --threads 2 --seed 5 --quiet --record "$out/$name-$machine/run.rec" "$@" \
      --render rgbd --backend soft --size 64 --frames "$out/$name-$machine/frames" --frame-every 20
  done
  diff -r "$out/$name-here" "$out/$name-arm"
}

compare_runs() {
  compare random --policy random --steps 200 --motion-noise 0.1 --motion-bias 0.1 --localization-noise 0.1 --action-delay 0-2 \
    --depth-noise 0.005 --color-noise 3 --light-jitter 0.1
  compare sensing --policy forward --steps 100 --laser-beams 32 --laser-noise 0.01 --geodesic --near-objects 4 --target-up
  compare scripted --policy scripted --steps 300
  compare published --policy forward --steps 200 --slide published --continuous-collision
}

run_tests() {
  local test
  for test in "${tests[@]}"; do arm "$test" --gtest_brief=1; done
}

phase arm64-setup "Installing compiler and emulator" scripts/setup.sh g++-12-aarch64-linux-gnu qemu-user
[ -f "$world" ] || scripts/quickstart.sh
phase arm64-root "Fetching libraries for ARM" fetch_root
phase arm64-configure "Configuring" cmake -S . -B build/arm64 -G Ninja -DCMAKE_TOOLCHAIN_FILE=cmake/arm64.cmake \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DGALACTIC_GL=OFF \
  -DGALACTIC_BUILD_BAKE=OFF -DGALACTIC_BUILD_PYTHON=OFF -DGALACTIC_BUILD_BENCHMARKS=OFF
phase arm64-build "Building" cmake --build build/arm64 --target galactic-run "${tests[@]}"
phase arm64-compare "Comparing runs" compare_runs
phase arm64-test "Testing" run_tests
echo "Runs are equal on both, bit for bit, and all tests pass"
