#!/usr/bin/env python3
"""Who may include whom: see docs/architecture.md.

    check_includes.py [ROOT]

Every quoted include must lead to a file that the including folder may know; every third-party include
must be on the folder's list; the types of a heavy library are named only in the files made for it.
"""

import dataclasses
import fnmatch
import pathlib
import re
import sys

import source_tree

SUFFIXES = (".h", ".cpp", ".inl")
ARCHITECTURE = "docs/architecture.md"
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)

# Headers with a dot or a slash that belong to the language or the system.
SYSTEM_HEADERS = {"dirent.h", "dlfcn.h", "fcntl.h", "immintrin.h", "malloc.h", "poll.h", "signal.h", "spawn.h", "unistd.h"}
SYSTEM_FOLDERS = {"linux", "sys"}
# Part of the compiler: its sanitizers' interface.
COMPILER_FOLDERS = {"sanitizer"}


@dataclasses.dataclass(frozen=True)
class HeavyLibrary:
    """A library that few files may know."""
    name: str
    headers: re.Pattern
    # A type of it, also when it is only declared.
    types: re.Pattern
    # Patterns of paths; "*" stands for any text.
    files: tuple[str, ...]

    def is_known_to(self, path: pathlib.Path) -> bool:
        return any(fnmatch.fnmatchcase(path.as_posix(), one) for one in self.files)


HEAVY_LIBRARIES = (
    HeavyLibrary("assimp", re.compile(r"assimp/"),
                 re.compile(r"\b(Assimp::|ai(Scene|Node|Mesh|Material|Matrix|Vector|Texture)\w*)"),
                 ("bake/src/import/assimp_reader*",)),
    HeavyLibrary("Bullet", re.compile(r"(bullet/|Bullet|LinearMath/|bt[A-Z])"),
                 re.compile(r"\bbt[A-Z][a-z]\w+"),
                 ("bake/src/engines/bullet*", "bake/src/episodes/trial/bullet*", "bake/src/fit/convex_hull.cpp",
                  "dynamics/bullet/*", "tests/bake/robot/bullet*", "tests/bake/simulation/bullet*",
                  "benchmarks/simulation/batch_kinematics.cpp")),
    HeavyLibrary("Embree", re.compile(r"embree\d/"), re.compile(r"\b(RTC[A-Z]\w+|rtc[A-Z]\w+)"),
                 ("bake/src/engines/embree*",)),
    HeavyLibrary("urdfdom", re.compile(r"(urdf_|tinyxml|console_bridge/)"),
                 re.compile(r"\b(urdf::|TiXml\w+|console_bridge::)"),
                 ("bake/src/robot_description/urdf/urdf_reader*", "bake/src/robot_description/mjcf/xml_tree.cpp")),
    HeavyLibrary("meshoptimizer", re.compile(r"meshoptimizer\.h"), re.compile(r"\bmeshopt_\w+"),
                 ("bake/src/render/mesh_optimizer.cpp",)),
    HeavyLibrary("OpenGL", re.compile(r"(epoxy|EGL|GL|KHR)/"),
                 re.compile(r"\b(GL(u?int|enum|sync|sizei)|EGL(Display|Context|DeviceEXT))\b"),
                 ("runtime/src/render/gl/*", "tests/runtime/render/gl_*")),
    HeavyLibrary("CUDA", re.compile(r"(cuda|nv)\w*\.h"),
                 re.compile(r"\bCU(result|context|device(ptr)?|graphicsResource)\b"),
                 ("runtime/src/render/gl/cuda*",)),
    HeavyLibrary("pybind11", re.compile(r"(pybind11/|Python\.h|numpy/)"), re.compile(r"\b(pybind11::|PyObject)"),
                 ("python/src/*",)),
    HeavyLibrary("toml++", re.compile(r"toml\+\+/"), re.compile(r"\btoml::"), ("bake/src/toml/toml_table*",)),
    HeavyLibrary("libpng", re.compile(r"png\.h"), re.compile(r"\bpng_(struct|info|byte)p+\b"),
                 ("bake/src/textures/images/png_image.cpp", "runtime/pictures/png_file.cpp", "tests/*")),
    HeavyLibrary("libjpeg", re.compile(r"(jpeglib|jerror)\.h"), re.compile(r"\bjpeg_\w+_struct\b"),
                 ("bake/src/textures/images/jpeg_image.cpp", "tests/*")),
    HeavyLibrary("zlib", re.compile(r"zlib\.h"), re.compile(r"\bz_streamp?\b"),
                 ("bake/src/json/gzip.cpp", "view/page_data.cpp", "tests/*")),
    HeavyLibrary("stb", re.compile(r"stb/"), re.compile(r"\bstb_\w+\("),
                 ("bake/src/textures/images/bc1_blocks.cpp",)),
)


