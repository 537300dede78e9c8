#include <fmt/format.h>

#include "pack_tool/describe/asset_text.h"
#include "pack_tool/describe/text_parts.h"
#include "pack_tool/support/text_table.h"
#include "support/text/counted.h"

namespace galactic::pack_tool {

namespace {

std::string numberText(const Json& number) {
  return number.is_null() ? "-" : fmt::format("{:.4g}", numberOf(number));
}

/// The position of this name, null when a link has none.
const Json* findPosition(const Json& positions, const Json& name) {
  for (const Json& position : positions) {
    if (position.at("name") == name) return &position;
  }
  return nullptr;
}

/// What a joint follows: empty when it moves for itself.
std::string followed(const Json& link) {
  const double multiplier = numberOf(link.at("multiplier"));
  const double offset = numberOf(link.at("offset"));
  const bool own = link.at("position") == link.at("joint") && multiplier == 1 && offset == 0;
  if (own || link.at("position").is_null()) return "";
  return fmt::format("{:.4g} * {} + {:.4g}", multiplier, textOf(link.at("position")), offset);
}

std::string linksText(const Json& robot) {
  TextTable table(4);
  table.add({"link", "parent", "joint", "type", "lower", "upper", "start", "follows"});
  for (const Json& link : robot.at("links")) {
    std::vector<std::string> line{textOf(link.at("name"))};
    if (!link.at("parent").is_null()) {
      line.insert(line.end(),
                  {textOf(link.at("parent")), textOf(link.at("joint")), textOf(link.at("type"))});
      const std::string follows = followed(link);
      const Json* position = findPosition(robot.at("positions"), link.at("position"));
      if (!follows.empty()) {
        line.insert(line.end(), {"", "", "", follows});
      } else if (position != nullptr) {
        line.insert(line.end(),
                    {numberText(position->at("lower")), numberText(position->at("upper")),
                     numberText(position->at("start"))});
      }
    }
    table.add(std::move(line));
  }
  return labeled("links", fmt::format("{}, {}; radians, meters", robot.at("links").size(),
                                      counted(robot.at("positions").size(), "joint position"))) +
         table.text();
}

std::string groupsText(const Json& robot) {
  TextTable table(4);
  table.add({"group", "links", "spheres", "by radius", "gap (mm)", "protrusion (mm)",
             "volume ratio", "by hand"});
  std::size_t spheres = 0;
  for (const Json& group : robot.at("groups")) {
    spheres += group.at("spheres").size();
    std::vector<std::string> line{textOf(group.at("name")),
                                  std::to_string(group.at("links").size()),
                                  std::to_string(group.at("spheres").size()),
                                  countsByRadius(group.at("spheres"), robot.at("radii"))};
    const Json& quality = group.at("sphere_quality");
    if (!quality.is_null()) {
      line.insert(line.end(),
                  {millimetersOf(quality.at("gap")), millimetersOf(quality.at("protrusion")),
                   fmt::format("{:.2f}", numberOf(quality.at("volume_ratio"))),
                   quality.at("authored").get<bool>() ? "yes" : "no"});
    }
    table.add(std::move(line));
  }
  return labeled("spheres", fmt::format("{} in {}; gap and protrusion: mean/p95/max", spheres,
                                        counted(robot.at("groups").size(), "group"))) +
         table.text();
}

std::string pairsText(const Json& pairs) {
  std::string text;
  for (const auto& [kind, list] : pairs.items()) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", list.size(), kind);
  }
  return labeled("pairs", text);
}

std::string controlledText(const Json& joints) {
  if (joints.empty()) return labeled("controlled", "none");
  TextTable table(4);
  table.add({"controlled joint", "step", "lower", "upper"});
  for (const Json& joint : joints) {
    table.add({textOf(joint.at("name")), numberText(joint.at("step")),
               numberText(joint.at("lower")), numberText(joint.at("upper"))});
  }
  return labeled("controlled", counted(joints.size(), "joint")) + table.text();
}

constexpr double kDegrees = 57.29577951308232;

std::string laserText(const Json& laser) {
  if (laser.is_null()) return labeled("laser", "none");
  return labeled(
      "laser",
      fmt::format("{} at {} m, {:.1f} degrees, {} to {} m, noise {} m", textOf(laser.at("link")),
                  pointOf(laser.at("link_from_laser").at("translation")),
                  kDegrees * numberOf(laser.at("field_of_view")), lengthOf(laser.at("least_range")),
                  lengthOf(laser.at("range")), lengthOf(laser.at("noise"))));
}

std::string toolsText(const Json& robot) {
  const Json& effector = robot.at("end_effector");
  std::string text =
      labeled("grasp", effector.is_null()
                           ? "none"
                           : fmt::format("{} at {} m, radius {} m", textOf(effector.at("link")),
                                         pointOf(effector.at("grasp_point")),
                                         lengthOf(effector.at("grasp_radius"))));
  const Json& camera = robot.at("camera");
  text += labeled("camera",
                  camera.is_null()
                      ? "none"
                      : fmt::format("{} at {} m, {:.1f} degrees high", textOf(camera.at("link")),
                                    pointOf(camera.at("link_from_camera").at("translation")),
                                    kDegrees * numberOf(camera.at("vertical_fov"))));
  text += laserText(robot.at("laser"));
  const Json& base = robot.at("base");
  if (base.is_null()) return text + labeled("base", "none");
  const Json& low = base.at("footprint_min");
  const Json& high = base.at("footprint_max");
  const std::string footprint =
      numberOf(base.at("footprint_radius")) > 0
          ? fmt::format("circle of radius {} m", lengthOf(base.at("footprint_radius")))
          : fmt::format("x {} to {}, z {} to {} m", lengthOf(low.at(0)), lengthOf(high.at(0)),
                        lengthOf(low.at(2)), lengthOf(high.at(2)));
  const bool drives_sideways = numberOf(base.at("sideways_step")) > 0;
  const std::string sideways =
      drives_sideways ? fmt::format(", {} m sideways", lengthOf(base.at("sideways_step"))) : "";
  return text + labeled("base", fmt::format("steps of {} m{} and {:.4g} rad, root {} m above the "
                                            "ground, footprint {}",
                                            lengthOf(base.at("forward_step")), sideways,
                                            numberOf(base.at("turn_step")),
                                            lengthOf(base.at("root_height")), footprint));
}

std::string surfacesText(const Json& surfaces) {
  std::uint64_t collision = 0;
  std::uint64_t visual = 0;
  for (const Json& surface : surfaces) {
    const auto triangles = [&surface](const char* kind) {
      const Json& mesh = surface.at(kind);
      return mesh.is_null() ? std::uint64_t{0} : mesh.at("triangles").get<std::uint64_t>();
    };
    collision += triangles("collision");
    visual += triangles("visual");
  }
  return labeled("triangles",
                 fmt::format("{} collision, {} visual", grouped(collision), grouped(visual)));
}

}  // namespace

std::string robotText(const Json& robot) {
  return labeled("robot", textOf(robot.at("name"))) +
         labeled("radii", radiiOf(robot.at("radii")) + " m") + surfacesText(robot.at("surfaces")) +
         toolsText(robot) + controlledText(robot.at("controlled_joints")) + linksText(robot) +
         groupsText(robot) + pairsText(robot.at("group_pairs"));
}

}  // namespace galactic::pack_tool
