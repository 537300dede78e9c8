// The scenes of ReplicaCAD that have their stage, from the real dataset.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/dataset/small_dataset.h"
#include "dataset/scene_dataset.h"
#include "galactic/bake/scene_baker.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/assets.h"

namespace galactic::test::replica_cad_test {
namespace {

using bake::MeshLibrary;
using bake::SceneDataset;
using Point = std::array<double, 3>;

constexpr std::string_view kScenesWithStage = "v3_sc1_staging_";
/// Placed twice in double precision; quaternions in the files are of length 1 to six digits.
constexpr double kTolerance = 1e-6;

class ReplicaCad : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = assetsFolder() / "replica_cad";
    const auto config = folder_ / "replicaCAD.scene_dataset_config.json";
    if (!std::filesystem::exists(config)) {
      GTEST_SKIP() << "set GALACTIC_ASSETS to a folder with replica_cad/ in it";
    }
    auto read = SceneDataset::read(config);
    ASSERT_TRUE(read) << read.error().text();
    dataset_.emplace(std::move(*read));
  }

  [[nodiscard]] nlohmann::json json(const std::string& name) const {
    std::ifstream stream(folder_ / name);
    return nlohmann::json::parse(stream);
  }

  std::filesystem::path folder_;
  std::optional<SceneDataset> dataset_;
  MeshLibrary meshes_{bake::datasetMeshOptions()};
};

TEST_F(ReplicaCad, ComposesAllScenesAndKnowsWhichHaveTheirStage) {
  std::size_t with_stage = 0;
  std::size_t movable = 0;
  for (const std::string& name : dataset_->scenes()) {
    SCOPED_TRACE(name);
    const auto scene = dataset_->compose(name, meshes_);
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->has_stage, name.starts_with(kScenesWithStage));
    with_stage += scene->has_stage ? 1U : 0U;
    const auto survey = dataset_->survey(name);
    ASSERT_TRUE(survey) << survey.error().text();
    movable += survey->movable.size();
    const auto mesh = placeAndClean(scene->scene);
    if (!mesh && scene->scene.instances.empty()) continue;
    ASSERT_TRUE(mesh) << mesh.error().message;
    if (!scene->has_stage) continue;
    EXPECT_GT(mesh->mesh.triangles.size(), 30000U);
    // No furniture leaves the apartment, which is 7.3 x 3.1 x 12.9 m.
    constexpr float kWall = 0.2F;
    EXPECT_GT(mesh->mesh.bounds.min.x, -2.66F - kWall);
    EXPECT_GT(mesh->mesh.bounds.min.y, -0.08F - kWall);
    EXPECT_GT(mesh->mesh.bounds.min.z, -4.76F - kWall);
    EXPECT_LT(mesh->mesh.bounds.max.x, 4.60F + kWall);
    EXPECT_LT(mesh->mesh.bounds.max.y, 3.06F + kWall);
    EXPECT_LT(mesh->mesh.bounds.max.z, 8.17F + kWall);
  }
  EXPECT_GT(with_stage, 0U);
  EXPECT_GT(movable, 0U) << "the apt scenes have small objects";
}

/// `p` turned by the quaternion (w, x, y, z) without a matrix.
Point turned(const std::vector<double>& q, const Point& p) {
  const auto cross = [](const Point& a, const Point& b) {
    return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const Point u{q[1] / length, q[2] / length, q[3] / length};
  const Point once = cross(u, p);
  const Point twice = cross(u, once);
  Point to = p;
  for (std::size_t i = 0; i < 3; ++i) to[i] += 2 * q[0] / length * once[i] + 2 * twice[i];
  return to;
}

TEST_F(ReplicaCad, PlacesObjectsWhereTheirFilesSay) {
  const std::string name = "v3_sc1_staging_00";
  const auto scene = dataset_->compose(name, meshes_);
  ASSERT_TRUE(scene) << scene.error().message;
  std::size_t compared = 0;
  std::map<std::string, unsigned> count;
  const auto instance_file = json("configs/scenes/" + name + ".scene_instance.json");
  for (const auto& object : instance_file.at("object_instances")) {
    const std::string of = object.at("template_name");
    const auto file = folder_ / "objects" / (of + ".glb");
    if (!std::filesystem::exists(file)) continue;
    // All of them have their center of mass at the origin of their mesh.
    const auto asset = bake::importMesh(file, bake::datasetMeshOptions());
    ASSERT_TRUE(asset);
    std::vector<Point> wanted;
    const std::vector<double> rotation = object.at("rotation");
    const std::vector<double> translation = object.at("translation");
    for (const auto& instance : asset->instances) {
      for (Point p : placedVertices(*asset, instance)) {
        p = turned(rotation, p);
        for (std::size_t i = 0; i < 3; ++i) p[i] += translation[i];
        wanted.push_back(p);
      }
    }
    const std::string placed_name = fmt::format("{}_:{:04d}", of, count[of]++);
    std::vector<Point> found;
    for (const auto& instance : scene->scene.instances) {
      if (instance.name != placed_name) continue;
      const auto points = placedVertices(scene->scene, instance);
      found.insert(found.end(), points.begin(), points.end());
    }
    ASSERT_EQ(found.size(), wanted.size()) << placed_name;
    double farthest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        farthest = std::max(farthest, std::abs(found[i][axis] - wanted[i][axis]));
      }
    }
    EXPECT_LT(farthest, kTolerance) << placed_name;
    ++compared;
  }
  EXPECT_EQ(compared, 18U);
}

