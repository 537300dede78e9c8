"""What cmake --install and cpack leave: a library that another project finds, tools with their man pages and
completions, Debian packages."""

from __future__ import annotations

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
COMPLETIONS = pathlib.Path("/usr/share/bash-completion/bash_completion")
OPTIONS = argparse.Namespace()


def run(*command: object, **more: object) -> str:
    done = subprocess.run([str(one) for one in command], capture_output=True, text=True, **more)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


class Install(unittest.TestCase):
    """The build folder, installed below a prefix of its own."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.prefix = pathlib.Path(cls.folder.name, "prefix")
        for component in ("run", "bake", "dev"):
            run(
                OPTIONS.cmake,
                "--install",
                OPTIONS.build,
                "--prefix",
                cls.prefix,
                "--component",
                component,
            )

    @classmethod
    def tearDownClass(cls) -> None:
        cls.folder.cleanup()

    def tool(self, name: str) -> pathlib.Path:
        return self.prefix / "bin" / name

    def tools(self) -> list[str]:
        return sorted(path.name for path in (self.prefix / "bin").iterdir())

    def verbs(self) -> list[str]:
        text = run(self.tool("galactic-pack"), "--help").split("Verbs:\n")[1].split("\n\n")[0]
        return [line.split()[0] for line in text.splitlines()]

    def complete(self, *words: str) -> list[str]:
        """What bash offers for the last word."""
        script = f"""
            source {COMPLETIONS}
            source {self.prefix}/share/bash-completion/completions/{words[0]}
            PATH={self.prefix}/bin:$PATH
            COMP_WORDS=({' '.join(word or "''" for word in words)}); COMP_CWORD={len(words) - 1}
            COMP_LINE="{' '.join(words)}"; COMP_POINT=${{#COMP_LINE}}
            _galactic; printf '%s\\n' "${{COMPREPLY[@]}}" """
        return run("bash", "--norc", "-c", script, cwd=self.folder.name).split()

    def test_another_project_finds_the_library(self) -> None:
        build = pathlib.Path(self.folder.name, "project")
        run(OPTIONS.cmake, "-S", HERE / "project", "-B", build, "-G", "Ninja",
            f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={OPTIONS.compiler}")  # fmt: skip
        run(OPTIONS.cmake, "--build", build)
        version = run(self.tool("galactic-run"), "--version").split()[1]
        said = run(build / "spans", OPTIONS.packs / "room-column.pack")
        self.assertEqual(said, f"2 grids, galactic {version}\n")

    def test_another_project_learns_that_there_is_no_such_component(self) -> None:
        source = pathlib.Path(self.folder.name, "component")
        source.mkdir()
        (source / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(component LANGUAGES CXX)\n"
            "find_package(galactic REQUIRED COMPONENTS runtime ${WANTED})\n", encoding="utf-8")  # fmt: skip
        configure = (OPTIONS.cmake, "-S", source, "-B", source / "build", "-G", "Ninja",
                     f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={OPTIONS.compiler}")  # fmt: skip
        run(*configure)
        with self.assertRaisesRegex(AssertionError, "none\\s+called\\s+bake;"):
            run(*configure, "-DWANTED=bake")

    def test_another_project_has_the_sources_as_a_part(self) -> None:
        build = pathlib.Path(self.folder.name, "embedding")
        run(OPTIONS.cmake, "-S", HERE / "embedding", "-B", build, "-G", "Ninja",
            f"-DGALACTIC_SOURCE={OPTIONS.source}", f"-DCMAKE_CXX_COMPILER={OPTIONS.compiler}")  # fmt: skip
        # Of galactic, it builds the library, a static one, and neither installs nor packs anything.
        built = run("ninja", "-C", build, "-t", "inputs", "all")
        self.assertIn("galactic/runtime/libgalactic.a", built)
        self.assertNotIn("galactic-run", built)
        self.assertFalse((build / "CPackConfig.cmake").exists())
        installs = (build / "galactic/cmake_install.cmake").read_text(encoding="utf-8")
        self.assertNotIn("file(INSTALL", installs)
        # It sees the headers alone, and its compiler may warn of what ours does not.
        commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
        command = {pathlib.Path(one["file"]).name: one["command"] for one in commands}
        self.assertIn(f"-I{OPTIONS.source}/runtime/include", command["spans.cpp"])
        self.assertNotIn(f"{OPTIONS.source}/runtime/src", command["spans.cpp"].split(" -o ")[0])
        self.assertNotIn("-Werror", command["column_grid.cpp"])

    def test_the_library_names_nothing_of_the_build(self) -> None:
        for file in (self.prefix / "lib").rglob("*.cmake"):
            self.assertNotIn(str(OPTIONS.build), file.read_text(encoding="utf-8"), file)
            self.assertNotIn(str(OPTIONS.source), file.read_text(encoding="utf-8"), file)

    def test_each_component_brings_its_license(self) -> None:
        documents = self.prefix / "share/doc"
        license = (OPTIONS.source / "LICENSE").read_text(encoding="utf-8")
        packages = {"galactic", "libgalactic-dev"}
        if self.tool("galactic-bake").exists():
            packages.add("galactic-bake")
        self.assertEqual({path.name for path in documents.iterdir()}, packages)
        for package in packages:
            self.assertEqual((documents / package / "copyright").read_text(encoding="utf-8"), license)

    def test_the_tools_run(self) -> None:
        self.assertLessEqual({"galactic-run", "galactic-pack"}, set(self.tools()))
        for tool in self.tools():
            self.assertRegex(run(self.tool(tool), "--version"), r"\d+\.\d+\.\d+")

    def test_each_tool_and_verb_has_a_man_page(self) -> None:
        pages = {path.stem for path in (self.prefix / "share/man/man1").glob("*.1")}
        wanted = {*self.tools(), *(f"galactic-pack-{verb}" for verb in self.verbs())}
        if not pages:
            self.skipTest("built without help2man")
        self.assertEqual(pages, wanted)
        for page in wanted:
            text = (self.prefix / f"share/man/man1/{page}.1").read_text(encoding="utf-8")
            self.assertIn(".SH SYNOPSIS", text)
            self.assertIn(".B 130\ninterrupted", text)
            self.assertNotIn("Exit codes:", text)
            # NAME says the name once, and what an option does stands on a line of its own.
            name = text.split(".SH NAME\n")[1].splitlines()[0]
            self.assertRegex(name, rf"^{page.replace('-', '.{1,2}')} .{{1,2}} [a-z]")
            self.assertNotIn(page, name.split(" ", 1)[1])
            self.assertNotRegex(text, r"(?m)^\\fB.*\] [A-Z][a-z]+ [a-z]")

    def test_bash_completes_options_verbs_and_choices(self) -> None:
        if not COMPLETIONS.is_file():
            self.skipTest("no bash-completion")
        self.assertEqual(self.complete("galactic-pack", "c"), ["check", "column"])
        self.assertEqual(
            sorted(self.complete("galactic-pack", "")),
            sorted([*self.verbs(), "--help", "--version"]),
        )
        self.assertEqual(self.complete("galactic-pack", "check", "--ju"), ["--junit"])
        self.assertEqual(self.complete("galactic-run", "--backend", ""), ["auto", "cuda", "gl", "soft"])
        self.assertEqual(self.complete("galactic-pack", "export", "a.pack", "--to", "ep"), ["episode_set"])
        self.assertEqual(self.complete("galactic-run", "--slide-direction", "t"), ["towards-base"])
        # What is in capitals stands for files, or for what nobody here knows.
        pathlib.Path(self.folder.name, "picker.pack").touch()
        self.assertEqual(self.complete("galactic-run", "--policy", "pick"), ["picker.pack"])
        self.assertEqual(self.complete("galactic-run", "--policy", "r"), ["random"])
        self.assertEqual(self.complete("galactic-run", "--camera", ""), ["head", "follow", "top"])
        for tool in self.tools():
            long_names = set(
                re.findall(r"^ +(?:-\w,)?(--[a-z0-9-]+)", run(self.tool(tool), "--help"), re.M)
            )
            self.assertGreater(len(long_names), 1)
            self.assertEqual(set(self.complete(tool, "--")), long_names)

    def test_debian_packages_hold_what_they_should(self) -> None:
        if not shutil.which("dpkg-shlibdeps"):
            self.skipTest("no dpkg-dev")
        packages = pathlib.Path(self.folder.name, "packages")
        run(OPTIONS.cpack, "-G", "DEB", "-B", packages, cwd=OPTIONS.build)
        found = {path.name.split("_")[0]: path for path in packages.glob("*.deb")}
        self.assertLessEqual({"galactic", "libgalactic-dev"}, set(found))
        listing = {name: run("dpkg-deb", "-c", path) for name, path in found.items()}
        self.assertIn("./usr/bin/galactic-run", listing["galactic"])
        self.assertIn("./usr/bin/galactic-pack", listing["galactic"])
        self.assertIn("galacticConfig.cmake", listing["libgalactic-dev"])
        for text in listing.values():
            self.assertNotIn(str(OPTIONS.build), text)
        depends = run("dpkg-deb", "-f", found["galactic"], "Depends")
        self.assertIn("libc6", depends)
        for heavy in ("assimp", "embree", "bullet", "urdfdom"):
            self.assertNotIn(heavy, depends)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    for name in ("--cmake", "--cpack", "--compiler"):
        parser.add_argument(name, required=True)
    for name in ("--build", "--source", "--packs"):
        parser.add_argument(name, type=pathlib.Path, required=True)
    OPTIONS, rest = parser.parse_known_args(namespace=OPTIONS)
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
