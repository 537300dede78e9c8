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

/// What starts are drawn in. The references outlive it.
struct StartHome {
  const Scene& scene;
  const Robot& robot;
  const FloorMap& floor;
};

/// What a start is drawn for.
struct StartWish {
  /// FloorPlace::part in which it has to be.
  std::uint32_t part = 0;
  /// The target's origin, and how far from it the base may be on the ground.
  Vec3 target;
  DistanceRange start_to_target{};
  /// What the robot must not touch.
  std::span<const PlacedObject> objects;
};

/// Draws a place on the floor where neither the robot nor its start pose touches anything. None
/// where the tries were in vain. Adds up in `rejections` what was drawn and not taken. The result
/// depends on the arguments only.
[[nodiscard]] std::optional<RobotStart> drawStart(const StartHome& home, const StartWish& wish,
                                                  Random& random, RejectionCounts& rejections);

/// Why there is no start at all, in one sentence: for a floor map without places.
[[nodiscard]] std::string whyNowhere(const FloorMap& floor, const Robot& robot);

}  // namespace galactic::bake
