// Whole datasets and worlds in one command, as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/plan_folder.h"
#include "galactic/pack_reference.h"
#include "galactic/world.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/habitat_text.h"
#include "support/image_files.h"
#include "support/mesh_files.h"
#include "support/recipe_text.h"

namespace galactic::test::plan_cli_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

using PlanCli = PlanFolder;

/// Names a material in looks.mtl.
std::string texturedCube(double size) {
  std::string text = "mtllib looks.mtl\nvt 0 0\nusemtl looks\n";
  for (unsigned n = 0; n < 8; ++n) {
    text += fmt::format("v {} {} {}\n", (n & 1U) * size, (n >> 1U & 1U) * size, (n >> 2U) * size);
  }
  for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"}) {
    text += "f ";
    for (const char c : std::string_view(face)) {
      text += c == ' ' ? std::string(" ") : fmt::format("{}/1", c);
    }
    text += "\n";
  }
  return text;
}

TEST_F(PlanCli, BakesADatasetIntoPacksAndAWorld) {
  const ProgramRun first = bake("out");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.err, IsEmpty());
  EXPECT_THAT(first.out,
              AllOf(HasSubstr("1 scene left out:\n  e: stage 'hall' is in none of"),
                    HasSubstr("scenes/d.pack: object 'lamp' is in none of the dataset's paths"),
                    HasSubstr("5 baked, 0 unchanged"), HasSubstr(" MB -> out/home.pack\n")));
  for (const char* name : {"home.pack", "home/scenes/a.pack", "home/scenes/b.pack",
                           "home/scenes/c.pack", "home/scenes/d.pack", "home/objects/box.pack"}) {
    EXPECT_EQ(packsIn("out").count(name), 1U) << name;
  }
  const auto world = PackFile::open(path("out/home.pack"));
  ASSERT_TRUE(world.has_value()) << world.error().text();
  EXPECT_EQ(world->kind(), PackKind::kWorld);
  const auto listed = packReferences(*world);
  ASSERT_TRUE(listed.has_value());
  EXPECT_THAT(packsIn("out"), SizeIs(listed->size() + 1));
  // There is nothing to run in it yet.
  const auto runnable = World::open(std::vector{path("out/home.pack")});
  ASSERT_FALSE(runnable.has_value());
  EXPECT_EQ(runnable.error().message, "has no robot (RBOT); give a pack of one, too");
}

TEST_F(PlanCli, ReportsWhatWasMadeAndWhatWasNot) {
  ASSERT_EQ(bake("out").exit_code, 0);
  const nlohmann::json made = report();
  EXPECT_EQ(made.at("tool"), "galactic-bake");
  EXPECT_EQ(made.at("output"), "out/home.pack");
  EXPECT_EQ(made.at("run").at("stopped"), false);
  ASSERT_THAT(made.at("run").at("packs"), SizeIs(5));
  ASSERT_THAT(made.at("baked"), SizeIs(5));
  EXPECT_EQ(made.at("baked").at(0).at("pack"), "objects/box.pack");
  EXPECT_EQ(made.at("baked").at(1).at("output"), "out/home/scenes/a.pack");
  EXPECT_THAT(made.at("failed"), IsEmpty());
  ASSERT_THAT(made.at("left_out"), SizeIs(1));
  EXPECT_EQ(made.at("left_out").at(0).at("scene"), "e");
  EXPECT_EQ(made.at("linked").size(), packsIn("out").size() - 1);
}

TEST_F(PlanCli, BakesNothingTheSecondTime) {
  ASSERT_EQ(bake("out").exit_code, 0);
  const PackContents before = packsIn("out");
  const ProgramRun second = bake("out");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(second.out, HasSubstr("0 baked, 5 unchanged"));
  EXPECT_THAT(packsThatAre("unchanged"), SizeIs(5));
  expectSamePacks(packsIn("out"), before);
  // Packs that were removed are taken from the cache.
  fs::remove(path("out/home/scenes/b.pack"));
  fs::remove(path("out/home.pack"));
  ASSERT_EQ(bake("out").exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), IsEmpty());
  expectSamePacks(packsIn("out"), before);
}

