#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "cli/bake_folder.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/mesh_files.h"

namespace galactic::bake_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using test::Refusal;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// A folder with a closed room and a file that is no mesh.
class BakeCli : public test::BakeFolder {
 protected:
  void SetUp() override {
    write("room.obj", test::objFile(test::unevenBox()));
    write("broken.obj", "this is no mesh\n");
  }
};

TEST_F(BakeCli, WaitsForNoPipeWithOptions) {
  ASSERT_EQ(::mkfifo(path("pipe.toml").c_str(), 0600), 0);
  for (const std::string& file : {path("pipe.toml").string(), std::string("/dev/zero")}) {
    const ProgramRun refused = run({"room.obj", "--config", file});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.err,
              "galactic-bake: " + file + ": is not a regular file; give the path of a file\n");
  }
}

TEST_F(BakeCli, WritesAPackNamedAfterItsInputWithTheOptionsAsUsersTypeThem) {
  const ProgramRun bake = run({"room.obj", "--radii", "0.015,0.05,0.12"});
  EXPECT_EQ(bake.exit_code, 0) << bake.err;
  EXPECT_THAT(bake.out, AllOf(HasSubstr("room.obj -> room.pack"), HasSubstr("12 triangles"),
                              HasSubstr("1.00 x 3.00 m and 2.00 m high"), HasSubstr("0.015"),
                              HasSubstr("columns checked, none wrong")));
  EXPECT_THAT(bake.err, IsEmpty());
  EXPECT_TRUE(has("room.pack"));
  const ProgramRun options_first = run({"--radii", "0.015,0.05,0.12", "-o", "b.pack", "room.obj"});
  EXPECT_EQ(options_first.exit_code, 0) << options_first.err;
  EXPECT_EQ(content("room.pack"), content("b.pack"));
}

TEST_F(BakeCli, WritesTheSameBytesForAnyNumberOfJobs) {
  ASSERT_EQ(run({"room.obj", "-o", "one.pack", "-j", "1"}).exit_code, 0);
  ASSERT_EQ(run({"room.obj", "-o", "five.pack", "-j5"}).exit_code, 0);
  EXPECT_EQ(content("one.pack"), content("five.pack"));
}

TEST_F(BakeCli, PrintsNothingButErrorsWhenQuiet) {
  const ProgramRun bake = run({"-q", "room.obj"});
  EXPECT_EQ(bake.exit_code, 0);
  EXPECT_THAT(bake.out, IsEmpty());
  EXPECT_THAT(bake.err, IsEmpty());
}

TEST_F(BakeCli, WritesNoPackOnADryRun) {
  const ProgramRun bake = run({"room.obj", "--dry-run"});
  EXPECT_EQ(bake.exit_code, 0);
  EXPECT_THAT(bake.out, HasSubstr("(dry run)"));
  EXPECT_FALSE(has("room.pack"));
}

TEST_F(BakeCli, StopsAtTheFirstErrorUnlessToldToKeepGoing) {
  const ProgramRun stops = run({"broken.obj", "room.obj", "-o", "packs"});
  EXPECT_EQ(stops.exit_code, 3);
  EXPECT_THAT(stops.err, StartsWith("galactic-bake: broken.obj: "));
  EXPECT_FALSE(has("packs/room.pack"));
  const ProgramRun goes_on =
      run({"broken.obj", "room.obj", "-o", "packs", "--keep-going", "--report", "report.json"});
  EXPECT_EQ(goes_on.exit_code, 3);
  EXPECT_TRUE(has("packs/room.pack"));
  const json report = json::parse(content("report.json"));
  EXPECT_EQ(report["baked"].size(), 1U);
  EXPECT_EQ(report["baked"][0]["triangles"]["kept"], 12);
  EXPECT_EQ(report["baked"][0]["grids"].size(), 3U);
  EXPECT_EQ(report["failed"][0]["input"], "broken.obj");
  EXPECT_EQ(report["failed"][0]["code"], 3);
}

