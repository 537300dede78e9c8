#include "galactic/position_names.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string_view>

namespace galactic {
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

}  // namespace

std::vector<std::uint32_t> positionOwners(const Robot& robot) {
  std::vector<std::uint32_t> owners(robot.positionCount(), kNoLink);
  // Prefer links that use their position unchanged; take any if there are none.
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

}  // namespace galactic
