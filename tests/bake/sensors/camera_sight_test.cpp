// Cameras that follow a robot through the sample apartment, against rays through its triangles.
#include "views/camera_sight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "engines/triangle_rays.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/build_paths.h"
#include "support/homes/sample_world.h"

namespace galactic::test::camera_sight_test {
namespace {

using bake::TriangleRays;

constexpr std::uint32_t kSeed = 12;

TriangleRays apartmentRays() {
  const auto asset =
      MemoryPack::opened(bake::importMesh(test::sourceFolder() / "packs/sample/apartment.glb"));
  auto clean = MemoryPack::opened(bake::placeAndClean(asset));
  return TriangleRays::build(std::move(clean.mesh.vertices), std::move(clean.mesh.triangles), 2)
      .value();
}

/// The camera `follow` of a robot at `base`.
RigidTransform behind(const Vec3& base, float yaw) {
  const float half = -19.0F * std::numbers::pi_v<float> / 180;
  const Pose base_pose{base, {.x = 0, .y = std::sin(yaw / 2), .z = 0, .w = std::cos(yaw / 2)}};
  return rigidTransform(base_pose) *
         rigidTransform(
             {{-1.3F, 1.9F, 0}, {.x = 0, .y = 0, .z = std::sin(half), .w = std::cos(half)}});
}

float distance(const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); }

bool isOpen(const TriangleRays& rays, const Vec3& from, const Vec3& to) {
  return rays.isOpen({.origin = from, .direction = to - from, .nearest = 0, .farthest = 1});
}

TEST(CameraSight, NothingOfTheApartmentStandsBetweenCameraAndRobot) {
  RecordProperty("seed", static_cast<int>(kSeed));
  const MemoryPack pack = bakeSampleApartment();
  const Scene scene = Scene::from(pack.pack()).value();
  const TriangleRays rays = apartmentRays();
  const ColumnGrid& wide = scene.grids().back();
  const ColumnGridLayout& layout = wide.layout();
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> share(0, 1);
  constexpr int kStates = 3000;
  int hidden = 0;
  int unchanged = 0;
  int near = 0;
  for (int n = 0; n < kStates;) {
    const Vec3 base{
        layout.min_x + share(random) * static_cast<float>(layout.columns_x) * layout.spacing, 0.05F,
        layout.min_z + share(random) * static_cast<float>(layout.columns_z) * layout.spacing};
    const float yaw = 2 * std::numbers::pi_v<float> * share(random);
    // Where a robot may stand: its body is free from the knee to the chest.
    bool stands = true;
    for (float height = 0.2F; height < 0.9F; height += 0.1F) {
      stands = stands && wide.clearance({base.x, height, base.z}) == Clearance::kFree;
    }
    if (!stands) continue;
    ++n;
    const RigidTransform wanted = behind(base, yaw);
    const SightLine line = inSight(scene, base, wanted);
    const Vec3& eye = line.world_from_camera.origin;
    hidden += isOpen(rays, line.target, wanted.origin) ? 0 : 1;
    EXPECT_TRUE(isOpen(rays, line.target, eye))
        << "base " << base.x << " " << base.z << ", yaw " << yaw;
    // It still looks at the robot, from above.
    const Vec3 way = line.target - eye;
    const float length = std::sqrt(dot(way, way));
    EXPECT_GE(dot(way, line.world_from_camera.x_axis), 0.999F * length);
    EXPECT_LT(std::hypot(line.target.x - base.x, line.target.z - base.z), 1e-3F);
    near += length < 0.8F ? 1 : 0;
    unchanged += distance(eye, wanted.origin) < 1e-4F ? 1 : 0;
  }
  std::printf("of %d states %d would be hidden, %d cameras stay, %d come nearer than 0.8 m\n",
              kStates, hidden, unchanged, near);
  EXPECT_GT(hidden, kStates / 10);
  EXPECT_LT(hidden, 9 * kStates / 10);
  EXPECT_GT(unchanged, kStates / 10);
  // There is always a way round, over or under.
  EXPECT_EQ(near, 0);
}

TEST(CameraSight, StaysAsItIsWhereTheGridKnowsNothing) {
  const MemoryPack pack = bakeSampleApartment();
  const Scene scene = Scene::from(pack.pack()).value();
  const RigidTransform wanted = behind({500, 0, 500}, 1);
  const SightLine line = inSight(scene, {500, 0, 500}, wanted);
  EXPECT_EQ(line.world_from_camera.origin, wanted.origin);
  const Vec3 nowhere{std::nanf(""), 0, 0};
  static_cast<void>(inSight(scene, nowhere, behind(nowhere, 0)));
}

}  // namespace
}  // namespace galactic::test::camera_sight_test