TEST_F(BakeCli, SaysForWhichInputAnOptionIsWrong) {
  write("hall.obj", content("room.obj"));
  const ProgramRun bake = run({"room.obj", "hall.obj", "-o", "packs", "--scale", "150", "--spacing",
                               "0.01", "--keep-going", "--report", "report.json"});
  EXPECT_EQ(bake.exit_code, 3);
  EXPECT_THAT(bake.err, HasSubstr("galactic-bake: room.obj: --spacing: 0.01 m over a scene of "));
  EXPECT_THAT(bake.err, HasSubstr("galactic-bake: hall.obj: --spacing: 0.01 m over a scene of "));
  const json report = json::parse(content("report.json"));
  ASSERT_EQ(report["failed"].size(), 2U);
  EXPECT_EQ(report["failed"][0]["where"], "room.obj: --spacing");
  EXPECT_EQ(report["failed"][1]["where"], "hall.obj: --spacing");
}

TEST_F(BakeCli, ReadsOptionsFromAConfigFile) {
  write("bake.toml", "radii = [0.05, 0.12]\nspacing = 0.04\ncoverage = \"cell\"\n");
  const ProgramRun bake = run({"room.obj", "--config", "bake.toml", "--report", "report.json"});
  ASSERT_EQ(bake.exit_code, 0) << bake.err;
  const json report = json::parse(content("report.json"));
  const json& asked = report["jobs"][0];
  EXPECT_EQ(asked["as"], "scene");
  EXPECT_EQ(asked["options"]["radii"], json::parse("[0.05, 0.12]"));
  EXPECT_EQ(asked["options"]["spacing"], 0.04);
  EXPECT_EQ(asked["options"]["coverage"], "cell");
  EXPECT_EQ(asked["options"]["keep"], "room") << "defaults are options, too";
  EXPECT_FALSE(asked["options"].contains("no-render-meshes")) << "a switch that is off";
  const json& grids = report["baked"][0]["grids"];
  ASSERT_EQ(grids.size(), 2U);
  EXPECT_FLOAT_EQ(grids[0]["radius"], 0.05F);
  EXPECT_FLOAT_EQ(grids[1]["radius"], 0.12F);
  EXPECT_FLOAT_EQ(grids[0]["spacing"], 0.04F);
}

TEST_F(BakeCli, RefusesAConfigFileThatIsNone) {
  struct Fault {
    std::string text;
    std::string message;
  };
  for (const Fault& fault : std::vector<Fault>{
           {"[a\n", "galactic-bake: bake.toml:1: it is not TOML: "},
           {"radii = [0.05]\n[a]\nradii = [0.1]\n",
            "bake.toml:2: a: is a table or a list of lists"},
           {"\nspacin = 0.04\n",
            "galactic-bake: bake.toml:2: spacin: is not an option; did you mean 'spacing'?\n"},
           {"radii = [[[0.05]]]\n", "bake.toml:1: radii: is a table or a list of lists"},
           {"radii = [0.05]\nradii = [0.1]\n", "bake.toml:2: it is not TOML: "},
           {"version = true\n", "bake.toml:1: version: belongs on the command line"},
           {"spacing = nan\n",
            "galactic-bake: bake.toml:1: spacing: found nan, expected a number above 0"},
           {"threads = -1\n",
            "galactic-bake: bake.toml:1: threads: found -1, expected a whole number"},
           {"keep-components = 1.5\n", "keep-components: found 1.5, expected a whole number"}}) {
    write("bake.toml", fault.text);
    const ProgramRun bake = run({"room.obj", "--config", "bake.toml"});
    EXPECT_EQ(bake.exit_code, 1) << fault.text;
    EXPECT_THAT(bake.err, HasSubstr(fault.message)) << fault.text;
    EXPECT_THAT(bake.err, StartsWith("galactic-bake: ")) << fault.text;
    EXPECT_EQ(std::count(bake.err.begin(), bake.err.end(), '\n'), 1) << bake.err;
  }
}

TEST_F(BakeCli, TellsAFullDiskBehindItsOutput) {
  const ProgramRun ended = test::runProgram(test::builtProgram("galactic-bake"), path(""),
                                            {"room.obj", "--radii", "0.12"}, "/dev/full");
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.err, HasSubstr("galactic-bake: standard output: cannot be written"));
  EXPECT_TRUE(has("room.pack"));
}

