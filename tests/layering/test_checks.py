#!/usr/bin/env python3
"""The checks of this folder catch what they are for: each is given a planted violation."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import check_imports
import check_includes
import check_needed
import check_schema
import check_style

PROJECT = pathlib.Path(__file__).parents[2]


class PlantedTree(unittest.TestCase):
    """A small project in a folder of its own."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.root = pathlib.Path(holder.name)
        for path in ("runtime/include/galactic/pack.h", "bake/include/galactic/bake/bake.h",
                     "runtime/src/inner.h", "schema/README.md"):
            self.plant(path, "// fine\n")

    def plant(self, path: str, text: str):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")


class IncludesTest(PlantedTree):
    def offences(self, path: str, text: str) -> list[str]:
        self.plant(path, text)
        return check_includes.check_tree(self.root)[0]

    def assert_refused(self, path: str, text: str, why: str):
        offences = self.offences(path, text)
        self.assertEqual(len(offences), 1, offences)
        self.assertTrue(offences[0].startswith(path + ": "), offences[0])
        self.assertIn(why, offences[0])

    def test_accepts_what_each_folder_may_know(self):
        fine = {
            "runtime/src/a.cpp": '#include "galactic/pack.h"\n#include "inner.h"\n#include <vector>\n'
                                 '#include <fmt/format.h>\n#include <sys/mman.h>\n#include <xxhash.h>\n'
                                 '#include "galactic/schema/pack_generated.h"\n',
            "runtime/app/main.cpp": "#include <CLI/CLI.hpp>\n",
            "runtime/pictures/image.h": "",
            "runtime/pictures/png_file.cpp": '#include "pictures/image.h"\n#include <png.h>\n',
            "runtime/app/b.cpp": '#include "pictures/image.h"\n',
            "python/src/a.cpp": '#include <pybind11/numpy.h>\n#include "galactic/pack.h"\n',
            "pack_tool/a.cpp": '#include <nlohmann/json.hpp>\n#include "pictures/image.h"\n',
            "runtime/src/support/text.h": "",
            "runtime/src/layout/cell.h": "",
            "pack_tool/b.cpp": '#include "support/text.h"\n#include "layout/cell.h"\n',
            "bake/src/c.cpp": '#include "support/text.h"\n#include "layout/cell.h"\n',
            "bake/src/import/assimp_reader.cpp": "#include <assimp/scene.h>\nconst aiScene* s;\n",
            "bake/src/engines/bullet_columns.cpp":
                "#include <BulletCollision/CollisionShapes/btSphereShape.h>\n",
            "bake/src/fit/convex_hull.cpp": "#include <LinearMath/btConvexHullComputer.h>\n",
            "bake/src/engines/embree_columns.cpp": "#include <embree3/rtcore.h>\nRTCScene s;\n",
            "bake/src/b.cpp": '#include "galactic/bake/bake.h"\n#include "galactic/pack.h"\n',
            "tests/a.cpp": "#include <gtest/gtest.h>\n#include <benchmark/benchmark.h>\n",
        }
        for path, text in fine.items():
            self.plant(path, text)
        self.assertEqual(check_includes.check_tree(self.root)[0], [])

    def test_refuses_the_bake_side_in_the_runtime(self):
        self.assert_refused("runtime/src/a.cpp", '#include "galactic/bake/bake.h"\n', "not found in")

    def test_refuses_png_outside_of_the_pictures(self):
        self.assert_refused("pack_tool/b.cpp", "png_structp p;\n", "may name types of libpng")

    def test_refuses_the_run_times_inside_in_its_programs(self):
        self.plant("runtime/src/workers.h", "")
        self.assert_refused("runtime/app/c.cpp", '#include "src/workers.h"\n',
                            "runtime/app may not know runtime/src")

    def test_refuses_the_bake_side_by_a_relative_path(self):
        self.assert_refused("runtime/src/a.cpp",
                            '#include "../../bake/include/galactic/bake/bake.h"\n', "may not know bake")

    def test_refuses_the_bake_side_in_the_pack_tool(self):
        self.assert_refused("pack_tool/a.cpp", '#include "bake/include/galactic/bake/bake.h"\n',
                            "may not know bake")

    def test_refuses_the_runtime_s_internals_elsewhere(self):
        self.assert_refused("pack_tool/a.cpp", '#include "runtime/src/inner.h"\n',
                            "may not know runtime/src")

    def test_refuses_what_the_tools_share_in_the_interface_and_in_python(self):
        self.plant("runtime/src/support/text.h", "")
        self.assert_refused("runtime/include/galactic/scene.h", '#include "support/text.h"\n', "not found in")
        (self.root / "runtime/include/galactic/scene.h").unlink()
        self.assert_refused("python/src/a.cpp", '#include "support/text.h"\n', "not found in")

    def test_refuses_the_parts_of_the_library_that_the_tools_do_not_share(self):
        self.plant("runtime/src/simulation/step.h", "")
        self.assert_refused("pack_tool/a.cpp", '#include "simulation/step.h"\n', "may not know runtime/src")

    def test_refuses_the_phases_of_a_step_in_what_they_work_on(self):
        self.plant("runtime/src/simulation/phases/task.h", '#include "simulation/state/model.h"\n')
        self.plant("runtime/src/simulation/state/model.h", "")
        self.assertEqual(check_includes.check_tree(self.root)[0], [])
        self.assert_refused("runtime/src/simulation/state/model.cpp", '#include "simulation/phases/task.h"\n',
                            "runtime/src/simulation/state may not know runtime/src/simulation/phases")

    def test_refuses_what_a_folder_of_a_library_may_not_know_of_others(self):
        self.plant("runtime/src/simulation/state/model.h", "")
        self.plant("bake/src/episodes/episode_draft.h", "")
        for path, header, who in (
                ("runtime/src/support/processor.h", "simulation/state/model.h",
                 "runtime/src/support may not know runtime/src/simulation, only itself; move"),
                ("runtime/src/render/soft/pane.h", "simulation/state/model.h",
                 "runtime/src/render/soft may not know runtime/src/simulation, only layout, render, render/raster, support;"),
                ("runtime/src/render/noise/a.cpp", "../../simulation/state/model.h", "may not know runtime/src/simulation"),
                ("bake/src/common/srgb.h", "episodes/episode_draft.h", "bake/src/common may not know bake/src/episodes")):
            with self.subTest(path):
                self.assert_refused(path, f'#include "{header}"\n', who)
                (self.root / path).unlink()

    def test_accepts_what_a_folder_of_a_library_may_know_of_others(self):
        self.plant("runtime/src/support/text/words.h", "")
        self.plant("runtime/src/render/raster/tables.h", "")
        self.assertEqual(self.offences("runtime/src/render/soft/deep/a.inl",
                                       '#include "render/raster/tables.h"\n#include "support/text/words.h"\n'), [])

    def test_refuses_a_new_folder_of_a_library_without_a_rule(self):
        self.plant("runtime/src/support/text.h", "")
        self.assert_refused("runtime/src/weather/a.cpp", '#include "support/text.h"\n', "no rule says what runtime/src/weather")

    def test_looks_into_inl_files(self):
        self.assert_refused("runtime/src/render/raster/clip.inl", '#include "galactic/bake/bake.h"\n', "not found in")

    def test_refuses_a_document_that_shows_other_tables(self):
        tables = check_includes.shown_parts()
        self.plant("docs/architecture.md", f"Folders:\n\n```text\n{tables}\n```\n")
        self.assertEqual(check_includes.check_tree(self.root)[0], [])
        self.plant("docs/architecture.md", f"Folders:\n\n```text\n{tables.replace('sensors', 'feelers')}\n```\n")
        self.assertEqual(len(check_includes.check_tree(self.root)[0]), 1)

    def test_refuses_a_json_parser_in_the_runtime(self):
        self.assert_refused("runtime/src/a.cpp", "#include <nlohmann/json.hpp>\n", "may include")

    def test_refuses_an_unlisted_library_in_the_runtime(self):
        self.assert_refused("runtime/app/a.cpp", "#  include <boost/any.hpp>\n", "may include")

    def test_refuses_assimp_outside_the_mesh_reader(self):
        for path in ("bake/src/import/mesh_import.cpp", "bake/app/main.cpp", "tests/import_test.cpp"):
            with self.subTest(path):
                self.assertTrue(any("assimp" in offence for offence in
                                    self.offences(path, "#include <assimp/scene.h>\n")))
                (self.root / path).unlink()

    def test_refuses_bullet_outside_its_files(self):
        self.assertIn("bake/src/engines/cast_check.cpp: <btBulletCollisionCommon.h>: only bake/src/engines/bullet* and ",
                      "\n".join(self.offences("bake/src/engines/cast_check.cpp", "#include <btBulletCollisionCommon.h>\n")))

    def test_refuses_embree_outside_its_files(self):
        self.assertTrue(any("Embree" in offence for offence in self.offences(
            "bake/src/asset/scene_baker.cpp", "#include <embree3/rtcore.h>\n")))

    def test_refuses_a_heavy_type_that_a_header_only_declares(self):
        self.assert_refused("bake/include/galactic/bake/caster.h", "class btCollisionWorld;\n",
                            "btCollisionWorld")
        (self.root / "bake/include/galactic/bake/caster.h").unlink()
        self.assert_refused("bake/src/import/reader.h", "struct aiScene;\n", "aiScene")

    def test_refuses_python_outside_its_module(self):
        self.assert_refused("runtime/app/a.cpp", "struct Shown { PyObject* self; };\n",
                            "may name types of pybind11")

    def test_refuses_internals_in_the_python_module(self):
        self.assert_refused("python/src/a.cpp", '#include "../../runtime/src/inner.h"\n',
                            "python may not know runtime/src")

    def test_lets_comments_name_heavy_types(self):
        self.assertEqual(self.offences("bake/src/a.cpp", "// as aiScene and RTCScene do\n"), [])

    def test_refuses_flatbuffers_types_in_public_headers(self):
        self.assert_refused("runtime/include/galactic/scene.h",
                            '#include "galactic/schema/pack_generated.h"\n', "no FlatBuffers type")

    def test_refuses_a_new_folder_without_a_rule(self):
        self.assert_refused("runtime/extras/a.cpp", "#include <vector>\n", "no rule")

    def test_refuses_code_in_the_schema_folder(self):
        offences = self.offences("schema/helper.h", "// fine\n")
        self.assertEqual([offence for offence in offences if "only .fbs" in offence], offences)
        self.assertEqual(len(offences), 1)


