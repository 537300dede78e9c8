#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <tuple>

#include "pack_tool/asset_packs.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/files/part_files.h"
#include "support/pack_tool_fixture.h"
#include "support/packs/episode_pack_builder.h"
#include "support/program_run.h"

namespace galactic::pack_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::StartsWith;

constexpr int kIo = static_cast<int>(ErrorCode::kIo);
constexpr int kInvalidInput = static_cast<int>(ErrorCode::kInvalidInput);
constexpr int kUnsupported = static_cast<int>(ErrorCode::kUnsupported);

/// A folder with a good pack of each kind, one that was cut off, one of a later format, and a file
/// that is no pack.
class PackCli : public testing::Test {
 protected:
  void SetUp() override {
    auto bytes = test::buildPack(test::kitchenScene());
    write("good.pack", test::asText(bytes.bytes()));
    write("cut.pack", test::asText(bytes.bytes()).substr(0, 500));
    constexpr std::size_t kVersionOffset = 8;
    bytes.bytes()[kVersionOffset] = std::byte{99};
    write("later.pack", test::asText(bytes.bytes()));
    write("toys.pack", test::asText(test::buildPack(test::ToyObjects{}).bytes()));
    write("arm.pack", test::asText(test::buildPack(test::ToyRobot{}).bytes()));
    write("text.pack", "this is a text and no pack, long enough to hold a whole header of a pack");
  }

  ProgramRun run(std::vector<std::string> arguments) {
    return test::runProgram(test::builtProgram("galactic-pack"), folder_.path(),
                            std::move(arguments));
  }

  void write(const std::string& name, std::string_view content) {
    ASSERT_EQ(test::fileContent(folder_.write(name, content)), content);
  }

  test::ScratchFolder folder_;
};

TEST_F(PackCli, ListsItsVerbsAndExitCodesInHelp) {
  const ProgramRun help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.err, "");
  for (const char* part :
       {"info", "check", "column", "diff", "export", "picture", "0    success",
        "1    wrong command line", "2    a file", "3    invalid input", "4    internal",
        "5    not supported", "7    packs, reports or runs differ"}) {
    EXPECT_THAT(help.out, HasSubstr(part));
  }
  const ProgramRun verb = run({"diff", "--help"});
  EXPECT_EQ(verb.exit_code, 0);
  EXPECT_THAT(verb.out, HasSubstr("--tolerance"));
  EXPECT_THAT(verb.out, HasSubstr("7    packs, reports or runs differ"));
}

