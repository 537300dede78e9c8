#!/usr/bin/env python3
"""Who of the Python package may import torch and the trainer: see docs/architecture.md.

    check_imports.py [ROOT]

The trainer, galactic.learning, and the programs that are its front ends; whoever imports anything else of the
package needs no torch.
"""

import ast
import pathlib
import sys

import source_tree

PACKAGE = pathlib.Path("python/galactic")
LEARNING = PACKAGE / "learning"
PROGRAMS = {PACKAGE / f"{name}.py" for name in ("train", "evaluate", "demonstrate", "export", "compare")}
CONFINED = ("torch", "galactic.learning")


def imported(path: pathlib.Path, tree: ast.Module) -> list[str]:
    """The modules that a file of the package imports, wherever in it; of `from a import b`, both a and a.b."""
    names = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            folders = path.relative_to(PACKAGE.parent).parts
            above = ".".join(folders[:-node.level]) if node.level else ""
            module = ".".join(filter(None, (above, node.module)))
            names += [module, *(f"{module}.{alias.name}" for alias in node.names)]
    return names


def check_file(root: pathlib.Path, path: pathlib.Path) -> list[str]:
    names = imported(path, ast.parse((root / path).read_text(encoding="utf-8")))
    found = [one for one in CONFINED if any(name == one or name.startswith(one + ".") for name in names)]
    return [f"{path}: imports {one}: only galactic.learning and the programs may" for one in found]


def check_tree(root: pathlib.Path) -> tuple[list[str], int]:
    """All offences, and the number of files looked at."""
    files = [path for path in source_tree.project_files(root, (".py",))
             if path.is_relative_to(PACKAGE) and not path.is_relative_to(LEARNING) and path not in PROGRAMS]
    return [offence for path in files for offence in check_file(root, path)], len(files)


def main(arguments: list[str]) -> int:
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parents[2])
    return source_tree.report("imports", *check_tree(root))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
