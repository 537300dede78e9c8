#!/usr/bin/env python3
"""How fast policies with a camera train, beside tables 5 and 6 of the paper; on a GPU where there is one.

    PYTHONPATH=build/release/python benchmarks/learning/training_speed.py WORLD.pack
    PYTHONPATH=build/release/python benchmarks/learning/training_speed.py WORLD.pack --also -- --cuda-graphs

Each configuration is trained twice with the preset `paper`, for a few updates and for some more: what counts is
the difference, so that starting and the choice of kernels do not. Options behind `--` are passed on to
galactic.train, with `--also` as further configurations beside the plain ones.
"""

import argparse
import dataclasses
import json
import pathlib
import subprocess
import sys
import tempfile

WARM_UP = 2
#: Network and envs of tables 5 and 6, with the paper's steps per second on a V100.
PAPER = {("resnet18", 128): 3716, ("simple_cnn", 512): 14791}


@dataclasses.dataclass
class Speed:
    """Of an update: steps per second, and milliseconds of a rollout's step and of the update's two halves."""

    steps_per_second: float
    rollout_step_ms: dict
    update_ms: dict
    device: str


def report_of(
    world: pathlib.Path, network: str, envs: int, updates: int, horizon: int, extra: list[str]
) -> dict:
    with tempfile.TemporaryDirectory() as folder:
        run = pathlib.Path(folder) / "run"
        command = [
            sys.executable,
            "-m",
            "galactic.train",
            str(world),
            "-o",
            str(run),
            "--preset",
            "paper",
        ]
        command += ["--network", network, "--envs", str(envs), "--horizon", str(horizon)]
        command += ["--steps", str(updates * envs * horizon), "--checkpoint-every", "0", *extra]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"training_speed: {' '.join(command)}\n{done.stderr}")
        return json.loads((run / "report.json").read_text(encoding="utf-8"))


def difference(long: dict, short: dict) -> Speed:
    """What the updates take that only the long run did."""
    updates = long["updates"] - short["updates"]

    def per_update(table: str) -> dict:
        names = long["timing"][table]
        sums = {
            n: [r["timing"][table].get(n, 0.0) * r["updates"] for r in (long, short)] for n in names
        }
        return {name: (both - first) / updates for name, (both, first) in sums.items()}

    update_ms = per_update("update_ms")
    steps = (long["steps"] - short["steps"]) / updates
    return Speed(
        1e3 * steps / sum(update_ms.values()),
        per_update("rollout_step_ms"),
        update_ms,
        long["device"],
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("world", type=pathlib.Path)
    parser.add_argument("--envs", type=int, nargs="*", help="instead of the paper's 128 and 512")
    parser.add_argument("--networks", nargs="*", default=["resnet18", "simple_cnn"])
    parser.add_argument("--updates", type=int, default=6)
    parser.add_argument("--horizon", type=int, default=64)
    parser.add_argument(
        "--also", action="store_true", help="measure with and without the options behind --"
    )
    own, extra = sys.argv[1:], []
    if "--" in own:
        own, extra = own[: own.index("--")], own[own.index("--") + 1 :]
    options = parser.parse_args(own)
    paper = {network: envs for network, envs in PAPER}
    print("network     envs  options          steps/s    paper   rollout ms  update ms")
    for network in options.networks:
        for envs in options.envs or [paper.get(network, 128)]:
            for passed in [[], extra] if options.also else [extra]:
                runs = [report_of(options.world, network, envs, updates, options.horizon, passed)
                        for updates in (WARM_UP + options.updates, WARM_UP)]  # fmt: skip
                speed = difference(*runs)
                reference = PAPER.get((network, envs))
                print(f"{network:10} {envs:5}  {' '.join(passed) or '-':15} {speed.steps_per_second:8.0f} "
                      f"{reference or '-':>8}   {speed.update_ms['compute rollouts']:10.0f} "
                      f"{speed.update_ms['update agent']:10.0f}   on {speed.device}")  # fmt: skip
                steps = ", ".join(
                    f"{name} {value:.2f}" for name, value in speed.rollout_step_ms.items()
                )
                print(f"            a step of a rollout, ms: {steps}", flush=True)


if __name__ == "__main__":
    main()
