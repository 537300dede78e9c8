"""The library as a guest of other projects: installed and found by CMake or pkg-config, or as a part of their sources."""

from __future__ import annotations

import json
import os
import pathlib
import re
import shutil

from installed import HERE, OPTIONS, Installed, main, run

# What the programs, the bake, the Python package and the tests need, and the library does not.
PACKAGES_OF_OTHERS = (
    "CLI11", "nlohmann_json", "PNG", "ZLIB", "JPEG", "assimp", "Bullet", "embree", "urdfdom", "tomlplusplus",
    "meshoptimizer", "pybind11", "GTest", "benchmark",
)  # fmt: skip
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

    def check_libepoxy(self, program: pathlib.Path) -> None:
        """Only a program into which the renderer came needs it: with large pieces of the library, it comes earlier."""
        calls = "epoxy_" in run("nm", "--undefined-only", program)
        self.assertEqual("[libepoxy.so" in run("readelf", "-d", program), calls)

    def version(self) -> str:
        header = (self.prefix / "include/galactic/version.h").read_text(encoding="utf-8")
        return ".".join(re.findall(r"#define GALACTIC_VERSION_\w+ (\d+)", header))

    def test_another_project_finds_it_and_keeps_what_is_its_own(self) -> None:
        build = self.configure(HERE / "project", "project", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run(OPTIONS.cmake, "--build", build)
        # The host's FlatBuffers is not taken for galactic's, and its plugin stays.
        said = run(build / "spans", OPTIONS.packs / "room-column.pack")
        self.assertEqual(said, f"plugin\n2 grids, galactic {self.version()}\n")
        self.check_libepoxy(build / "spans")
        self.assertNotIn("-DFMT_", self.commands(build)["spans.cpp"])

    def test_a_compiler_with_pkg_config_finds_it(self) -> None:
        if not shutil.which("pkg-config"):
            self.skipTest("no pkg-config")
        program = pathlib.Path(self.folder.name, "spans")
        environment = {**os.environ, "PKG_CONFIG_PATH": str(self.prefix / "lib/pkgconfig")}
        self.assertEqual(
            run("pkg-config", "--modversion", "galactic", env=environment), f"{self.version()}\n"
        )
        for more in ([], ["--static"]):
            flags = run(
                "pkg-config", "--cflags", "--libs", *more, "galactic", env=environment
            ).split()
            run(OPTIONS.compiler, "-std=c++20", HERE / "project/spans.cpp", "-o", program, *flags)
            said = run(program, OPTIONS.packs / "room-column.pack")
            self.assertEqual(said, f"2 grids, galactic {self.version()}\n")
            self.check_libepoxy(program)

    def test_a_fmt_of_another_major_version_is_refused_at_configuring(self) -> None:
        other = pathlib.Path(self.folder.name, "fmt")
        other.mkdir()
        (other / "fmt-config.cmake").write_text(
            "add_library(fmt::fmt INTERFACE IMPORTED)\n", encoding="utf-8"
        )
        version = pathlib.Path(self.folder.name, "version.cmake")
        version.write_text(
            "include(CMakePackageConfigHelpers)\nwrite_basic_package_version_file("
            f"{other}/fmt-config-version.cmake VERSION 99.1.0 COMPATIBILITY AnyNewerVersion ARCH_INDEPENDENT)\n",
            encoding="utf-8")  # fmt: skip
        run(OPTIONS.cmake, "-P", version)
        with self.assertRaisesRegex(
            AssertionError, r'"\d+\.\d+\.\d+\.\.\.<\d+"(.|\n)*version: 99\.1\.0'
        ):
            # It is the only one: nothing is looked for where the system has packages.
            self.configure(HERE / "project", "other_fmt", f"-DCMAKE_PREFIX_PATH={self.prefix};{other}",
                           f"-DCMAKE_MAKE_PROGRAM={shutil.which('ninja')}", "-DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF",
                           "-DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF")  # fmt: skip

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
        disabled = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in PACKAGES_OF_OTHERS]
        build = self.configure(
            HERE / "embedding", "embedding", f"-DGALACTIC_SOURCE={OPTIONS.source}", *disabled
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

    def test_the_installed_examples_are_a_project(self) -> None:
        examples = self.prefix / "share/doc/libgalactic-dev/examples"
        build = self.configure(examples, "examples", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run(OPTIONS.cmake, "--build", build)
        programs = {path.stem for path in examples.glob("*.cpp")}
        self.assertIn("query_scene", programs)
        self.assertLessEqual(programs, {path.name for path in build.iterdir()})
        said = run(build / "query_scene", OPTIONS.packs / "room-column.pack")
        self.assertIn("outside the grid\n", said)

    def test_the_example_that_bakes_needs_no_package_of_the_tools(self) -> None:
        if not (OPTIONS.build / "bin/galactic-bake").exists():
            self.skipTest("built without the bake")
        disabled = "-DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON"
        build = self.configure(OPTIONS.source / "examples/bake", "bake", disabled)
        built = run("ninja", "-C", build, "-t", "inputs", "all")
        self.assertIn("galactic/bake/libgalactic_bake.a", built)
        self.assertNotIn("galactic-bake", built)

    def test_it_is_built_and_installed_without_the_tools(self) -> None:
        disabled = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in PACKAGES_OF_OTHERS]
        off = [f"-DGALACTIC_BUILD_{name}=OFF" for name in ("TOOLS", "BAKE", "PYTHON")]
        build = self.configure(OPTIONS.source, "library", *off, *disabled)
        built = run("ninja", "-C", build, "-t", "inputs", "all")
        self.assertIn("runtime/libgalactic.a", built)
        self.assertNotIn("galactic-run", built)
        self.assertNotIn(
            "galactic-run", (build / "cmake_install.cmake").read_text(encoding="utf-8")
        )

    def test_it_names_nothing_of_the_build(self) -> None:
        for file in (*(self.prefix / "lib").rglob("*.cmake"), *(self.prefix / "lib").rglob("*.pc")):
            self.assertNotIn(str(OPTIONS.build), file.read_text(encoding="utf-8"), file)
            self.assertNotIn(str(OPTIONS.source), file.read_text(encoding="utf-8"), file)


if __name__ == "__main__":
    main()