TEST_F(PlanCli, BakesWhatDependsOnAFileThatChangedAndNothingElse) {
  ASSERT_EQ(bake("out").exit_code, 0);
  fs::last_write_time(path("data/meshes/objects/mug.glb"), fs::file_time_type::clock::now());
  ASSERT_EQ(bake("out").exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), IsEmpty()) << "a date says nothing";
  write("data/meshes/objects/mug.glb", fileContent(sampleFile("objects/bowl.glb")));
  ASSERT_EQ(bake("out").exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/a.pack", "scenes/b.pack"));
  addScene("c", "flat", thing("mug", 3));
  ASSERT_EQ(bake("out").exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/c.pack"));
  write("data/meshes/objects/cereal_box.glb", fileContent(sampleFile("objects/book.glb")));
  ASSERT_EQ(bake("out").exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("objects/box.pack"));
  const PackContents incremental = packsIn("out");
  ASSERT_EQ(bake("clean", {"--no-cache"}).exit_code, 0);
  EXPECT_FALSE(has("clean/home/.cache"));
  // Textures of before may lie about, unlisted; what the world lists is the same.
  for (const auto& [name, bytes] : packsIn("clean")) EXPECT_TRUE(incremental.at(name) == bytes);
}

TEST_F(PlanCli, BakesASceneAnewWhenWhatItLackedAppears) {
  ASSERT_EQ(bake("out").exit_code, 0);
  addTemplate("objects/lamp.object_config.json", "objects/bottle.glb");
  const ProgramRun run = bake("out");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(packsThatAre("baked"), Contains("scenes/d.pack"));
  EXPECT_THAT(run.out, Not(HasSubstr("lamp")));
}

TEST_F(PlanCli, DrawsAndKeepsScenesOfOneNameInSeveralFolders) {
  write("data/home.scene_dataset_config.json",
        R"({"stages": {"paths": {".json": ["stages"]}},
            "scene_instances": {"paths": {".json": ["scenes/*/"]}}})");
  write("data/stages/cube.stage_config.json", R"({"render_asset": "../meshes/cube.obj"})");
  write("data/meshes/cube.obj", texturedCube(4));
  write("data/meshes/looks.mtl", "newmtl looks\nmap_Kd paint.png\n");
  write("data/meshes/paint.png",
        test::pngFile({2, 1, {255, 0, 0, 0, 255, 0}}, {.color_type = PNG_COLOR_TYPE_RGB}));
  addScene("one/x", "cube", "");
  addScene("two/x", "cube", "");
  const ProgramRun first = bake("out");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out, Not(HasSubstr("is missing")));
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/one_x.pack", "scenes/two_x.pack"));
  const auto world = PackFile::open(path("out/home.pack"));
  ASSERT_TRUE(world) << world.error().text();
  const auto listed = packReferences(*world);
  ASSERT_TRUE(listed);
  EXPECT_THAT(*listed, SizeIs(3)) << "with their texture";
  for (const char* scene : {"out/home/scenes/one_x.pack", "out/home/scenes/two_x.pack"}) {
    const ProgramRun drawn =
        runProgram(builtProgram("galactic-pack"), path(""),
                   {"picture", scene, "--what", "mesh", "--size", "64", "-o", "x.png"});
    EXPECT_EQ(drawn.exit_code, 0);
    EXPECT_EQ(drawn.err, "") << "no texture is drawn as a flat color";
  }
  ASSERT_EQ(bake("out").exit_code, 0);
  EXPECT_THAT(packsThatAre("unchanged"), ElementsAre("scenes/one_x.pack", "scenes/two_x.pack"));
}

