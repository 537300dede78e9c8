// galactic-bake --as world as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/bake_folder.h"
#include "galactic/world.h"
#include "support/packs/world_pack_builder.h"

namespace galactic::world_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using test::Refusal;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

class WorldCli : public test::BakeFolder {
 protected:
  void SetUp() override {
    const test::WorldFields world;
    write("episodes.pack", test::textOf(buildPack(world.episodes)));
    write("objects.pack", test::textOf(buildPack(world.objects)));
    write("robots/helper.pack", test::textOf(buildPack(world.robot)));
    write("scenes/kitchen.pack", test::textOf(buildPack(world.scene)));
  }

  const std::vector<std::string> packs_{"scenes/kitchen.pack", "objects.pack", "robots/helper.pack",
                                        "episodes.pack"};

  [[nodiscard]] ProgramRun link(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = packs_;
    arguments.insert(arguments.end(), {"--as", "world"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(std::move(arguments));
  }
};

TEST_F(WorldCli, LinksPacksIntoAWorldThatOpens) {
  const ProgramRun run = link({"--report", "report.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("4 packs -> world.pack"), HasSubstr("EPIS episodes.pack"),
                             HasSubstr("RBOT robots/helper.pack")));
  EXPECT_THAT(run.err, IsEmpty());
  const auto world = World::open(std::vector{path("world.pack")});
  ASSERT_TRUE(world.has_value()) << world.error().text();
  EXPECT_EQ(world->robot().name(), "helper");
  const json report = json::parse(content("report.json"))["baked"][0];
  EXPECT_EQ(report["output"], "world.pack");
  EXPECT_EQ(report["pack_bytes"], std::filesystem::file_size(path("world.pack")));
  ASSERT_EQ(report["packs"].size(), 4U);
  EXPECT_EQ(report["packs"][0]["path"], "episodes.pack");
  EXPECT_EQ(report["packs"][0]["xxh3_128"].get<std::string>().size(), 32U);
}

TEST_F(WorldCli, WritesTheSameBytesWhateverTheOrderOfThePacks) {
  ASSERT_EQ(link({"-o", "a.pack"}).exit_code, 0);
  const ProgramRun turned =
      run({"--as", "world", "-o", "b.pack", "episodes.pack", "./robots/../robots/helper.pack",
           "objects.pack", path("scenes/kitchen.pack").string()});
  EXPECT_EQ(turned.exit_code, 0) << turned.err;
  EXPECT_FALSE(content("a.pack").empty());
  EXPECT_TRUE(content("a.pack") == content("b.pack"));
}

TEST_F(WorldCli, WritesNoPackOnADryRun) {
  const ProgramRun run = link({"--dry-run"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("(dry run)"));
  EXPECT_FALSE(has("world.pack"));
}

TEST_F(WorldCli, ExplainsEveryRefusal) {
  write("text.pack", "no pack");
  ASSERT_EQ(link({"-o", "old.pack"}).exit_code, 0);
  const std::vector<Refusal> refusals{
      {{"objects.pack", "--as", "world"}, 3, "hold no scene, a world has at least one"},
      {{"old.pack", "--as", "world"}, 3, "old.pack: is a world"},
      {{"text.pack", "--as", "world"}, 3, "text.pack"},
      {{"none.pack", "--as", "world"}, 2, "none.pack"},
      {{"objects.pack", "objects.pack", "--as", "world"}, 3, "objects.pack: is there twice"},
      {{"objects.pack", "--as", "world", "-o", "objects.pack"}, 3, "is also an input"},
      {{"objects.pack", "--as", "world", "-o", "scenes/w.pack"},
       3,
       "put the world pack above all its packs"},
      {{"objects.pack", "--as", "world", "--radii", "0.05"},
       1,
       "--radii: does not go with --as world"},
      {{"objects.pack", "--as", "world", "--seed", "1"}, 1, "--seed: does not go with --as world"},
      {{"objects.pack", "--as", "world", "--count", "1"},
       1,
       "--count: does not go with --as world"},
      {{"objects.pack", "--as", "episodes"}, 3, "objects and 0 robots; episodes are generated"},
      {{"episodes.pack", "--as", "episodes", "-o", "x.pack"},
       3,
       "is a pack of kind EPIS; episodes are generated in"},
      {{"objects.pack", "--as", "episodes", "--only", "x"},
       1,
       "--only: does not go with --as episodes of packs; leave it out"},
      {{"objects.pack", "--as", "episodes", "--seed", "1,2,3"},
       1,
       "--seed: found 1,2,3, expected a whole number from 0 to "},
      {{"objects.pack", "--as", "episodes", "--seed", "1", "--seed", "2"},
       1,
       "--seed: is given twice"},
      {{"objects.pack", "--as", "episodes", "--heights", "1"}, 1, "--heights: has 1 numbers"},
      {{"objects.pack", "--as", "episodes", "--goal-distance", "x"}, 1, "--goal-distance"},
      {{"objects.pack", "--as", "episodes", "--start-distance", "1,2,3"},
       1,
       "--start-distance: has 3 numbers"},
      {{"objects.pack", "--as", "episodes", "--objects", "2.5"},
       1,
       "--objects: is \"2.5\", expected a whole number from 1 to 1024 or two of them"},
      {{"objects.pack", "--as", "episodes", "--geometry", "a"},
       1,
       "--geometry: is \"a\", expected SCENE=FILE"},
      {{"objects.pack", "--as", "episodes", "--geometry", "a=b", "--geometry", "a=c"},
       1,
       "--geometry: names a twice"},
      {{"objects.pack", "--as", "episodes", "--geometry", "a=b"},
       3,
       "is for the scene a, which none of the packs holds"},
      {{"objects.pack", "--as", "episodes", "--split", "test"}, 1, "--split"},
      {{"objects.pack", "--as", "episodes", "--count", "0"}, 1, "--count"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const ProgramRun run_once = run(refusal.arguments);
    EXPECT_EQ(run_once.exit_code, refusal.exit_code);
    EXPECT_THAT(run_once.err, HasSubstr(refusal.part));
    EXPECT_THAT(run_once.out, IsEmpty());
  }
  EXPECT_FALSE(has("world.pack"));
}

}  // namespace
}  // namespace galactic::world_cli_test
