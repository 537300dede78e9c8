"""Sources that are compiled as one do not see what the others keep to themselves."""

import pathlib
import sys
import tempfile
import unittest
import unittest.mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import source_groups  # noqa: E402


def source(body: str, rest: str = "", namespace: str = "galactic") -> str:
    return (f"namespace {namespace} {{\nnamespace {{\n\n{body}\n\n}}  // namespace\n\n{rest}\n\n"
            f"}}  // namespace {namespace}\n")


class SourceGroupsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def groups(self, *texts: str) -> list[int]:
        """The sizes of the groups of sources with these texts."""
        count = len(list(self.folder.iterdir()))
        paths = [self.folder / f"source_{count + at}.cpp" for at in range(len(texts))]
        for path, text in zip(paths, texts):
            path.write_text(text)
        return [len(group) for group in source_groups.group_sources([str(path) for path in paths])]

    def private(self, body: str) -> set[str]:
        path = self.folder / "private.cpp"
        path.write_text(source(body))
        source_groups.read.cache_clear()
        return {name for _, name, _ in source_groups.read(path).private}

    def test_knows_what_an_unnamed_namespace_declares(self):
        for body, name in (
                ("constexpr float kTurn = 6.3F;", "kTurn"),
                ("const std::map<int, std::string> kNames{{1, \"one\"}};", "kNames"),
                ("constexpr std::array<std::string_view, 2>\n    kWords{\"a\", \"b\"};", "kWords"),
                ("struct Robot {\n  int links = 0;\n};", "Robot"),
                ("class Probe final : public Base {\n};", "Probe"),
                ("enum class Side : int { kLeft };", "Side"),
                ("using Rows = std::array<double, 6>;", "Rows"),
                ("std::vector<Vec3> cornersOf(const Box& box) {\n  return {};\n}", "cornersOf"),
                ("template <typename T>\nT twice(T value) {\n  return value + value;\n}", "twice"),
                ("#define WIDTH 3", "WIDTH"),
                ("TEST(Robot, Moves) {\n}", "Robot_Moves")):
            self.assertEqual(self.private(body), {name}, body)

    def test_strangers_go_together(self):
        self.assertEqual(self.groups(source("int one() {\n  return 1;\n}"), source("int two() {\n  return 2;\n}")),
                         [2])

    def test_equal_names_stay_apart(self):
        self.assertEqual(self.groups(source("constexpr int kSeed = 1;"), source("constexpr int kSeed = 2;")), [1, 1])

    def test_a_name_that_the_other_uses_stays_apart(self):
        self.assertEqual(self.groups(source("struct Robot {\n};"), source("", "int linksOf(const Robot& robot);")),
                         [1, 1])

    def test_namespaces_that_do_not_see_each_other_go_together(self):
        one = source("constexpr int kSeed = 1;", namespace="galactic::one_test")
        two = source("constexpr int kSeed = 2;", namespace="galactic::two_test")
        inner = source("constexpr int kSeed = 3;", namespace="galactic::two_test::inner")
        self.assertEqual(self.groups(one, two), [2])
        self.assertEqual(self.groups(two, inner), [1, 1])

    def test_comments_literals_and_members_are_no_uses(self):
        self.assertEqual(self.groups(source("void move(int n) {\n}"), source(
            "", '// move it\nauto text = "move";\nauto b = std::move(text);\nauto c = b.move();')), [2])

    def test_a_variable_may_have_the_name_of_a_function(self):
        order = source("std::vector<int> order(int n) {\n  return {};\n}")
        self.assertEqual(self.groups(order, source("", "int first(const Order& order) {\n  return order[0];\n}")), [2])
        self.assertEqual(self.groups(order, source("", "int first() {\n  return order(1)[0];\n}")), [1, 1])

    def test_macros_are_seen_everywhere(self):
        self.assertEqual(self.groups("#define WIDTH 3\n", source("", "int WIDTH = 4;", "other")), [1, 1])

    def test_what_both_include_keeps_nobody_apart(self):
        header = self.folder / "both.h"
        header.write_text("#define WIDTH 3\n")
        source_groups.our_headers()[header.name] = [header]
        self.addCleanup(source_groups.our_headers().pop, header.name)
        uses = [f'#include "{self.folder.name}/both.h"\nint f{n}() {{\n  return WIDTH;\n}}\n' for n in range(3)]
        self.assertEqual(self.groups(*uses), [3])
        self.assertEqual(self.groups(uses[0], "int WIDTH = 4;\n"), [1, 1])

    def test_a_shorter_name_of_the_standard_library_keeps_nobody_apart(self):
        alias = "namespace fs = std::filesystem;"
        self.assertEqual(self.groups(source(alias), source(alias, "bool isFile(const fs::path& path);")), [2])
        self.assertEqual(self.groups(source("namespace fs = galactic::flows;"), source(alias, "fs::path path();")), [1, 1])

    def test_a_source_that_opens_a_namespace_to_all_stays_apart(self):
        self.assertEqual(self.groups("int a;\nusing namespace std;\n", "int b;\n"), [1, 1])

    def test_a_group_does_not_grow_without_end(self):
        many = [source(f"int f{n}() {{\n  return {n};\n}}") for n in range(source_groups.MOST_SOURCES + 1)]
        self.assertEqual(self.groups(*many), [source_groups.MOST_SOURCES, 1])

    def test_a_folder_may_have_a_space_in_its_name(self):
        folder = self.folder / "two words"
        folder.mkdir()
        sources = [folder / name for name in ("a.cpp", "b.cpp")]
        for path in sources:
            path.write_text(source("constexpr int kOf_" + path.stem + " = 1;"))
        (folder / "targets.txt").write_text(f"tool;{sources[0]};{sources[1]}\n")
        command = ["source_groups", str(folder / "targets.txt"), str(folder / "groups.cmake")]
        with unittest.mock.patch.object(sys, "argv", command):
            self.assertEqual(source_groups.main(), 0)
        self.assertEqual((folder / "groups.cmake").read_text(),
                         f'set_source_files_properties("{sources[0]}" "{sources[1]}" TARGET_DIRECTORY tool\n'
                         "  PROPERTIES UNITY_GROUP 0)\n")


if __name__ == "__main__":
    unittest.main()
