#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "bake/episodes/made_world.h"

namespace galactic::test {

struct TelescopeOptions {
  std::size_t segments = 3;
  bool with_wrist = false;
};

/// Meters.
namespace telescope {

/// From the base's middle to the telescope, in the way that the base drives.
constexpr float kAhead = 0.1F;
/// Heights of the telescope above the floor.
constexpr float kLowest = 0.3F;
constexpr float kHighest = 1.1F;
/// From the mast to the grip.
constexpr float kShortest = 0.3F;
constexpr float kLongest = 0.9F;
/// From the wrist to the grip.
constexpr float kHand = 0.2F;

}  // namespace telescope

/// A mast with a lift on a base of one sphere; a telescope that slides out to the base's right, and
/// at its end the hand, which a wrist turns about the vertical if there is one.
inline RobotPackFields telescopeRobot(const TelescopeOptions& options) {
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
  const float way =
      (telescope::kLongest - telescope::kShortest) / static_cast<float>(options.segments);
  add("base", {}, JointType::kFixed, {});
  add("lift", {{telescope::kAhead, telescope::kLowest, 0}, up}, JointType::kPrismatic,
      {0, telescope::kHighest - telescope::kLowest});
  for (std::size_t n = 0; n < options.segments; ++n) {
    const Pose at = n == 0 ? Pose{{}, down * right} : Pose{};
    add("segment" + std::to_string(n), at, JointType::kPrismatic, {0, way});
  }
  const Pose wrist{{telescope::kShortest - telescope::kHand, 0, 0}, {}};
  add("hand", wrist, options.with_wrist ? JointType::kRevolute : JointType::kFixed, {-1.5F, 1.5F});
  if (options.with_wrist) robot.start_positions.back() = 0;
  const auto hand = static_cast<std::uint32_t>(robot.links.size() - 1);
  robot.end_effector = EndEffectorFields{.link = hand, .grasp_point = Vec3{telescope::kHand, 0, 0}};
  robot.end_effector->grasp_radius = 0.05F;
  robot.spheres = {{{0, 0.2F, 0}, 2}, {{telescope::kHand - 0.06F, 0, 0}, 1}};
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
