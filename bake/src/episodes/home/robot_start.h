#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/random.h"
#include "episodes/home/floor_map.h"
#include "episodes/home/placed_object.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/robot.h"
#include "galactic/scene.h"

namespace galactic::bake {

/// Where the robot starts an episode, in its start pose.
struct RobotStart {
  /// On the floor, meters.
  Vec3 base_position;
  /// Radians.
  float base_yaw = 0;
};

/// The home in which starts are drawn. The references must outlive this.
struct StartHome {
  const Scene& scene;
  const Robot& robot;
  const FloorMap& floor;
};

/// The requirements for a start.
struct StartWish {
  /// FloorPlace::part where it must be.
  std::uint32_t part = 0;
  /// The target's origin, and the permitted distance from it to the base on the ground.
  Vec3 target;
  DistanceRange start_to_target{};
  /// Objects that the robot must not touch.
  std::span<const PlacedObject> objects;
};

/// Draws a place on the floor where the robot in its start pose touches nothing. None if all tries
/// fail. Counts draws that were rejected in `rejections`. The result depends only on the arguments.
[[nodiscard]] std::optional<RobotStart> drawStart(const StartHome& home, const StartWish& wish,
                                                  Random& random, RejectionCounts& rejections);

/// Why there is no start at all, in one sentence; for a floor map without places.
[[nodiscard]] std::string whyNowhere(const FloorMap& floor, const Robot& robot);

}  // namespace galactic::bake