TEST_F(PackCli, PrintsItsVersion) {
  const ProgramRun version = run({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, MatchesRegex("galactic-pack [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(PackCli, ExplainsAWrongCommandLineWithExitCodeOne) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> lines{
      {{}, "no verb; give info, check"},
      {{"frobnicate", "good.pack"}, "\"frobnicate\" is not a verb; give info, check"},
      {{"inof", "good.pack"}, "\"inof\" is not a verb; did you mean 'info'?"},
      {{"info", "good.pack", "--jsn"}, "--jsn; did you mean '--json'?"},
      {{"diff", "good.pack", "good.pack", "--tolerance", "nan"}, "--tolerance: found nan"},
      {{"diff", "good.pack", "good.pack", "--tolerance", "inf"}, "--tolerance: found inf"},
      {{"diff", "good.pack", "good.pack", "--tolerance", ""}, "--tolerance"},
      {{"column", "good.pack", "--at", "1,2", "--radius", "nan"}, "--radius: found nan"},
      {{"column", "good.pack", "--at", "1,2", "--radius", "-1"}, "--radius: found -1"},
      {{"picture", "good.pack", "-o", "a.png", "--radius", "1e99"}, "--radius: found 1e99"},
      {{"picture", "good.pack", "-o", "a.png", "--episode", "-1"}, "--episode: found -1"},
      {{"picture", "arm.pack", "-o", "a.png", "--size", "0100"}, "--size: found 0100"},
      {{"picture", "arm.pack", "-o", "a.png", "--size", "99999999999999999999"}, "--size"},
      {{"check", "good.pack", "--threads", "-1"}, "--threads: found -1, expected a whole number"},
      {{"info"}, "PACK is required"},
      {{"info", "good.pack", "--frob"}, "--frob"},
      {{"column", "good.pack"}, "--at is required"},
      {{"column", "good.pack", "--at", "1"}, "\"1\" is not 2 numbers"},
      {{"column", "good.pack", "--at", "1,nan"}, "\"1,nan\" is not 2 numbers"},
      {{"column", "good.pack", "--at", "1,2,3"}, "\"1,2,3\" is not 2 numbers"},
      {{"diff", "good.pack"}, "B is required"},
      {{"diff", "good.pack", "good.pack", "--tolerance", "-1"}, "--tolerance"},
      {{"export", "good.pack"}, "--out is required"},
      {{"picture", "good.pack", "-o", "a.png", "--slice", "1,2,3"}, "is not 4 numbers"},
      {{"picture", "good.pack"}, "--out is required"},
      {{"picture", "arm.pack", "-o", "a.png", "--joints", "lift"}, "is not joint=value"},
      {{"picture", "arm.pack", "-o", "a.png", "--joints", "lift=1,"}, "is not joint=value"},
      {{"picture", "arm.pack", "-o", "a.png", "--what", "mesh,bones"},
       "\"bones\" is not mesh, spheres or boxes"},
      {{"picture", "arm.pack", "-o", "a.png", "--size", "10"}, "--size"},
      {{"export", "good.pack", "-o", "a.png", "--to", "gif"}, "--to"},
      {{"export", "good.pack", "--to", "ply"}, "--out is required"},
      {{"export", "good.pack", "-o", "x.json", "--object-up", "w"}, "--object-up"},
      {{"view", "good.pack"}, "--out is required"},
      {{"view", "good.pack", "-o", "a.html", "--texture-size", "100"},
       "found 100, expected a power"},
      {{"view", "good.pack", "-o", "a.html", "--texture-size", "0"}, "--texture-size: found 0"},
      {{"view", "good.pack", "-o", "a.html", "--texture-size", "8192"}, "--texture-size"},
  };
  for (const auto& [arguments, message] : lines) {
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 1) << message;
    EXPECT_EQ(result.out, "") << message;
    EXPECT_THAT(result.err, StartsWith("galactic-pack: command line: "));
    EXPECT_THAT(result.err, HasSubstr(message));
  }
}

TEST_F(PackCli, InfoPrintsTextAndJson) {
  const ProgramRun text = run({"info", "good.pack"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out, StartsWith("good.pack\n  kind         SCEN, format version 1\n"));
  EXPECT_THAT(text.out, HasSubstr("--radii 0.5,0.75"));

  const ProgramRun result = run({"info", "--json", "good.pack"});
  EXPECT_EQ(result.exit_code, 0);
  const json packs = json::parse(result.out);
  ASSERT_EQ(packs.size(), 1U);
  EXPECT_EQ(packs.at(0).at("scene").at("name"), "kitchen");
  EXPECT_EQ(packs.at(0).at("scene").at("column_grids").at(1).at("radius"), 0.75);
}

TEST_F(PackCli, InfoGoesOnAfterAPackThatCannotBeRead) {
  const ProgramRun result = run({"info", "missing.pack", "good.pack"});
  EXPECT_EQ(result.exit_code, kIo);
  EXPECT_THAT(result.err, StartsWith("galactic-pack: missing.pack: "));
  EXPECT_THAT(result.out, StartsWith("good.pack\n"));
}

TEST_F(PackCli, CheckSaysOkOrTheOffenceOfEachPack) {
  const ProgramRun good = run({"check", "good.pack", "good.pack"});
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_EQ(good.out, "good.pack: ok\n") << "once, though it is named twice";
  EXPECT_EQ(good.err, "");

  const ProgramRun all =
      run({"check", "missing.pack", "cut.pack", "later.pack", "text.pack", "good.pack"});
  EXPECT_EQ(all.exit_code, kInvalidInput);
  EXPECT_EQ(all.out, "good.pack: ok\n");
  EXPECT_EQ(std::count(all.err.begin(), all.err.end(), '\n'), 4);
  for (const char* pack : {"missing", "cut", "later", "text"}) {
    EXPECT_THAT(all.err, HasSubstr("galactic-pack: " + std::string(pack) + ".pack: "));
  }
}

TEST_F(PackCli, CheckReturnsTheExitCodeOfTheOffence) {
  EXPECT_EQ(run({"check", "missing.pack"}).exit_code, kIo);
  EXPECT_EQ(run({"check", "cut.pack"}).exit_code, kInvalidInput);
  EXPECT_EQ(run({"check", "text.pack"}).exit_code, kInvalidInput);
  EXPECT_EQ(run({"check", "later.pack"}).exit_code, kUnsupported);
}

TEST_F(PackCli, CheckReportsAsJson) {
  const ProgramRun result = run({"check", "--json", "cut.pack", "good.pack"});
  EXPECT_EQ(result.exit_code, kInvalidInput);
  const json report = json::parse(result.out);
  EXPECT_EQ(report.at(0).at("ok"), false);
  EXPECT_EQ(report.at(0).at("exit_code"), kInvalidInput);
  EXPECT_EQ(report.at(0).at("code"), "pack/size");
  EXPECT_EQ(report.at(1).at("ok"), true);
}

TEST_F(PackCli, CheckSearchesFoldersAndWritesAJUnitReport) {
  const ProgramRun result = run({"check", ".", "--junit", "report.xml", "--threads", "3"});
  EXPECT_EQ(result.exit_code, kInvalidInput);
  EXPECT_EQ(result.out, "./arm.pack: ok\n./good.pack: ok\n./toys.pack: ok\n");
  for (const char* line : {"galactic-pack: ./cut.pack: announces ", " [pack/size]\n",
                           " [pack/version-new]\n", " [pack/not-a-pack]\n"}) {
    EXPECT_THAT(result.err, HasSubstr(line));
  }
  const std::string report = test::fileContent(folder_.path() / "report.xml");
  EXPECT_THAT(report, HasSubstr("tests=\"6\" failures=\"3\""));
  EXPECT_THAT(report, HasSubstr("<testcase classname=\"packs\" name=\"./arm.pack\"/>"));
  const ProgramRun quiet = run({"check", ".", "-j", "0", "-q"});
  EXPECT_EQ(quiet.exit_code, kInvalidInput);
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, result.err);
}

TEST_F(PackCli, EveryVerbRefusesADamagedPack) {
  for (const char* pack : {"cut.pack", "text.pack"}) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"info", pack},
                                                      {"column", pack, "--at", "1,1"},
                                                      {"diff", "good.pack", pack},
                                                      {"picture", pack, "-o", "a.png"},
                                                      {"export", pack, "-o", "a.glb"},
                                                      {"view", pack, "-o", "a.html"}}) {
      const ProgramRun result = run(arguments);
      EXPECT_EQ(result.exit_code, kInvalidInput) << arguments.front();
      EXPECT_THAT(result.out, IsEmpty());
      EXPECT_THAT(result.err, StartsWith("galactic-pack: " + std::string(pack) + ": "));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a.png"));
}

