#!/usr/bin/env python3
"""What the run side's programs link: see docs/architecture.md.

    check_needed.py --run GALACTIC_RUN --pack GALACTIC_PACK

Every library that a program needs directly must be on its list, and nothing of the bake side may come
in by way of another library.
"""

import argparse
import re
import subprocess
import sys

# What GCC and glibc bring, and the sanitizers' run time in sanitizer builds.
SYSTEM = {"libstdc++", "libgcc_s", "libm", "libc", "libpthread", "ld-linux-x86-64",
          "ld-linux-aarch64", "libasan", "libubsan", "libtsan", "libclang_rt"}
ALLOWED = {
    # libz comes with libpng, which writes pictures. libepoxy finds OpenGL when it is first used: the
    # programs start without any.
    "galactic-run": SYSTEM | {"libfmt", "libpng16", "libz", "libepoxy", "libdl"},
    "galactic-pack": SYSTEM | {"libfmt", "libpng16", "libz", "libepoxy", "libdl"},
}
BAKE_SIDE = re.compile(r"lib(assimp|embree|Bullet|LinearMath|urdfdom|console_bridge|jsoncpp|tinyxml)",
                       re.IGNORECASE)


def base_name(library: str) -> str:
    """The name of a library without version: "libfmt.so.9" and "libfmt.so.10" are one."""
    name = re.split(r"\.so\b", library.split("/")[-1])[0]
    return re.sub(r"^libclang_rt\..*", "libclang_rt", name)


def needed(program: str) -> list[str]:
    """The libraries in the program's dynamic section, as readelf prints it."""
    listing = subprocess.run(["readelf", "-d", program], capture_output=True, text=True, check=True)
    return re.findall(r"\(NEEDED\).*\[(.+)\]", listing.stdout)


def loaded(program: str) -> list[str]:
    """The libraries that the loader would map, by way of others too."""
    listing = subprocess.run(["ldd", program], capture_output=True, text=True, check=True)
    return [line.split()[0] for line in listing.stdout.splitlines() if line.strip()]


def judge(program: str, direct: list[str], transitive: list[str]) -> list[str]:
    """The offences of a program that needs `direct` and maps `transitive`."""
    allowed = ALLOWED[program]
    offences = [f"{program} links {library}; allowed are {', '.join(sorted(allowed - SYSTEM))}"
                for library in direct if base_name(library) not in allowed]
    offences += [f"{program} maps {library}, which belongs to the bake side"
                 for library in transitive if BAKE_SIDE.match(library.split("/")[-1])]
    if not direct:
        offences.append(f"{program} has no dynamic section to look at")
    return offences


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--run", required=True, help="path of galactic-run")
    parser.add_argument("--pack", required=True, help="path of galactic-pack")
    options = parser.parse_args()
    offences = []
    for program, path in (("galactic-run", options.run), ("galactic-pack", options.pack)):
        direct = needed(path)
        offences += judge(program, direct, loaded(path))
        print(f"{program}: needs {', '.join(direct)}")
    for offence in offences:
        print(offence)
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