TEST_F(BakeCli, KeepsItsExitCodeWhereNobodyHearsItsErrors) {
  for (const char* unheard : {"2>&-", "2>/dev/full"}) {
    EXPECT_EQ(
        test::runRedirected(test::builtProgram("galactic-bake"), path(""), {"none.obj"}, unheard)
            .exit_code,
        2);
    EXPECT_EQ(
        test::runRedirected(test::builtProgram("galactic-bake"), path(""), {"--nonsense"}, unheard)
            .exit_code,
        1);
  }
}

TEST_F(BakeCli, BakesTheSameWithAllStandardStreamsClosed) {
  ASSERT_EQ(run({"room.obj", "--radii", "0.12", "-q", "-o", "heard.pack"}).exit_code, 0);
  const ProgramRun unheard = test::runRedirected(
      test::builtProgram("galactic-bake"), path(""),
      {"room.obj", "--radii", "0.12", "-q", "-o", "unheard.pack"}, "<&- >&- 2>&-");
  EXPECT_EQ(unheard.exit_code, 0);
  EXPECT_EQ(test::fileContent(path("unheard.pack")), test::fileContent(path("heard.pack")));
}

TEST_F(BakeCli, RefusesASceneThatIsHigherThanHomesUnlessItsUnitIsStated) {
  test::MeshContent box = test::unevenBox();
  for (auto& p : box.positions) p[1] *= 100;
  write("tower.obj", test::objFile(box));
  const ProgramRun refused = run({"tower.obj", "--radii", "0.05"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(
      refused.err,
      "galactic-bake: tower.obj: the scene is 200 m high (Y up (OBJ convention), 1 m per unit "
      "(OBJ convention)), and homes are lower than 60 m; give meters per unit with --scale: "
      "0.01 for centimeters, 0.001 for millimeters, 1 if it is right in meters\n");
  EXPECT_EQ(run({"tower.obj", "--radii", "0.05", "--scale", "1"}).exit_code, 0);
}

/// The box without the triangles at its ceiling or its floor.
template <typename Chosen>
test::MeshContent openBox(const Chosen& is_open_height) {
  test::MeshContent box = test::unevenBox();
  std::erase_if(box.triangles, [&](const auto& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t corner) {
      return is_open_height(box.positions[corner][1]);
    });
  });
  return box;
}

TEST_F(BakeCli, TellsThatARoomIsOpen) {
  const std::string open =
      "radius 0.05 m: the room is one with the outside, and all of it is stored: ";
  write("no_ceiling.obj", test::objFile(openBox([](double y) { return y > 2; })));
  write("no_floor.obj", test::objFile(openBox([](double y) { return y < 0.5; })));
  const ProgramRun no_ceiling = run({"no_ceiling.obj", "--radii", "0.05"});
  EXPECT_EQ(no_ceiling.exit_code, 0);
  EXPECT_THAT(no_ceiling.out, HasSubstr(open + "it leads over the walls, there is no ceiling"));
  const ProgramRun no_floor = run({"no_floor.obj", "--radii", "0.05"});
  EXPECT_THAT(no_floor.out, HasSubstr(open + "it leads under the walls, there is no floor"));
  EXPECT_THAT(run({"room.obj", "--radii", "0.05"}).out, Not(HasSubstr("one with the outside")));
}

TEST_F(BakeCli, LeavesAnOldPackIntactWhenABakeFails) {
  write("room.pack", "the old pack");
  EXPECT_EQ(run({"room.obj", "--inside", "100,0,0"}).exit_code, 3);
  EXPECT_EQ(content("room.pack"), "the old pack");
}

TEST_F(BakeCli, WritesPacksUnderNamesOfPacksOnly) {
  write("mine.glb", "a mesh");
  for (const char* name : {"mine.glb", "new", "new.PACK.gz", "folder.pack/room"}) {
    const ProgramRun bake = run({"room.obj", "-o", name});
    EXPECT_EQ(bake.exit_code, 3) << name;
    EXPECT_EQ(bake.err, "galactic-bake: --out: is \"" + std::string(name) +
                            "\", expected NAME.pack, an existing folder or FOLDER/\n");
    EXPECT_EQ(run({"room.obj", "-o", name, "--dry-run"}).exit_code, 3) << name;
  }
  EXPECT_EQ(content("mine.glb"), "a mesh");
  EXPECT_FALSE(has("new") || has("folder.pack"));
}

