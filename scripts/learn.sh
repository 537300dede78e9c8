#!/usr/bin/env bash
# learn.sh [SEED]: a robot learns to pick things up in the sample apartment, without a camera or a
# graphics processor, and shows what it learned. After scripts/quickstart.sh; works from any folder.
# What it makes is in build/release/learn; the worlds lie beside the packs that they list.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
cd "$galactic_root"

seed=${1:-1}
bin=build/release/bin
sample=build/release/sample
out=build/release/learn
run=$out/seed-$seed
packs=("$sample/apartment.pack" "$sample/objects.pack" "$sample/robot.pack")
export PYTHONPATH=build/release/python

for pack in "${packs[@]}"; do
  if [ ! -f "$pack" ]; then
    echo "learn: $pack is not there; run scripts/quickstart.sh first" >&2
    exit 2
  fi
done

# world NAME EPISODES SEED: a world of the sample's packs with episodes of its own.
world() {
  local name=$1 count=$2 episode_seed=$3
  "$bin/galactic-bake" "${packs[@]}" --as episodes --count "$count" --seed "$episode_seed" \
    -o "$sample/$name-episodes.pack"
  "$bin/galactic-bake" "${packs[@]}" "$sample/$name-episodes.pack" --as world -o "$sample/$name.pack"
}

phase learn-configure "Configuring (preset release)" cmake --preset release
phase learn-build "Building the Python package" \
  cmake --build --preset release --target galactic-bake galactic-run galactic_python

heading "Drawing episodes: 2000 to learn from, 400 that it never sees"
mkdir -p "$out"
world homes 2000 101
world unseen 400 202

heading "Learning to pick (preset quick)"
if [ -f "$run/settings.json" ]; then
  # A run that was interrupted goes on; one that is complete stays as it is.
  /usr/bin/python3 -m galactic.train -o "$run" --resume
else
  /usr/bin/python3 -m galactic.train "$sample/homes.pack" --preset quick --seed "$seed" \
    --validation "$sample/unseen.pack" -o "$run"
fi

heading "Playing each unseen episode once: sampled actions, then the likeliest"
/usr/bin/python3 -m galactic.evaluate "$run/best.pt" "$sample/unseen.pack" \
  --report "$run/unseen.json" --contact-sheet "$run/unseen.png"
/usr/bin/python3 -m galactic.evaluate "$run/best.pt" "$sample/unseen.pack" --deterministic \
  --report "$run/unseen-deterministic.json"

heading "The same policy without Python: the likeliest actions in each unseen episode once"
/usr/bin/python3 -m galactic.export "$run/best.pt" -o "$run/picker.pack"
"$bin/galactic-run" "$sample/unseen.pack" --policy "$run/picker.pack" --deterministic \
  --order partition --envs 64 --steps 100000
"$bin/galactic-run" "$sample/unseen.pack" --policy "$run/picker.pack" --envs 8 --steps 300 \
  --view "$run/run.html" --view-envs 8 >"$run/run.txt"

cat <<END

Look at these, in $run/:
  curves.html    success, return and losses while it learned; open it in a browser
  run.html       eight homes to watch: play, scrub, look around; open it in a browser
  unseen.png     moments of episodes that it had never seen: successes and failures
  unseen.json    all 400 of them, with path and ending
  best.pt        the policy, for Python
  picker.pack    the policy, for galactic-run
END