TEST_F(ReplicaCad, StandsFurnitureOnTheFloor) {
  const auto scene = dataset_->compose("v3_sc1_staging_00", meshes_);
  ASSERT_TRUE(scene) << scene.error().message;
  const auto heights = [&](std::string_view name) {
    std::pair<double, double> range{1e9, -1e9};
    for (const auto& instance : scene->scene.instances) {
      if (instance.name != name) continue;
      for (const Point& p : placedVertices(scene->scene, instance)) {
        range = {std::min(range.first, p[1]), std::max(range.second, p[1])};
      }
    }
    return range;
  };
  // Meters above the floor: the sizes of the meshes, turned and placed by hand.
  constexpr double kHand = 0.02;
  EXPECT_NEAR(heights("fridge_:0000").first, 0.05, kHand);
  EXPECT_NEAR(heights("fridge_:0000").second, 1.98, kHand);
  EXPECT_NEAR(heights("kitchen_counter_:0000").first, 0.015, kHand);
  EXPECT_NEAR(heights("kitchen_counter_:0000").second, 0.97, kHand);
  EXPECT_NEAR(heights("cabinet_:0000").first, 0.03, kHand);
  EXPECT_NEAR(heights("cabinet_:0000").second, 0.81, kHand);
  EXPECT_NEAR(heights("door2_:0000").first, -0.04, kHand);
  EXPECT_NEAR(heights("door2_:0000").second, 2.39, kHand);
}

/// Heights at which the vertical line through (x, z) meets triangles.
std::vector<float> heightsAt(const bake::TriangleMesh& mesh, float x, float z) {
  std::vector<float> heights;
  for (const auto& triangle : mesh.triangles) {
    const Vec3& a = mesh.vertices[triangle[0]];
    const Vec3 ab = mesh.vertices[triangle[1]] - a;
    const Vec3 ac = mesh.vertices[triangle[2]] - a;
    const float area = ab.x * ac.z - ab.z * ac.x;
    if (area == 0) continue;
    const float u = ((x - a.x) * ac.z - (z - a.z) * ac.x) / area;
    const float v = (ab.x * (z - a.z) - ab.z * (x - a.x)) / area;
    if (u >= 0 && v >= 0 && u + v <= 1) heights.push_back(a.y + u * ab.y + v * ac.y);
  }
  return heights;
}

TEST_F(ReplicaCad, HasSurfacesUnderItsReceptacles) {
  const auto scene = dataset_->compose("v3_sc1_staging_00", meshes_);
  ASSERT_TRUE(scene) << scene.error().message;
  const auto mesh = placeAndClean(scene->scene);
  ASSERT_TRUE(mesh) << mesh.error().message;
  std::size_t on_surface = 0;
  for (const bake::SupportRegion& region : scene->receptacles) {
    // All stand upright: the lowest corner is as low as the bottom.
    const Vec3& half = region.half_extents;
    float bottom = region.world_from_region.translation.y;
    for (const Vec3& axis : {Vec3{half.x, 0, 0}, Vec3{0, half.y, 0}, Vec3{0, 0, half.z}}) {
      bottom -= std::abs(rotate(region.world_from_region.rotation, axis).y);
    }
    const auto is_bottom = [bottom](float height) {
      constexpr float kUnder = 0.05F;
      constexpr float kOver = 0.03F;
      return height > bottom - kUnder && height < bottom + kOver;
    };
    bool found = false;
    // Some boxes have an edge between two boards right under their middle.
    for (const Vec3& aside : {Vec3{}, half * 0.3F, half * -0.3F}) {
      const Vec3 point = region.world_from_region * aside;
      found = found || std::ranges::any_of(heightsAt(mesh->mesh, point.x, point.z), is_bottom);
    }
    if (found) ++on_surface;
  }
  EXPECT_GT(scene->receptacles.size(), 40U);
  // They were drawn by hand: one in the fridge is further off its board.
  EXPECT_GE(20 * on_surface, 19 * scene->receptacles.size());
}

TEST_F(ReplicaCad, AComposedSceneHasRoomsToMoveIn) {
  const auto scene = dataset_->compose("v3_sc1_staging_00", meshes_);
  ASSERT_TRUE(scene) << scene.error().message;
  bake::StageTimes times;
  bake::SceneBakeOptions options;
  options.radii = {0.12F};
  options.spacing = 0.06F;
  const auto with = bakeScene(scene->scene, options, times, [](std::string_view, double) {});
  ASSERT_TRUE(with) << with.error().message;
  bake::SourceAsset stage = scene->scene;
  std::erase_if(stage.instances,
                [](const auto& one) { return one.name.find("_:") != std::string::npos; });
  const auto without = bakeScene(stage, options, times, [](std::string_view, double) {});
  ASSERT_TRUE(without) << without.error().message;
  const auto volume = [](const bake::BakedScene& baked) {
    return baked.grids.at(0).components.at(0).volume;
  };
  // The apartment holds some 180 m3 of air, furniture takes a part of it, not most.
  EXPECT_LT(volume(*with), 0.99 * volume(*without));
  EXPECT_GT(volume(*with), 0.6 * volume(*without));
}

}  // namespace
}  // namespace galactic::test::replica_cad_test
