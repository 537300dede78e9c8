#!/usr/bin/env bash
# run_ctest.sh PRESET [ctest options...]: runs the tests of a built preset. Says only what failed, how
# many tests were skipped, and in the last line ctest's verdict.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
cd "$galactic_root"
preset=$1
shift
log=$log_folder/ctest-$preset.log
mkdir -p "$log_folder"

code=0
ctest --preset "$preset" --parallel "$(nproc)" "$@" >"$log" 2>&1 </dev/null || code=$?
if [ "$code" -ne 0 ]; then
  # What passed is of no interest now.
  grep -vE '^ *Start +[0-9]+: |Test +#[0-9]+: .* (Passed|\*\*\*Skipped) ' "$log" | tail -n 300 || true
  printf '   everything ctest said: build/logs/ctest-%s.log\n' "$preset"
fi
skipped=$(grep -c '\*\*\*Skipped ' "$log" || true)
if [ "$skipped" -gt 0 ]; then
  printf '   %d tests skipped, mostly for want of real scenes: see docs/testing.md\n' "$skipped"
fi
grep -E '^Total Test time' "$log" || true
grep -E '^[0-9]+% tests passed' "$log" || echo "ctest ran no tests"
exit "$code"
