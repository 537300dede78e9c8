#include "episodes/home/robot_body.h"

#include <algorithm>

namespace galactic::bake {
namespace {

/// Whether a sphere of one group overlaps one of the other.
bool overlap(std::span<const BodySphere> spheres, std::uint32_t first, std::uint32_t second) {
  for (const BodySphere& a : spheres) {
    if (a.group != first) continue;
    for (const BodySphere& b : spheres) {
      const Vec3 between = a.center - b.center;
      const float reach = a.radius + b.radius;
      if (b.group == second && dot(between, between) < reach * reach) return true;
    }
  }
  return false;
}

}  // namespace

RobotBody robotBody(const Robot& robot, const Pose& world_from_ground,
                    std::span<const float> positions) {
  const Pose ground_from_root{{0, robot.base()->root_height, 0}, {}};
  std::vector<Pose> world_from_link(robot.links().size());
  forwardKinematics(robot.links(), world_from_ground * ground_from_root, positions,
                    world_from_link);
  RobotBody body;
  body.spheres.reserve(robot.spheres().size());
  for (std::uint32_t group = 0; group < robot.groups().size(); ++group) {
    const SphereGroup& spheres = robot.groups()[group];
    for (const SetSphere& sphere : spheres.spheres) {
      body.spheres.push_back({.center = world_from_link[spheres.link] * sphere.center,
                              .radius = robot.radii()[sphere.radius_index],
                              .radius_index = sphere.radius_index,
                              .group = group});
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

bool anyOverlaps(std::span<const GroupPair> pairs, std::span<const BodySphere> spheres) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const GroupPair& pair) {
    return overlap(spheres, pair.first, pair.second);
  });
}

std::vector<GroupPair> pairsApartAtStart(const Robot& robot) {
  const RobotBody body = robotBody(robot, {}, robot.startPositions());
  std::vector<GroupPair> pairs = robot.testedPairs();
  std::erase_if(
      pairs, [&](const GroupPair& pair) { return overlap(body.spheres, pair.first, pair.second); });
  return pairs;
}

}  // namespace galactic::bake
