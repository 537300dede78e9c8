#!/usr/bin/env python3
"""What Python costs: its loop against that of galactic-run, with random actions and without images.

    PYTHONPATH=build/release/python benchmarks/learning/python_overhead.py build/release/bin/galactic-run WORLD.pack

Each is a whole process that opens the world and steps it, once for long and once for short: the processor
time of a step is that of the longer run less that of the shorter one, user and system. They take turns, so
that what else the machine does meets all. What numpy takes to draw the actions is measured on its own.
"""

import argparse
import resource
import statistics
import subprocess
import sys

# As the policy `random` of galactic-run acts: from -1 to 1, terminating once in 500 steps. Drawn anew for
# each step: actions that come again and again drive robots into walls, where a step is dearer.
SETUP = """
import sys, numpy as np, galactic
path, envs, steps, threads = sys.argv[1], *map(int, sys.argv[2:])
random = np.random.default_rng(1)
def act(count):
    actions = random.random((envs, count), np.float32) * 2 - 1
    actions[:, -1] = random.random(envs, np.float32) < 1 / 500
    return actions
"""
LOOPS = {
    "Simulator": f"""{SETUP}
env = galactic.Simulator(galactic.World(path), envs=envs, threads=threads)
for _ in range(steps): env.step(act(env.action_count))
""",
    "VectorEnv": f"""{SETUP}
env = galactic.VectorEnv(path, envs, threads=threads, copy=False)
env.reset()
for _ in range(steps): env.step(act(env.action_space.shape[1]))
""",
    "drawing in numpy": f"""{SETUP}
env = galactic.Simulator(galactic.World(path), envs=envs, threads=threads)
for _ in range(steps): act(env.action_count)
""",
}


def processor_seconds(command: list[str]) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def command_of(name: str, options: argparse.Namespace, steps: int) -> list[str]:
    numbers = [str(options.envs), str(steps), str(options.threads)]
    if name in LOOPS:
        return [sys.executable, "-c", LOOPS[name], options.world, *numbers]
    return [options.galactic_run, options.world, "--envs", numbers[0], "--steps",
            numbers[1], "--threads", numbers[2], "--policy", "random"]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("galactic_run")
    parser.add_argument("world")
    parser.add_argument("--envs", type=int, default=1024)
    parser.add_argument("--steps", type=int, default=2000)
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
    print(
        f"{options.envs} envs, {options.threads} threads: nanoseconds of the processor a step, medians"
    )
    base, drawing = rates["galactic-run"], rates["drawing in numpy"]
    for name, values in rates.items():
        line = f"  {name:17} {statistics.median(values):6.0f}"
        if name in ("Simulator", "VectorEnv"):
            whole = statistics.median(one / run for one, run in zip(values, base))
            rest = statistics.median(
                (one - draw) / run for one, draw, run in zip(values, drawing, base)
            )
            line += f"   {whole:5.3f} of galactic-run, {rest:5.3f} less the drawing"
        print(line)


if __name__ == "__main__":
    main()