@dataclasses.dataclass(frozen=True)
class Rule:
    """What the files under a folder may include."""
    folder: str
    # Folders in which a quoted include may be found, besides the including file's own.
    roots: tuple[str, ...]
    # First parts of third-party includes.
    third_party: frozenset[str] = frozenset()
    # Whether headers generated from the schema may be included.
    schema: bool = True
    # Whether the folders of runtime/src that the programs share (SHARED) may be included.
    shared: bool = False


LEAN = frozenset({"fmt", "tl"})
# What the tools and the bake share with libgalactic, below its interface; never installed.
SHARED = ("runtime/src/support", "runtime/src/layout")
# The first rule whose folder holds the file applies.
RULES = (
    Rule("runtime/include", ("runtime/include",), frozenset({"tl"}), schema=False),
    Rule("runtime/src", ("runtime/include", "runtime/src"), LEAN | {"flatbuffers", "xxhash.h"}),
    Rule("runtime/pictures", ("runtime/include", "runtime"), LEAN, schema=False, shared=True),
    # xxHash as headers: digests of recordings.
    Rule("runtime/app", ("runtime/include", "runtime/app", "runtime", "."), LEAN | {"CLI", "xxhash.h"}, shared=True),
    # The policy is a user of the library: its interface alone, beside threads and random numbers.
    Rule("scripted", ("runtime/include", "."), frozenset(), schema=False, shared=True),
    Rule("view", ("runtime/include", "runtime", "."), LEAN, shared=True),
    Rule("python", ("runtime/include", "python/src", "."), LEAN, schema=False),
    Rule("pack_tool", ("runtime/include", "runtime", "."), LEAN | {"CLI", "nlohmann"}, shared=True),
    Rule("bake/include", ("runtime/include", "bake/include"), frozenset({"tl"}), schema=False, shared=True),
    Rule("bake/src", ("runtime/include", "bake/include", "bake/src", "."),
         LEAN | {"Eigen", "flatbuffers", "nlohmann", "xxhash.h"}, shared=True),
    # Reports have the same JSON of figures as the cache.
    Rule("bake/app", ("runtime/include", "bake/include", "bake/app", "bake/src/json"), LEAN | {"CLI", "nlohmann"}, shared=True),
    Rule("dynamics/app", ("runtime/include", "bake/include", "runtime/app", "dynamics", "."),
         LEAN | {"CLI", "nlohmann"}, shared=True),
    # Of galactic-run what reads recordings, plays policies and draws, of the bake what reads untrusted JSON and what
    # makes a mesh Bullet's: one place knows each.
    Rule("dynamics", ("runtime/include", "bake/include", "runtime/app", "runtime", ".", "bake/src/json", "bake/src/engines"),
         LEAN | {"nlohmann"}, shared=True),
)
# Whose files a folder must not reach, even by a relative path.
FORBIDDEN_TARGETS = {"runtime": ("bake", "dynamics", "pack_tool", "tests", "benchmarks"),
                     "runtime/pictures": ("runtime/src", "runtime/app"),
                     "runtime/app": ("runtime/src",),
                     # Below a step's phases is what they work on, above them what runs, makes and keeps simulations.
                     "runtime/src/simulation/state": ("runtime/src/simulation/phases", "runtime/src/simulation/simulator"),
                     "runtime/src/simulation/phases": ("runtime/src/simulation/simulator",),
                     "scripted": ("bake", "dynamics", "pack_tool", "tests", "benchmarks", "runtime/src", "runtime/app"),
                     "view": ("bake", "dynamics", "pack_tool", "tests", "benchmarks", "runtime/src", "runtime/app"),
                     "python": ("bake", "dynamics", "pack_tool", "view", "tests", "benchmarks", "runtime/src",
                                "runtime/app"),
                     "pack_tool": ("bake", "dynamics", "tests", "benchmarks", "runtime/src", "runtime/app"),
                     "bake": ("dynamics", "pack_tool", "tests", "benchmarks", "runtime/src", "runtime/app"),
                     "dynamics": ("pack_tool", "tests", "benchmarks", "runtime/src", "bake/src")}

