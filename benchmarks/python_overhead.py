#!/usr/bin/env python3
"""What Python costs: its loop against that of galactic-run, with random actions and without images.

    PYTHONPATH=build/release/python benchmarks/python_overhead.py build/release/bin/galactic-run WORLD.pack

Both are whole processes that open the world, and step it twice: the processor time of a step is that of
the longer run less that of the shorter one, user and system. They take turns, so that what else the
machine does meets both.
"""

import argparse
import os
import statistics
import subprocess
import sys

# As the policy `random` of galactic-run acts: from -1 to 1, terminating once in 500 steps.
ACT = """
def act(random, envs, count):
    actions = random.random((envs, count), np.float32) * 2 - 1
    actions[:, -1] = random.random(envs, np.float32) < 1 / 500
    return actions
"""
LOOPS = {
    "Simulator": f"""
import sys, numpy as np, galactic
{ACT}
path, envs, steps, threads = sys.argv[1], *map(int, sys.argv[2:])
one = galactic.Simulator(galactic.World(path), envs=envs, threads=threads)
random = np.random.default_rng(1)
for _ in range(steps):
    one.step(act(random, envs, one.action_count))
""",
    "VectorEnv": f"""
import sys, numpy as np, galactic
{ACT}
path, envs, steps, threads = sys.argv[1], *map(int, sys.argv[2:])
env = galactic.VectorEnv(path, envs, threads=threads, copy=False)
env.reset()
random = np.random.default_rng(1)
for _ in range(steps):
    env.step(act(random, *env.action_space.shape))
""",
}


def processor_seconds(command: list[str]) -> float:
    before = os.times()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = os.times()
    user = after.children_user - before.children_user
    return user + after.children_system - before.children_system


def command_of(name: str, options: argparse.Namespace, steps: int) -> list[str]:
    numbers = [str(options.envs), str(steps), str(options.threads)]
    if name in LOOPS:
        return [sys.executable, "-c", LOOPS[name], options.world, *numbers]
    return [options.galactic_run, "--pack", options.world, "--envs", numbers[0], "--steps",
            numbers[1], "--threads", numbers[2], "--policy", "random"]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("galactic_run")
    parser.add_argument("world")
    parser.add_argument("--envs", type=int, default=1024)
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    names = ["galactic-run", *LOOPS]
    rates: dict[str, list[float]] = {name: [] for name in names}
    for _ in range(options.rounds):
        for name in names:
            short, long = (
                processor_seconds(command_of(name, options, steps))
                for steps in (options.steps // 10, options.steps)
            )
            steps = (options.steps - options.steps // 10) * options.envs
            rates[name].append((long - short) / steps * 1e9)
    base = rates["galactic-run"]
    print(f"{options.envs} envs, {options.threads} threads: nanoseconds of the processor a step")
    for name, values in rates.items():
        ratio = statistics.median(one / other for one, other in zip(values, base))
        print(f"  {name:14} {statistics.median(values):8.0f}   {ratio:5.3f} of galactic-run")


if __name__ == "__main__":
    main()
