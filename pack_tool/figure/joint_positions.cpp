#include "pack_tool/figure/joint_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace galactic::pack_tool {

namespace {

constexpr std::uint32_t kNoLink = 0xffffffffU;

constexpr std::array<std::string_view, 3> kPlanarParts{".x", ".y", ".angle"};
constexpr std::array<std::string_view, 7> kFloatingParts{".x",  ".y",  ".z", ".qx",
                                                         ".qy", ".qz", ".qw"};

std::string_view partName(JointType type, std::uint32_t n) {
  if (type == JointType::kPlanar) return kPlanarParts.at(n);
  if (type == JointType::kFloating) return kFloatingParts.at(n);
  return {};
}

std::vector<float> unnamedPositions(const Robot& robot, OtherJoints others) {
  if (others == OtherJoints::kStart) {
    return {robot.startPositions().begin(), robot.startPositions().end()};
  }
  std::vector<float> positions(robot.positionCount());
  for (const LinkFrame& link : robot.links()) {
    // The last of seven values is the quaternion's w.
    if (link.type == JointType::kFloating) {
      positions[static_cast<std::size_t>(link.position) + kFloatingParts.size() - 1] = 1;
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

std::vector<std::uint32_t> positionOwners(const Robot& robot) {
  std::vector<std::uint32_t> owners(robot.positionCount(), kNoLink);
  // First those that take their position as it is, then, should there be none, any.
  for (const bool only_plain : {true, false}) {
    for (std::uint32_t n = 0; n < robot.links().size(); ++n) {
      const LinkFrame& link = robot.links()[n];
      const bool plain = link.multiplier == 1 && link.offset == 0;
      if (link.position < 0 || (only_plain && !plain)) continue;
      for (std::uint32_t value = 0; value < positionCount(link.type); ++value) {
        std::uint32_t& owner = owners[static_cast<std::size_t>(link.position) + value];
        if (owner == kNoLink) owner = n;
      }
    }
  }
  return owners;
}

std::vector<std::string> positionNames(const Robot& robot) {
  const std::vector<std::uint32_t> owners = positionOwners(robot);
  std::vector<std::string> names;
  for (std::uint32_t position = 0; position < owners.size(); ++position) {
    const std::uint32_t owner = owners[position];
    if (owner == kNoLink) {
      names.push_back(fmt::format("position {}", position));
      continue;
    }
    const LinkFrame& link = robot.links()[owner];
    names.push_back(
        std::string(robot.jointName(owner)) +
        std::string(partName(link.type, position - static_cast<std::uint32_t>(link.position))));
  }
  return names;
}

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
