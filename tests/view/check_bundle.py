#!/usr/bin/env python3
"""Whether the page that is kept with its sources was made of them: view/page/build.mjs writes hashes.

    check_bundle.py FOLDER
"""

import hashlib
import pathlib
import sys

FIXED = ("build.mjs", "index.html", "package.json", "package-lock.json", "style.css")
ADVICE = "run npm ci && npm run build in view/page, and commit dist/"


def hash_of_sources(folder: pathlib.Path) -> str:
    digest = hashlib.sha256()
    names = [*FIXED, *sorted(f"src/{path.name}" for path in (folder / "src").iterdir())]
    for name in names:
        digest.update(name.encode() + b"\0" + (folder / name).read_bytes() + b"\0")
    return digest.hexdigest()


def offences_of(folder: pathlib.Path) -> list[str]:
    kept = dict(line.split() for line in (folder / "dist/hashes.txt").read_text().splitlines())
    page = hashlib.sha256((folder / "dist/page.html").read_bytes()).hexdigest()
    offences = []
    if kept.get("sources") != hash_of_sources(folder):
        offences.append(f"{folder}/dist is of other sources; {ADVICE}")
    if kept.get("page") != page:
        offences.append(f"{folder}/dist/page.html was changed by hand; {ADVICE}")
    return offences


def main(arguments: list[str]) -> int:
    offences = offences_of(pathlib.Path(arguments[0]))
    for offence in offences:
        print(offence)
    print(f"bundle: {len(offences)} offences")
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
