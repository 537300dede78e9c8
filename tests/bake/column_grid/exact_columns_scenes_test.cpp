// The exact engine against brute force on real scenes, where they are present.
#include <gtest/gtest.h>

#include <string>

#include "galactic/bake/column_engines.h"
#include "oracle_comparison.h"
#include "support/asset_mesh.h"

namespace galactic::bake::exact_columns_scenes_test {
namespace {

/// An asset and how its columns are sampled.
struct SceneCase {
  const char* name;
  const char* asset;
  /// Every so many columns are compared: a prime, so that the sample drifts over the rows.
  std::size_t step;
};

class ExactColumnsOfARealScene : public testing::TestWithParam<SceneCase> {};

TEST_P(ExactColumnsOfARealScene, AgreeWithBruteForce) {
  const SceneCase& scene = GetParam();
  if (!test::hasAsset(scene.asset)) GTEST_SKIP() << scene.asset << " is not on this machine";
  const auto mesh = test::loadAsset(scene.asset);
  ASSERT_TRUE(mesh) << mesh.error().message;
  const test::ColumnOracle oracle(*mesh, 0.13);
  for (const float radius : {0.015F, 0.05F, 0.12F}) {
    const GridFrame frame = makeGridFrame(mesh->bounds, radius, 0.03F).value();
    const Columns columns = exactColumns(*mesh, frame, Coverage::kColumn, 2).columns;
    const test::Comparison found = compareWithOracle(oracle, columns, scene.step);
    EXPECT_EQ(found.offence, "") << "radius " << radius;
    // Walls on round coordinates can stand at exactly the radius from whole rows of columns.
    EXPECT_LT(found.ties, found.columns / 50) << "radius " << radius;
    EXPECT_LT(found.steep_ends, found.spans / 200 + 1);
    EXPECT_GT(found.touching, found.columns / 10);
    const std::string tag = "_r" + std::to_string(static_cast<int>(radius * 1000));
    RecordProperty("columns" + tag, found.columns);
    RecordProperty("spans" + tag, found.spans);
    RecordProperty("ties" + tag, found.ties);
    RecordProperty("steep_ends" + tag, found.steep_ends);
    RecordProperty("greatest_error_nm" + tag, static_cast<int>(found.greatest_error * 1e9));
  }
}

INSTANTIATE_TEST_SUITE_P(Assets, ExactColumnsOfARealScene,
                         testing::Values(SceneCase{"ApartmentStage", test::kApartmentStage, 31},
                                         SceneCase{"ScannedRoom", test::kScannedRoom, 7},
                                         SceneCase{"Office", test::kOffice, 101}),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace galactic::bake::exact_columns_scenes_test
