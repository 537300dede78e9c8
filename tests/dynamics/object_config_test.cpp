// What object configurations say of masses, friction and convex pieces.
#include "dynamics/sources/object_config.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/scratch_folder.h"

namespace galactic::test::object_config_test {
namespace {

using dynamics::findObjectConfig;
using dynamics::ObjectConfig;
using dynamics::readObjectConfig;
using testing::HasSubstr;

TEST(AnObjectConfig, IsFoundWhereDatasetsHaveIt) {
  const ScratchFolder folder;
  const auto beside = folder.write("a/cup.object_config.json", "{}");
  EXPECT_EQ(findObjectConfig(folder.path() / "a/cup.glb", "cup"), beside);
  // As ReplicaCAD has it, and as YCB.
  const auto replica = folder.write("configs/objects/vase.object_config.json", "{}");
  EXPECT_EQ(findObjectConfig(folder.path() / "objects/vase.glb", "vase"), replica);
  const auto ycb = folder.write("ycb/configs/002_can.object_config.json", "{}");
  EXPECT_EQ(
      findObjectConfig(folder.path() / "ycb/meshes/002_can/google_16k/textured.glb", "002_can"),
      ycb);
  EXPECT_FALSE(findObjectConfig(folder.path() / "a/plate.glb", "plate"));
}

TEST(AnObjectConfig, TellsMassFrictionAndPieces) {
  const ScratchFolder folder;
  const auto pieces = folder.write("convex/cup_cv.glb", "");
  const auto file = folder.write("cup.object_config.json",
                                 R"({"mass": 0.25, "friction_coefficient": 0.4,
                                     "collision_asset": "convex/cup_cv.glb",
                                     "join_collision_meshes": true})");
  const ObjectConfig config = readObjectConfig(file).value();
  EXPECT_EQ(config.mass, 0.25);
  EXPECT_EQ(config.friction, 0.4);
  EXPECT_EQ(config.collision_asset, pieces);
  EXPECT_TRUE(config.joins_meshes);
  EXPECT_TRUE(config.warnings.empty());
}

TEST(AnObjectConfig, WithValuesThatNoBodyHasWarns) {
  const ScratchFolder folder;
  for (const char* text :
       {R"({"mass": 0})", R"({"mass": -1})", R"({"mass": "heavy"})",
        R"({"friction_coefficient": -0.1})", R"({"mass": null})", R"({"mass": 1e30})",
        R"({"friction_coefficient": 1e300})", R"({"collision_asset": "none.glb"})"}) {
    const ObjectConfig config =
        readObjectConfig(folder.write("cup.object_config.json", text)).value();
    EXPECT_FALSE(config.mass) << text;
    EXPECT_FALSE(config.friction) << text;
    EXPECT_TRUE(config.collision_asset.empty()) << text;
    ASSERT_EQ(config.warnings.size(), 1U) << text;
    EXPECT_THAT(config.warnings.front(), testing::AnyOf(HasSubstr("default"), HasSubstr("hull")));
  }
}

TEST(AnObjectConfig, MayHoldTheEndsOfTheRangesAndNothingBeyond) {
  const ScratchFolder folder;
  const auto read = [&](const char* text) {
    return readObjectConfig(folder.write("cup.object_config.json", text)).value();
  };
  const ObjectConfig light = read(R"({"mass": 1e-6, "friction_coefficient": 0})");
  EXPECT_EQ(light.mass, 1e-6);
  EXPECT_EQ(light.friction, 0);
  const ObjectConfig heavy = read(R"({"mass": 1000000, "friction_coefficient": 10})");
  EXPECT_EQ(heavy.mass, 1e6);
  EXPECT_EQ(heavy.friction, 10);
  const ObjectConfig beyond = read(R"({"mass": 1000001, "friction_coefficient": 10.1})");
  EXPECT_FALSE(beyond.mass);
  EXPECT_FALSE(beyond.friction);
  EXPECT_THAT(
      beyond.warnings,
      testing::ElementsAre("has no usable 'mass' in 'cup.object_config.json': found 1000001, "
                           "expected 1e-06 to 1e+06; the default counts",
                           "has no usable 'friction_coefficient' in "
                           "'cup.object_config.json': found 10.1, expected 0 to 10; the "
                           "default counts"));
}

TEST(AnObjectConfig, MayBeNestedDeeply) {
  const ScratchFolder folder;
  // So many levels that a function that calls itself for each overflows the stack.
  constexpr std::size_t kLevels = 200'000;
  for (const char* key : {"mass", "collision_asset", "friction_coefficient", "other"}) {
    const std::string text =
        fmt::format("{{\"{}\": {}{}}}", key, std::string(kLevels, '['), std::string(kLevels, ']'));
    const auto config = readObjectConfig(folder.write("cup.object_config.json", text));
    // The reader of JSON may refuse it.
    if (!config) {
      EXPECT_EQ(config.error().code, ErrorCode::kInvalidInput) << key;
      continue;
    }
    EXPECT_FALSE(config->mass) << key;
    for (const std::string& warning : config->warnings) {
      EXPECT_THAT(warning, HasSubstr("found a list, expected "));
    }
  }
}

TEST(AnObjectConfig, ThatIsNoJsonObjectIsRefused) {
  const ScratchFolder folder;
  for (const char* text : {"", "[]", "{", "7", "{\"mass\": 1"}) {
    const auto config = readObjectConfig(folder.write("cup.object_config.json", text));
    ASSERT_FALSE(config) << text;
    EXPECT_EQ(config.error().code, ErrorCode::kInvalidInput);
  }
}

}  // namespace
}  // namespace galactic::test::object_config_test