TEST_F(BakeCli, MakesTheFolderOfItsPack) {
  const std::vector<std::pair<std::string, std::string>> outputs{
      {"new/folder/one.pack", "new/folder/one.pack"}, {"slash/", "slash/room.pack"}};
  for (const auto& [out, pack] : outputs) {
    EXPECT_EQ(run({"room.obj", "--radii", "0.12", "--dry-run", "-o", out}).exit_code, 0) << out;
    EXPECT_FALSE(std::filesystem::exists(path(pack).parent_path())) << "a dry run writes nothing";
    const ProgramRun bake = run({"room.obj", "--radii", "0.12", "-o", out});
    EXPECT_EQ(bake.exit_code, 0) << bake.err;
    EXPECT_TRUE(has(pack)) << pack;
  }
}

TEST_F(BakeCli, TriesItsPackBeforeItBakes) {
  write("broken.obj", "v 0 0\n");
  std::filesystem::create_symlink("/dev/null", path("null.pack"));
  const std::vector<Refusal> refusals{
      // Where nobody may write, root neither.
      {{"broken.obj", "-o", "/proc/none/room.pack"}, 2, "/proc/none: cannot be made a folder"},
      {{"broken.obj", "-o", "/proc/room.pack"}, 2, "/proc/room.pack: cannot write the file"},
      {{"broken.obj", "-o", "null.pack"}, 2, "a device or pipe of this name is there"}};
  for (const Refusal& refusal : refusals) {
    const ProgramRun bake = run(refusal.arguments);
    EXPECT_EQ(bake.exit_code, refusal.exit_code) << refusal.part;
    EXPECT_THAT(bake.err, HasSubstr(refusal.part));
  }
  EXPECT_EQ(run({"broken.obj", "-o", "fine.pack"}).exit_code, 3);
  EXPECT_FALSE(has("fine.pack"));
}

TEST_F(BakeCli, SaysHowFoldersAndJsonAreBaked) {
  write("flats/flat.scene_instance.json", "{}");
  write("flats/flat.stage_config.json", "{}");
  write("flats/mug.object_config.json", "{}");
  write("flats/episodes.json", "{}");
  const std::vector<Refusal> refusals{
      {{"flats"},
       2,
       "flats: is a folder; give a mesh in it, or add --as object to bake the meshes in it as "
       "objects, or --as dataset to bake them as scans"},
      {{"flats/flat.scene_instance.json"},
       5,
       "flats/flat.scene_instance.json: is a scene of a dataset; give the dataset's "
       "NAME.scene_dataset_config.json, with --scenes flat"},
      {{"flats/flat.stage_config.json"},
       5,
       "flats/flat.stage_config.json: is about a stage of a dataset; give the mesh that it names "
       "as its render_asset, with the axis that it gives as --up, or the dataset's "
       "NAME.scene_dataset_config.json for scenes with their furniture"},
      {{"flats/mug.object_config.json", "--as", "object"},
       5,
       "flats/mug.object_config.json: is about an object of a dataset; give the mesh that it names "
       "as its render_asset, with --as object and the axis that it gives as --up, or the "
       "dataset's NAME.scene_dataset_config.json for all objects that its scenes move"},
      {{"flats/episodes.json", "--as", "object"},
       5,
       "flats/episodes.json: is no mesh but JSON; add --as episodes if it holds published "
       "episodes"}};
  for (const Refusal& refusal : refusals) {
    const ProgramRun bake = run(refusal.arguments);
    EXPECT_EQ(bake.exit_code, refusal.exit_code);
    EXPECT_EQ(bake.err, "galactic-bake: " + refusal.part + "\n");
  }
  EXPECT_THAT(run({"none.json"}).err, HasSubstr("there is no such file"));
}

TEST_F(BakeCli, RefusesToReplaceItsInput) {
  const std::string before = content("room.obj");
  const ProgramRun bake = run({"room.obj", "-o", "room.obj"});
  EXPECT_EQ(bake.exit_code, 3);
  EXPECT_THAT(bake.err, HasSubstr("is also an input"));
  EXPECT_EQ(content("room.obj"), before);
}

