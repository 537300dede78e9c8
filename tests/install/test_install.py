"""What cmake --install and cpack leave of the programs: man pages, completions, licenses, Debian packages."""

from __future__ import annotations

import pathlib
import re
import shutil

from installed import OPTIONS, Installed, main, run

COMPLETIONS = pathlib.Path("/usr/share/bash-completion/bash_completion")


class Install(Installed):
    COMPONENTS = ("run", "bake", "dev")

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
    main()
