#!/usr/bin/env bash
# Installs what is needed, builds everything and runs the tests. Works from any folder. The last line is
# ctest's verdict.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
cd "$galactic_root"

phase setup "Installing packages" scripts/setup.sh
phase test-configure "Configuring (preset release)" cmake --preset release
phase test-build "Building" cmake --build --preset release
heading "Testing"
scripts/run_ctest.sh release
