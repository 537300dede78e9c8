"""_core.pyi says of the compiled module what is there, no less and no more."""

import ast
import enum
import os
import pathlib

import pytest

from galactic import _core

PYI = pathlib.Path(os.environ["GALACTIC_SOURCE_DIR"]) / "python" / "galactic" / "_core.pyi"


def names_in(body: list[ast.stmt]) -> set[str]:
    """What these lines declare, without what is private."""
    names = set()
    for line in body:
        if isinstance(line, (ast.ClassDef, ast.FunctionDef)):
            names.add(line.name)
        elif isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name):
            names.add(line.target.id)
        elif isinstance(line, ast.Assign):
            names.update(one.id for one in line.targets if isinstance(one, ast.Name))
    return public(names)


def public(names) -> set[str]:
    return {name for name in names if not name.startswith("_")}


def is_dictionary(line: ast.stmt) -> bool:
    """Whether it declares what keys a dictionary has, which is no class of the module."""
    return isinstance(line, ast.ClassDef) and any(
        isinstance(base, ast.Name) and base.id == "TypedDict" for base in line.bases
    )


TREE = ast.parse(PYI.read_text(encoding="utf-8")).body
CLASSES = {
    line.name: line for line in TREE if isinstance(line, ast.ClassDef) and not is_dictionary(line)
}


def require_same(declared: set[str], module: set[str], of: str) -> None:
    lacks, invents = sorted(module - declared), sorted(declared - module)
    assert not lacks, f"{PYI.name} does not declare {lacks} of {of}; add them"
    assert not invents, f"{PYI.name} declares {invents}, which {of} does not have; remove them"


def test_it_declares_the_names_of_the_module():
    require_same(
        names_in([line for line in TREE if not is_dictionary(line)]),
        public(vars(_core)),
        "the module",
    )


@pytest.mark.parametrize("name", CLASSES)
def test_it_declares_the_members_of_each_class(name):
    require_same(names_in(CLASSES[name].body), public(vars(getattr(_core, name))), name)


def test_it_declares_the_numbers_of_each_enum():
    enums = {name: one for name, one in vars(_core).items() if isinstance(one, enum.EnumMeta)}
    assert "EpisodeEnd" in enums and len(enums) > 3
    for name, one in enums.items():
        assigned = {
            line.targets[0].id: ast.literal_eval(line.value)
            for line in CLASSES[name].body
            if isinstance(line, ast.Assign) and isinstance(line.targets[0], ast.Name)
        }
        assert assigned == {member.name: member.value for member in one}, f"{PYI.name}: {name}"
