#include "episodes/home/robot_body.h"

#include <algorithm>

namespace galactic::bake {
RobotBody robotBody(const Robot& robot, const Pose& world_from_ground,
                    std::span<const float> positions) {
  const Pose ground_from_root{{0, robot.base()->root_height, 0}, {}};
  std::vector<Pose> world_from_link(robot.links().size());
  forwardKinematics(robot.links(), world_from_ground * ground_from_root, positions,
                    world_from_link);
  RobotBody body;
  body.spheres.reserve(robot.spheres().size());
  for (const SphereGroup& group : robot.groups()) {
    for (const SetSphere& sphere : group.spheres) {
      body.spheres.push_back({.center = world_from_link[group.link] * sphere.center,
                              .radius = robot.radii()[sphere.radius_index],
                              .radius_index = sphere.radius_index});
    }
  }
  std::stable_sort(body.spheres.begin(), body.spheres.end(),
                   [](const BodySphere& a, const BodySphere& b) { return a.radius > b.radius; });
  const EndEffector& hand = *robot.endEffector();
  body.grasp_point = world_from_link[hand.link] * hand.grasp_point;
  return body;
}

bool isFree(const Scene& scene, std::span<const BodySphere> spheres, const Vec3& offset) {
  return std::all_of(spheres.begin(), spheres.end(), [&](const BodySphere& sphere) {
    const ColumnGrid& grid = scene.grids()[sphere.radius_index];
    return grid.clearance(sphere.center + offset) == Clearance::kFree;
  });
}

}  // namespace galactic::bake
