#!/usr/bin/env bash
# learn.sh [TASK] [SEED]: a robot learns to pick things up in the sample apartment (pick), or to rearrange
# them (rearrange), along a path that it knows; or without one, from a robot that knows it, by its laser
# (pick-laser, rearrange-laser) or its depth camera (pick-depth, rearrange-depth). Shows what it learned;
# without a graphics processor. After scripts/quickstart.sh; works from any folder. What it makes is in
# build/release/learn; the worlds lie beside the packs that they list.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/phases.sh"
cd "$galactic_root"

task=${1:-pick}
seed=${2:-1}
if [[ ! $task =~ ^(pick|rearrange)(-laser|-depth)?$ || ! $seed =~ ^[0-9]+$ || $# -gt 2 ]]; then
  echo "learn: found \"$*\", wanted a task, which is pick, pick-laser, pick-depth, rearrange, \
rearrange-laser or rearrange-depth, and a seed, a whole number" >&2
  exit 1
fi
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

# What the world to learn in consists of: the same bytes make the same runs.
world_sum() { cat "${packs[@]}" "$sample/homes-episodes.pack" | sha256sum | cut -d ' ' -f 1; }

# learn RUN PRESET OPTION...: one that was interrupted goes on; one that is complete stays as it is. One of
# another world, which an earlier version made, is set aside.
learn() {
  local run=$1 preset=$2
  shift 2
  if [ -f "$run/settings.json" ] && [ "$(cat "$run/world.sha256" 2>/dev/null)" != "$(world_sum)" ]; then
    local aside=$run-of-another-world
    while [ -e "$aside" ]; do aside+=-before; done
    echo "learn: $run is of another world, or of an earlier version; it is in $aside now"
    mv "$run" "$aside"
  fi
  mkdir -p "$run"
  world_sum >"$run/world.sha256"
  if [ -f "$run/settings.json" ]; then
    /usr/bin/python3 -m galactic.train -o "$run" --resume
  else
    /usr/bin/python3 -m galactic.train "$sample/homes.pack" --preset "$preset" --seed "$seed" \
      --validation "$sample/validation.pack" -o "$run" "$@"
  fi
}

learn_to_pick() {
  heading "Learning to pick, along a path that it knows (preset quick)"
  learn "$out/pick-$seed" quick
}

# rearrange RUN PRESET RULES OPTION...: a run that learns to rearrange. Other senses, and what they pay,
# are the preset's.
rearrange() {
  local run=$1 preset=$2 rules=$3
  shift 3
  learn "$run" "$preset" --second-closeup 0.04 --validate-every 2e6 "$@" --simulation "task=rearrange \
episode-steps=500 observe-current target-goal target-up tilt-penalty=0.1 $rules"
}

# Three runs. Each begins with what the one before has learned, and its rules are stricter.
learn_to_rearrange() {
  local run=$out/rearrange-$seed
  heading "1 of 3: to carry. Away from the goal the hand keeps the target; to let go there costs little"
  # A hand that were sure to stay closed would not find out that letting go at the goal pays.
  rearrange "$run/1" quick "no-terminate safe-drop drop-penalty=0.05" --steps 16e6 \
    --learning-rate 2e-3 --target-kl 0.02 --odds-limit 4
  heading "2 of 3: to say when it is done"
  rearrange "$run/2" quick "safe-drop drop-penalty=0.5" --start-from "$run/1/best.pt" --steps 8e6 \
    --target-kl 0.03 --initial-log-std -1.4 --final-log-std -1.7
  heading "3 of 3: the paper's rules. Letting go elsewhere ends the episode"
  rearrange "$run/3" quick "" --start-from "$run/2/best.pt" --steps 50e6 --target-kl 0.015 \
    --initial-log-std -1.7 --final-log-std -2.6
}

run=$out/$task-$seed
case $task in
  pick)
    learn_to_pick
    ;;
  pick-*)
    learn_to_pick
    preset=quick-${task#pick-}
    heading "Learning the same without the path, from the one that knows it (preset $preset)"
    learn "$run" "$preset" --teacher "$out/pick-$seed/best.pt"
    ;;
  rearrange)
    learn_to_rearrange
    run=$run/3
    ;;
  rearrange-*)
    learn_to_rearrange
    preset=quick-${task#rearrange-}
    # By the camera a step takes three times as long.
    steps=16e6
    [ "$preset" = quick-laser ] || steps=12e6
    heading "Learning the same without the path, from the one that knows it (preset $preset)"
    rearrange "$run" "$preset" "" --teacher "$out/rearrange-$seed/3/best.pt" --teacher-share 1 \
      --steps "$steps" --initial-log-std -1.2 --final-log-std -2.6
    ;;
esac

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
if [[ $task == *-depth ]]; then
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
if [[ $task == *-depth ]]; then
  echo "  camera.png     what the camera of four robots showed, its depth on the right"
fi
