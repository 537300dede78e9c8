// Real scenes, where they are at hand: triangle counts and bounds as other tools report them.
#include <gmock/gmock.h>

#include "bake/import/import_helpers.h"
#include "support/assets.h"

namespace galactic::test::real_assets_test {
namespace {

using bake::importMesh;
using bake::placeAndClean;
using bake::UpAxis;

/// The reported bounds have three significant digits.
constexpr double kReportedDigits = 0.0051;

struct RealScene {
  const char* path;
  std::uint64_t triangles;
  WorldPoint low;
  WorldPoint high;
  std::string_view convention;
  std::optional<UpAxis> up = {};
};

std::ostream& operator<<(std::ostream& out, const RealScene& scene) { return out << scene.path; }

constexpr std::string_view kObj = "Y up (OBJ convention), 1 m per unit (OBJ convention)";
constexpr std::string_view kGltf = "Y up (glTF convention), 1 m per unit (glTF convention)";

std::vector<RealScene> realScenes() {
  return {
      {"replica_cad/stages/Stage_v3_sc1_staging.obj",
       24224,
       {-2.66, -0.0788, -4.76},
       {4.6, 3.06, 8.17},
       kObj},
      {"scenes/scan_polycam_room/room.glb", 39492, {-1.38, -1.65, -2}, {1.29, 0.949, 1.74}, kGltf},
      {"scenes/cpr_office/office.dae",
       3790,
       {-15, 0, -13.3},
       {29, 2.51, 12.2},
       "Z up (file), 1 m per unit (file)"},
      {"scenes/aws_small_house/models/aws_robomaker_residential_HouseWallB_01/meshes/"
       "aws_HouseWallB_01_visual.DAE",
       241,
       {-9.5, 0, -5.7},
       {9.5, 3, 5.7},
       "Z up (file), 0.01 m per unit (file)"},
      {"scenes/aws_small_house/models/aws_robomaker_residential_NightStand_01/meshes/"
       "aws_NightStand_01_visual.DAE",
       616,
       {-0.363, 0, -0.235},
       {0.363, 0.682, 0.235},
       "Z up (file), 0.01 m per unit (file)"},
      {"scenes/habitat_van_gogh_room/van-gogh-room.mesh.ply",
       11272,
       {-0.776, -0.0233, -1.67},
       {5.99, 3.84, 1.87},
       "Z up (PLY convention), 1 m per unit (PLY convention)"},
      {"scenes/recast_demo/dungeon.obj", 10133, {-25, -0.00271, -90}, {49.3, 40.2, 8.89}, kObj},
      {"scenes/habitat_simple_room/simple_room.glb",
       84,
       {-5.25, -0.0614, -5.45},
       {5.28, 2.15, 5.4},
       "Z up (`up`), 1 m per unit (glTF convention)",
       UpAxis::kZ},
      {"scenes/habitat_simple_room/simple_room.glb",
       84,
       {-5.25, -5.4, -0.0614},
       {5.28, 5.45, 2.15},
       kGltf},
  };
}

class RealScenes : public testing::TestWithParam<RealScene> {};

TEST_P(RealScenes, HaveTheReportedTrianglesAndBounds) {
  const RealScene& scene = GetParam();
  const auto path = assetsFolder() / scene.path;
  if (assetsFolder().empty() || !std::filesystem::exists(path)) {
    GTEST_SKIP() << "real assets are not here: set GALACTIC_ASSETS to their folder";
  }
  const auto asset = importMesh(path, {.up = scene.up, .scale = {}, .transform = {}});
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  EXPECT_EQ(asset->convention, scene.convention);
  const auto clean = placeAndClean(*asset);
  ASSERT_TRUE(clean.has_value()) << clean.error().message;
  EXPECT_EQ(clean->counts.read, scene.triangles);
  EXPECT_EQ(clean->counts.read - clean->counts.degenerate - clean->counts.duplicate,
            clean->mesh.triangles.size());
  const auto& [low, high] = clean->mesh.bounds;
  const auto expect_near = [](float found, double reported) {
    EXPECT_NEAR(static_cast<double>(found), reported,
                kReportedDigits * std::max(1.0, std::abs(reported)));
  };
  expect_near(low.x, scene.low[0]);
  expect_near(low.y, scene.low[1]);
  expect_near(low.z, scene.low[2]);
  expect_near(high.x, scene.high[0]);
  expect_near(high.y, scene.high[1]);
  expect_near(high.z, scene.high[2]);
}

INSTANTIATE_TEST_SUITE_P(Assets, RealScenes, testing::ValuesIn(realScenes()));

}  // namespace
}  // namespace galactic::test::real_assets_test
