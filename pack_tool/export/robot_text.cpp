#include "pack_tool/export/robot_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "galactic/position_names.h"
#include "galactic/self_collision.h"
#include "pack_tool/support/xml_text.h"

namespace galactic::pack_tool {

namespace {

/// The URDF's frame from the pack's: (x, y, z) to (x, -z, y). Adding zero turns -0 into 0.
Vec3 zUp(const Vec3& v) { return {v.x, 0.0F - v.z, v.y + 0.0F}; }

std::string vectorText(const Vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

/// Roll, pitch and yaw, radians: rotation = Rz(yaw) Ry(pitch) Rx(roll).
std::array<double, 3> rollPitchYaw(const Quat& q) {
  const std::array<double, 4> d{static_cast<double>(q.x), static_cast<double>(q.y),
                                static_cast<double>(q.z), static_cast<double>(q.w)};
  const auto [x, y, z, w] = d;
  // The elements of the rotation matrix that the angles are read from, times the squared length.
  const double r00 = w * w + x * x - y * y - z * z;
  const double r10 = 2 * (x * y + w * z);
  const double r20 = 2 * (x * z - w * y);
  const double r21 = 2 * (y * z + w * x);
  const double r22 = w * w - x * x - y * y + z * z;
  const double cos_pitch = std::hypot(r00, r10);
  const double pitch = std::atan2(-r20, cos_pitch);
  // Rounding of floats: nearer to the pole, roll and yaw cannot be told apart.
  constexpr double kPole = 1e-6;
  if (cos_pitch < kPole) {
    const double r12 = 2 * (y * z - w * x);
    const double r11 = w * w - x * x + y * y - z * z;
    return {std::atan2(-r12, r11), pitch, 0};
  }
  return {std::atan2(r21, r22), pitch, std::atan2(r10, r00)};
}

std::string originText(const Pose& pose) {
  const Quat& q = pose.rotation;
  const Vec3 axis = zUp({q.x, q.y, q.z});
  const auto [roll, pitch, yaw] = rollPitchYaw({axis.x, axis.y, axis.z, q.w});
  return fmt::format("<origin xyz=\"{}\" rpy=\"{} {} {}\"/>", vectorText(zUp(pose.translation)),
                     roll + 0.0, pitch + 0.0, yaw + 0.0);
}

bool isUnlimited(const PositionLimits& limits) {
  constexpr float kMost = std::numeric_limits<float>::max();
  return limits.lower == -kMost && limits.upper == kMost;
}

std::string_view typeName(JointType type) {
  switch (type) {
    case JointType::kFixed:
      return "fixed";
    case JointType::kRevolute:
      return "revolute";
    case JointType::kContinuous:
      return "continuous";
    case JointType::kPrismatic:
      return "prismatic";
    case JointType::kPlanar:
      return "planar";
    case JointType::kFloating:
      return "floating";
  }
  return "fixed";
}

/// Writes the links and joints of one robot.
class UrdfWriter {
 public:
  explicit UrdfWriter(const Robot& robot)
      : robot_(robot), owners_(positionOwners(robot)), groups_(robot.links().size()) {
    for (const SphereGroup& group : robot.groups()) groups_[group.link] = group.spheres;
  }

  std::string text() const {
    std::string text =
        fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", xmlEscaped(robot_.name()));
    for (std::size_t n = 0; n < robot_.links().size(); ++n) text += linkText(n);
    for (std::size_t n = 0; n < robot_.links().size(); ++n) {
      if (robot_.links()[n].parent >= 0) text += jointText(n);
    }
    return text + "</robot>\n";
  }

 private:
  std::string linkText(std::size_t n) const {
    const std::string name = xmlEscaped(robot_.linkName(n));
    if (groups_[n].empty()) return fmt::format("  <link name=\"{}\"/>\n", name);
    std::string text = fmt::format("  <link name=\"{}\">\n", name);
    for (const SetSphere& sphere : groups_[n]) {
      text += fmt::format(
          "    <collision>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n"
          "      <geometry><sphere radius=\"{}\"/></geometry>\n    </collision>\n",
          vectorText(zUp(sphere.center)), robot_.radii()[sphere.radius_index]);
    }
    return text + "  </link>\n";
  }

  std::string jointText(std::size_t n) const {
    const LinkFrame& link = robot_.links()[n];
    std::string text = fmt::format(
        "  <joint name=\"{}\" type=\"{}\">\n    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n",
        xmlEscaped(robot_.jointName(n)), typeName(writtenType(link)),
        xmlEscaped(robot_.linkName(static_cast<std::size_t>(link.parent))),
        xmlEscaped(robot_.linkName(n)));
    text += "    " + originText(link.parent_from_joint) + "\n";
    if (link.type != JointType::kFixed && link.type != JointType::kFloating) {
      text += fmt::format("    <axis xyz=\"{}\"/>\n", vectorText(zUp(link.axis)));
    }
    return text + limitText(link) + mimicText(n, link) + "  </joint>\n";
  }

  [[nodiscard]] JointType writtenType(const LinkFrame& link) const {
    const bool free = link.type == JointType::kRevolute && isUnlimited(limitsOf(link));
    return free ? JointType::kContinuous : link.type;
  }

  [[nodiscard]] const PositionLimits& limitsOf(const LinkFrame& link) const {
    return robot_.limits()[static_cast<std::size_t>(link.position)];
  }

  /// What the position's limits mean for this joint, which may mimic its owner.
  [[nodiscard]] std::string limitText(const LinkFrame& link) const {
    const JointType type = writtenType(link);
    if (type != JointType::kRevolute && type != JointType::kPrismatic) return {};
    const PositionLimits& limits = limitsOf(link);
    const auto value = [&](float position) {
      return isUnlimited(limits) ? position : link.multiplier * position + link.offset;
    };
    const auto [lower, upper] = std::minmax({value(limits.lower), value(limits.upper)});
    return fmt::format("    <limit lower=\"{}\" upper=\"{}\" effort=\"0\" velocity=\"0\"/>\n",
                       lower, upper);
  }

  [[nodiscard]] std::string mimicText(std::size_t n, const LinkFrame& link) const {
    if (link.type == JointType::kFixed) return {};
    const std::uint32_t owner = owners_[static_cast<std::size_t>(link.position)];
    if (owner == n) return {};
    return fmt::format("    <mimic joint=\"{}\" multiplier=\"{}\" offset=\"{}\"/>\n",
                       xmlEscaped(robot_.jointName(owner)), link.multiplier, link.offset);
  }

  const Robot& robot_;
  std::vector<std::uint32_t> owners_;
  /// Of each link; empty where it has none of its own.
  std::vector<std::span<const SetSphere>> groups_;
};

}  // namespace

namespace {

/// Why MoveIt need not test a pair; empty where it has to.
std::string_view reasonOf(const GroupPair& pair, std::span<const GroupPair> tested) {
  const auto is_same = [&](const GroupPair& other) {
    return other.first == pair.first && other.second == pair.second;
  };
  switch (pair.kind) {
    case PairKind::kTested:
      return std::ranges::any_of(tested, is_same) ? "" : "Default";
    case PairKind::kAdjacent:
      return "Adjacent";
    case PairKind::kAlways:
      return "Always";
    case PairKind::kNever:
      return "Never";
    case PairKind::kIgnored:
      return "User";
  }
  return "";
}

/// The pairs of links that are not to be tested, ascending, each with its reason.
std::map<std::pair<std::uint32_t, std::uint32_t>, std::string_view> untestedLinks(
    const Robot& robot) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::string_view> reasons;
  const auto add = [&](const SphereGroup& first, const SphereGroup& second,
                       std::string_view reason) {
    for (const std::uint32_t a : first.links) {
      for (const std::uint32_t b : second.links) {
        if (a != b) reasons.try_emplace(std::minmax(a, b), reason);
      }
    }
  };
  for (std::uint32_t link = 1; link < robot.links().size(); ++link) {
    const auto parent = static_cast<std::uint32_t>(robot.links()[link].parent);
    reasons.try_emplace({parent, link}, "Adjacent");
  }
  for (const SphereGroup& group : robot.groups()) add(group, group, "Adjacent");
  const SelfCollision self_collision(robot);
  for (const GroupPair& pair : robot.groupPairs()) {
    const std::string_view reason = reasonOf(pair, self_collision.pairs());
    if (reason.empty()) continue;
    add(robot.groups()[pair.first], robot.groups()[pair.second], reason);
  }
  return reasons;
}

}  // namespace

std::string srdfText(const Robot& robot) {
  std::vector<std::span<const SetSphere>> spheres(robot.links().size());
  for (const SphereGroup& group : robot.groups()) spheres[group.link] = group.spheres;
  std::string text =
      fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", xmlEscaped(robot.name()));
  for (std::size_t n = 0; n < spheres.size(); ++n) {
    text +=
        fmt::format("  <link_sphere_approximation link=\"{}\">\n", xmlEscaped(robot.linkName(n)));
    for (const SetSphere& sphere : spheres[n]) {
      text += fmt::format("    <sphere center=\"{}\" radius=\"{}\"/>\n",
                          vectorText(zUp(sphere.center)), robot.radii()[sphere.radius_index]);
    }
    if (spheres[n].empty()) text += "    <sphere center=\"0 0 0\" radius=\"0\"/>\n";
    text += "  </link_sphere_approximation>\n";
  }
  for (const auto& [links, reason] : untestedLinks(robot)) {
    text += fmt::format("  <disable_collisions link1=\"{}\" link2=\"{}\" reason=\"{}\"/>\n",
                        xmlEscaped(robot.linkName(links.first)),
                        xmlEscaped(robot.linkName(links.second)), reason);
  }
  return text + "</robot>\n";
}

std::string spherizedUrdfText(const Robot& robot) { return UrdfWriter(robot).text(); }

}  // namespace galactic::pack_tool
