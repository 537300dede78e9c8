"""What the checks of this folder share: the project's own text files."""

import pathlib
import subprocess

# Folders of the root that hold generated files and version control. Others may be called so: bake/src/build.
SKIPPED_FOLDERS = {".git", "build"}


def project_files(root: pathlib.Path, suffixes: tuple[str, ...]) -> list[pathlib.Path]:
    """All files under `root` with one of `suffixes`, relative to it, sorted.

    In a git checkout these are the tracked files and those that are neither tracked nor ignored, so
    that a build folder of any name is left out.
    """
    listing = subprocess.run(
        ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        capture_output=True, check=False) if (root / ".git").exists() else None
    if listing is not None and listing.returncode == 0:
        names = [pathlib.Path(name) for name in listing.stdout.decode().split("\0") if name]
    else:
        names = [path.relative_to(root) for path in root.rglob("*") if path.is_file()]
    return sorted(name for name in names
                  if name.suffix in suffixes and name.parts[0] not in SKIPPED_FOLDERS
                  and (root / name).is_file())


def report(check: str, offences: list[str], examined: int) -> int:
    """Prints the offences, or that there are none; returns the exit code."""
    for offence in offences:
        print(offence)
    print(f"{check}: {len(offences)} offences in {examined} files")
    if examined == 0:
        print(f"{check}: found nothing to look at; give the project's folder")
    return 1 if offences or examined == 0 else 0