class ImportsTest(PlantedTree):
    def offences(self, path: str, text: str) -> list[str]:
        self.plant(path, text)
        return check_imports.check_tree(self.root)[0]

    def test_accepts_torch_in_the_trainer_and_its_programs(self):
        self.assertEqual(self.offences("python/galactic/learning/a.py", "import torch\n"), [])
        self.assertEqual(self.offences("python/galactic/train.py", "from galactic.learning import a\n"), [])
        self.assertEqual(self.offences("python/galactic/a.py", "import numpy\nfrom galactic import files\n"), [])
        self.assertEqual(self.offences("tests/python/a.py", "import torch\n"), [])

    def test_refuses_torch_and_the_trainer_elsewhere(self):
        for text in ("import torch\n", "from torch import nn\n", "import torch.nn as nn\n",
                     "def late():\n    import torch\n"):
            self.assertEqual(self.offences("python/galactic/a.py", text),
                             ["python/galactic/a.py: imports torch: only galactic.learning and the programs may"])
        for text in ("import galactic.learning\n", "from galactic import learning\n",
                     "from galactic.learning.settings import Settings\n", "from . import learning\n",
                     "from .learning import settings\n"):
            self.assertEqual(len(self.offences("python/galactic/a.py", text)), 1, text)


class NeededTest(unittest.TestCase):
    LEAN = ["libfmt.so.9", "libstdc++.so.6", "libgcc_s.so.1", "libm.so.6", "libc.so.6"]

    def test_accepts_the_lean_libraries(self):
        self.assertEqual(check_needed.judge("galactic-run", self.LEAN, self.LEAN), [])

    def test_accepts_sanitizers_and_other_versions(self):
        libraries = ["libasan.so.8", "libubsan.so.1", "libfmt.so.10", "libc.so.6",
                     "libclang_rt.asan-x86_64.so"]
        self.assertEqual(check_needed.judge("galactic-run", libraries, libraries), [])

    def test_refuses_a_bake_library(self):
        for library in ("libassimp.so.5", "libembree3.so.3", "libBulletCollision.so.3.24",
                        "liburdfdom_model.so.3.0"):
            with self.subTest(library):
                self.assertTrue(check_needed.judge("galactic-run", [*self.LEAN, library], self.LEAN))

    def test_refuses_a_bake_library_that_another_brings(self):
        offences = check_needed.judge("galactic-pack", self.LEAN, [*self.LEAN, "libassimp.so.5"])
        self.assertEqual(len(offences), 1)
        self.assertIn("bake side", offences[0])

    def test_accepts_png_in_both_programs_and_nothing_else_that_draws(self):
        libraries = [*self.LEAN, "libpng16.so.16"]
        self.assertEqual(check_needed.judge("galactic-run", libraries, libraries), [])
        self.assertEqual(check_needed.judge("galactic-pack", libraries, libraries), [])
        libraries = [*self.LEAN, "libjpeg.so.62"]
        self.assertEqual(len(check_needed.judge("galactic-run", libraries, libraries)), 1)

    def test_reads_the_libraries_of_a_real_program(self):
        self.assertIn("libc.so.6", check_needed.needed(sys.executable))
        self.assertIn("libc.so.6", check_needed.loaded(sys.executable))

    def test_refuses_a_program_of_which_nothing_is_known(self):
        self.assertTrue(check_needed.judge("galactic-run", [], []))


