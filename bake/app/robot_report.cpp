#include <array>

#include "object_outcome.h"
#include "render_job.h"
#include "robot_outcome.h"

namespace galactic::bake {
namespace {

Json groupReport(const BakedRobot& robot, const BakedGroup& group) {
  Json links = Json::array();
  for (const std::uint32_t link : group.links) links.push_back(robot.link_names[link]);
  Json json{{"link", robot.link_names[group.link]},
            {"links", links},
            {"by_hand", group.authored},
            {"eps", group.eps},
            {"tau", group.tau},
            {"count", group.spheres.spheres.size()}};
  if (group.measured) json["spheres"] = sphereSetReport(group.spheres, robot.radii.size());
  return json;
}

}  // namespace

Json robotReport(const RobotOutcome& outcome) {
  constexpr std::array<const char*, 5> kKinds{"tested", "adjacent", "always", "never", "ignored"};
  const BakedRobot& robot = outcome.robot;
  Json json{{"input", outcome.input.string()},
            {"output", outcome.output.string()},
            {"pack_bytes", outcome.pack_bytes},
            {"name", robot.name},
            {"links", robot.kinematics.links.size()},
            {"joint_positions", robot.kinematics.limits.size()},
            {"controlled_joints", robot.controlled_joints.size()}};
  json["groups"] = Json::array();
  for (const BakedGroup& group : robot.groups) json["groups"].push_back(groupReport(robot, group));
  json["pairs"] = Json::array();
  for (const BakedPair& pair : robot.pairs) {
    json["pairs"].push_back({{"first", robot.link_names[robot.groups[pair.first].link]},
                             {"second", robot.link_names[robot.groups[pair.second].link]},
                             {"kind", kKinds[static_cast<std::size_t>(pair.kind)]}});
  }
  json["meshes"] = outcome.resolutions;
  json["seconds"] = {{"import", outcome.import_seconds},
                     {"spheres", robot.times.spheres},
                     {"self_collision", robot.times.self_collision},
                     {"render", robot.times.render},
                     {"all", outcome.seconds}};
  if (robot.render_meshes) json["render_meshes"] = renderReport(*robot.render_meshes);
  json["warnings"] = robot.warnings;
  return json;
}

}  // namespace galactic::bake