TEST_F(PackCli, ColumnTakesNegativeNumbersAndRefusesPointsOutside) {
  const ProgramRun inside = run({"column", "good.pack", "--at", "1.5,0.5", "--radius", "0.5"});
  EXPECT_EQ(inside.exit_code, 0);
  EXPECT_THAT(inside.out, StartsWith("radius 0.5 m: cell (1, 0), column at x 1.5, z 0.5\n"));
  const ProgramRun outside = run({"column", "good.pack", "--at", "-1.5,-0.5"});
  EXPECT_EQ(outside.exit_code, kInvalidInput);
  EXPECT_EQ(outside.out, "");
  EXPECT_THAT(outside.err,
              StartsWith("galactic-pack: good.pack: the point x -1.5, z -0.5 is outside"));
}

TEST_F(PackCli, DiffReturnsSevenWhenPacksDiffer) {
  test::ScenePackFields other = test::kitchenScene();
  other.name = "bath";
  write("other.pack", test::asText(test::buildPack(other).bytes()));
  const ProgramRun differ = run({"diff", "good.pack", "other.pack"});
  EXPECT_EQ(differ.exit_code, kExitDiffers);
  EXPECT_EQ(differ.err, "");
  EXPECT_THAT(differ.out, StartsWith("A good.pack\nB other.pack\ndiffer\n"));
  EXPECT_THAT(differ.out, HasSubstr("name: kitchen | bath"));
  const ProgramRun same = run({"diff", "good.pack", "good.pack", "--json"});
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_EQ(json::parse(same.out).at("identical"), true);
}