class StyleTest(PlantedTree):
    def offences(self, path: str, text: str) -> list[str]:
        self.plant(path, text)
        return check_style.check_tree(self.root)[0]

    def test_accepts_plain_text(self):
        self.assertEqual(self.offences("a.md", "A temporary file, atempt, templates and Todoist.\n"
                                               "#!/usr/bin/env bash; see docs/home/index.md\n"), [])

    def test_refuses_words_of_unfinished_code(self):
        for line in ("// TODO: more", "int temp = 0;", "// a Hack", "this is not implemented yet"):
            with self.subTest(line):
                self.assertEqual(len(self.offences("a.cpp", line + "\n")), 1)

    def test_refuses_code_that_is_switched_off(self):
        self.assertEqual(len(self.offences("a.cpp", "  #  if 0\n#endif\n")), 1)

    def test_accepts_other_conditions(self):
        self.assertEqual(self.offences("a.cpp", "#if RTC_VERSION_MAJOR >= 4\n#endif\n"), [])

    def test_refuses_the_paths_of_one_machine(self):
        for line in ("see /home/ann/scene.glb", 'open("/mnt/x")', "in /root/x"):
            with self.subTest(line):
                self.assertEqual(len(self.offences("a.md", line + "\n")), 1)

    def test_accepts_an_example_path(self):
        self.assertEqual(self.offences("a.md", "for example /home/me/scene.glb\n"), [])

    def test_refuses_long_files(self):
        self.assertEqual(len(self.offences("a.cpp", "int x;\n" * 801)), 1)
        self.assertEqual(self.offences("a.cpp", "int x;\n" * 800), [])

    def test_refuses_flags_in_messages_of_the_library(self):
        for text in ('fail("use a wider spacing (--spacing)");', 'x = {1, "Without --inside: how"};',
                     'R"(one\n--two)";', 'a("//", "--two");', "b('\"', \"--two\");",
                     'c("\\"", "(-j, --memory)");'):
            with self.subTest(text):
                self.assertEqual(len(self.offences("bake/src/a.cpp", text + "\n")), 1)

    def test_accepts_flags_elsewhere(self):
        for path, text in (("bake/app/a.cpp", 'fail("--spacing");'),
                           ("bake/src/a.cpp", '// "--spacing"\n/* "--a" */ b("`spacing`, a--b, ---x");'),
                           ("bake/src/b.h", 'a("see `galactic-bake --print-recipe`"); // --list')):
            with self.subTest(text):
                self.assertEqual(self.offences(path, text + "\n"), [])

    def test_leaves_build_folders_alone(self):
        self.assertEqual(self.offences("build/release/a.cpp", "// TODO\n"), [])

    def test_refuses_tests_in_a_namespace_of_others(self):
        for space in ("galactic", "galactic::test"):
            offences = self.offences("tests/runtime/fly_test.cpp", f"namespace {space} {{\n}}\n")
            self.assertEqual(offences, [f"tests/runtime/fly_test.cpp: is in the namespace {space}, expected one that "
                                        f"ends in the file's name: {space}::fly_test"])

    def test_accepts_tests_in_a_namespace_of_their_own(self):
        for space in ("galactic::test::fly_test", "galactic::fly_test", "galactic::bake::fly_test"):
            self.assertEqual(self.offences("tests/bake/fly_test.cpp", f"namespace {space} {{\n}}\n"), [])

    def test_looks_at_folders_of_that_name_elsewhere(self):
        self.assertEqual(len(self.offences("bake/src/build/a.cpp", "// TODO\n")), 1)

    def test_says_when_it_found_nothing_to_look_at(self):
        with tempfile.TemporaryDirectory() as empty:
            self.assertEqual(check_style.main([empty]), 1)


