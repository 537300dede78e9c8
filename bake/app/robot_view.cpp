#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "support/printable.h"
#include "terminal.h"
#include "views.h"

namespace galactic::bake {
namespace {

void printGroup(const BakedRobot& robot, const BakedGroup& group, int name_width) {
  const std::string name = printable(robot.link_names[group.link]);
  if (!group.measured) {
    fmt::print("  {:<{}} {:>5} {:>9} {:>4}\n", name, name_width, group.links.size(),
               sphereCounts(group.spheres.spheres, robot.radii.size()),
               group.spheres.spheres.size());
    return;
  }
  const SphereSetQuality& quality = group.spheres.quality;
  fmt::print("  {:<{}} {:>5} {:>9} {:>4} {:>16} {:>16} {:>6.2f} {:>5}{}\n", name, name_width,
             group.links.size(), sphereCounts(group.spheres.spheres, robot.radii.size()),
             group.spheres.spheres.size(), millimeters(quality.gap),
             millimeters(quality.protrusion), quality.volume_ratio, quality.thin_points,
             group.authored ? "  by hand" : "");
}

void printPairs(const BakedRobot& robot) {
  std::array<std::size_t, 5> counts{};
  for (const BakedPair& pair : robot.pairs) ++counts[static_cast<std::size_t>(pair.kind)];
  fmt::print(
      "  {} pairs of groups: {} tested, {} adjacent, {} always touch, {} never, {} ignored\n",
      robot.pairs.size(), counts[0], counts[1], counts[2], counts[3], counts[4]);
}

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

void printTable(const RobotOutcome& outcome, const Made& made, Verbosity verbosity) {
  const BakedRobot& robot = outcome.robot;
  std::size_t spheres = 0;
  std::size_t longest = 5;
  for (const BakedGroup& group : robot.groups) {
    spheres += group.spheres.spheres.size();
    longest = std::max(longest, robot.link_names[group.link].size());
  }
  const int name_width = static_cast<int>(longest);
  fmt::print("{} -> {}\n", outcome.input.string(),
             made.pack_bytes > 0 ? made.output.string() : "(dry run)");
  fmt::print("  {}: {} links, {} joint positions, {} controlled joints, {} spheres\n",
             printable(robot.name), robot.kinematics.links.size(), robot.kinematics.limits.size(),
             robot.controlled_joints.size(), spheres);
  fmt::print("  {:<{}} {:>5} {:>9} {:>4} {:>16} {:>16} {:>6} {:>5}\n", "group", name_width, "links",
             "spheres", "all", "gap mm", "protrusion mm", "volume", "thin");
  for (const BakedGroup& group : robot.groups) printGroup(robot, group, name_width);
  printPairs(robot);
  printRenderMeshes(robot.render_meshes);
  if (verbosity == Verbosity::kVerbose) {
    for (const std::string& found : outcome.resolutions)
      fmt::print("  {}\n", printable(withFlags(found)));
  }
  printWarnings(robot.warnings, verbosity);
  fmt::print(
      "  {:.3f} s: import {:.3f}, spheres {:.3f}, self-collision {:.3f}, render {:.3f}; {:.2f} "
      "MB\n",
      outcome.seconds, outcome.import_seconds, robot.times.spheres, robot.times.self_collision,
      robot.times.render, static_cast<double>(made.pack_bytes) / 1e6);
}

Json reportEntries(const RobotOutcome& outcome, const Made& made) {
  constexpr std::array<const char*, 5> kKinds{"tested", "adjacent", "always", "never", "ignored"};
  const BakedRobot& robot = outcome.robot;
  Json json{{"input", outcome.input.string()},
            {"output", made.output.string()},
            {"pack_bytes", made.pack_bytes},
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
  json["meshes"] = withFlags(outcome.resolutions);
  json["seconds"] = {{"import", outcome.import_seconds},
                     {"spheres", robot.times.spheres},
                     {"self_collision", robot.times.self_collision},
                     {"render", robot.times.render},
                     {"all", outcome.seconds}};
  if (robot.render_meshes) json["render_meshes"] = renderReport(*robot.render_meshes);
  json["warnings"] = withFlags(robot.warnings);
  return Json::array({std::move(json)});
}

}  // namespace galactic::bake