TEST_F(BakeCli, SaysWhatAPackIsAnInputOf) {
  write("room.pack", "a pack");
  const ProgramRun bake = run({"room.pack"});
  EXPECT_EQ(bake.exit_code, 3);
  EXPECT_EQ(bake.err,
            "galactic-bake: room.pack: is a pack already; add --as episodes to generate episodes "
            "in packs, or --as world to link them\n");
  EXPECT_EQ(content("room.pack"), "a pack");
}

TEST_F(BakeCli, ListsTheExtensionsThatItReads) {
  const ProgramRun bake = run({"scene.xyz"});
  EXPECT_EQ(bake.exit_code, 2);
  EXPECT_THAT(bake.err, HasSubstr("scene.xyz: there is no such file, and no reader knows the "
                                  "extension '.xyz'; expected one of "));
  EXPECT_THAT(run({"scene.obj"}).err, HasSubstr("there is no such file; check the path"));
}

TEST_F(BakeCli, SaysTheDefaultsOfObjectsAndOfRobots) {
  const std::string help = run({"--help"}).out;
  for (const char* option : {"--eps", "--tau", "--max-spheres"}) {
    const std::size_t begin = help.find(std::string(option) + " ");
    ASSERT_NE(begin, std::string::npos) << option;
    const std::string text = help.substr(begin, help.find("\n  -", begin) - begin);
    EXPECT_THAT(text, testing::ContainsRegex("of robots|of *\n *robots")) << option;
    EXPECT_THAT(text, Not(HasSubstr("["))) << option;
  }
}

TEST_F(BakeCli, NeverReplacesAnythingThatItReads) {
  write("textured.obj", "mtllib colors.mtl\n" + test::objFile(test::unevenBox()));
  write("colors.mtl", "newmtl red\nKd 1 0 0\n");
  write("bake.toml", "radii = [0.05]\n");
  const std::vector<std::pair<std::string, std::vector<std::string>>> attempts{
      {"room.obj", {"room.obj", "--report", "room.obj"}},
      {"colors.mtl", {"textured.obj", "--report", "colors.mtl"}},
      {"bake.toml", {"room.obj", "--config", "bake.toml", "--report", "bake.toml"}},
  };
  for (const auto& [file, arguments] : attempts) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const std::string before = content(file);
    const ProgramRun bake = run(arguments);
    EXPECT_EQ(bake.exit_code, 3);
    EXPECT_THAT(bake.err, HasSubstr("is also an input"));
    EXPECT_EQ(content(file), before);
  }
  EXPECT_EQ(run({"room.obj", "-o", "one.pack", "--report", "one.pack"}).exit_code, 3);
  EXPECT_FALSE(has("one.pack"));
}

TEST_F(BakeCli, KeepsItsReportApartFromThePackWhateverItIsCalled) {
  ASSERT_EQ(run({"room.obj", "--radii", "0.12", "-o", "one.pack"}).exit_code, 0);
  const std::string before = content("one.pack");
  std::filesystem::create_symlink("one.pack", path("link.json"));
  for (const std::string& report : {path("one.pack").string(), std::string("link.json")}) {
    const ProgramRun bake =
        run({"room.obj", "--radii", "0.12", "-o", "one.pack", "--report", report});
    EXPECT_EQ(bake.exit_code, 3) << report;
    EXPECT_EQ(bake.err, "galactic-bake: " + report +
                            ": is also a pack that is written; give --report another name\n");
    EXPECT_EQ(content("one.pack"), before) << report;
  }
}

TEST_F(BakeCli, TriesItsReportBeforeItBakes) {
  const ProgramRun bake = run({"room.obj", "-o", "one.pack", "--report", "missing/report.json"});
  EXPECT_EQ(bake.exit_code, 2);
  EXPECT_THAT(bake.err, HasSubstr("missing/report.json: cannot write the file"));
  EXPECT_FALSE(has("one.pack"));
  // It may go where the packs go.
  write("other.obj", test::objFile(test::unevenBox()));
  const ProgramRun two =
      run({"room.obj", "other.obj", "-o", "packs", "--report", "packs/report.json"});
  EXPECT_EQ(two.exit_code, 0) << two.err;
}