class SchemaTest(unittest.TestCase):
    FLATC = "flatc"

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.schema = pathlib.Path(holder.name) / "schema"
        shutil.copytree(PROJECT / "schema", self.schema)
        self.assertEqual(check_schema.check(self.FLATC, self.schema), [])

    def change(self, file: str, before: str, after: str) -> list[str]:
        path = self.schema / file
        text = path.read_text(encoding="utf-8")
        self.assertIn(before, text)
        path.write_text(text.replace(before, after, 1), encoding="utf-8")
        return check_schema.check(self.FLATC, self.schema)

    def test_accepts_a_new_field_at_the_end(self):
        text = (self.schema / "column_grid.fbs").read_text(encoding="utf-8")
        table = text[text.index("table ColumnGrid {"):].split("}", 1)[0]
        self.assertEqual(self.change("column_grid.fbs", table, table + "  note:string;\n"), [])

    def test_accepts_a_deprecated_field(self):
        self.assertEqual(self.change("column_grid.fbs", "quantum:float;",
                                     "quantum:float (deprecated);"), [])

    def test_accepts_a_change_of_a_kind_that_is_not_settled(self):
        self.assertEqual(self.change("render.fbs", "  name:string (required);\n", ""), [])

    def test_refuses_a_field_in_the_middle(self):
        self.assertTrue(self.change("column_grid.fbs", "  spacing:float;",
                                    "  gap:float;\n  spacing:float;"))

    def test_refuses_another_type(self):
        self.assertTrue(self.change("column_grid.fbs", "columns_x:uint;", "columns_x:ulong;"))

    def test_refuses_another_default(self):
        self.assertTrue(self.change("column_grid.fbs", "quantum:float;", "quantum:float = 1;"))

    def test_refuses_a_field_that_is_gone(self):
        self.assertTrue(self.change("column_grid.fbs", "  statistics:GridStatistics (required);\n", ""))

    def test_refuses_a_struct_that_grows(self):
        self.assertTrue(self.change("common.fbs", "  lo:float;\n", "  lo:float;\n  mid:float;\n"))

    def test_refuses_a_union_in_another_order(self):
        self.assertTrue(self.change("pack.fbs", "Scene, ObjectSet", "ObjectSet, Scene"))

    def test_refuses_an_enum_value_that_moves(self):
        self.assertTrue(self.change("column_grid.fbs", "Outside = 1", "Outside = 3"))

    def test_refuses_a_schema_without_a_released_version(self):
        shutil.rmtree(self.schema / "released")
        self.assertTrue(check_schema.check(self.FLATC, self.schema))


