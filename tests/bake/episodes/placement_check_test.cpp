// Whether an object can be released somewhere, against what a run does.
#include "episodes/trial/placement_check.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "made_world.h"
#include "simulation/collision/resting_objects.h"
#include "simulation/phases/object_placement.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test::placement_check_test {
namespace {

TEST(PlacementCheck, AgreesWithTheRunsPlacement) {
  MeshBuilder room = madeRoom(3, 3);
  room.box({1, 0.7F, 1}, {1.8F, 0.74F, 1.6F});
  room.box({1.2F, 0.9F, 1}, {1.4F, 0.95F, 1.6F});
  const MadeWorld world(room.build(), stickRobot());
  const ObjectModel& cube = world.objects().objects().front();
  const std::vector<float> radii = madeRadii();
  simulation::PlacementScratch scratch(cube.spheres.size(), radii);
  const simulation::RestingObjects nothing(1, radii.back());
  PlacementOptions options;
  options.attempts = 1;
  std::mt19937 random(17);
  constexpr int kCases = 5000;
  int released = 0;
  for (int n = 0; n < kCases; ++n) {
    const auto number = [&](double low, double high) {
      return static_cast<float>(low + (high - low) * uniform(random));
    };
    const float yaw = number(0, 2 * std::numbers::pi);
    const Pose pose{{number(0.8, 2), number(0.6, 1.0), number(0.8, 1.8)},
                    {0, std::sin(yaw / 2), 0, std::cos(yaw / 2)}};
    RandomStream stream(1, 0, 0, static_cast<std::uint32_t>(n));
    const simulation::Landing landing =
        simulation::placeObject({world.scene(), nothing}, cube, pose, stream, options, scratch);
    const float moved = landing.pose.translation.y - pose.translation.y;
    // The run leaves a millimeter under the object; nearer to the limit the two may differ.
    constexpr float kUndecided = 0.002F;
    if (landing.placed && std::abs(std::abs(moved) - options.most_lift) < kUndecided) continue;
    const bool expected = landing.placed && std::abs(moved) < options.most_lift;
    EXPECT_EQ(bake::canBeReleased(world.scene(), cube, pose), expected)
        << pose.translation.x << ", " << pose.translation.y << ", " << pose.translation.z;
    if (expected) ++released;
  }
  EXPECT_GT(released, kCases / 10);
  EXPECT_LT(released, kCases * 9 / 10);
}

TEST(PlacementCheck, TakesTheEndOfTheGridForNoFloor) {
  // A table in an open yard whose ground has a gap: below the gap there is nothing.
  MeshBuilder yard;
  yard.floor({0, 0, 0}, {1, 0, 2}, 0).floor({1.6F, 0, 0}, {3, 0, 2}, 0);
  yard.box({2, 0.6F, 0.5F}, {2.6F, 0.7F, 1.5F});
  const MadeWorld world(yard.build(), stickRobot());
  const ObjectModel& cube = world.objects().objects().front();
  const std::vector<float> radii = madeRadii();
  simulation::PlacementScratch scratch(cube.spheres.size(), radii);
  const simulation::RestingObjects nothing(1, radii.back());
  PlacementOptions options;
  options.attempts = 1;
  const ColumnGrid& grid = world.scene().grids()[cube.spheres.front().radius_index];
  const auto agrees = [&](float x) {
    // The sphere is a little above the lowest height of the grid.
    const Vec3 center{x, grid.layout().heights.lo + 0.03F, 1};
    const Pose pose{center - cube.spheres.front().center, {}};
    RandomStream stream(1, 0, 0, 0);
    const bool placed =
        simulation::placeObject({world.scene(), nothing}, cube, pose, stream, options, scratch)
            .placed;
    EXPECT_EQ(bake::canBeReleased(world.scene(), cube, pose), placed) << x;
    return grid.clearance(center);
  };
  EXPECT_EQ(agrees(1.3F), Clearance::kFree) << "in the gap";
  agrees(0.5F);
  agrees(2.3F);
}

}  // namespace
}  // namespace galactic::test::placement_check_test
