#!/usr/bin/env python3
"""How fast builds of the library are, side by side: what is left of a change once chance is gone.

    benchmarks/simulation/compare_builds.py WORLDS BUILD BUILD... [--envs N,N] [--loads L,L] [--steps N]
                                            [--before N] [--orders N] [--turns N]

WORLDS is what make_published_world.sh left. Where code happens to lie in memory changes the time of a step by 2 % and
more, so play_workload, as it is here, is linked with the library of each build (libgalactic.a) in several orders of its
sections, and runs in turns, after so many steps that robots that drive ahead have reached the walls. Prints the
processor time of a step of one env in nanoseconds: of the least of each order's turns the mean and the range, and how
many times as fast that is as the first build. Needs lld, or the linker that a build was configured with.
"""

import argparse
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from workload import nanoseconds_of_step

HERE = pathlib.Path(__file__).resolve().parent
LIBRARIES = ("-lfmt", "-lxxhash", "-lepoxy", "-lpthread", "-ldl")


def configured(build: pathlib.Path, name: str) -> str:
    """What a build folder was configured with, "" if it was not."""
    cache = (build / "CMakeCache.txt").read_text()
    found = re.search(rf"^{name}:\w+=(.*)$", cache, re.MULTILINE)
    return found[1] if found else ""


def compiler_of(build: pathlib.Path) -> list[str]:
    """As programs of a build folder are compiled and linked."""
    command = [configured(build, "CMAKE_CXX_COMPILER"), "-O3", "-DNDEBUG", "-std=c++20"]
    across_files = configured(build, "CMAKE_INTERPROCEDURAL_OPTIMIZATION").upper()
    if across_files in ("ON", "TRUE", "YES", "1"):
        command.append("-flto=thin" if "clang" in command[0] else "-flto=auto")
    return command


def link(build: pathlib.Path, orders: int, out: pathlib.Path) -> list[pathlib.Path]:
    """play_workload with the library of a build, in so many orders of its sections."""
    compiler = compiler_of(build)
    linker = shlex.split(configured(build, "CMAKE_EXE_LINKER_FLAGS")) or ["-fuse-ld=lld"]
    part = out / "play_workload.o"
    source = configured(build, "CMAKE_HOME_DIRECTORY")
    if not source:
        raise ValueError(f"{build} is no build folder: CMakeCache.txt names no source")
    include = pathlib.Path(source) / "runtime/include"
    subprocess.run(
        [*compiler, f"-I{include}", "-c", HERE / "play_workload.cpp", "-o", part], check=True
    )
    programs = []
    for order in range(1, orders + 1):
        program = out / str(order)
        library = build / "runtime/libgalactic.a"
        shuffle = (*linker, f"-Wl,--shuffle-sections=.text*={order}", "-Wl,--as-needed")
        subprocess.run([*compiler, *shuffle, part, library, *LIBRARIES, "-o", program], check=True)
        programs.append(program)
    return programs


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("worlds", type=pathlib.Path)
    parser.add_argument("builds", type=pathlib.Path, nargs="+")
    parser.add_argument("--envs", default="128,512,4096,16384")
    parser.add_argument("--loads", default="random,forward,held")
    parser.add_argument("--steps", type=int, help="of each env; 76800 of all of them, 50 at least")
    parser.add_argument("--before", type=int, default=1000)
    parser.add_argument("--orders", type=int, default=6)
    parser.add_argument("--turns", type=int, default=3)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="galactic-compare-") as folder:
        programs = []
        for n, build in enumerate(options.builds):
            out = pathlib.Path(folder) / str(n)
            out.mkdir()
            programs.append(link(build.resolve(), options.orders, out))
        for envs in map(int, options.envs.split(",")):
            counts = (envs, options.steps or max(50, 76800 // envs), options.before)
            for load in options.loads.split(","):
                world = options.worlds / ("held_world.pack" if load == "held" else "world.pack")
                least = [[float("inf")] * options.orders for _ in programs]
                for _ in range(options.turns):
                    for order in range(options.orders):
                        for n, each in enumerate(programs):
                            took = nanoseconds_of_step(each[order], world, load, *counts)
                            least[n][order] = min(least[n][order], took)
                means = [sum(row) / len(row) for row in least]
                print(f"{envs} envs, {load}")
                for build, row, mean in zip(options.builds, least, means):
                    times = f"{mean:.1f} ({min(row):.0f} to {max(row):.0f})"
                    print(f"  {times:24} {means[0] / mean:.3f}  {build}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
