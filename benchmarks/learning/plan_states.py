#!/usr/bin/env python3
"""What it costs to put the state of one env into many, to try as many plans: beside a step of theirs.

    PYTHONPATH=build/release/python benchmarks/learning/plan_states.py WORLD.pack

The processor time of one thread in milliseconds, the least of some repetitions.
"""

import argparse
import time
from collections.abc import Callable

import numpy as np

import galactic


class Nearer(galactic.Task):
    """A task of one's own, with memory."""

    options = {"episode_steps": 1000}

    def prepare(self, envs: galactic.TaskEnvs) -> None:
        self.memory = {"way": np.zeros((envs.num_envs, 3), np.float32)}

    def step(self, envs: galactic.TaskEnvs) -> galactic.Outcome:
        before = np.linalg.norm(self.memory["way"], axis=1)
        self.memory["way"][:] = envs.observations["grip_target"]
        return galactic.Outcome(before - np.linalg.norm(self.memory["way"], axis=1))


def milliseconds(work: Callable[[], object], times: int = 20) -> float:
    spent = []
    for _ in range(times):
        begun = time.process_time()
        work()
        spent.append(time.process_time() - begun)
    return 1e3 * min(spent)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("world")
    parser.add_argument("--plans", type=int, default=512)
    options = parser.parse_args()
    world, plans = galactic.World(options.world), range(options.plans)
    alike = {"task": "pick", "threads": 1}
    actual, simulator = (galactic.Simulator(world, envs, **alike) for envs in (1, len(plans)))
    actions = np.random.default_rng(1).uniform(-1, 1, (len(plans), actual.action_count))
    moves = actions.astype(np.float32)
    for _ in range(50):
        actual.step(moves[:1])
    state = actual.save_state()
    print(f"{len(plans)} plans, ms of one thread")
    print(f"  step {milliseconds(lambda: simulator.step(moves)):.2f}")
    print(f"  save_state() of one env {milliseconds(actual.save_state):.3f}")
    print(
        f"  restore_state(state) {milliseconds(lambda: simulator.restore_state(state, plans)):.2f}"
    )

    def one_by_one() -> None:
        for env in plans:
            simulator.restore_state(state, [env])

    print(f"  one after the other {milliseconds(one_by_one, 5):.2f}")
    real, planner = (
        galactic.VectorEnv(world, envs, task=Nearer, threads=1) for envs in (1, len(plans))
    )
    real.reset()
    planner.reset()
    for _ in range(50):
        real.step(moves[:1])
    kept = real.save_state(envs=[0])
    print(f"  VectorEnv with a task: step {milliseconds(lambda: planner.step(moves)):.2f}")
    print(f"  save_state(envs=[0]) {milliseconds(lambda: real.save_state(envs=[0])):.3f}")
    print(f"  restore_state(state) {milliseconds(lambda: planner.restore_state(kept)):.2f}")


if __name__ == "__main__":
    main()
