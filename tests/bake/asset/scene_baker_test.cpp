// A whole scene from its asset to its grids.
#include "galactic/bake/scene_baker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "support/asset_mesh.h"
#include "support/build_paths.h"
#include "support/scene_meshes.h"
#include "support/source_asset.h"

namespace galactic::bake::scene_baker_test {
namespace {

constexpr std::uint32_t kSeed = 20250314;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Result<BakedScene> bake(const SourceAsset& asset, const SceneBakeOptions& options,
                        unsigned threads = 1) {
  StageTimes times;
  return bakeScene(
      asset, options, times, [](auto, auto) {}, threads);
}

SourceAsset room() { return test::sourceAssetOf(test::furnishedRoom(kSeed)); }

/// The error of options that must be refused.
Error errorOf(const SceneBakeOptions& options) {
  const auto scene = bake(room(), options);
  EXPECT_FALSE(scene);
  return scene ? Error{} : scene.error();
}

TEST(SceneBaker, RefusesRadiiThatMakeNoWorkingSet) {
  const struct {
    std::vector<float> radii;
    const char* message;
  } cases[] = {
      {{}, "has 0 radii, expected 1 to 8"},
      {{1, 2, 3, 4, 5, 6, 7, 8, 9}, "has 9 radii, expected 1 to 8"},
      {{0.05F, -0.1F}, "has the radius -0.1 m, expected a positive length"},
      {{0}, "has the radius 0 m, expected a positive length"},
      {{kNan}, "has the radius nan m, expected a positive length"},
      {{10.5F}, "has the radius 10.5 m, expected at most 10 m; millimeters? Give meters"},
      {{15, 50, 120}, "has the radius 15 m, expected at most 10 m; millimeters? Give meters"},
      {{0.05F, 0.05F}, "has 0.05 m after 0.05 m; list each radius once, in ascending order"},
      {{0.12F, 0.05F}, "has 0.05 m after 0.12 m; list each radius once, in ascending order"},
  };
  for (const auto& [radii, message] : cases) {
    const Error error = errorOf({.radii = radii});
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
    EXPECT_EQ(error.where, "`radii`");
    EXPECT_EQ(error.message, message);
  }
}

TEST(SceneBaker, RefusesARadiusLargerThanTheScene) {
  const SourceAsset block =
      test::sourceAssetOf(test::MeshBuilder().box({0, 0, 0}, {1, 2, 0.5F}).build());
  const auto refused = bake(block, {.radii = {0.05F, 2.1F}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "`radii`");
  EXPECT_EQ(refused.error().message,
            "has the radius 2.1 m, and the whole scene is 1 x 2 x 0.5 m; millimeters? Give meters, "
            "or check the scene's unit (`scale`)");
  const auto largest = bake(block, {.radii = {2}, .spacing = 0.5F, .check_columns = 1});
  EXPECT_TRUE(largest);
}

TEST(SceneBaker, RefusesARadiusUnderHalfTheSpacing) {
  const Error error = errorOf({.radii = {0.02F, 0.05F}, .spacing = 0.05F});
  EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
  EXPECT_EQ(error.where, "`radii`");
  EXPECT_THAT(error.message, testing::StartsWith("radius 0.02 m is under half the spacing"));
}

TEST(SceneBaker, RefusesCellCoverageFromSphereCasts) {
  for (const Engine engine : {Engine::kBullet, Engine::kEmbree}) {
    const Error error = errorOf({.engine = engine, .coverage = Coverage::kCell});
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
    EXPECT_EQ(error.where, "`coverage`");
    EXPECT_EQ(error.message, "cell works with `engine` exact only: sphere casts know single lines");
  }
}

TEST(SceneBaker, RefusesASeedThatIsNotFree) {
  SceneBakeOptions options;
  options.free_space.seeds = {{-50, 1, 1}};
  const Error error = errorOf(options);
  EXPECT_EQ(error.where, "`inside`");
  EXPECT_THAT(error.message,
              testing::StartsWith("(-50, 1, 1) is outside the scene for radius 0.015"));
}

TEST(SceneBaker, RefusesAnAssetWithoutTriangles) {
  SourceAsset empty;
  empty.name = "nothing";
  const auto scene = bake(empty, {});
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, ErrorCode::kInvalidInput);
}

TEST(SceneBaker, DescribesTheSceneAndEachGrid) {
  SourceAsset asset = room();
  asset.meshes[0].triangles.push_back(asset.meshes[0].triangles[0]);
  asset.warnings = {"a texture is missing"};
  const auto scene = bake(asset, {.check_columns = 32});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->name, "room");
  EXPECT_EQ(scene->imported.format, "test mesh");
  EXPECT_EQ(scene->imported.meshes, 1U);
  EXPECT_EQ(scene->imported.instances, 1U);
  EXPECT_EQ(scene->imported.counts.read, asset.meshes[0].triangles.size());
  EXPECT_GE(scene->imported.counts.duplicate, 1U);
  EXPECT_EQ(scene->imported.triangles, scene->imported.counts.read -
                                           scene->imported.counts.degenerate -
                                           scene->imported.counts.duplicate);
  ASSERT_FALSE(scene->warnings.empty());
  EXPECT_EQ(scene->warnings[0], "a texture is missing");
  ASSERT_EQ(scene->grids.size(), 3U);
  double last_volume = std::numeric_limits<double>::infinity();
  for (const BakedGrid& grid : scene->grids) {
    const RegionTotals& rooms = grid.totals[static_cast<std::size_t>(Region::kRoom)];
    EXPECT_EQ(rooms.components, 1U);
    EXPECT_LT(rooms.volume, last_volume) << "a bigger sphere has less room";
    last_volume = rooms.volume;
    EXPECT_EQ(rooms.spans, grid.grid.spans + grid.grid.slivers);
    EXPECT_GT(grid.raw_spans, grid.grid.spans);
  }
}

/// What the casts say of every grid of a scene: nothing contradicts it.
void expectNoCastErrors(const BakedScene& scene, std::uint32_t columns) {
  for (const BakedGrid& grid : scene.grids) {
    SCOPED_TRACE(testing::Message() << "radius " << grid.grid.frame.radius);
    ASSERT_TRUE(grid.cast_check);
    EXPECT_EQ(grid.cast_check->columns, columns);
    EXPECT_GT(grid.cast_check->compared, 0.1 * columns);
    EXPECT_EQ(grid.cast_check->errors, 0);
    // The casting method's own error: some centimeters per column around thin spans.
    EXPECT_LT(grid.cast_check->method, 0.1 * grid.cast_check->compared);
  }
}

TEST(SceneBaker, IsNotContradictedByCastsInAFurnishedRoom) {
  for (const Coverage coverage : {Coverage::kColumn, Coverage::kCell}) {
    const auto scene = bake(room(), {.coverage = coverage, .check_columns = 64});
    ASSERT_TRUE(scene);
    expectNoCastErrors(*scene, 64);
  }
}

TEST(SceneBaker, IsNotContradictedByCastsInTheSampleApartment) {
  const std::filesystem::path path = test::sourceFolder() / "packs" / "sample" / "apartment.glb";
  const auto asset = importMesh(path);
  ASSERT_TRUE(asset) << asset.error().message;
  const auto scene = bake(*asset, {.check_columns = 64}, 2);
  ASSERT_TRUE(scene) << scene.error().message;
  expectNoCastErrors(*scene, 64);
}

TEST(SceneBaker, IsNotContradictedByCastsOnTheApartmentStage) {
  if (!test::hasAsset(test::kApartmentStage)) {
    GTEST_SKIP() << test::kApartmentStage << " is not on this machine";
  }
  const auto asset = importMesh(test::assetsFolder() / test::kApartmentStage);
  ASSERT_TRUE(asset) << asset.error().message;
  const auto scene = bake(*asset, {.check_columns = 64}, 2);
  ASSERT_TRUE(scene) << scene.error().message;
  expectNoCastErrors(*scene, 64);
}

TEST(SceneBaker, ChecksNothingWhenAskedTo) {
  const auto scene = bake(room(), {.radii = {0.05F}, .check_columns = 0});
  ASSERT_TRUE(scene);
  EXPECT_FALSE(scene->grids[0].cast_check);
}

/// A room of thin walls and 3 x 2.5 x 4 m, with a door of 0.8 m in its wall at x = 3, on a ground
/// that reaches 2 m beyond its walls, and one that is closed.
SourceAsset roomWithADoor() {
  test::MeshBuilder builder;
  builder.box({-2, -0.1F, -2}, {5, 0, 6}).box({0, 2.5F, 0}, {3, 2.6F, 4});
  builder.box({-0.1F, 0, 0}, {0, 2.5F, 4}).box({0, 0, -0.1F}, {3, 2.5F, 0});
  builder.box({0, 0, 4}, {3, 2.5F, 4.1F});
  builder.box({3, 0, 0}, {3.1F, 2.5F, 1}).box({3, 0, 1.8F}, {3.1F, 2.5F, 4});
  builder.box({3, 2, 1}, {3.1F, 2.5F, 1.8F});
  return test::sourceAssetOf(builder.build());
}

TEST(SceneBaker, NamesTheHoleThroughWhichARoomIsOpenOnceForAllRadii) {
  for (const std::vector<Vec3>& seeds : {std::vector<Vec3>{}, {{1, 1, 1}}}) {
    SceneBakeOptions options{.radii = {0.05F, 0.12F}, .check_columns = 0};
    options.free_space.seeds = seeds;
    const auto scene = bake(roomWithADoor(), options);
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->warnings.size(), 1U);
    EXPECT_THAT(
        scene->warnings[0],
        testing::MatchesRegex(
            "radius 0\\.05 m, 0\\.12 m: the room is one with the outside, and all of it is "
            "stored: the narrowest passage on the way out is at \\((2\\.[89]|3\\.[012])[0-9], "
            "[01]\\.[0-9]+, 1\\.[345][0-9]\\), some 0\\.[78][0-9] m wide; a scan with an "
            "open door or window works as it is, and for grids of the room alone close it "
            "in the mesh"));
  }
}