class ReleaseScriptTest(unittest.TestCase):
    SCRIPT = PROJECT / "scripts" / "release_schema.sh"

    def release(self, root: pathlib.Path, *arguments: str) -> subprocess.CompletedProcess:
        return subprocess.run(["bash", root / "scripts" / "release_schema.sh", *arguments],
                              capture_output=True, text=True, check=False)

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.root = pathlib.Path(holder.name)
        (self.root / "scripts").mkdir()
        shutil.copy(self.SCRIPT, self.root / "scripts")
        shutil.copytree(PROJECT / "schema", self.root / "schema",
                        ignore=shutil.ignore_patterns("released"))

    def test_keeps_a_copy_to_which_the_schema_conforms(self):
        self.assertEqual(self.release(self.root, "1").returncode, 0)
        self.assertEqual(check_schema.check("flatc", self.root / "schema"), [])

    def test_never_overwrites_a_released_version(self):
        self.release(self.root, "1")
        again = self.release(self.root, "1")
        self.assertEqual(again.returncode, 3)
        self.assertIn("is there already", again.stderr)

    def test_refuses_what_is_no_version(self):
        for arguments in ((), ("v1",), ("0",), ("../x",)):
            with self.subTest(arguments):
                self.assertEqual(self.release(self.root, *arguments).returncode, 1)

    def test_refuses_a_schema_that_it_does_not_know(self):
        (self.root / "schema" / "weather.fbs").write_text("namespace galactic.schema;\n")
        self.assertEqual(self.release(self.root, "1").returncode, 3)


if __name__ == "__main__":
    if len(sys.argv) > 2 and sys.argv[1] == "--flatc":
        SchemaTest.FLATC = sys.argv[2]
        del sys.argv[1:3]
    unittest.main()