TEST_F(PlanCli, BakesMeshesAndRobotsAnewWhenWhatTheyNameAppears) {
  write("room/room.obj", texturedCube(2));
  write("thing/thing.obj", texturedCube(0.1));
  write("thing/looks.mtl", "newmtl looks\nmap_Kd paint.png\n");
  write("robot/robot.urdf", R"(<robot name="r"><link name="base">
      <collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision>
      <visual><geometry><mesh filename="part.obj"/></geometry></visual>
      <visual><geometry><mesh filename="broken.obj"/></geometry></visual></link></robot>)");
  write("robot/broken.obj", "v 0 0\n");
  write("w.toml",
        "[bake]\nno-render-meshes = true\nradii = [0.05, 0.12]\n"
        "[[scenes]]\nfiles = [\"room/room.obj\"]\n"
        "[[objects]]\nfiles = [\"thing/thing.obj\"]\n"
        "[robot]\nfiles = [\"robot/robot.urdf\"]\n");
  const auto bakeAll = [this] {
    const ProgramRun baked = run({"w.toml", "--report", "report.json"});
    EXPECT_EQ(baked.exit_code, 0) << baked.err;
  };
  bakeAll();
  EXPECT_THAT(packsThatAre("baked"), SizeIs(3));
  bakeAll();
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("robot.pack")) << "nobody knows what it lacks";
  write("robot/broken.obj", texturedCube(0.2));
  bakeAll();
  bakeAll();
  EXPECT_THAT(packsThatAre("unchanged"), SizeIs(3));
  write("room/looks.mtl", "newmtl looks\nKd 1 0 0\n");
  bakeAll();
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/room.pack"));
  write("thing/paint.png", "any");
  bakeAll();
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("objects/thing.pack"));
  write("robot/part.obj", texturedCube(0.2));
  bakeAll();
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("robot.pack"));
}

