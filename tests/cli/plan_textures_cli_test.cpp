// Textures that the scenes of a world share: made again, and missed where they are gone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/plan_folder.h"
#include "support/build_paths.h"

namespace galactic::test::plan_textures_cli_test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;

using PlanTextures = PlanFolder;

TEST_F(PlanTextures, MakesTexturePacksAgainThatAreGoneOrDamaged) {
  ASSERT_EQ(bake("out", {"--scenes", "c"}).exit_code, 0);
  const PackContents before = packsIn("out");
  const std::vector<std::string> names = textures("out");
  ASSERT_GE(names.size(), 3U);
  fs::remove(path(names[0]));
  ASSERT_EQ(bake("out", {"--scenes", "c"}).exit_code, 0);
  EXPECT_THAT(packsThatAre("unchanged"), Contains("scenes/c.pack")) << "the cache has it";
  expectSamePacks(packsIn("out"), before);
  const std::string whole = content(names[1]);
  // In place, where the cache has the same file.
  write(names[1], whole.substr(0, whole.size() / 2));
  ASSERT_EQ(bake("out", {"--scenes", "c"}).exit_code, 0);
  EXPECT_THAT(packsThatAre("baked"), Contains("scenes/c.pack"));
  expectSamePacks(packsIn("out"), before);
  damage(names[2]);
  ASSERT_EQ(bake("out", {"--scenes", "c", "--no-cache"}).exit_code, 0);
  expectSamePacks(packsIn("out"), before);
}

/// Where those of the cache are those of the world.
TEST_F(PlanTextures, MakesThemAgainWhereTheCacheIsTheFolderOfTheWorld) {
  const std::vector<std::string> options{"--scenes", "c", "--cache", "out/home"};
  ASSERT_EQ(bake("out", options).exit_code, 0);
  const std::string texture = textures("out").front();
  const std::string before = content(texture);
  fs::remove(path(texture));
  ASSERT_EQ(bake("out", options).exit_code, 0);
  EXPECT_TRUE(content(texture) == before);
}

/// What is drawn is not what the scene looks like, and nobody may take it for that.
TEST_F(PlanTextures, SaysWhichSharedTexturesAPictureLacks) {
  ASSERT_EQ(bake("out", {"--scenes", "c"}).exit_code, 0);
  const std::string scene = "out/home/scenes/c.pack";
  const std::vector<std::vector<std::string>> runs{
      {"picture", scene, "--what", "mesh", "--size", "64", "-o", "c.png"},
      {"view", "out/home.pack", "-o", "c.html"},
      {"export", scene, "-o", "c.glb"},
      {"report", "out/home.pack", scene, "-o", "r.html"}};
  const auto drawn = [this](const std::vector<std::string>& arguments) {
    const ProgramRun result = runProgram(builtProgram("galactic-pack"), path(""), arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(has(arguments.back()));
    return result.err;
  };
  const std::vector<std::string> packs = textures("out");
  ASSERT_GT(packs.size(), 2U);
  for (const auto& arguments : runs) EXPECT_EQ(drawn(arguments), "") << arguments.front();
  damage(packs.front());
  EXPECT_EQ(drawn(runs.front()),
            "galactic-pack: warning: 1 shared texture is drawn as flat colors: its pack is missing "
            "or damaged in out/home/textures\n");
  fs::remove_all(path("out/home/textures"));
  for (const auto& arguments : runs) {
    EXPECT_EQ(drawn(arguments),
              fmt::format("galactic-pack: warning: {} shared textures are drawn as flat colors: "
                          "their packs are missing or damaged in out/home/textures\n",
                          packs.size()))
        << arguments.front();
  }
  // Grids have none.
  EXPECT_EQ(drawn({"picture", scene, "-o", "grids.png"}), "");
}

}  // namespace
}  // namespace galactic::test::plan_textures_cli_test
