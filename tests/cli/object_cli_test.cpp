// galactic-bake --as object as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/bake_folder.h"
#include "galactic/object_set.h"
#include "galactic/pack.h"
#include "support/mesh_files.h"

namespace galactic::object_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using test::Refusal;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A brick of 1 x 2 x 3 units.
std::string brick() { return test::objFile(test::unevenBox()); }

class ObjectCli : public test::BakeFolder {
 protected:
  /// Bricks of 3 x 6 x 9 cm in few large spheres: a bake takes a tenth of a second.
  [[nodiscard]] ProgramRun bake(std::vector<std::string> arguments) const {
    const std::vector<std::string> quick{"--as",      "object", "--scale", "0.03",  "--radii",
                                         "0.03,0.05", "--eps",  "0.02",    "--tau", "0.03"};
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    return run(std::move(arguments));
  }

  [[nodiscard]] std::vector<std::string> namesIn(const std::string& pack_name) const {
    std::vector<std::string> names;
    const auto pack = PackFile::open(path(pack_name));
    EXPECT_TRUE(pack) << pack.error().text();
    if (!pack) return names;
    const auto set = ObjectSet::from(*pack);
    EXPECT_TRUE(set);
    for (const ObjectModel& object : set->objects()) names.emplace_back(object.name);
    return names;
  }
};

TEST_F(ObjectCli, BakesOneFileIntoAPackOfItsName) {
  write("mug.obj", brick());
  const ProgramRun run = bake({"mug.obj"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("1 object -> mug.pack"), HasSubstr("30x60x90"),
                             HasSubstr("spheres of radius 0.05+0.03 m")));
  EXPECT_THAT(run.err, IsEmpty());
  EXPECT_THAT(namesIn("mug.pack"), ElementsAre("mug"));
}

