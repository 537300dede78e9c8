// Settling against what mechanics says of boxes.
#include "episodes/trial/settling.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "made_world.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test::settling_test {
namespace {

using bake::SettlingBody;
using bake::SettlingEnd;
using bake::SettlingScene;

constexpr float kTable = 0.74F;

/// A table from (0, 0) to (1, 1), and the floor 2 m around it.
bake::TriangleMesh tableAndFloor() {
  MeshBuilder mesh;
  mesh.box({0, 0.7F, 0}, {1, kTable, 1}).floor({-2, 0, -2}, {3, 0, 3}, 0);
  return mesh.build();
}

/// A box whose origin is in the middle of its bottom.
ObjectModel boxModel(const Vec3& half) {
  ObjectModel model;
  model.box = {{{0, half.y, 0}, {}}, half};
  return model;
}

std::vector<Vec3> cornersOf(const ObjectModel& model) {
  std::vector<Vec3> corners;
  const Vec3& half = model.box.half_extents;
  for (const float x : {-half.x, half.x}) {
    for (const float y : {0.0F, 2 * half.y}) {
      for (const float z : {-half.z, half.z}) corners.push_back({x, y, z});
    }
  }
  return corners;
}

Quat yawOf(double yaw) {
  return {0, static_cast<float>(std::sin(yaw / 2)), 0, static_cast<float>(std::cos(yaw / 2))};
}

double distanceBetween(const Vec3& a, const Vec3& b) {
  const Vec3 way = a - b;
  return std::sqrt(static_cast<double>(dot(way, way)));
}

TEST(Settling, KeepsABoxOnATable) {
  const SettlingScene scene(tableAndFloor());
  const ObjectModel model = boxModel({0.04F, 0.1F, 0.03F});
  const Pose put{{0.5F, kTable, 0.5F}, yawOf(0.3)};
  for (const SettlingBody& body : {bake::boxBody(model), bake::hullBody(cornersOf(model), model)}) {
    const auto settled = scene.settle(body, put);
    EXPECT_EQ(settled.end, SettlingEnd::kRests);
    // Less than a millimeter: Bullet lets contacts overlap a little.
    EXPECT_LT(distanceBetween(settled.pose.translation, put.translation), 0.001);
    EXPECT_NEAR(settled.pose.rotation.y, put.rotation.y, 0.002F);
  }
}

TEST(Settling, DoesTheSameEveryTime) {
  const SettlingScene scene(tableAndFloor());
  const SettlingScene again(tableAndFloor());
  const ObjectModel model = boxModel({0.04F, 0.1F, 0.03F});
  const SettlingBody body = bake::hullBody(cornersOf(model), model);
  const Pose over_edge{{0.99F, kTable, 0.5F}, yawOf(0.3)};
  const Pose put{{0.5F, kTable, 0.5F}, yawOf(0.3)};
  const auto first = scene.settle(body, put);
  (void)scene.settle(body, over_edge);
  EXPECT_EQ(scene.settle(body, put).pose, first.pose);
  EXPECT_EQ(again.settle(body, put).pose, first.pose);
}

TEST(Settling, LetsABoxGoWhoseMiddleIsOverTheEdge) {
  const SettlingScene scene(tableAndFloor());
  std::mt19937 random(11);
  int rests = 0;
  int cases = 0;
  constexpr int kCases = 400;
  for (int n = 0; n < kCases; ++n) {
    const double half = 0.03 + 0.04 * uniform(random);
    const ObjectModel model = boxModel({static_cast<float>(half), 0.05F, static_cast<float>(half)});
    // How far the middle is inside of the edge at x = 1.
    const double inside = 0.06 * uniform(random) - 0.03;
    // Bullet takes contacts for one that are this near, meters: a box is held a little longer.
    constexpr double kUndecided = 0.004;
    if (std::abs(inside) < kUndecided) continue;
    const Pose put{{static_cast<float>(1 - inside), kTable, 0.5F}, {}};
    const auto settled = scene.settle(bake::boxBody(model), put);
    EXPECT_EQ(settled.end == SettlingEnd::kRests, inside > 0) << inside << " of " << half;
    ++cases;
    if (settled.end == SettlingEnd::kRests) ++rests;
  }
  EXPECT_GT(rests, cases / 10);
  EXPECT_LT(rests, cases * 9 / 10);
}

TEST(Settling, LetsTallBoxesTipThatStandOnASlope) {
  // A slope of 20 degrees: friction of 0.8 holds up to 38.
  constexpr double kSlope = 20 * std::numbers::pi / 180;
  const auto rise = static_cast<float>(std::tan(kSlope));
  MeshBuilder mesh;
  mesh.quad({Vec3{-1, -rise, -1}, {-1, -rise, 1}, {1, rise, 1}, {1, rise, -1}});
  const SettlingScene scene(mesh.build());
  const Quat tilt{0, 0, static_cast<float>(std::sin(kSlope / 2)),
                  static_cast<float>(std::cos(kSlope / 2))};
  // Tips when the middle is beyond the lower edge: height over width above 1 / tan(20 degrees).
  const auto end = [&](float height) {
    return scene.settle(bake::boxBody(boxModel({0.03F, height, 0.03F})), {{}, tilt}).end;
  };
  EXPECT_EQ(end(0.06F), SettlingEnd::kRests);
  EXPECT_NE(end(0.11F), SettlingEnd::kRests);
}

TEST(Settling, LetsABoxFallThatHangsInTheAir) {
  const SettlingScene scene(tableAndFloor());
  const auto settled =
      scene.settle(bake::boxBody(boxModel({0.03F, 0.03F, 0.03F})), {{0.5F, 0.8F, 0.5F}, {}});
  EXPECT_EQ(settled.end, SettlingEnd::kMoved);
}

TEST(Settling, TakesTheCenterOfMassOfTheHull) {
  // A wedge: a right triangle's center is at a third of its legs.
  const std::vector<Vec3> wedge{{0, 0, 0}, {0.3F, 0, 0}, {0, 0.3F, 0},
                                {0, 0, 1}, {0.3F, 0, 1}, {0, 0.3F, 1}};
  const ObjectModel model = boxModel({0.15F, 0.15F, 0.5F});
  const SettlingBody body = bake::hullBody(wedge, model);
  EXPECT_EQ(body.corners.size(), 6U);
  EXPECT_NEAR(body.object_from_body.translation.x, 0.1F, 1e-4F);
  EXPECT_NEAR(body.object_from_body.translation.y, 0.1F, 1e-4F);
  EXPECT_NEAR(body.object_from_body.translation.z, 0.5F, 1e-4F);
  // What is flat is settled as its box.
  EXPECT_TRUE(bake::hullBody(std::span(wedge).first(3), model).corners.empty());
}

}  // namespace
}  // namespace galactic::test::settling_test
