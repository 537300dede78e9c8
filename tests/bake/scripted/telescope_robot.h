#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "../episodes/made_world.h"

namespace galactic::test {

/// A mast on a small base with a lift, from which a telescope of `segments` slides out to the
/// right, 0.1 m ahead of the base's middle, and where `with_wrist` a wrist that turns the hand
/// about the vertical. Hand and grip point along the grip's X axis.
struct TelescopeOptions {
  std::size_t segments = 3;
  bool with_wrist = false;
};

namespace telescope {

constexpr float kAhead = 0.1F;
/// Of the lift, height above the floor; of the whole telescope, length to the grip.
constexpr float kLowest = 0.3F;
constexpr float kHighest = 1.1F;
constexpr float kShortest = 0.3F;
constexpr float kLongest = 0.9F;
constexpr float kHand = 0.2F;

}  // namespace telescope

inline RobotPackFields telescopeRobot(const TelescopeOptions& options) {
  using namespace telescope;
  RobotPackFields robot;
  robot.name = "stick";
  robot.radii = madeRadii();
  robot.camera = std::nullopt;
  robot.base = BaseFields{};
  robot.base->root_height = 0;
  const auto add = [&robot](const std::string& name, const Pose& at, JointType type,
                            const PositionLimits& limits) {
    LinkFrame frame;
    frame.parent_from_joint = at;
    frame.axis = type == JointType::kRevolute ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    frame.parent = static_cast<std::int32_t>(robot.links.size()) - 1;
    frame.type = type;
    robot.link_names.push_back(name);
    robot.joint_names.push_back(robot.links.empty() ? "" : name + "_joint");
    if (type != JointType::kFixed) {
      const auto position = static_cast<std::uint32_t>(robot.limits.size());
      frame.position = static_cast<std::int32_t>(position);
      robot.limits.push_back(limits);
      robot.start_positions.push_back(limits.lower);
      robot.controlled_joints.push_back({position, 0.1F, limits.lower, limits.upper});
    }
    robot.links.push_back(frame);
  };
  // Quarter turns about Z and about Y: X up, and X to the robot's right.
  const float half = std::sqrt(0.5F);
  const Quat up{0, 0, half, half};
  const Quat down{0, 0, -half, half};
  const Quat right{0, -half, 0, half};
  const float way = (kLongest - kShortest) / static_cast<float>(options.segments);
  add("base", {}, JointType::kFixed, {});
  add("lift", {{kAhead, kLowest, 0}, up}, JointType::kPrismatic, {0, kHighest - kLowest});
  for (std::size_t n = 0; n < options.segments; ++n) {
    const Pose at = n == 0 ? Pose{{}, down * right} : Pose{};
    add("segment" + std::to_string(n), at, JointType::kPrismatic, {0, way});
  }
  const Pose wrist{{kShortest - kHand, 0, 0}, {}};
  add("hand", wrist, options.with_wrist ? JointType::kRevolute : JointType::kFixed, {-1.5F, 1.5F});
  if (options.with_wrist) robot.start_positions.back() = 0;
  const auto hand = static_cast<std::uint32_t>(robot.links.size() - 1);
  robot.end_effector = EndEffectorFields{.link = hand, .grasp_point = Vec3{kHand, 0, 0}};
  robot.end_effector->grasp_radius = 0.05F;
  robot.spheres = {{{0, 0.2F, 0}, 2}, {{kHand - 0.06F, 0, 0}, 1}};
  const auto count = static_cast<std::uint32_t>(robot.links.size());
  robot.groups.reserve(count);
  for (std::uint32_t link = 0; link < count; ++link) {
    const bool has_sphere = link == 0 || link == hand;
    const std::uint32_t first = link == 0 ? 0 : 1;
    robot.groups.push_back({link,
                            {link},
                            first,
                            has_sphere ? 1U : 0U,
                            has_sphere ? std::optional(SphereStatisticsFields{}) : std::nullopt});
  }
  return robot;
}

}  // namespace galactic::test
