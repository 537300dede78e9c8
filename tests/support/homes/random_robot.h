#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "support/oracles/resting_oracle.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::test {

/// Draws robots as real ones are: chains of revolute, continuous and prismatic joints about any
/// axis, fixed links between them, fingers that mimic other joints, spheres on most links.
class RandomRobotMaker {
 public:
  explicit RandomRobotMaker(std::mt19937& random) : random_(random) {}

  /// A robot with at least two controlled joints; some of its joints nothing moves.
  RobotPackFields robot() {
    RobotPackFields robot;
    robot.name = "random";
    robot.radii = {0.015F, 0.05F, 0.12F};
    robot.surfaces.clear();
    const std::size_t links = 5 + random_() % 16;
    for (std::size_t n = 0; n < links; ++n) addLink(robot, n);
    while (robot.limits.size() < 3) addLink(robot, robot.links.size());
    addGroups(robot);
    addControlledJoints(robot);
    robot.end_effector->link = static_cast<std::uint32_t>(robot.links.size() - 1);
    robot.end_effector->grasp_point = Vec3{0.1F, -0.02F, 0.03F};
    robot.camera.reset();
    robot.base->root_height = uniformIn(random_, -0.2F, 0.5F);
    robot.base->forward_step = uniformIn(random_, 0.05F, 0.2F);
    robot.base->turn_step = uniformIn(random_, 0.05F, 0.3F);
    if (random_() % 2 == 0) robot.base->sideways_step = uniformIn(random_, 0.05F, 0.2F);
    return robot;
  }

  /// Any direction; every other one along an axis of the frame, as robots have them.
  Vec3 direction() {
    constexpr std::array<Vec3, 6> kAxes{Vec3{1, 0, 0},  Vec3{-1, 0, 0}, Vec3{0, 1, 0},
                                        Vec3{0, -1, 0}, Vec3{0, 0, 1},  Vec3{0, 0, -1}};
    if (random_() % 2 == 0) return kAxes[random_() % kAxes.size()];
    return rotate(randomQuat(random_), {0, 1, 0});
  }

 private:
  void addLink(RobotPackFields& robot, std::size_t n) {
    robot.link_names.push_back("link" + std::to_string(n));
    robot.joint_names.push_back(n == 0 ? "" : "joint" + std::to_string(n));
    LinkFrame link;
    link.parent_from_joint = {{coordinate(), coordinate(), coordinate()}, randomQuat(random_)};
    link.axis = direction();
    if (n > 0) {
      // Near the end: chains grow long.
      link.parent = static_cast<std::int32_t>(n - 1 - random_() % std::min<std::size_t>(n, 2));
      constexpr std::array kTypes{JointType::kFixed, JointType::kRevolute, JointType::kContinuous,
                                  JointType::kPrismatic};
      link.type = kTypes[random_() % kTypes.size()];
    }
    if (link.type != JointType::kFixed) addPosition(robot, link);
    robot.links.push_back(link);
  }

  void addPosition(RobotPackFields& robot, LinkFrame& link) {
    const bool slides = link.type == JointType::kPrismatic;
    if (!robot.limits.empty() && random_() % 4 == 0) {
      link.position = static_cast<std::int32_t>(random_() % robot.limits.size());
      link.multiplier = slides ? uniformIn(random_, -0.1F, 0.1F) : uniformIn(random_, -2, 2);
      link.offset = slides ? uniformIn(random_, -0.1F, 0.1F) : uniformIn(random_, -1, 1);
      return;
    }
    link.position = static_cast<std::int32_t>(robot.limits.size());
    constexpr float kUnlimited = std::numeric_limits<float>::max();
    const float reach = slides ? 0.4F : 2.5F;
    PositionLimits limits{-kUnlimited, kUnlimited};
    if (link.type != JointType::kContinuous) {
      limits.lower = uniformIn(random_, -reach, 0);
      limits.upper = uniformIn(random_, 0, reach);
    }
    robot.limits.push_back(limits);
    robot.start_positions.push_back(link.type == JointType::kContinuous
                                        ? uniformIn(random_, -3, 3)
                                        : uniformIn(random_, limits.lower, limits.upper));
  }

  /// A group for each link, with up to twelve spheres; the last has at least one.
  void addGroups(RobotPackFields& robot) {
    for (std::uint32_t n = 0; n < robot.links.size(); ++n) {
      const bool is_last = n + 1 == robot.links.size();
      const auto count = static_cast<std::uint32_t>(is_last ? 3 : random_() % 13);
      robot.groups.push_back(
          {n, {n}, static_cast<std::uint32_t>(robot.spheres.size()), count, std::nullopt});
      for (std::uint32_t sphere = 0; sphere < count; ++sphere) {
        robot.spheres.push_back({{coordinate(), coordinate(), coordinate()},
                                 static_cast<std::uint32_t>(random_() % robot.radii.size())});
      }
      sortSpheres(std::span(robot.spheres).last(count));
    }
  }

  /// All positions but the second.
  void addControlledJoints(RobotPackFields& robot) {
    for (std::uint32_t n = 0; n < robot.limits.size(); ++n) {
      if (n == 1) continue;
      const PositionLimits& limits = robot.limits[n];
      robot.controlled_joints.push_back(
          {n, uniformIn(random_, 0.02F, 0.3F), limits.lower, limits.upper});
    }
  }

  float coordinate() { return uniformIn(random_, -0.3F, 0.3F); }

  std::mt19937& random_;
};

}  // namespace galactic::test
