"""The library as a guest of other projects: installed and found by CMake, or as a part of their sources."""

from __future__ import annotations

import json
import pathlib
import re

from installed import HERE, OPTIONS, Installed, main, run

# Of what a library may have functions in it: its own, those of the compiler's library, and those whose version is a part
# of their names.
OWN_OR_VERSIONED = re.compile(
    r"galactic|\bstd::|__gnu_cxx::|\bfmt::v\d+::|^DW\.ref\.|^typeinfo (name )?for bool \("
)
OTHER_FLATBUFFERS = re.compile(r"(?<!\w)flatbuffers::")


class Library(Installed):
    COMPONENTS = ("dev",)

    def configure(self, source: pathlib.Path, name: str, *options: object) -> pathlib.Path:
        build = pathlib.Path(self.folder.name, name)
        run(OPTIONS.cmake, "-S", source, "-B", build, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={OPTIONS.compiler}",
            *options)  # fmt: skip
        return build

    def commands(self, build: pathlib.Path) -> dict[str, str]:
        commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
        return {pathlib.Path(one["file"]).name: one["command"].split(" -o ")[0] for one in commands}

    def version(self) -> str:
        header = (self.prefix / "include/galactic/version.h").read_text(encoding="utf-8")
        return ".".join(re.findall(r"#define GALACTIC_VERSION_\w+ (\d+)", header))

    def test_another_project_finds_it_and_keeps_its_flatbuffers(self) -> None:
        build = self.configure(HERE / "project", "project", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run(OPTIONS.cmake, "--build", build)
        # The host's FlatBuffers is not taken for galactic's.
        said = run(build / "spans", OPTIONS.packs / "room-column.pack")
        self.assertEqual(said, f"2 grids, galactic {self.version()}\n")

    def test_it_defines_nothing_that_a_host_could_have_in_another_version(self) -> None:
        lines = run("nm", "-C", "--defined-only", self.prefix / "lib/libgalactic.a").splitlines()
        symbols = {
            match[1] for line in lines if (match := re.match(r"[0-9a-f]+ [A-TV-Zuvw] (.*)", line))
        }
        self.assertGreater(len(symbols), 1000)
        self.assertEqual([name for name in symbols if not OWN_OR_VERSIONED.search(name)], [])
        self.assertEqual([name for name in symbols if OTHER_FLATBUFFERS.search(name)], [])

    def test_another_project_learns_that_there_is_no_such_component(self) -> None:
        source = pathlib.Path(self.folder.name, "component")
        source.mkdir()
        (source / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(component LANGUAGES CXX)\n"
            "find_package(galactic REQUIRED COMPONENTS runtime ${WANTED})\n", encoding="utf-8")  # fmt: skip
        prefix = f"-DCMAKE_PREFIX_PATH={self.prefix}"
        self.configure(source, "component/build", prefix)
        with self.assertRaisesRegex(AssertionError, "none\\s+called\\s+bake;"):
            self.configure(source, "component/build", prefix, "-DWANTED=bake")

    def test_another_project_has_the_sources_as_a_part(self) -> None:
        build = self.configure(
            HERE / "embedding", "embedding", f"-DGALACTIC_SOURCE={OPTIONS.source}"
        )
        # Of galactic, it builds the library, a static one, and neither installs nor packs anything.
        built = run("ninja", "-C", build, "-t", "inputs", "all")
        self.assertIn("galactic/runtime/libgalactic.a", built)
        self.assertNotIn("galactic-run", built)
        self.assertFalse((build / "CPackConfig.cmake").exists())
        installs = (build / "galactic/cmake_install.cmake").read_text(encoding="utf-8")
        self.assertNotIn("file(INSTALL", installs)
        # It sees the headers alone, and its compiler may warn of what ours does not.
        commands = self.commands(build)
        self.assertIn(f"-I{OPTIONS.source}/runtime/include", commands["spans.cpp"])
        self.assertNotRegex(commands["spans.cpp"], r"runtime/src|schema|flatbuffers")
        self.assertIn("-Dflatbuffers=", commands["pack_check.cpp"])
        self.assertNotIn("-Werror", commands["column_grid.cpp"])

    def test_it_names_nothing_of_the_build(self) -> None:
        for file in (self.prefix / "lib").rglob("*.cmake"):
            self.assertNotIn(str(OPTIONS.build), file.read_text(encoding="utf-8"), file)
            self.assertNotIn(str(OPTIONS.source), file.read_text(encoding="utf-8"), file)


if __name__ == "__main__":
    main()
