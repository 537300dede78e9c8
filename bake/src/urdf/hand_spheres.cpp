#include "galactic/bake/hand_spheres.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "galactic/bake/triangle_mesh.h"
#include "urdf/urdf_frames.h"
#include "urdf/urdf_process.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kTimeLimit{60};

Result<void> checkSphere(const HandSphere& sphere, const std::string& place) {
  const auto within = [](double v) { return std::abs(v) <= kMaxCoordinate; };
  const auto& c = sphere.centre;
  // NaN compares false.
  if (within(c[0]) && within(c[1]) && within(c[2]) && within(sphere.radius) && sphere.radius > 0) {
    return {};
  }
  return fail(ErrorCode::kInvalidInput, place,
              fmt::format("a sphere at ({} {} {}) of radius {}: wanted a finite centre and a "
                          "positive radius, in metres",
                          c[0], c[1], c[2], sphere.radius));
}

Result<HandSpheres> finish(HandSpheres spheres, const fs::path& path, std::string_view element) {
  std::erase_if(spheres.links, [](const LinkSpheres& link) { return link.spheres.empty(); });
  for (LinkSpheres& link : spheres.links) {
    for (HandSphere& sphere : link.spheres) {
      auto checked = checkSphere(sphere, fmt::format("{}: link '{}'", path.string(), link.link));
      if (!checked) return tl::unexpected(checked.error());
      sphere.centre = transformed(kYUpFromZUp, sphere.centre);
    }
  }
  if (spheres.links.empty()) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("no link has a {}; is it the spherized file?", element));
  }
  return spheres;
}

std::string escaped(std::string_view text) {
  std::string xml;
  for (const char c : text) {
    switch (c) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      case '"':
        xml += "&quot;";
        break;
      default:
        xml += c;
    }
  }
  return xml;
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
  return "";
}

/// Roll, pitch and yaw of a rotation matrix: R = Rz(yaw) Ry(pitch) Rx(roll).
std::array<double, 3> rollPitchYaw(const Affine& m) {
  constexpr double kGimbalLock = 1e-12;
  const double cos_pitch = std::hypot(m[0], m[4]);
  const double pitch = std::atan2(-m[8], cos_pitch);
  if (cos_pitch < kGimbalLock) return {std::atan2(-m[6], m[5]), pitch, 0};
  return {std::atan2(m[9], m[10]), pitch, std::atan2(m[4], m[0])};
}

std::string vectorText(const std::array<double, 3>& v) {
  return fmt::format("{} {} {}", v[0], v[1], v[2]);
}

std::string originText(const Affine& frame) {
  return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", vectorText({frame[3], frame[7], frame[11]}),
                     vectorText(rollPitchYaw(frame)));
}

std::string jointText(const SourceRobot& robot, const SourceLink& link) {
  std::string text = fmt::format("  <joint name=\"{}\" type=\"{}\">\n", escaped(link.joint_name),
                                 typeName(link.joint_type));
  const auto& parent = robot.links[static_cast<std::size_t>(link.parent)];
  text += fmt::format("    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n", escaped(parent.name),
                      escaped(link.name));
  text += "    " + originText(conjugate(kZUpFromYUp, link.parent_from_joint, kYUpFromZUp)) + "\n";
  if (link.joint_type != JointType::kFixed && link.joint_type != JointType::kFloating) {
    text +=
        fmt::format("    <axis xyz=\"{}\"/>\n", vectorText(transformed(kZUpFromYUp, link.axis)));
  }
  if (link.limits) {
    text += fmt::format("    <limit lower=\"{}\" upper=\"{}\" effort=\"0\" velocity=\"0\"/>\n",
                        link.limits->lower, link.limits->upper);
  }
  if (link.mimic) {
    text += fmt::format("    <mimic joint=\"{}\" multiplier=\"{}\" offset=\"{}\"/>\n",
                        escaped(robot.links[link.mimic->link].joint_name), link.mimic->multiplier,
                        link.mimic->offset);
  }
  return text + "  </joint>\n";
}

std::string linkText(const SourceLink& link, std::span<const LinkSpheres> spheres) {
  std::string text;
  for (const LinkSpheres& set : spheres) {
    if (set.link != link.name) continue;
    for (const HandSphere& sphere : set.spheres) {
      text += fmt::format(
          "    <collision>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n"
          "      <geometry><sphere radius=\"{}\"/></geometry>\n    </collision>\n",
          vectorText(transformed(kZUpFromYUp, sphere.centre)), sphere.radius);
    }
  }
  if (text.empty()) return fmt::format("  <link name=\"{}\"/>\n", escaped(link.name));
  return fmt::format("  <link name=\"{}\">\n{}  </link>\n", escaped(link.name), text);
}

}  // namespace

Result<HandSpheres> readSpherizedUrdf(const fs::path& path) {
  const auto model = readUrdf(path, kTimeLimit);
  if (!model) return tl::unexpected(model.error());
  HandSpheres spheres;
  for (const UrdfLink& link : model->links) {
    LinkSpheres& set = spheres.links.emplace_back();
    set.link = link.name;
    std::size_t others = 0;
    for (const UrdfShape& shape : link.collisions) {
      if (shape.geometry != UrdfGeometry::kSphere) {
        ++others;
        continue;
      }
      const Affine& t = shape.link_from_shape;
      set.spheres.push_back({.centre = {t[3], t[7], t[11]}, .radius = shape.size[0]});
    }
    if (others == 0) continue;
    spheres.warnings.push_back(
        fmt::format("link '{}': {} collision elements are no spheres: "
                    "left out",
                    link.name, others));
  }
  return finish(std::move(spheres), path, "<sphere> collision element");
}

Result<HandSpheres> readSrdfSpheres(const fs::path& path) {
  auto links = readSrdf(path, kTimeLimit);
  if (!links) return tl::unexpected(links.error());
  for (LinkSpheres& link : *links) {
    if (link.spheres.size() == 1 && link.spheres.front().radius == 0) link.spheres.clear();
  }
  return finish({.links = std::move(*links), .warnings = {}}, path,
                "<sphere> in a <link_sphere_approximation>");
}

std::string writeSrdfSpheres(const std::string& robot, std::span<const LinkSpheres> spheres) {
  std::string text = fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", escaped(robot));
  for (const LinkSpheres& link : spheres) {
    text += fmt::format("  <link_sphere_approximation link=\"{}\">\n", escaped(link.link));
    for (const HandSphere& sphere : link.spheres) {
      text += fmt::format("    <sphere center=\"{}\" radius=\"{}\"/>\n",
                          vectorText(transformed(kZUpFromYUp, sphere.centre)), sphere.radius);
    }
    if (link.spheres.empty()) text += "    <sphere center=\"0 0 0\" radius=\"0\"/>\n";
    text += "  </link_sphere_approximation>\n";
  }
  return text + "</robot>\n";
}

std::string writeSpherizedUrdf(const SourceRobot& robot, std::span<const LinkSpheres> spheres) {
  std::string text =
      fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", escaped(robot.name));
  for (const SourceLink& link : robot.links) text += linkText(link, spheres);
  for (const SourceLink& link : robot.links) {
    if (link.parent >= 0) text += jointText(robot, link);
  }
  return text + "</robot>\n";
}

}  // namespace galactic::bake
