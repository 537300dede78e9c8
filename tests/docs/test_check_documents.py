#!/usr/bin/env python3
"""The check of the documents catches what it is for: each part is given a planted violation."""

import pathlib
import tempfile
import unittest

import check_documents


class CheckDocumentsTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.root = pathlib.Path(holder.name)
        (self.root / "docs").mkdir()
        (self.root / "packs").mkdir()
        (self.root / "a.cpp").write_text("int a;\n")
        self.plant("<!-- file: a.cpp -->\n```cpp\nint a;\n```\nSee [b](../a.cpp#x) and "
                   "[c](https://example.org).\n```sh\ngalactic-tool yes\n```\n")
        tool = self.root / "galactic-tool"
        tool.write_text('#!/bin/sh\n[ "$1" = yes ] && exit 0\n'
                        'for last; do :; done; [ "$last" = --help ] || exit 7\n'
                        'if [ $# = 1 ]; then echo "  -q,--quiet  Only errors"; else echo "  --slow N  Steps"; fi\n')
        tool.chmod(0o755)

    def plant(self, text: str):
        (self.root / "docs" / "page.md").write_text(text)

    def plant_tools(self, text: str):
        (self.root / "docs" / "tools.md").write_text(f"## galactic-tool\n\n`-q`, `--quiet`: only errors.\n\n{text}")

    def test_accepts_what_is_true(self):
        self.assertEqual(check_documents.check_code(self.root), [])
        self.assertEqual(check_documents.check_links(self.root), [])
        self.assertEqual(check_documents.check_commands(self.root, self.root), [])
        self.plant_tools("### fall\n\n| option | what |\n|---|---|\n| `--slow N` | steps; not `--fast` |\n")
        self.assertEqual(check_documents.check_options(self.root, self.root), [])

    def test_refuses_an_option_of_a_verb_that_is_not_listed(self):
        self.plant_tools("### fall\n\nIt falls.\n")
        self.assertEqual(check_documents.check_options(self.root, self.root),
                         ["docs/tools.md: does not list galactic-tool --slow"])

    def test_refuses_an_option_that_no_tool_has(self):
        self.plant_tools("| `--slow N` | steps |\n")
        self.assertEqual(check_documents.check_options(self.root, self.root),
                         ["docs/tools.md: lists --slow, which galactic-tool does not have"])

    def test_refuses_options_of_no_tool(self):
        (self.root / "docs" / "tools.md").write_text("Nothing.\n")
        self.assertEqual(len(check_documents.check_options(self.root, self.root)), 1)

    def test_refuses_a_block_that_differs_from_its_file(self):
        self.plant("<!-- file: a.cpp -->\n```cpp\nint b;\n```\n")
        self.assertEqual(len(check_documents.check_code(self.root)), 1)

    def test_refuses_a_block_of_a_missing_file(self):
        self.plant("<!-- file: gone.cpp -->\n```cpp\nint b;\n```\n")
        self.assertEqual(len(check_documents.check_code(self.root)), 1)

    def test_refuses_documents_that_quote_nothing(self):
        self.plant("```cpp\nint b;\n```\n")
        self.assertEqual(len(check_documents.check_code(self.root)), 1)

    def test_refuses_a_link_to_nowhere(self):
        self.plant("See [b](gone.md).\n")
        self.assertEqual(len(check_documents.check_links(self.root)), 1)

    def test_refuses_a_link_to_no_heading(self):
        self.plant("# A `b`-c: d, e!\n\n## Same\n\n## Same\n\n```sh\n# none\n```\n"
                   "[1](#a-b-c-d-e) [2](page.md#same) [3](#same-1) [4](../a.cpp#L3) `[5](#code)`\n")
        self.assertEqual(check_documents.check_links(self.root), [])
        self.plant("# One\n\n```sh\n# none\n```\n[1](#ones) [2](page.md#none)\n")
        self.assertEqual(check_documents.check_links(self.root), [
            "docs/page.md: links to #ones, but no heading there is called so; did you mean #one?",
            "docs/page.md: links to page.md#none, but no heading there is called so; did you mean #one?"])

    def test_refuses_an_example_that_is_not_listed_or_not_run(self):
        for folder in ("examples/python", "tests/python"):
            (self.root / folder).mkdir(parents=True)
        self.assertEqual(len(check_documents.check_examples(self.root)), 1)
        (self.root / "examples" / "python" / "fly.py").write_text("")
        (self.root / "examples" / "README.md").write_text("| program |\n|---|\n| `fly.py WORLD` | flies |\n")
        (self.root / "tests" / "python" / "test_examples.py").write_text('output_of("fly.py")\n')
        self.assertEqual(check_documents.check_examples(self.root), [])
        (self.root / "examples" / "python" / "swim.py").write_text("")
        offences = check_documents.check_examples(self.root)
        self.assertEqual(len(offences), 2, offences)

    def test_skips_documents_whose_tools_are_not_built(self):
        (self.root / "docs" / "other.md").write_text("```sh\ngalactic-gone no\nprintf a | galactic-tool no\n```\n")
        self.assertEqual(check_documents.check_commands(self.root, self.root), [])

    def test_refuses_to_skip_all(self):
        self.plant("```sh\ngalactic-gone no\n```\n")
        self.assertEqual(len(check_documents.check_commands(self.root, self.root)), 1)

    def test_refuses_a_command_that_fails(self):
        self.plant("```sh\ngalactic-tool no\n```\n")
        self.assertEqual(len(check_documents.check_commands(self.root, self.root)), 1)

    def test_refuses_a_command_that_does_not_fail_as_announced(self):
        self.plant("```sh\ngalactic-tool yes  # exit 7\n```\n")
        self.assertEqual(len(check_documents.check_commands(self.root, self.root)), 1)

    def test_accepts_an_announced_exit_code_and_a_continued_line(self):
        self.plant("```sh\ngalactic-tool \\\n  no  # exit 7\n```\n")
        self.assertEqual(check_documents.check_commands(self.root, self.root), [])

    def test_leaves_other_commands_and_blocks_alone(self):
        text = "```sh\nrm -rf elsewhere\n```\n```text\ngalactic-tool no\n```\n"
        self.assertEqual(check_documents.commands_of(text), [])


if __name__ == "__main__":
    unittest.main()