/// Two closed rooms, the second as big as the first but for `shorter` meters.
SourceAsset twoClosedRooms(float shorter) {
  test::MeshBuilder builder;
  builder.box({0, 0, 0}, {3, 2.5F, 3}).box({3.5F, 0, 0}, {6.5F - shorter, 2.5F, 3});
  return test::sourceAssetOf(builder.build());
}

TEST(SceneBaker, WarnsOfAClosedRoomThatItLeavesOut) {
  SceneBakeOptions options{.radii = {0.05F, 0.12F}, .check_columns = 0};
  options.free_space.seeds = {{1, 1, 1}};
  const auto scene = bake(twoClosedRooms(0.5F), options);
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->warnings.size(), 1U);
  EXPECT_THAT(scene->warnings[0],
              testing::MatchesRegex("radius 0\\.05 m: a closed part of 16\\.[0-9] m3 \\(room: "
                                    "20\\.[0-9] m3\\) from \\(3\\.5[0-9], 0\\.05, 0\\.0[0-9]\\) to "
                                    "\\(5\\.9[0-9], 2\\.45, 2\\.9[0-9]\\) is left out; keep it "
                                    "with `inside` or `keep-components`"));
}

TEST(SceneBaker, TellsRadiiThatFitOutsideTheRoomOnlyFromThoseThatFitNowhere) {
  test::MeshBuilder builder;
  builder.box({0, 0, 0}, {0.6F, 2.5F, 4});
  const SceneBakeOptions options{.radii = {0.05F, 0.4F}, .check_columns = 0};
  const auto scene = bake(test::sourceAssetOf(builder.build()), options);
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_THAT(scene->warnings,
              testing::ElementsAre("radius 0.4 m: no free space in the room; what is free outside "
                                   "of it is left out, keep it with `inside`"));
}

