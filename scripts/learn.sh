#!/usr/bin/env bash
# learn.sh [TASK] [SEED]: a robot learns to pick things up in the sample apartment, along a path that it
# knows (pick), or without one, by its laser (pick-laser) or its depth camera (pick-depth), or to
# rearrange them (rearrange), and shows what it learned; without a graphics processor. After
# scripts/quickstart.sh; works from any folder. What it makes is in build/release/learn; the worlds lie
# beside the packs that they list.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
cd "$galactic_root"

task=${1:-pick}
seed=${2:-1}
if [[ ! $task =~ ^(pick|pick-laser|pick-depth|rearrange)$ || ! $seed =~ ^[0-9]+$ || $# -gt 2 ]]; then
  echo "learn: found \"$*\", wanted a task, which is pick, pick-laser, pick-depth or rearrange, and a \
seed, a whole number" >&2
  exit 1
fi
preset=quick
[[ $task != pick-* ]] || preset=quick-${task#pick-}
bin=build/release/bin
sample=build/release/sample
out=build/release/learn
run=$out/$task-$seed
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

heading "Drawing episodes: 2000 to learn from, 200 to choose the best policy by, 400 that it never sees"
mkdir -p "$out"
world homes 2000 101
world validation 200 303
world unseen 400 202

# learn RUN OPTION...: one that was interrupted goes on; one that is complete stays as it is.
learn() {
  local run=$1
  shift
  if [ -f "$run/settings.json" ]; then
    /usr/bin/python3 -m galactic.train -o "$run" --resume
  else
    /usr/bin/python3 -m galactic.train "$sample/homes.pack" --preset "$preset" --seed "$seed" \
      --validation "$sample/validation.pack" -o "$run" "$@"
  fi
}

# stage RUN RULES OPTION...: one of the runs that learn to rearrange. Other senses, and what they pay,
# are the preset's.
stage() {
  local run=$1 rules=$2
  shift 2
  learn "$run" --second-closeup 0.04 --validate-every 2e6 "$@" --simulation "task=rearrange \
episode-steps=500 observe-current target-goal target-up tilt-penalty=0.1 $rules"
}

# Three runs. Each begins with what the one before has learned, and its rules are stricter.
learn_to_rearrange() {
  heading "1 of 3: to carry. Away from the goal the hand keeps the target; to let go there costs little"
  # A hand that were sure to stay closed would not find out that letting go at the goal pays.
  stage "$run/1" "no-terminate safe-drop drop-penalty=0.05" --steps 16e6 --learning-rate 2e-3 \
    --target-kl 0.02 --odds-limit 4
  heading "2 of 3: to say when it is done"
  stage "$run/2" "safe-drop drop-penalty=0.5" --start-from "$run/1/best.pt" --steps 8e6 \
    --target-kl 0.03 --initial-log-std -1.4 --final-log-std -1.7
  heading "3 of 3: the paper's rules. Letting go elsewhere ends the episode"
  stage "$run/3" "" --start-from "$run/2/best.pt" --steps 50e6 --target-kl 0.015 \
    --initial-log-std -1.7 --final-log-std -2.6
  run=$run/3
}

if [ "$task" = rearrange ]; then
  learn_to_rearrange
else
  heading "Learning to pick (preset $preset)"
  learn "$run"
fi

heading "Playing each unseen episode once: sampled actions, then the likeliest"
/usr/bin/python3 -m galactic.evaluate "$run/best.pt" "$sample/unseen.pack" \
  --report "$run/unseen.json" --contact-sheet "$run/unseen.png"
/usr/bin/python3 -m galactic.evaluate "$run/best.pt" "$sample/unseen.pack" --deterministic \
  --report "$run/unseen-deterministic.json"

heading "The same policy without Python: the likeliest actions in each unseen episode once"
/usr/bin/python3 -m galactic.export "$run/best.pt" -o "$run/policy.pack"
"$bin/galactic-run" "$sample/unseen.pack" --policy "$run/policy.pack" --deterministic \
  --order partition --envs 64 --steps 100000
"$bin/galactic-run" "$sample/unseen.pack" --policy "$run/policy.pack" --envs 8 --steps 300 \
  --view "$run/run.html" --view-envs 8 >"$run/run.txt"
if [ "$task" = pick-depth ]; then
  "$bin/galactic-run" "$sample/unseen.pack" --policy "$run/policy.pack" --envs 4 --steps 40 \
    --render rgbd --contact-sheet "$run/camera.png" >"$run/camera.txt"
fi

cat <<END

Look at these, in $run/:
  curves.html    success, return and losses while it learned; open it in a browser
  run.html       eight homes to watch: play, scrub, look around; open it in a browser
  unseen.png     moments of episodes that it had never seen: successes and failures
  unseen.json    all 400 of them, with path and ending
  best.pt        the policy, for Python
  policy.pack    the policy, for galactic-run
END
if [ "$task" = pick-depth ]; then
  echo "  camera.png     what the camera of four robots showed, its depth on the right"
fi
