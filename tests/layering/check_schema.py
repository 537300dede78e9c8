#!/usr/bin/env python3
"""Whether today's schema still reads the packs of every released format version.

    check_schema.py --flatc FLATC [--schema FOLDER]

For each folder of schema/released: flatc --conform, which compares offsets, types and defaults, and
what it does not see: a field, an enum value or a whole table that is gone, and a changed struct.
"""

import argparse
import pathlib
import re
import subprocess
import sys

DECLARATION = re.compile(r"^(table|struct|enum|union)\s+(\w+)[^{]*\{([^}]*)\}", re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*")


def declarations(folder: pathlib.Path) -> dict[str, tuple[str, list[str]]]:
    """Kind and members of everything that the schemas of a folder declare, by name."""
    found = {}
    for file in sorted(folder.glob("*.fbs")):
        text = COMMENT.sub("", file.read_text(encoding="utf-8"))
        for kind, name, body in DECLARATION.findall(text):
            separator = ";" if kind in ("table", "struct") else ","
            members = [" ".join(member.split()) for member in body.split(separator)]
            found[name] = (kind, [member for member in members if member])
    return found


def member_name(member: str) -> str:
    return re.split(r"[:=\s]", member)[0]


def losses(released: dict, today: dict) -> list[str]:
    """What the released schema has and today's has not, or has in another place."""
    offences = []
    for name, (kind, members) in released.items():
        if name not in today:
            offences.append(f"{kind} {name} is gone")
            continue
        present = today[name][1]
        if kind == "struct" and present != members:
            offences.append(f"struct {name} changed; structs never do, add a new one")
            continue
        for place, member in enumerate(members):
            wanted = member_name(member)
            actual = member_name(present[place]) if place < len(present) else "nothing"
            if actual != wanted:
                offences.append(f"{kind} {name} has {actual} where {wanted} was expected; new members go to "
                                "the end, unused ones are marked deprecated")
                break
    return offences


def conform(flatc: str, schema: pathlib.Path, released: pathlib.Path) -> list[str]:
    """What flatc has to say against today's schema."""
    run = subprocess.run(
        [flatc, "--conform", released / "pack.fbs", "--conform-includes", released, "-I", schema,
         schema / "pack.fbs"], capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return []
    return [" ".join((run.stdout + run.stderr).split()) or f"flatc ended with {run.returncode}"]


def check(flatc: str, schema: pathlib.Path) -> list[str]:
    """All offences against all released versions."""
    versions = sorted((schema / "released").glob("v*"))
    if not versions:
        return [f"{schema}/released holds no version; run scripts/release_schema.sh 1"]
    offences = []
    for version in versions:
        found = conform(flatc, schema, version) + losses(declarations(version), declarations(schema))
        offences += [f"{version.name}: {offence}" for offence in found]
    return offences


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flatc", default="flatc")
    parser.add_argument("--schema", type=pathlib.Path,
                        default=pathlib.Path(__file__).parents[2] / "schema")
    options = parser.parse_args()
    offences = check(options.flatc, options.schema)
    for offence in offences:
        print(offence)
    print(f"schema: {len(offences)} offences against released versions")
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