TEST_F(ObjectCli, BakesAFolderOfFoldersAsYcbIsLaidOut) {
  write("ycb/025_mug/textured.obj", brick());
  write("ycb/003_box/textured.obj", brick());
  write("ycb/003_box/notes.txt", "not a mesh");
  write("ycb/loose/cup.obj", brick());
  write("ycb/loose/cup.stl", test::stlBinaryFile(test::unevenBox()));
  const ProgramRun run = bake({"ycb"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 objects -> ycb.pack"));
  EXPECT_THAT(namesIn("ycb.pack"), ElementsAre("003_box", "025_mug", "cup"));
}

TEST_F(ObjectCli, BakesModelsAsYcbAndGoogleScannedObjectsPublishThem) {
  // Of several models of one object the one that YCB made of the fewest points.
  write("models/025_mug/google_16k/textured.obj", brick());
  write("models/025_mug/google_512k/textured.obj", "broken");
  write("models/025_mug/tsdf/textured.obj", "broken");
  write("models/Tea_Pot/meshes/model.obj", brick());
  const ProgramRun run = bake({"models"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(namesIn("models.pack"), ElementsAre("025_mug", "Tea_Pot"));
}

TEST_F(ObjectCli, NamesThePackAfterTheFolderHoweverItIsWritten) {
  write("things.v2/mug.obj", brick());
  for (const char* input : {"things.v2", "things.v2/", "./things.v2/.", "things.v2/../things.v2"}) {
    SCOPED_TRACE(input);
    EXPECT_EQ(bake({input, "-q"}).exit_code, 0);
    EXPECT_TRUE(has("things.v2.pack"));
    std::filesystem::remove(path("things.v2.pack"));
  }
  const std::string name = path("x").parent_path().filename().string() + ".pack";
  EXPECT_EQ(bake({".", "-q"}).exit_code, 0);
  EXPECT_TRUE(has(name));
}

TEST_F(ObjectCli, WritesTheSameBytesForAnyNumberOfJobs) {
  for (const char* name : {"a", "b", "c"}) write(std::string("set/") + name + ".obj", brick());
  ASSERT_EQ(bake({"set", "-o", "one.pack", "-j", "1"}).exit_code, 0);
  ASSERT_EQ(bake({"set", "-o", "three.pack", "-j", "3"}).exit_code, 0);
  EXPECT_FALSE(content("one.pack").empty());
  EXPECT_TRUE(content("one.pack") == content("three.pack"));
}

TEST_F(ObjectCli, RefusesTwoObjectsOfOneName) {
  write("set/a/mug.obj", brick());
  write("set/b/mug.obj", brick());
  const ProgramRun run = bake({"set"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, AllOf(StartsWith("galactic-bake: set/b/mug.obj: would be the object 'mug', "
                                        "as set/a/mug.obj is"),
                             HasSubstr("rename one of them")));
  EXPECT_FALSE(has("set.pack"));
}

TEST_F(ObjectCli, StopsAtABrokenFileUnlessToldToKeepGoing) {
  write("set/broken.obj", "this is no mesh\n");
  write("set/mug.obj", brick());
  const ProgramRun stops = bake({"set"});
  EXPECT_EQ(stops.exit_code, 3);
  EXPECT_THAT(stops.err, StartsWith("galactic-bake: set/broken.obj: "));
  EXPECT_FALSE(has("set.pack"));
  const ProgramRun goes_on = bake({"set", "--keep-going", "--report", "report.json"});
  EXPECT_EQ(goes_on.exit_code, 3);
  EXPECT_THAT(namesIn("set.pack"), ElementsAre("mug"));
  const json report = json::parse(content("report.json"));
  ASSERT_EQ(report["failed"].size(), 1U);
  EXPECT_EQ(report["failed"][0]["input"], "set/broken.obj");
  EXPECT_EQ(report["failed"][0]["code"], 3);
  ASSERT_EQ(report["baked"].size(), 1U);
}

TEST_F(ObjectCli, ReportsEachObject) {
  write("mug.obj", brick());
  ASSERT_EQ(bake({"mug.obj", "--report", "report.json"}).exit_code, 0);
  const json object = json::parse(content("report.json"))["baked"][0];
  EXPECT_EQ(object["name"], "mug");
  EXPECT_EQ(object["output"], "mug.pack");
  EXPECT_EQ(object["pack_bytes"], std::filesystem::file_size(path("mug.pack")));
  EXPECT_EQ(object["triangles"]["kept"], 12);
  EXPECT_NEAR(object["box"]["half_extents"][1], 0.03, 1e-5);
  EXPECT_NEAR(object["box"]["volume"], 0.03 * 0.06 * 0.09, 1e-6);
  EXPECT_EQ(object["box"]["rotation_wxyz"], json::array({1, 0, 0, 0}));
  EXPECT_EQ(object["stable_poses"].size(), 6U);
  const json& spheres = object["spheres"];
  EXPECT_EQ(spheres["meets_tolerances"], true);
  EXPECT_EQ(spheres["count_per_radius"].size(), 2U);
  EXPECT_EQ(spheres["count"],
            spheres["count_per_radius"][0].get<int>() + spheres["count_per_radius"][1].get<int>());
  EXPECT_LE(spheres["gap"]["max"], 0.021);
  EXPECT_TRUE(object["warnings"].empty());
}

TEST_F(ObjectCli, AsksAboutUnits) {
  write("mug.obj", brick());
  const ProgramRun tiny = run({"mug.obj", "--as", "object", "--scale", "0.0005"});
  EXPECT_EQ(tiny.exit_code, 0) << tiny.err;
  EXPECT_THAT(tiny.out,
              HasSubstr("warning: object 'mug': is only 1.5 mm large; is the unit right?"));
  const ProgramRun huge = run({"mug.obj", "--as", "object", "--scale", "30"});
  EXPECT_EQ(huge.exit_code, 5);
  EXPECT_THAT(huge.err, AllOf(StartsWith("galactic-bake: mug.obj: mesh: its extents are"),
                              HasSubstr("is its unit the centimeter or the millimeter?")));
}

/// Fitting spheres to it would take minutes.
TEST_F(ObjectCli, RefusesAnObjectOfMetersUnlessItsUnitIsStated) {
  const auto refusalOf = [&](const std::string& name, float units) {
    test::MeshContent box = test::unevenBox();
    for (auto& p : box.positions) {
      for (float& coordinate : p) coordinate *= units;
    }
    write(name, test::objFile(box));
    const ProgramRun refused = run({name, "--as", "object"});
    EXPECT_EQ(refused.exit_code, 3);
    return refused.err;
  };
  const std::string units =
      "(Y up (OBJ convention), 1 m per unit (OBJ convention)), and objects are smaller than 3 m; "
      "give meters per unit with --scale: 0.01 for centimeters, 0.001 for millimeters, 1 if it is "
      "right in meters; ";
  EXPECT_EQ(
      refusalOf("crate.obj", 2),
      "galactic-bake: crate.obj: the object is 2 x 4 x 6 m large " + units + "0.01 is likely\n");
  // 3.6 m are no likely size, and neither are 3.6 cm.
  EXPECT_EQ(refusalOf("bench.obj", 1.2F),
            "galactic-bake: bench.obj: the object is 1.2 x 2.4 x 3.6 m large " +
                units.substr(0, units.size() - 2) + "\n");
  EXPECT_EQ(refusalOf("screw.obj", 200),
            "galactic-bake: screw.obj: the object is 200 x 400 x 600 m large " + units +
                "0.001 is likely\n");
  // Stated by the user, it is only asked about.
  const ProgramRun stated = run({"crate.obj", "--as", "object", "--scale", "1", "--radii",
                                 "1.5,2.5", "--eps", "1", "--tau", "1.5"});
  EXPECT_EQ(stated.exit_code, 0) << stated.err;
  EXPECT_THAT(stated.out, HasSubstr("object 'crate': is 6 m large; is the unit right?"));
  EXPECT_EQ(bake({"crate.obj", "-o", "small.pack"}).exit_code, 0);
}

TEST_F(ObjectCli, TakesTheUnitOfAFileThatStatesIt) {
  test::MeshContent box = test::unevenBox();
  for (auto& p : box.positions) {
    for (float& coordinate : p) coordinate *= 1.2F;
  }
  write("bench.dae", test::daeFile(box, {"Y_UP", "1", ""}));
  write("bench.fbx", test::fbxFile(box, {}));
  for (const std::string name : {"bench.dae", "bench.fbx"}) {
    const ProgramRun run_of =
        run({name, "--as", "object", "--radii", "1.5,2.5", "--eps", "1", "--tau", "1.5"});
    EXPECT_EQ(run_of.exit_code, 0) << run_of.err;
    EXPECT_THAT(run_of.out, HasSubstr("object 'bench': is 3.6 m large; is the unit right?"));
  }
}

TEST_F(ObjectCli, UnderstandsEveryOptionOfObjects) {
  write("mug.obj", brick());
  for (const char* box : {"yaw", "min", "aabb"})
    EXPECT_EQ(bake({"mug.obj", "--obb", box}).exit_code, 0);
  EXPECT_EQ(bake({"mug.obj", "--no-support"}).exit_code, 0);
  const ProgramRun one = bake({"mug.obj", "--max-spheres", "1", "--report", "report.json"});
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_THAT(one.out, HasSubstr("warning: object 'mug': with 1 sphere there are gaps"));
  EXPECT_EQ(json::parse(content("report.json"))["baked"][0]["spheres"]["count"], 1);
  EXPECT_EQ(bake({"mug.obj", "--dry-run", "-o", "none.pack"}).exit_code, 0);
  EXPECT_FALSE(has("none.pack"));
}

TEST_F(ObjectCli, ExplainsEveryRefusal) {
  write("mug.obj", brick());
  write("empty/readme.txt", "");
  const std::vector<Refusal> refusals{
      {{"mug.obj", "--as", "thing"}, 1, "--as"},
      {{"mug.obj", "--as", "object", "--spacing", "0.04"},
       1,
       "--spacing: does not go with --as object; leave it out"},
      {{"mug.obj", "--as", "object", "--recipe", "r.toml"},
       1,
       "--recipe: does not go with --as object; leave it out"},
      {{"mug.obj", "--as", "object", "--allow-missing"},
       1,
       "--allow-missing: does not go with --as object"},
      {{"mug.obj", "--obb", "min"}, 1, "--obb: does not go with --as scene; leave it out"},
      {{"mug.obj", "--as", "object", "--obb", "round"}, 1, "--obb"},
      {{"mug.obj", "--as", "object", "--profile", "loose"}, 1, "--profile"},
      {{"mug.obj", "--as", "object", "--eps", "0"}, 1, "--eps: found 0, expected a number above 0"},
      {{"mug.obj", "--as", "object", "--tau", "x"}, 1, "--tau: found x, expected a number above 0"},
      {{"mug.obj", "--as", "object", "--max-spheres", "-1"}, 1, "--max-spheres"},
      {{"missing.obj", "--as", "object"}, 2, "missing.obj"},
      {{"empty", "--as", "object"}, 3, "empty: holds no mesh file; .glb"},
      {{"mug.obj", "--as", "object", "--radii", "0.05,0.02"},
       1,
       "--radii: has 0.02 m after 0.05 m; list each radius once, in ascending order"},
      {{"mug.obj", "--as", "object", "-o", "mug.obj"}, 3, "is also an input"},
  };
  const std::string before = content("mug.obj");
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun run_once = run(refusal.arguments);
    EXPECT_EQ(run_once.exit_code, refusal.exit_code);
    EXPECT_THAT(run_once.err, HasSubstr(refusal.part));
    EXPECT_THAT(run_once.out, IsEmpty());
  }
  EXPECT_EQ(content("mug.obj"), before);
}

TEST_F(ObjectCli, NeverReplacesAMeshOfTheFolder) {
  write("set/mug.obj", brick());
  const ProgramRun run = bake({"set", "--report", "set/mug.obj"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("is also an input"));
  EXPECT_EQ(content("set/mug.obj"), brick());
}

/// The brick as a published object, in the frame of its file.
constexpr const char* kCollection = R"({"collection": {
  "collisionRadiusWorkingSet": [0.03, 0.05], "author": "me", "robots": [],
  "freeObjects": [{"name": "mug", "collisionBox": {"min": [0, 0, 0], "max": [0.03, 0.06, 0.09]},
    "collisionSpheres": [{"origin": [0.015, 0.03, 0.045], "radius": 0.05}]}]}})";

TEST_F(ObjectCli, TakesBoxesAndSpheresOfACollection) {
  write("set/mug.obj", brick());
  write("set/cup.obj", brick());
  write("c.collection.json", kCollection);
  const ProgramRun run =
      bake({"set", "--up", "z", "--collection", "c.collection.json", "--report", "report.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(
      run.out,
      AllOf(HasSubstr("as given"), HasSubstr("warning: collection.author is not used"),
            HasSubstr("warning: object 'cup': the collection does not name it: box and spheres are "
                      "fitted")));
  const json baked = json::parse(content("report.json"))["baked"];
  ASSERT_EQ(baked.size(), 2U);
  EXPECT_EQ(baked[0]["authored_spheres"], false);
  const json& mug = baked[1];
  EXPECT_EQ(mug["authored_spheres"], true);
  EXPECT_EQ(mug["spheres"]["count"], 1);
  const auto pack = PackFile::open(path("set.pack"));
  ASSERT_TRUE(pack) << pack.error().message;
  const auto set = ObjectSet::from(*pack);
  ASSERT_TRUE(set);
  const ObjectModel& object = set->objects()[1];
  EXPECT_EQ(object.name, "mug");
  EXPECT_EQ(object.box.pose.rotation, Quat{});
  EXPECT_NEAR(object.box.half_extents.x, 0.015F, 1e-8F);
  EXPECT_NEAR(object.box.half_extents.y, 0.045F, 1e-8F);
  EXPECT_NEAR(object.box.half_extents.z, 0.03F, 1e-8F);
  ASSERT_EQ(object.spheres.size(), 1U);
  EXPECT_NEAR(object.spheres[0].center.y, 0.045F, 1e-8F);
  EXPECT_NEAR(object.spheres[0].center.z, -0.03F, 1e-8F);
}

TEST_F(ObjectCli, ExplainsWhatACollectionLacks) {
  write("mug.obj", brick());
  write("c.collection.json", kCollection);
  write("broken.json", "{}");
  const std::vector<Refusal> refusals{
      {{"mug.obj", "--collection", "c.collection.json"},
       1,
       "--collection: needs the up axis of the meshes"},
      {{"mug.obj", "--collection", "broken.json", "--up", "z"},
       3,
       "broken.json: collection: it is missing"},
      {{"mug.obj", "--collection", "none.json", "--up", "z"}, 2, "none.json"},
      {{"mug.obj", "--collection", "c.collection.json", "--up", "z", "-o", "c.collection.json"},
       3,
       "is also an input"}};
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun refused = bake(refusal.arguments);
    EXPECT_EQ(refused.exit_code, refusal.exit_code);
    EXPECT_THAT(refused.err, HasSubstr(refusal.part));
  }
  const ProgramRun scene = run({"mug.obj", "--collection", "c.collection.json"});
  EXPECT_EQ(scene.exit_code, 1);
  EXPECT_THAT(scene.err, HasSubstr("--collection: does not go with --as scene"));
  const ProgramRun other = run({"mug.obj", "--as", "object", "--scale", "0.03", "--up", "z",
                                "--radii", "0.02", "--collection", "c.collection.json"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("c.collection.json: object 'mug': lists spheres whose radii"));
}

}  // namespace
}  // namespace galactic::object_cli_test