# What the folders of the two libraries may know of the others beside them; what is not named here has no rule.
# docs/architecture.md shows both tables: see shown_parts().
PARTS = {
    "runtime/src": {
        "support": "",
        "layout": "",
        "check": "column_grid layout pack policy support",
        "column_grid": "check layout support",
        "pack": "check column_grid support",
        "policy": "check pack support",
        "simulation": "column_grid sensors support",
        "sensors": "simulation support",
        "views": "column_grid layout support",
        "render": "layout render/noise render/raster support",
        "render/raster": "layout support",
        "render/noise": "render/raster support",
        "render/soft": "layout render render/raster support",
        "render/cuda": "layout render render/raster support",
        "render/gl": "layout render render/raster support",
    },
    "bake/src": {
        "common": "",
        "json": "common",
        "toml": "common",
        "distance": "common",
        "import": "common",
        "column_grid": "common",
        "engines": "column_grid common",
        "fit": "common engines",
        "robot_description": "common fit import json",
        "sphere_set": "common distance robot_description",
        "ambient": "common engines",
        "textures": "common import",
        "robot": "common fit import sphere_set",
        "render": "ambient common distance import robot",
        "recipe": "common import json robot robot_description sphere_set toml",
        "dataset": "common import json render robot robot_description",
        "episodes": "common engines fit import json",
        "options": "common",
        "cache": "common json",
        "write": "",
        "asset": "cache column_grid common dataset fit import recipe render sphere_set",
        "build": "asset cache common dataset json recipe robot_description",
    },
}


def shown_parts() -> str:
    """The tables, as the document has them."""
    width = max(len(folder) for parts in PARTS.values() for folder in parts) + 2
    lines = []
    for library, parts in PARTS.items():
        lines += [f"{library}/", *(f"  {folder:{width}}{allowed}".rstrip() for folder, allowed in parts.items())]
    return "\n".join(lines)


def check_shown(root: pathlib.Path) -> list[str]:
    """Whether the document shows the tables, where there is one."""
    document = root / ARCHITECTURE
    if not document.is_file() or f"\n```text\n{shown_parts()}\n```\n" in document.read_text(encoding="utf-8"):
        return []
    return [f"{ARCHITECTURE}: does not show the tables PARTS of check_includes.py; let its block say\n{shown_parts()}"]


def part_of(path: pathlib.Path) -> tuple[str, str] | None:
    """The library that a file is of, and its folder there, "" for one that has none; None for others."""
    for library, parts in PARTS.items():
        if path.is_relative_to(library):
            folder = path.relative_to(library).parent
            known = [part for part in parts if folder.is_relative_to(part)]
            return library, max(known, key=len, default=folder.as_posix().removeprefix("."))
    return None


def check_parts(path: pathlib.Path, target: pathlib.Path) -> str | None:
    """What is wrong with an include of one folder of a library in another."""
    mine, theirs = part_of(path), part_of(target)
    if mine is None or theirs is None or mine[0] != theirs[0] or "" in (mine[1], theirs[1]) or mine == theirs:
        return None
    library, folder = mine
    allowed = PARTS[library].get(folder)
    if allowed is None:
        return f"no rule says what {library}/{folder} may know; add it to PARTS of check_includes.py"
    if theirs[1] in allowed.split():
        return None
    return (f"{library}/{folder} may not know {library}/{theirs[1]}, only {', '.join(allowed.split()) or 'itself'}; "
            f"move what both need to a folder that it may know, or change PARTS of check_includes.py")


def is_system(header: str) -> bool:
    first = header.split("/")[0]
    return ("." not in header and "/" not in header) or header in SYSTEM_HEADERS or (
        "/" in header and first in SYSTEM_FOLDERS | COMPILER_FOLDERS)


def rule_of(path: pathlib.Path) -> Rule | None:
    return next((rule for rule in RULES if path.is_relative_to(rule.folder)), None)


