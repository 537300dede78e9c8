#!/usr/bin/env python3
"""Who may include whom: see docs/architecture.md.

    check_includes.py [ROOT]

Every quoted include must lead to a file that the including folder may know; every third-party include
must be on the folder's list; the types of a heavy library are named only in the files made for it.
"""

import dataclasses
import pathlib
import re
import sys

import source_tree

SUFFIXES = (".h", ".cpp")
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
    allowed: re.Pattern


HEAVY_LIBRARIES = (
    HeavyLibrary("assimp", re.compile(r"assimp/"),
                 re.compile(r"\b(Assimp::|ai(Scene|Node|Mesh|Material|Matrix|Vector|Texture)\w*)"),
                 re.compile(r"bake/src/import/assimp_reader[^/]*$")),
    HeavyLibrary("Bullet", re.compile(r"(bullet/|Bullet|LinearMath/|bt[A-Z])"),
                 re.compile(r"\bbt[A-Z][a-z]\w+"),
                 re.compile(r"bake/src/((engines|episodes/trial)/bullet[^/]*|fit/convex_hull\.cpp)$|"
                            r"dynamics/bullet/|"
                            r"tests/bake/(robot|simulation)/bullet[^/]*$|"
                            r"benchmarks/simulation/batch_kinematics\.cpp$")),
    HeavyLibrary("Embree", re.compile(r"embree\d/"), re.compile(r"\b(RTC[A-Z]\w+|rtc[A-Z]\w+)"),
                 re.compile(r"bake/src/engines/embree[^/]*$")),
    HeavyLibrary("urdfdom", re.compile(r"(urdf_|tinyxml|console_bridge/)"),
                 re.compile(r"\b(urdf::|TiXml\w+|console_bridge::)"),
                 re.compile(r"bake/src/robot_description/(urdf/urdf_reader[^/]*|mjcf/xml_tree\.cpp)$")),
    HeavyLibrary("meshoptimizer", re.compile(r"meshoptimizer\.h"), re.compile(r"\bmeshopt_\w+"),
                 re.compile(r"bake/src/render/mesh_optimizer\.cpp$")),
    HeavyLibrary("OpenGL", re.compile(r"(epoxy|EGL|GL|KHR)/"),
                 re.compile(r"\b(GL(u?int|enum|sync|sizei)|EGL(Display|Context|DeviceEXT))\b"),
                 re.compile(r"(runtime/src/render/gl/[^/]*|tests/runtime/render/gl_[^/]*)$")),
    HeavyLibrary("CUDA", re.compile(r"(cuda|nv)\w*\.h"), re.compile(r"\bCU(result|context|device(ptr)?|graphicsResource)\b"),
                 re.compile(r"runtime/src/render/gl/cuda[^/]*$")),
    HeavyLibrary("pybind11", re.compile(r"(pybind11/|Python\.h|numpy/)"), re.compile(r"\b(pybind11::|PyObject)"),
                 re.compile(r"^python/src/")),
    HeavyLibrary("toml++", re.compile(r"toml\+\+/"), re.compile(r"\btoml::"),
                 re.compile(r"bake/src/toml/toml_table[^/]*$")),
    HeavyLibrary("libpng", re.compile(r"png\.h"), re.compile(r"\bpng_(struct|info|byte)p+\b"),
                 re.compile(r"bake/src/textures/images/png_image\.cpp$|^runtime/pictures/png_file\.cpp$|"
                            r"^tests/")),
    HeavyLibrary("libjpeg", re.compile(r"(jpeglib|jerror)\.h"), re.compile(r"\bjpeg_\w+_struct\b"),
                 re.compile(r"bake/src/textures/images/jpeg_image\.cpp$|^tests/")),
    HeavyLibrary("zlib", re.compile(r"zlib\.h"), re.compile(r"\bz_streamp?\b"),
                 re.compile(r"bake/src/json/gzip\.cpp$|^view/page_data\.cpp$|^tests/")),
    HeavyLibrary("stb", re.compile(r"stb/"), re.compile(r"\bstb_\w+\("),
                 re.compile(r"bake/src/textures/images/bc1_blocks\.cpp$")),
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
    return None


def check_angled(path: pathlib.Path, header: str, rule: Rule) -> str | None:
    if is_system(header) or header.split("/")[0] in rule.third_party:
        return None
    if any(library.headers.match(header) and library.allowed.search(path.as_posix())
           for library in HEAVY_LIBRARIES):
        return None
    allowed = ", ".join(sorted(rule.third_party))
    return f"<{header}>: {rule.folder} may include of other projects only {allowed}"


def check_heavy(path: pathlib.Path, text: str) -> list[str]:
    """Offences against the files that heavy libraries are confined to, in any folder."""
    code = COMMENT.sub("", text)
    offences = []
    for library in HEAVY_LIBRARIES:
        if library.allowed.search(path.as_posix()):
            continue
        headers = [m.group(2) for m in INCLUDE.finditer(code) if library.headers.match(m.group(2))]
        named = library.types.search(code)
        if headers:
            offences.append(f"<{headers[0]}>: only {library.allowed.pattern} may know {library.name}")
        elif named:
            offences.append(f"{named.group(0)}: only {library.allowed.pattern} may name types of "
                            f"{library.name}")
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
    return offences + check_schema(root), len(files)


def main(arguments: list[str]) -> int:
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parents[2])
    return source_tree.report("includes", *check_tree(root))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