TEST_F(PlanCli, WritesTheSameBytesOnAnyNumberOfThreadsAndInShards) {
  ASSERT_EQ(bake("one", {"-j", "1"}).exit_code, 0);
  ASSERT_EQ(bake("two", {"-j", "2", "--memory", "0.001"}).exit_code, 0);
  const PackContents one = packsIn("one");
  expectSamePacks(packsIn("two"), one);
  const ProgramRun first = bake("parts", {"--shard", "1/2"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(packsThatAre("baked"),
              ElementsAre("objects/box.pack", "scenes/b.pack", "scenes/d.pack"));
  EXPECT_THAT(packsThatAre("elsewhere"), ElementsAre("scenes/a.pack", "scenes/c.pack"));
  EXPECT_FALSE(has("parts/home.pack"));
  ASSERT_EQ(bake("parts", {"--shard", "2/2"}).exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/a.pack", "scenes/c.pack"));
  EXPECT_FALSE(has("parts/home.pack"));
  ASSERT_EQ(bake("parts").exit_code, 0);
  EXPECT_THAT(packsThatAre("unchanged"), SizeIs(5));
  expectSamePacks(packsIn("parts"), one);
}

TEST_F(PlanCli, KeepsItsCacheWhereTheUserWants) {
  ASSERT_EQ(bake("out", {"--cache", "kept", "--scenes", "c"}).exit_code, 0);
  EXPECT_FALSE(has("out/home/.cache"));
  ASSERT_EQ(bake("other", {"--cache", "kept", "--scenes", "c"}).exit_code, 0);
  EXPECT_THAT(packsThatAre("unchanged"), ElementsAre("scenes/c.pack"));
  EXPECT_EQ(report().at("baked").at(0).at("output"), "other/home/scenes/c.pack");
  ASSERT_EQ(bake("other", {"--no-cache", "--scenes", "c"}).exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/c.pack"));
  expectSamePacks(packsIn("other"), packsIn("out"));
  // A dataset that was moved is found again.
  fs::rename(path("data"), path("moved"));
  fs::create_directory(path("data"));
  fs::rename(path("moved"), path("data/in"));
  auto arguments = datasetArguments("third", {"--cache", "kept", "--scenes", "c"});
  arguments[0] = "data/in/home.scene_dataset_config.json";
  ASSERT_EQ(run(arguments).exit_code, 0);
  EXPECT_THAT(packsThatAre("unchanged"), ElementsAre("scenes/c.pack"));
}

TEST_F(PlanCli, SaysWhichMovableObjectsHaveOneName) {
  const std::string boxes =
      R"({"template_name": "box", "motion_type": "DYNAMIC"},
         {"template_name": "box", "motion_type": "DYNAMIC", "uniform_scale": 2})";
  addScene("c", "flat", boxes);
  const ProgramRun baked = bake("out", {"--scenes", "c", "--scenes", "a"});
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(baked.out, HasSubstr("object \"box\": scenes place several of this name, of other "
                                   "templates or of other scales"));
  EXPECT_THAT(baked.out, HasSubstr("1 movable object of the scenes: episodes alone place them\n"));
  EXPECT_EQ(packsIn("out").count("home/objects/box.pack"), 1U);
}

TEST_F(PlanCli, ListsScenesAndChoosesThemByPattern) {
  const ProgramRun all = run({"data/home.scene_dataset_config.json", "--list"});
  EXPECT_EQ(all.out, "a\nb\nc\nd\ne\n");
  const ProgramRun some =
      run({"data/home.scene_dataset_config.json", "--list", "--scenes", "[", "--scenes", "a"});
  EXPECT_EQ(some.exit_code, 3);
  EXPECT_THAT(some.err, HasSubstr("--scenes: \"[\" fits none of the dataset's 5 scenes; "
                                  "galactic-bake DATASET --list prints them"));
  const ProgramRun two =
      run({"data/home.scene_dataset_config.json", "--list", "--scenes", "?", "--scenes", "a*"});
  EXPECT_EQ(two.out, "a\nb\nc\nd\ne\n");
  const ProgramRun dry = bake("out", {"--dry-run", "--scenes", "b"});
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  EXPECT_THAT(dry.out, HasSubstr("2 planned"));
  EXPECT_FALSE(has("out"));
}

TEST_F(PlanCli, TreatsScenesThatLackSomethingAsTheUserWants) {
  const ProgramRun fails = bake("out", {"--missing", "fail"});
  EXPECT_EQ(fails.exit_code, 3);
  EXPECT_THAT(fails.err, HasSubstr("home.scene_dataset_config.json: d: object 'lamp' is in none of "
                                   "the dataset's paths; add it, or bake with --missing skip or "
                                   "--missing without"));
  EXPECT_FALSE(has("out"));
  const ProgramRun skips = bake("out", {"--missing", "skip", "--dry-run"});
  EXPECT_EQ(skips.exit_code, 3) << "a dry run tells scripts that something is missing";
  EXPECT_THAT(skips.out, HasSubstr("2 scenes left out:\n"));
  EXPECT_THAT(packsThatAre("planned"), Not(Contains("scenes/d.pack")));
  ASSERT_EQ(bake("out", {"--missing", "without", "--dry-run"}).exit_code, 3);
  EXPECT_THAT(packsThatAre("planned"), Contains("scenes/d.pack"));
  const ProgramRun nothing = bake("out", {"--scenes", "e"});
  EXPECT_EQ(nothing.exit_code, 3);
  EXPECT_THAT(nothing.err, HasSubstr("out/home.pack: would have no scene, 1 is left out: e: stage "
                                     "'hall' is in none of the dataset's paths; a world has"));
  EXPECT_FALSE(has("out/home.pack"));
}

/// A world of the dataset's first scenes, an object and the sample robot.
std::string recipe() {
  return test::quickRecipe(
      "dataset = \"data/home.scene_dataset_config.json\"\nscenes = [\"a\", \"c\"]", "count = 3");
}

TEST_F(PlanCli, BakesAFolderOfScans) {
  for (const char* name : {"scans/hall/hall.glb", "scans/loft.glb"}) {
    write(name, fileContent(sampleFile("apartment.glb")));
  }
  // As Matterport3D has it: it says how to read scans, and composes no scene.
  write("scans/mp3d.scene_dataset_config.json", R"({"stages": {"paths": {".glb": ["*/*.glb"]}}})");
  const ProgramRun list = run({"scans/", "--as", "dataset", "--list"});
  EXPECT_EQ(list.out, "hall\nloft\n");
  const ProgramRun baked = run({"scans", "--as", "dataset", "--scenes", "h*", "--up", "y",
                                "--radii", "0.12", "-o", "homes.pack"});
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_TRUE(has("homes.pack"));
  EXPECT_TRUE(has("homes/scenes/hall.pack"));
  EXPECT_FALSE(has("homes/scenes/loft.pack"));
  // Under another name it has the same packs, in another folder.
  ASSERT_EQ(run({"scans", "--as", "dataset", "--scenes", "h*", "--up", "y", "--radii", "0.12", "-o",
                 "again.pack"})
                .exit_code,
            0);
  const ProgramRun diff =
      runProgram(builtProgram("galactic-pack"), path(""), {"diff", "homes.pack", "again.pack"});
  EXPECT_EQ(diff.exit_code, 0) << diff.out;
  const ProgramRun habitat = bake("out", {"--up", "z"});
  EXPECT_EQ(habitat.exit_code, 3);
  EXPECT_THAT(
      habitat.err,
      HasSubstr("says itself how its meshes stand; leave out --up, --scale and --transform, "
                "or correct up, front and scale in the attributes of its stages and "
                "objects"));
}

TEST_F(PlanCli, TurnsScansAsTheirAttributesSay) {
  const auto heightOf = [this](const std::string& attributes) {
    write("scans/loft.glb", fileContent(sampleFile("apartment.glb")));
    if (!attributes.empty()) write("scans/loft.stage_config.json", attributes);
    const ProgramRun baked =
        run({"scans", "--as", "dataset", "-o", "out.pack", "--radii", "0.12", "--check-columns",
             "0", "--no-render-meshes", "--report", "report.json"});
    EXPECT_EQ(baked.exit_code, 0) << baked.err;
    const nlohmann::json bounds = report().at("baked").at(0).at("bounds");
    return bounds.at("max").at(1).get<double>() - bounds.at("min").at(1).get<double>();
  };
  // It is higher than it is deep.
  const double lying = heightOf("");
  const double standing = heightOf(R"({"up": [0, 1.0, 0], "front": [0, 0, -1]})");
  EXPECT_GT(lying, standing + 1);
  EXPECT_EQ(heightOf(R"({"up": [0, 0, 1]})"), lying);
  EXPECT_EQ(heightOf(R"({"friction_coefficient": 0.4})"), lying);
  write("scans/loft.stage_config.json", R"({"up": [1, 0, 0]})");
  write("scans/hall.glb", fileContent(sampleFile("apartment.glb")));
  const ProgramRun odd = run({"scans", "--as", "dataset", "-o", "out.pack", "--radii", "0.12",
                              "--check-columns", "0", "--keep-going", "--report", "report.json"});
  EXPECT_EQ(odd.exit_code, 3);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/hall.pack"));
  EXPECT_THAT(odd.err, HasSubstr("loft.stage_config.json: up: is neither [0, 1, 0] nor [0, 0, 1]; "
                                 "give --up"));
}

/// Before anything is baked, however the folder is named.
TEST_F(PlanCli, WritesNoPacksIntoTheFolderOfTheirInputs) {
  write("store/hall/hall.glb", fileContent(sampleFile("apartment.glb")));
  fs::create_directory_symlink(path("store"), path("scans"));
  const auto expectRefused = [this](const std::vector<std::string>& arguments,
                                    const std::string& message) {
    const ProgramRun refused = run(arguments);
    EXPECT_EQ(refused.exit_code, 3) << arguments.back();
    EXPECT_THAT(refused.err, HasSubstr(message));
    EXPECT_THAT(refused.err, HasSubstr("; name another world with --out OTHER.pack\n"));
    EXPECT_FALSE(has("store/scenes"));
    EXPECT_FALSE(has("store/.cache"));
  };
  const std::string scans = ", which is the folder of scans scans or inside it";
  // A folder that is not there yet, as its user names it who stands among the scans.
  const ProgramRun inside = test::runProgram(test::builtProgram("galactic-bake"), path("store"),
                                             {".", "--as", "dataset", "-o", "w.pack"});
  EXPECT_EQ(inside.exit_code, 3);
  EXPECT_THAT(inside.err, HasSubstr("into w, which is the folder of scans . or inside it"));
  expectRefused({"scans", "--as", "dataset"},
                "galactic-bake: scans.pack: its packs would be written into scans" + scans);
  expectRefused({"scans", "--as", "dataset", "-o", "store.pack"}, "into store" + scans);
  expectRefused({"scans", "--as", "dataset", "-o", "scans/hall/world.pack"},
                "into scans/hall/world" + scans);
  // A configuration in a folder of its own, and a recipe's objects.
  expectRefused({"data/home.scene_dataset_config.json", "-o", "data.pack", "--scenes", "c"},
                "into data, where the input data/home.scene_dataset_config.json is");
  write("things/mug/mug.glb", fileContent(sampleFile("objects/mug.glb")));
  write("things.toml",
        "[[scenes]]\nfiles = \"data/meshes/apartment.glb\"\n"
        "[[objects]]\nfiles = \"things\"\n");
  expectRefused({"things.toml"}, "into things, where the input ");
  EXPECT_FALSE(has("things/scenes"));
  // Beside them it may go: a folder of a dataset is full of folders.
  const ProgramRun beside = run({"data/home.scene_dataset_config.json", "-o", "data/home.pack",
                                 "--scenes", "c", "--dry-run"});
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
}

TEST_F(PlanCli, IsComparedWithARenamedWorldOfBefore) {
  ASSERT_EQ(bake("out", {"--scenes", "c"}).exit_code, 0);
  fs::rename(path("out/home.pack"), path("out/before.pack"));
  ASSERT_EQ(bake("out", {"--scenes", "c", "--coverage", "cell"}).exit_code, 0);
  const ProgramRun diff = runProgram(builtProgram("galactic-pack"), path(""),
                                     {"diff", "out/before.pack", "out/home.pack"});
  EXPECT_EQ(diff.exit_code, kExitDiffers) << diff.err;
  EXPECT_THAT(diff.out, AllOf(HasSubstr("packs.scenes/c.pack.xxh3_128"), Not(HasSubstr("none\n")),
                              Not(HasSubstr("sources."))));
}

TEST_F(PlanCli, ReportsTheSameOfPacksThatWereMadeBeforeAndNow) {
  const auto compared = [this] {
    return test::runProgram(test::builtProgram("galactic-pack"), path(""),
                            {"diff", "golden.json", "report.json"});
  };
  ASSERT_EQ(bake("out").exit_code, 0);
  std::filesystem::rename(path("report.json"), path("golden.json"));
  ASSERT_EQ(bake("out").exit_code, 0);
  const ProgramRun same = compared();
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
  EXPECT_THAT(same.out, HasSubstr("\nequal\n")) << "not identical: the second run baked nothing";
  addScene("c", "flat", thing("mug", 3));
  ASSERT_EQ(bake("out").exit_code, 0);
  EXPECT_EQ(compared().exit_code, 7);
}

TEST_F(PlanCli, BakesTheWorldOfARecipe) {
  write("flat.toml", recipe());
  const std::vector<std::string> arguments{"flat.toml", "--data", sampleFile(""), "--report",
                                           "report.json"};
  const ProgramRun first = run(arguments);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(packsThatAre("baked"),
              ElementsAre("objects/box.pack", "objects/mug.pack", "robot.pack", "scenes/a.pack",
                          "scenes/c.pack", "episodes.pack"));
  const auto world = World::open(std::vector{path("flat.pack")});
  ASSERT_TRUE(world.has_value()) << world.error().text();
  EXPECT_EQ(world->episodes().episodes().size(), 3U);
  EXPECT_EQ(world->scenes().size(), 2U);
  unsigned settled = 0;
  const nlohmann::json made = report();
  for (const auto& entry : made.at("baked")) {
    if (!entry.contains("generation")) continue;
    for (const auto& scene : entry["generation"]["scenes"]) {
      EXPECT_EQ(scene["settled"], true) << "the meshes of the scenes are at hand: " << scene;
      ++settled;
    }
  }
  EXPECT_EQ(settled, 2U);
  const std::string bytes = content("flat.pack");

  ASSERT_EQ(run(arguments).exit_code, 0);
  EXPECT_THAT(packsThatAre("unchanged"), SizeIs(6));
  EXPECT_TRUE(content("flat.pack") == bytes);
  // Episodes stand in all packs, so that they are made anew with any of them.
  addScene("c", "flat", thing("mug", 3));
  ASSERT_EQ(run(arguments).exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/c.pack", "episodes.pack"));
  // What the robot has to do stands in the world alone.
  write("flat.toml", recipe() + "[task]\nepisode-steps = 300\nsafe-drop = true\n");
  ASSERT_EQ(run(arguments).exit_code, 0);
  EXPECT_THAT(packsThatAre("unchanged"), SizeIs(6));
  EXPECT_EQ(report()["task"], (nlohmann::json{{"episode-steps", "300"}, {"safe-drop", "true"}}));
  const auto with_task = World::open(std::vector{path("flat.pack")});
  ASSERT_TRUE(with_task.has_value());
  EXPECT_EQ(with_task->withTask().task.most_steps, 300U);
  EXPECT_FALSE(with_task->withTask().task.drop_fails);
  const auto stepped = [this](std::vector<std::string> more) {
    more.insert(more.begin(), {"flat.pack", "--envs", "2", "--steps", "3", "--report", "run.json"});
    const ProgramRun stepping = runProgram(test::builtProgram("galactic-run"), path(""), more);
    EXPECT_EQ(stepping.exit_code, 0) << stepping.err;
    return nlohmann::json::parse(content("run.json"), nullptr, false);
  };
  const nlohmann::json as_baked = stepped({});
  EXPECT_EQ(as_baked["options"]["episode-steps"], 300);
  EXPECT_EQ(as_baked["options"]["safe-drop"], true);
  const nlohmann::json typed = stepped({"--episode-steps", "2", "--safe-drop=false"});
  EXPECT_EQ(typed["options"]["episode-steps"], 2);
  EXPECT_EQ(typed["options"]["safe-drop"], false);
  EXPECT_EQ(typed["from_world"], nlohmann::json::array());
  EXPECT_GE(typed["episodes"]["ended"], 2);
  // In shards episodes wait for the join.
  auto part = arguments;
  part.insert(part.end(), {"--shard", "1/2", "-o", "part.pack"});
  ASSERT_EQ(run(part).exit_code, 0);
  EXPECT_FALSE(has("part/episodes.pack"));
  EXPECT_THAT(packsThatAre("baked"),
              ElementsAre("objects/box.pack", "robot.pack", "scenes/c.pack"));
}

TEST_F(PlanCli, BakesEpisodesAnewForEachOptionThatTheReportOrThePackShows) {
  const std::vector<std::string> arguments{"flat.toml", "--data", sampleFile(""), "--report",
                                           "report.json"};
  write("flat.toml", recipe());
  ASSERT_EQ(run(arguments).exit_code, 0);
  // In the pack, and in the report alone.
  for (const char* option : {"flatness = 0.004", "solve = 0"}) {
    write("flat.toml", fmt::format("{}{}\n", recipe(), option));
    ASSERT_EQ(run(arguments).exit_code, 0) << option;
    EXPECT_THAT(packsThatAre("baked"), ElementsAre("episodes.pack")) << option;
    ASSERT_EQ(run(arguments).exit_code, 0) << option;
    EXPECT_THAT(packsThatAre("baked"), IsEmpty()) << option;
  }
}

TEST_F(PlanCli, FindsFilesOfEpisodesBesideTheRecipeAndThenInItsData) {
  write("recipes/home.toml",
        "[[scenes]]\nfiles = \"../data/meshes/apartment.glb\"\ncheck-columns = 0\nradii = [0.05]\n"
        "[episodes]\nfiles = \"habitat.json\"\nobject-pack = \"objects.pack\"\n");
  write("recipes/habitat.json", kSmallHabitatSet);
  const std::string tetrahedron =
      "v 0 0 0\nv 0.1 0 0\nv 0 0.2 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  write("mug.obj", tetrahedron);
  write("003_cracker_box.obj", tetrahedron);
  const ProgramRun objects = run({"mug.obj", "003_cracker_box.obj", "--as", "object", "--up", "y",
                                  "--radii", "0.05", "-o", "objects.pack"});
  ASSERT_EQ(objects.exit_code, 0) << objects.err;
  const std::string pack = content("objects.pack");
  const std::vector<std::string> arguments{"recipes/home.toml", "--data", "elsewhere", "--report",
                                           "report.json",       "-o",     "home.pack"};
  // Beside the caller is not where it is looked for.
  const ProgramRun lost = run(arguments);
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_THAT(lost.err, HasSubstr("home.toml:7: object-pack: objects.pack fits no file in "));
  write("elsewhere/objects.pack", pack);
  const ProgramRun found = run(arguments);
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(packsThatAre("baked"), ElementsAre("scenes/apartment.pack", "episodes.pack"));
  write("recipes/objects.pack", "no pack");
  const ProgramRun beside = run(arguments);
  EXPECT_EQ(beside.exit_code, 3) << "the one beside the recipe comes first";
  EXPECT_THAT(beside.err, HasSubstr("recipes/objects.pack"));
}

}  // namespace
}  // namespace galactic::test::plan_cli_test
