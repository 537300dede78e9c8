#include "pack_tool/figure/joint_positions.h"

#include <fmt/format.h>

#include <algorithm>

#include "galactic/position_names.h"

namespace galactic::pack_tool {
namespace {

std::vector<float> unnamedPositions(const Robot& robot, OtherJoints others) {
  if (others == OtherJoints::kStart) {
    return {robot.startPositions().begin(), robot.startPositions().end()};
  }
  std::vector<float> positions(robot.positionCount());
  for (const LinkFrame& link : robot.links()) {
    // The last of seven values is the quaternion's w.
    if (link.type == JointType::kFloating) {
      positions[static_cast<std::size_t>(link.position) + positionCount(link.type) - 1] = 1;
    }
  }
  return positions;
}

/// Why no position has this name: the joint follows another one, does not move, or is not there.
std::string unknownJoint(const Robot& robot, const std::vector<std::string>& names,
                         const std::string& name) {
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    if (robot.jointName(link) != name) continue;
    const LinkFrame& frame = robot.links()[link];
    if (frame.type == JointType::kFixed) return fmt::format("joint \"{}\" does not move", name);
    return fmt::format("joint \"{}\" follows {}; give that one", name,
                       names[static_cast<std::size_t>(frame.position)]);
  }
  return fmt::format("the robot has no joint \"{}\"; it has {}", name,
                     names.empty() ? "none that moves" : fmt::format("{}", fmt::join(names, ", ")));
}

}  // namespace

Result<std::vector<float>> jointPositions(const Robot& robot, const JointChoice& choice,
                                          const std::string& where) {
  std::vector<float> positions = unnamedPositions(robot, choice.others);
  const std::vector<std::string> names = positionNames(robot);
  for (const JointValue& joint : choice.values) {
    const auto found = std::find(names.begin(), names.end(), joint.name);
    if (found == names.end()) {
      return fail(ErrorCode::kInvalidInput, where, unknownJoint(robot, names, joint.name));
    }
    const auto position = static_cast<std::size_t>(found - names.begin());
    const PositionLimits& limits = robot.limits()[position];
    if (!(joint.value >= limits.lower && joint.value <= limits.upper)) {
      return fail(ErrorCode::kInvalidInput, where,
                  fmt::format("joint \"{}\" cannot be at {}; its limits are {} to {}", joint.name,
                              joint.value, limits.lower, limits.upper));
    }
    positions[position] = joint.value;
  }
  return positions;
}

}  // namespace galactic::pack_tool
