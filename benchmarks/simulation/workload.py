"""The program play_workload, for scripts that compare what it measures."""

import pathlib
import re
import subprocess


def nanoseconds_of_step(
    program: pathlib.Path, world: pathlib.Path, load: str, *counts: int
) -> float:
    """Processor time of a step of one env. `counts`: envs, steps, and maybe steps before these."""
    run = subprocess.run(
        [program, world, load, *map(str, counts)], check=True, capture_output=True, text=True
    )
    found = re.search(r"([\d.]+) ns each", run.stdout)
    if found is None:
        raise ValueError(f"{program} says: {run.stdout}")
    return float(found[1])