TEST(SceneBaker, WarnsOfAGardenThatItLeavesOut) {
  test::MeshBuilder builder;
  builder.box({0, 0.1F, 0}, {5, 2.5F, 4}).box({-8, -0.1F, -8}, {13, 0, 12});
  const SceneBakeOptions options{.radii = {0.05F, 0.12F}, .check_columns = 0};
  const auto scene = bake(test::sourceAssetOf(builder.build()), options);
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->warnings.size(), 1U);
  EXPECT_THAT(
      scene->warnings[0],
      testing::MatchesRegex("radius 0\\.05 m: the outside, with 3[0-9][0-9]\\.[0-9] m2 of "
                            "floor under the sky, is left out \\(room: 1[0-9]\\.[0-9] m2 of "
                            "floor\\); keep it with `inside` or `keep-components`"));
}

TEST(SceneBaker, DoesNotWarnOfWhatItKeepsOrWhatIsSmall) {
  SceneBakeOptions options{.radii = {0.05F}, .check_columns = 0};
  options.free_space.seeds = {{1, 1, 1}, {4, 1, 1}};
  EXPECT_TRUE(bake(twoClosedRooms(0.5F), options)->warnings.empty());
  options.free_space.seeds = {{1, 1, 1}};
  options.free_space.keep = Keep::kAll;
  EXPECT_TRUE(bake(twoClosedRooms(0.5F), options)->warnings.empty());
  options.free_space.keep = Keep::kRoom;
  EXPECT_TRUE(bake(twoClosedRooms(2.7F), options)->warnings.empty());
}

TEST(SceneBaker, CallsTheProgressInOrderAndMeasuresItsStages) {
  StageTimes times;
  std::vector<std::string> stages;
  double last = 0;
  const auto scene =
      bakeScene(room(), {.check_columns = 4}, times, [&](std::string_view stage, double fraction) {
        stages.emplace_back(stage);
        EXPECT_GE(fraction, last);
        EXPECT_LE(fraction, 1);
        last = fraction;
      });
  ASSERT_TRUE(scene);
  EXPECT_THAT(stages,
              testing::ElementsAre("clean", "grid r=0.015 m", "grid r=0.05 m", "grid r=0.12 m"));
  EXPECT_GT(times.clean, 0);
  EXPECT_GT(times.columns, 0);
  EXPECT_GT(times.regions, 0);
  EXPECT_GT(times.encode, 0);
  EXPECT_GT(times.check, 0);
  EXPECT_EQ(times.import, 0);
}

}  // namespace
}  // namespace galactic::bake::scene_baker_test