TEST_F(BakeCli, RefusesTwoInputsForOnePack) {
  write("other/room.obj", test::objFile(test::unevenBox()));
  const ProgramRun bake = run({"room.obj", "other/room.obj", "-o", "packs"});
  EXPECT_EQ(bake.exit_code, 3);
  EXPECT_THAT(bake.err, HasSubstr("would be written twice"));
}

TEST_F(BakeCli, ExplainsEveryRefusal) {
  const std::vector<Refusal> refusals{
      {{}, 1, "input is required"},
      {{"room.obj", "--no-such-option"}, 1, "galactic-bake: command line: "},
      {{"room.obj", "--radi", "0.1"}, 1, "--radi; did you mean '--radii'?; see --help"},
      {{"room.obj", "--radii", "0.1,,0.2"}, 1, "--radii: has \"\" in \"0.1,,0.2\""},
      {{"room.obj", "--radii", "0.05,x"}, 1, "--radii: has \"x\" in \"0.05,x\""},
      {{"room.obj", "--inside", "1,2"}, 1, "--inside: has 2 numbers in \"1,2\", expected 3"},
      {{"room.obj", "--up", "w"}, 1, "--up: is \"w\""},
      {{"room.obj", "--scale", "-1"}, 1, "--scale: found -1, expected a number above 0"},
      {{"room.obj", "--transform", "1,2,3"}, 1, "--transform: has 3 numbers, expected 12"},
      {{"room.obj", "--engine", "magic"}, 1, "--engine"},
      {{"room.obj", "--threads", "4097"}, 1, "--threads"},
      {{"missing.obj"}, 2, "missing.obj"},
      {{"room.obj", "--config", "missing.toml"}, 2, "missing.toml"},
      {{"room.obj", "-o", "/dev/null"}, 3, "--out: is \"/dev/null\", expected NAME.pack"},
      {{"room.obj", "--radii", "0.01"},
       3,
       "room.obj: --radii: radius 0.01 m is under half the spacing"},
      {{"room.obj", "--radii", "9"}, 3, "room.obj: --radii: has the radius 9 m, and the whole"},
      {{"room.obj", "--scale", "150", "--spacing", "0.01"},
       3,
       "room.obj: --spacing: 0.01 m over a scene of "},
      {{"room.obj", "--radii", "0.12,0.05"}, 1, "in ascending order"},
      {{"room.obj", "--spacing", "0"}, 1, "--spacing: found 0, expected a number above 0"},
      {{"room.obj", "--coverage", "cell", "--engine", "embree"},
       3,
       "room.obj: --coverage: cell works with"},
      {{"room.obj", "--inside", "9,9,9"}, 3, "room.obj: --inside: (9, 9, 9) is outside the scene"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun bake = run(refusal.arguments);
    EXPECT_EQ(bake.exit_code, refusal.exit_code);
    EXPECT_THAT(bake.err, HasSubstr(refusal.part));
    EXPECT_THAT(bake.out, IsEmpty());
  }
}

TEST_F(BakeCli, ListsItsExitCodesInHelp) {
  const ProgramRun help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, AllOf(HasSubstr("0    success"), HasSubstr("130  interrupted"),
                              HasSubstr("--keep-components"),
                              HasSubstr("galactic-bake scene.glb --radii 0.015,0.05,0.12")));
  EXPECT_EQ(run({"--version"}).exit_code, 0);
}

TEST_F(BakeCli, AppliesUpScaleAndTransformInThisOrder) {
  const ProgramRun bake = run({"room.obj", "--up", "z", "--scale", "0.5", "--transform",
                               "1,0,0,10,0,1,0,20,0,0,1,30", "--report", "report.json"});
  ASSERT_EQ(bake.exit_code, 0) << bake.err;
  const json bounds = json::parse(content("report.json"))["baked"][0]["bounds"];
  // The box reaches from (0.5, 0.25, 1) to (1.5, 2.25, 4), its z becomes up and its y becomes -z.
  EXPECT_EQ(bounds["min"], json::array({10.25, 20.5, 30 - 1.125}));
  EXPECT_EQ(bounds["max"], json::array({10.75, 22.0, 30 - 0.125}));
}

}  // namespace
}  // namespace galactic::bake_cli_test
