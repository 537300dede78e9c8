#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "galactic/printable.h"
#include "object_outcome.h"
#include "render_job.h"
#include "robot_outcome.h"
#include "warning_list.h"

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
             group.spheres.spheres.size(), millimetres(quality.gap),
             millimetres(quality.protrusion), quality.volume_ratio, quality.thin_points,
             group.authored ? "  by hand" : "");
}

void printPairs(const BakedRobot& robot) {
  std::array<std::size_t, 5> counts{};
  for (const BakedPair& pair : robot.pairs) ++counts[static_cast<std::size_t>(pair.kind)];
  fmt::print(
      "  {} pairs of groups: {} tested, {} adjacent, {} always touch, {} never, {} ignored\n",
      robot.pairs.size(), counts[0], counts[1], counts[2], counts[3], counts[4]);
}

}  // namespace

void printRobotTable(const RobotOutcome& outcome, Verbosity verbosity) {
  const BakedRobot& robot = outcome.robot;
  std::size_t spheres = 0;
  std::size_t longest = 5;
  for (const BakedGroup& group : robot.groups) {
    spheres += group.spheres.spheres.size();
    longest = std::max(longest, robot.link_names[group.link].size());
  }
  const int name_width = static_cast<int>(longest);
  fmt::print("{} -> {}\n", outcome.input.string(),
             outcome.pack_bytes > 0 ? outcome.output.string() : "(dry run)");
  fmt::print("  {}: {} links, {} joint positions, {} controlled joints, {} spheres\n",
             printable(robot.name), robot.kinematics.links.size(), robot.kinematics.limits.size(),
             robot.controlled_joints.size(), spheres);
  fmt::print("  {:<{}} {:>5} {:>9} {:>4} {:>16} {:>16} {:>6} {:>5}\n", "group", name_width, "links",
             "spheres", "all", "gap mm", "protrusion mm", "volume", "thin");
  for (const BakedGroup& group : robot.groups) printGroup(robot, group, name_width);
  printPairs(robot);
  printRenderMeshes(robot.render_meshes);
  if (verbosity == Verbosity::kVerbose) {
    for (const std::string& found : outcome.resolutions) fmt::print("  {}\n", printable(found));
  }
  printWarnings(robot.warnings, verbosity);
  fmt::print(
      "  {:.3f} s: import {:.3f}, spheres {:.3f}, self-collision {:.3f}, render {:.3f}; {:.2f} "
      "MB\n",
      outcome.seconds, outcome.import_seconds, robot.times.spheres, robot.times.self_collision,
      robot.times.render, static_cast<double>(outcome.pack_bytes) / 1e6);
}

}  // namespace galactic::bake
