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

}  // namespace
}  // namespace galactic::test::placement_check_test
