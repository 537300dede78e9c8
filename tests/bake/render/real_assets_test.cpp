// Real furniture, scans and robots: what is drawn lies where the source lies, and opens no crack.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "bake/render/render_helpers.h"
#include "galactic/bake/mesh_import.h"
#include "render/render_source.h"
#include "support/asset_mesh.h"
#include "support/oracles/distance_oracle.h"

namespace galactic::test::real_assets_test {
namespace {

/// The bake measures corners and middles of triangles; points between them were seen to move twice
/// as far.
constexpr double kBetweenTolerance = 2.25;

/// Largest distance from points spread over `from` to `to`; `reach` at most.
double deviation(const bake::TriangleMesh& from, const bake::TriangleMesh& to, double reach) {
  const DistanceOracle oracle(to, reach);
  std::mt19937 random(23);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  double worst = 0;
  for (const bake::Triangle& triangle : from.triangles) {
    for (int n = 0; n < 3; ++n) {
      const double a = uniform();
      const double b = uniform() * (1 - a);
      bake::Point point{};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const double share = corner == 0 ? 1 - a - b : corner == 1 ? a : b;
        const Vec3& at = from.vertices[triangle[corner]];
        point[0] += share * static_cast<double>(at.x);
        point[1] += share * static_cast<double>(at.y);
        point[2] += share * static_cast<double>(at.z);
      }
      worst = std::max(worst, oracle.distance(point));
    }
  }
  return worst;
}

void expectNear(const std::string& relative, double error) {
  SCOPED_TRACE(relative);
  const auto asset = bake::importMesh(assetsFolder() / relative);
  ASSERT_TRUE(asset) << asset.error().message;
  const auto source =
      bake::sceneRenderSource(*asset, (assetsFolder() / relative).parent_path(), {.largest = 64});
  ASSERT_TRUE(source) << source.error().message;
  const auto meshes =
      bake::bakeRenderMeshes(*source, {.error = error, .lighting = bake::Lighting::kNone}, 2);
  ASSERT_TRUE(meshes) << meshes.error().message;
  const auto placed = bake::placeAndClean(*asset);
  ASSERT_TRUE(placed);
  const bake::TriangleMesh drawn = asMesh(drawnTriangles(meshes->view(), 0));
  const double rounding = static_cast<double>(meshes->models[0].step);
  const double allowed = kBetweenTolerance * error + rounding;
  EXPECT_LE(deviation(placed->mesh, drawn, 4 * error), allowed);
  EXPECT_LE(deviation(drawn, placed->mesh, 4 * error), allowed);
  EXPECT_LE(meshes->models[0].largest_error, error * 1.0001);
  EXPECT_LE(drawn.triangles.size(), placed->mesh.triangles.size());
}

TEST(RealRenderMeshes, OfFurnitureLieWhereTheSourceLies) {
  const std::vector<std::string> furniture{"replica_cad/objects/frl_apartment_chair_01.glb",
                                           "replica_cad/objects/frl_apartment_sofa.glb",
                                           "replica_cad/objects/frl_apartment_indoor_plant_01.glb",
                                           "replica_cad/urdf/fridge/body.glb"};
  if (!hasAsset(furniture.front())) GTEST_SKIP() << "ReplicaCAD is not on this machine";
  for (const std::string& file : furniture) expectNear(file, 0.005);
}

TEST(RealRenderMeshes, OfAStageLieWhereTheSourceLies) {
  if (!hasAsset(kApartmentStage)) GTEST_SKIP() << "the sc1 stage is not on this machine";
  expectNear(kApartmentStage, 0.005);
}

TEST(RealRenderMeshes, OfAScanLieWhereTheSourceLies) {
  if (!hasAsset(kScannedRoom)) GTEST_SKIP() << "the scanned room is not on this machine";
  expectNear(kScannedRoom, 0.005);
}

TEST(RealRenderMeshes, OfClosedFurnitureStayClosed) {
  const std::string chair = "replica_cad/objects/frl_apartment_chair_01.glb";
  if (!hasAsset(chair)) GTEST_SKIP() << "ReplicaCAD is not on this machine";
  const auto asset = bake::importMesh(assetsFolder() / chair);
  ASSERT_TRUE(asset);
  const auto source = bake::sceneRenderSource(*asset, {}, {.largest = 64});
  ASSERT_TRUE(source);
  const auto meshes =
      bake::bakeRenderMeshes(*source, {.error = 0.005, .lighting = bake::Lighting::kNone});
  ASSERT_TRUE(meshes);
  const auto triangles = drawnTriangles(meshes->view(), 0);
  EXPECT_EQ(openEdges(triangles), 0U);
  EXPECT_EQ(twoSidedCount(triangles), 0U);
}

}  // namespace
}  // namespace galactic::test::real_assets_test