TEST_F(PackCli, PictureExportAndViewWriteTheirFilesQuietly) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> runs{
      {{"picture", "good.pack", "-o", "all.png"}, "\x89PNG"},
      {{"picture", "good.pack", "-o", "one.PNG", "--radius", "0.75", "--value", "lowest"},
       "\x89PNG"},
      {{"picture", "good.pack", "-o", "large.png", "--size", "3000"}, "\x89PNG"},
      {{"picture", "good.pack", "-o", "slice.png", "--slice", "0,0.5,5,2.5"}, "\x89PNG"},
      {{"picture", "toys.pack", "-o", "sheet.png"}, "\x89PNG"},
      {{"picture", "toys.pack", "-o", "block.png", "--object", "block", "--size", "100"},
       "\x89PNG"},
      {{"picture", "arm.pack", "-o", "arm.png", "--joints", "lift=-0.5,reach=1", "--what",
        "mesh,spheres"},
       "\x89PNG"},
      {{"export", "good.pack", "-o", "mesh.ply", "--radius", "0.5", "--surface"}, "ply\n"},
      {{"export", "good.pack", "-o", "mesh.obj", "--radius", "0.5", "--floors-only"},
       "# free space"},
      {{"export", "good.pack", "-o", "mesh.dat", "--to", "obj", "--radius", "0.5"}, "# free space"},
      {{"export", "toys.pack", "-o", "toys.glb", "--what", "boxes"}, "glTF"},
      {{"export", "arm.pack", "-o", "arm.GLB", "--all-zero"}, "glTF"},
      {{"export", "arm.pack", "-o", "arm.srdf"}, "<?xml"},
      {{"export", "arm.pack", "-o", "arm.urdf"}, "<?xml"},
      {{"view", "good.pack", "-o", "good.html"}, "<!doctype html>"},
      {{"view", "toys.pack", "-o", "toys.html", "--texture-size", "64"}, "<!doctype html>"},
      {{"view", "arm.pack", "-o", "arm.html", "--trusted"}, "<!doctype html>"},
  };
  for (const auto& [arguments, start] : runs) {
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments[3];
    EXPECT_EQ(result.out + result.err, "") << arguments[3];
    EXPECT_THAT(test::fileContent(folder_.path() / arguments[3]), StartsWith(start));
  }
}

TEST_F(PackCli, RemovesWhatKilledOnesLeftOfTheFileThatItWrites) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"picture", "good.pack", "-o", "out.png"},
        {"view", "good.pack", "-o", "out.html"}}) {
    const std::string part = partPathOf(arguments.back(), 0).string();
    write(part, "half");
    EXPECT_EQ(run(arguments).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / part)) << part;
  }
}

TEST_F(PackCli, WritesNoFileThatIsCalledADash) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"report", "good.pack", "-o", "-"},
        {"view", "good.pack", "-o", "-"},
        {"check", "good.pack", "--junit", "-"},
        {"export", "good.pack", "-o", "-", "--to", "obj", "--radius", "0.5"}}) {
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0] << result.err;
    EXPECT_EQ(result.err,
              "galactic-pack: -: is not the standard output here; give a file's name, or ./- for a "
              "file of that name\n");
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "-"));
}

