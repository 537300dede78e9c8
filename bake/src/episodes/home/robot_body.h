#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "galactic/robot.h"
#include "galactic/scene.h"

namespace galactic::bake {

/// A sphere of the robot in the world.
struct BodySphere {
  Vec3 center;
  float radius = 0;
  std::uint32_t radius_index = 0;
};

/// The spheres and the grasp point of the robot in one configuration.
struct RobotBody {
  /// By descending radius, since large spheres are the likeliest to be blocked.
  std::vector<BodySphere> spheres;
  /// Of the end effector.
  Vec3 grasp_point;
};

/// The frame on the ground under the root's origin: `position` in the world, turned by `yaw`.
[[nodiscard]] inline Pose groundPose(const Vec3& position, float yaw) {
  return {position, rotationOfYaw(yaw)};
}

/// Spheres and grasp point with the base at `world_from_ground` and the joints at `positions`
/// (radians or meters, one per position of the robot). The robot must have a base and an end
/// effector.
[[nodiscard]] RobotBody robotBody(const Robot& robot, const Pose& world_from_ground,
                                  std::span<const float> positions);

/// Whether every sphere, moved by `offset` (meters), is free in the column grid of its radius; the
/// scene must have the robot's radii. Spheres outside the grid are not free.
[[nodiscard]] bool isFree(const Scene& scene, std::span<const BodySphere> spheres,
                          const Vec3& offset = {});

}  // namespace galactic::bake
