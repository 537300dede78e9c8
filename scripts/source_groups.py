"""Which sources can be compiled as one: for unity builds and for clang-tidy.

    source_groups.py TARGETS OUTPUT

TARGETS has a line for each target: its name, then its sources, separated by semicolons. OUTPUT becomes CMake
code that gives each source that fits together with others the property UNITY_GROUP.

What a source keeps to itself, that is what it declares in an unnamed namespace and its macros, is seen by the
sources after it when they are compiled as one. Two sources fit together when neither names what it would see of
the other. That is read from the text, so it separates some that a compiler would take; and it relies on the
formatter: what a namespace declares begins where a line begins, and a comment ends each namespace.
"""

import collections
import dataclasses
import functools
import pathlib
import re
import sys

MOST_SOURCES = 16
ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("bake", "benchmarks", "dynamics", "pack_tool", "python", "runtime", "scripted", "tests", "view")

COMMENT_OR_LITERAL = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.DOTALL)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<]([^">\n]+)[">]', re.MULTILINE)
MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", re.MULTILINE)
NAMESPACE = re.compile(r"^(?:inline )?namespace ?([\w:]*) \{$|^\}  // namespace.*$", re.MULTILINE)
# The formatter gives these no comment.
SHORT_NAMESPACE = re.compile(r"^namespace [\w:]+ \{\n[^\n]*\n\}$", re.MULTILINE)
# A shorter name for one of the standard library's: whoever gives it again means the same.
STANDARD_ALIAS = re.compile(r"^namespace \w+ = std::[\w:]+;$", re.MULTILINE)
# From where a line begins to what follows a name: parameters, a value, a body.
DECLARATION = re.compile(r"^(?![}#\s]|template\b[^;{(]*$)([^({=;\[]+)(\(?)", re.MULTILINE)
TYPE = re.compile(r"^(?:struct|class|union|enum(?: class)?) (\w+)")
TEST = re.compile(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", re.MULTILINE)
# Neither members nor names of the standard library can be mistaken for ours.
WORD = re.compile(r"(?<![.>\w])(?<!std::)[A-Za-z_]\w*")
CALLED = re.compile(WORD.pattern + r"(?=\s*[(<])")
TEMPLATE_ARGUMENTS = re.compile(r"<[^<>;]*>")


@dataclasses.dataclass(frozen=True)
class Text:
    """What a file says: its words, the namespaces it speaks in, the headers it includes, what it keeps to itself."""

    words: frozenset[str]
    called: frozenset[str]
    namespaces: frozenset[str]
    headers: frozenset[pathlib.Path]
    private: frozenset[tuple[str, str, bool]]  # namespace, name, whether it is a function's
    joins: bool


def plain(text: str) -> str:
    """The text without its comments and without what its string literals say."""
    return COMMENT_OR_LITERAL.sub(lambda match: " " if match.group()[0] == "/" else '""', text)


def declared(block: str) -> set[tuple[str, bool]]:
    """The names that a block of a namespace declares, and which are functions' names."""
    block, before = STANDARD_ALIAS.sub("", plain(block)), None
    names = {("_".join(test), False) for test in TEST.findall(block)}
    while before != block:
        before, block = block, TEMPLATE_ARGUMENTS.sub("", block)
    for declaration, parameters in DECLARATION.findall(block):
        found = TYPE.match(declaration)
        words = re.findall(r"\w+", declaration)
        if words:
            names.add((found.group(1), False) if found else (words[-1], bool(parameters)))
    return {(name, function) for name, function in names if not name.startswith(("TEST", "TYPED_TEST"))}


@functools.cache
def our_headers() -> dict[str, list[pathlib.Path]]:
    """All headers of the checkout by file name."""
    headers = collections.defaultdict(list)
    for folder in FOLDERS:
        for path in (ROOT / folder).rglob("*.h"):
            headers[path.name].append(path)
    return headers


@functools.cache
def read(path: pathlib.Path) -> Text:
    text = SHORT_NAMESPACE.sub("", path.read_text(encoding="utf-8"))
    private = {("", name, False) for name in MACRO.findall(text)}
    opened: list[tuple[str, int]] = [("", 0)]
    namespaces = {""}
    for match in NAMESPACE.finditer(text):
        name, begin = opened[-1]
        if not match.group().startswith("}"):
            inner = "::".join(filter(None, (name, match.group(1))))
            namespaces.add(inner)
            # An unnamed one has the name of the one around it.
            opened.append((inner, match.end() if not match.group(1) else 0))
        elif len(opened) > 1:
            opened.pop()
            if begin:
                private.update((name, *one) for one in declared(text[begin:match.start()]))
    headers = {header for name in INCLUDE.findall(text) for header in our_headers().get(name.rpartition("/")[2], ())
               if str(header).endswith("/" + name)}
    said = INCLUDE.sub("", plain(text))
    return Text(frozenset(WORD.findall(said)), frozenset(CALLED.findall(said)), frozenset(namespaces),
                frozenset(headers), frozenset(private), "\nusing namespace " not in text)


@functools.cache
def read_source(path: str) -> Text:
    """What a source says, with all headers that it includes."""
    source = read(pathlib.Path(path))
    headers: set[pathlib.Path] = set()
    waiting = set(source.headers)
    while waiting:
        headers |= waiting
        waiting = {inner for header in waiting for inner in read(header).headers} - headers
    return dataclasses.replace(source, headers=frozenset(headers))


def disturbs(private: frozenset[tuple[str, str, bool]], other: Text) -> bool:
    """Whether `other` would see what is private elsewhere. A variable may have the name of a function."""
    return any(name in (other.called if function else other.words)
               and (not space or any(f"{inner}::".startswith(f"{space}::") for inner in other.namespaces))
               for space, name, function in private)


def fit(one: Text, other: Text) -> bool:
    """Whether two sources can be compiled as one, in any order."""
    return one.joins and other.joins and not (disturbs_any(one, other) or disturbs_any(other, one))


def disturbs_any(one: Text, other: Text) -> bool:
    """Whether a source or its headers keep something to themselves that another one or its headers would see."""
    # What both include means to both the same.
    headers = (read(header).private for header in one.headers - other.headers)
    private = one.private.union(*headers)
    return disturbs(private, other) or any(disturbs(private, read(header)) for header in other.headers - one.headers)


def group_sources(paths: list[str], most: int = MOST_SOURCES) -> list[list[str]]:
    """The sources in groups that can be compiled as one, `most` in each at most."""
    groups: list[list[str]] = []
    for path in paths:
        source = read_source(path)
        for members in groups:
            if len(members) < most and all(fit(source, read_source(member)) for member in members):
                members.append(path)
                break
        else:
            groups.append([path])
    return groups


def main() -> int:
    if len(sys.argv) != 3:
        print("source_groups: give the list of targets and the file to write", file=sys.stderr)
        return 1
    targets = [line.split(";") for line in pathlib.Path(sys.argv[1]).read_text(encoding="utf-8").splitlines()]
    # CMake keeps the properties of a source for a folder, not for a target.
    uses = collections.Counter(source for _, *sources in targets for source in sources)
    lines = []
    for name, *sources in targets:
        groups = group_sources([source for source in sources if uses[source] == 1])
        for number, members in enumerate(groups):
            if len(members) > 1:
                quoted = " ".join(f'"{member}"' for member in members)
                lines.append(f"set_source_files_properties({quoted} TARGET_DIRECTORY {name}\n"
                             f"  PROPERTIES UNITY_GROUP {number})\n")
    pathlib.Path(sys.argv[2]).write_text("".join(lines), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
