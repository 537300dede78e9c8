"""What the tests of pages share: packs of a small home, pages made of them, and a browser.

Each file of tests says which pages it opens, and is a program of its own: run_tests().
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from browser import Browser, Page, find_chromium

SKIPPED = 77
OPTIONS = argparse.Namespace()
# Of the PNG's filters in the test's own reader: small pictures suffice.
SMALL = (900, 520)
# The pages that galactic-run makes, with the arguments but for --view; galactic-pack makes all others.
RUNS = {
    "run": ("world.pack", "--policy", "replay:run.rec", "--view-envs", 2),
    "bare": ("bare/world.pack", "--envs", 1, "--steps", 5),
    # Three of four episodes can be played: env 1 has one of them, env 0 two.
    "shares": ("world.pack", "--envs", 2, "--order", "partition", "--episode-steps", 10),
}


def tool(program: str, *arguments: object, folder: pathlib.Path | None = None) -> str:
    return subprocess.run(
        [program, *map(str, arguments)], check=True, capture_output=True, text=True, cwd=folder
    ).stdout


class PageCase(unittest.TestCase):
    """Pages open without an error or a request."""

    pages: tuple[str, ...] = ()

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="galactic-pages-")
        cls.folder = pathlib.Path(cls.scratch.name)
        tool(OPTIONS.packs, cls.folder)
        for name in cls.pages:
            if name in RUNS:
                tool(OPTIONS.run, *RUNS[name], "--view", f"{name}.html", folder=cls.folder)
            else:
                tool(OPTIONS.pack, "view", f"{name}.pack", "-o", f"{name}.html", folder=cls.folder)
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()
        cls.scratch.cleanup()

    def open(self, name: str, fragment: str, shown: str, size: tuple[int, int] = SMALL) -> Page:
        page = self.browser.open(self.folder / f"{name}.html", "#" + fragment, size)
        self.addCleanup(self.expect_peace, page)
        page.shown(shown)
        return page

    def expect_peace(self, page: Page):
        """Neither an error nor a request but for the page itself."""
        page.evaluate("1")
        self.assertEqual(page.errors, [])
        self.assertEqual({url.split("#")[0] for url in page.requests}, {page.url})

    def click(self, page: Page, selector: str, number: int = 0):
        x, y = page.evaluate(
            f"(() => {{ const one = document.querySelectorAll({json.dumps(selector)})[{number}];"
            "const area = one.getBoundingClientRect();"
            "return [area.left + area.width / 2, area.top + area.height / 2]; })()"
        )
        page.click(x, y)

    def marked(self, page: Page) -> list[str]:
        """The entries of the list that are marked as shown."""
        return page.evaluate(
            "[...document.querySelectorAll('#list [aria-current=true]')].map((one) => one.firstChild.textContent)"
        )

    def show_all_parts(self, page: Page) -> int:
        count = page.evaluate("galactic.parts.length")
        for number in range(count):
            page.evaluate(f"galactic.show(galactic.parts[{number}]).then(() => 1)")
            problem = page.evaluate(
                "document.getElementById('progress').hidden ? '' : document.getElementById('progress').textContent"
            )
            self.assertEqual(problem, "", f"part {number}")
        return count


def run_tests(doc: str | None) -> int:
    """Runs the tests of the program; its exit code, SKIPPED where there is no Chromium."""
    parser = argparse.ArgumentParser(
        description=doc, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--packs", required=True, help="the program that writes the packs")
    for name in ("pack", "run"):
        parser.add_argument(f"--{name}", required=True, help=f"galactic-{name}")
    parser.add_argument("tests", nargs="*", help="tests to run, as CLASS.TEST")
    parser.parse_args(namespace=OPTIONS)
    if not find_chromium():
        print("skipped: no Chromium found (Debian: chromium), pages are not tested in a browser")
        return SKIPPED
    result = unittest.main(argv=[sys.argv[0], "-v", *OPTIONS.tests], exit=False).result
    return 0 if result.wasSuccessful() else 1