def resolve(root: pathlib.Path, path: pathlib.Path, header: str, rule: Rule) -> pathlib.Path | None:
    """The project's file that a quoted include means, relative to the root."""
    for folder in (path.parent, *map(pathlib.Path, rule.roots), *(["runtime/src"] if rule.shared else [])):
        candidate = (root / folder / header).resolve()
        if candidate.is_file() and candidate.is_relative_to(root):
            return candidate.relative_to(root)
    return None


def check_quoted(root: pathlib.Path, path: pathlib.Path, header: str, rule: Rule) -> str | None:
    if re.fullmatch(r"galactic/schema/\w+_generated\.h", header):
        return None if rule.schema else f'"{header}": public headers show no FlatBuffers type'
    # Strings made of files (cmake/embed_texts.cmake): beside their sources, in the build folder.
    texts = root / rule.folder / header
    made_of = {"shader_texts.h": "shaders", "ptx_texts.h": "kernels"}.get(texts.name)
    if made_of is not None and texts.with_name(made_of).is_dir():
        return None
    target = resolve(root, path, header, rule)
    if target is None:
        return f'"{header}": not found in {", ".join(rule.roots)}, where {rule.folder} may look'
    for folder, targets in FORBIDDEN_TARGETS.items():
        forbidden = next((one for one in targets if target.is_relative_to(one)), None)
        # What a rule names is no offence, though it may lie in a folder that is.
        is_named = target.parent.as_posix() in rule.roots
        if path.is_relative_to(folder) and forbidden is not None and not is_named and not (
                rule.shared and any(target.is_relative_to(one) for one in SHARED)):
            return f'"{header}": {folder} may not know {forbidden}'
    found = check_parts(path, target)
    return f'"{header}": {found}' if found else None


def check_angled(path: pathlib.Path, header: str, rule: Rule) -> str | None:
    if is_system(header) or header.split("/")[0] in rule.third_party:
        return None
    if any(library.headers.match(header) and library.is_known_to(path) for library in HEAVY_LIBRARIES):
        return None
    allowed = ", ".join(sorted(rule.third_party))
    return f"<{header}>: {rule.folder} may include of other projects only {allowed or 'nothing'}"


def check_heavy(path: pathlib.Path, text: str) -> list[str]:
    """Offences against the files that heavy libraries are confined to, in any folder."""
    code = COMMENT.sub("", text)
    offences = []
    for library in HEAVY_LIBRARIES:
        if library.is_known_to(path):
            continue
        headers = [m.group(2) for m in INCLUDE.finditer(code) if library.headers.match(m.group(2))]
        named = library.types.search(code)
        files = " and ".join(library.files)
        if headers:
            offences.append(f"<{headers[0]}>: only {files} may know {library.name}; let one of these do it")
        elif named:
            offences.append(f"{named.group(0)}: only {files} may name types of {library.name}; let one of these "
                            "do it")
    return offences


def check_file(root: pathlib.Path, path: pathlib.Path) -> list[str]:
    text = (root / path).read_text(encoding="utf-8", errors="replace")
    offences = check_heavy(path, text)
    rule = rule_of(path)
    if rule is None:
        if path.parts[0] in FORBIDDEN_TARGETS:
            offences.append(f"no rule of check_includes.py covers {path.parent}; add one")
        return offences
    for match in INCLUDE.finditer(COMMENT.sub("", text)):
        quote, header = match.groups()
        found = check_quoted(root, path, header, rule) if quote == '"' else check_angled(path, header,
                                                                                         rule)
        if found:
            offences.append(found)
    return offences


def check_schema(root: pathlib.Path) -> list[str]:
    """schema/ holds schemas, their documentation and their build file, nothing else."""
    allowed = {".fbs", ".md", ".txt"}
    return [f"{path.relative_to(root)}: only .fbs files, README.md and CMakeLists.txt live in schema/"
            for path in sorted((root / "schema").rglob("*"))
            if path.is_file() and path.suffix not in allowed]


def check_tree(root: pathlib.Path) -> tuple[list[str], int]:
    """All offences, and the number of files looked at."""
    root = root.resolve()
    files = source_tree.project_files(root, SUFFIXES)
    offences = [f"{path}: {offence}" for path in files for offence in check_file(root, path)]
    return offences + check_schema(root) + check_shown(root), len(files)


def main(arguments: list[str]) -> int:
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parents[2])
    offences, examined = check_tree(root)
    if offences:
        print(f"{ARCHITECTURE} tells which folder may know which, and why:")
    return source_tree.report("includes", offences, examined)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