TEST_F(PackCli, ExportsEpisodesBesideItselfWhereNoFileIsNamed) {
  write("tidy.pack", test::asText(test::buildPack(test::smallEpisodes()).bytes()));
  const ProgramRun result =
      run({"export", "tidy.pack", "--to", "episode_set", "--object-up", "-y"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "");
  const json set = json::parse(test::fileContent(folder_.path() / "tidy.episode_set.json"));
  EXPECT_EQ(set.at("episodeSet").at("episodes").size(), 2U);
}

TEST_F(PackCli, PictureAndExportRefuseWhatTheyCannotWrite) {
  std::filesystem::create_symlink("good.pack", folder_.path() / "linked.htm");
  const std::vector<std::tuple<std::vector<std::string>, int, std::string>> runs{
      {{"export", "good.pack", "-o", "a.jpg"},
       kUnsupported,
       "use .glb, .srdf, .urdf, .obj, .ply or .episode_set.json"},
      {{"view", "good.pack", "-o", "good.pack"},
       kUnsupported,
       "galactic-pack: good.pack: pages are HTML files; end the name with .html"},
      {{"view", "good.pack", "-o", "a.png"}, kUnsupported, "end the name with .html"},
      {{"view", "good.pack", "-o", "linked.htm"}, kInvalidInput, "is the pack itself"},
      {{"report", "good.pack", "-o", "a.pdf"}, kUnsupported, "end the name with .html"},
      {{"view", "good.pack", "-o", "none/a.html"}, kIo, "galactic-pack: none/a.html: "},
      {{"export", "good.pack", "-o", "a.png"}, kUnsupported, "draw it with galactic-pack picture"},
      {{"picture", "good.pack", "-o", "a.jpg"}, kUnsupported, "end the name with .png"},
      {{"picture", "good.pack", "-o", "none/a.png"}, kIo, "galactic-pack: none/a.png: "},
      {{"export", "good.pack", "-o", "a.ply"},
       kInvalidInput,
       "choose with --radius one of 0.5 0.75"},
      {{"picture", "good.pack", "-o", "a.png", "--slice", "50,50,60,50"},
       kInvalidInput,
       "misses the grid"},
      {{"picture", "good.pack", "-o", "a.png", "--what", "mesh", "--radius", "0.5"},
       kInvalidInput,
       "is a scene: "},
      {{"picture", "arm.pack", "-o", "a.png", "--size", "2049"},
       kInvalidInput,
       "found --size 2049, expected at most 2048 for views"},
      {{"picture", "arm.pack", "-o", "a.png", "--radius", "0.5"},
       kInvalidInput,
       "is a pack of kind RBOT and holds no column grids; --radius is for scenes, worlds"},
      {{"picture", "arm.pack", "-o", "a.png", "--value", "spans"},
       kInvalidInput,
       "is a pack of kind RBOT and holds no column grids; --slice and --value are for scenes"},
      {{"picture", "good.pack", "-o", "a.png", "--episode", "0"},
       kInvalidInput,
       "is a pack of kind SCEN and holds no episodes; --scene and --episode are for worlds"},
      {{"picture", "toys.pack", "-o", "a.png", "--object", "mug"},
       kInvalidInput,
       "has no object \"mug\""},
      {{"picture", "arm.pack", "-o", "a.png", "--joints", "lift=7"},
       kInvalidInput,
       "its limits are -1 to 2"},
      {{"export", "toys.pack", "-o", "a.ply"},
       kInvalidInput,
       "is a pack of kind OBJS and holds no column grids, which OBJ and PLY files show"},
      {{"export", "toys.pack", "-o", "a.urdf"}, kInvalidInput, "expected a robot (RBOT)"},
      {{"export", "good.pack", "-o", "a.glb"}, kInvalidInput, "has no render meshes"},
      {{"export", "arm.pack", "-o", "a.urdf", "--all-zero"}, kExitUsage, "are for GLB files"},
      {{"export", "arm.pack", "-o", "a.obj", "--object-up", "z"},
       kExitUsage,
       "galactic-pack: command line: --object-up is for episode sets; leave it out"},
      {{"export", "arm.pack", "-o", "a.glb", "--radius", "0.5"},
       kExitUsage,
       "are for OBJ and PLY files"},
      {{"column", "arm.pack", "--at", "0,0"},
       kInvalidInput,
       "is a pack of kind RBOT and holds no column grids"},
      {{"export", "arm.pack", "-o", "arm.pack", "--to", "urdf"},
       kInvalidInput,
       "is the pack itself"},
  };
  for (const auto& [arguments, exit_code, message] : runs) {
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << message;
    EXPECT_EQ(result.out, "") << message;
    EXPECT_THAT(result.err, HasSubstr(message));
  }
}

TEST_F(PackCli, InfoChecksAndComparesObjectsAndRobots) {
  const ProgramRun info = run({"info", "--json", "toys.pack", "arm.pack"});
  EXPECT_EQ(info.exit_code, 0);
  const json packs = json::parse(info.out);
  EXPECT_EQ(packs.at(0).at("object_set").at("objects").size(), 2U);
  EXPECT_EQ(packs.at(1).at("robot").at("links").size(), 5U);
  EXPECT_EQ(run({"check", "toys.pack", "arm.pack"}).exit_code, 0);
  test::ToyRobot shorter;
  shorter.upper_limit = 1;
  write("shorter.pack", test::asText(buildPack(shorter).bytes()));
  const ProgramRun differ = run({"diff", "arm.pack", "shorter.pack"});
  EXPECT_EQ(differ.exit_code, kExitDiffers);
  EXPECT_THAT(differ.out, HasSubstr("positions.lift.upper: 2.0 | 1.0"));
}

TEST_F(PackCli, ReportsAFullDiskBehindStandardOutput) {
  const std::filesystem::path full = "/dev/full";
  if (!std::filesystem::exists(full)) GTEST_SKIP() << "this system has no /dev/full";
  const ProgramRun result = test::runProgram(test::builtProgram("galactic-pack"), folder_.path(),
                                             {"info", "good.pack"}, full);
  EXPECT_EQ(result.exit_code, kIo);
  EXPECT_THAT(result.err, HasSubstr("galactic-pack: standard output: cannot be written"));
}

}  // namespace
}  // namespace galactic::pack_cli_test
