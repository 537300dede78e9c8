#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "support/text/counted.h"
#include "support/text/printable.h"
#include "terminal.h"
#include "views.h"

namespace galactic::bake {
namespace {

void printGroup(const RobotFigures::Group& group, int name_width) {
  const std::string name = printable(group.link);
  if (!group.is_measured) {
    fmt::print("  {:<{}} {:>5} {:>9} {:>4}\n", name, name_width, group.links.size(),
               sphereCounts(group.spheres), group.spheres.count);
    return;
  }
  const SphereSetQuality& quality = group.spheres.quality;
  fmt::print("  {:<{}} {:>5} {:>9} {:>4} {:>16} {:>16} {:>6.2f} {:>5}{}\n", name, name_width,
             group.links.size(), sphereCounts(group.spheres), group.spheres.count,
             millimeters(quality.gap), millimeters(quality.protrusion), quality.volume_ratio,
             quality.thin_points, group.by_hand ? "  by hand" : "");
}

void printPairs(const RobotFigures& robot) {
  std::array<std::size_t, 5> counts{};
  for (const RobotFigures::Pair& pair : robot.pairs) ++counts[static_cast<std::size_t>(pair.kind)];
  fmt::print("  {} of groups: {} tested, {} adjacent, {} always touch, {} never, {} ignored\n",
             counted(robot.pairs.size(), "pair"), counts[0], counts[1], counts[2], counts[3],
             counts[4]);
}

}  // namespace

void printTable(const RobotFigures& robot, const PackFigures& pack, Verbosity verbosity) {
  std::uint64_t spheres = 0;
  std::size_t longest = 5;
  for (const RobotFigures::Group& group : robot.groups) {
    spheres += group.spheres.count;
    longest = std::max(longest, group.link.size());
  }
  const int name_width = static_cast<int>(longest);
  fmt::print("{} -> {}\n", robot.input, targetOf(pack));
  fmt::print("  {}: {}, {}, {}, {}\n", printable(robot.name), counted(robot.links, "link"),
             counted(robot.joint_positions, "joint position"),
             counted(robot.controlled_joints, "controlled joint"), counted(spheres, "sphere"));
  if (robot.controlled_joints == 0) {
    fmt::print(
        "  no action moves it: --print-recipe, given this robot, drafts a recipe that does\n");
  }
  fmt::print("  {:<{}} {:>5} {:>9} {:>4} {:>16} {:>16} {:>6} {:>5}\n", "group", name_width, "links",
             "spheres", "all", "gap mm", "protrusion mm", "volume", "thin");
  for (const RobotFigures::Group& group : robot.groups) printGroup(group, name_width);
  printPairs(robot);
  printRenderMeshes(robot.render_meshes);
  if (verbosity == Verbosity::kVerbose) {
    for (const std::string& found : robot.meshes) fmt::print("  {}\n", printable(withFlags(found)));
  }
  printWarnings(robot.warnings, verbosity);
  fmt::print(
      "  {:.3f} s: import {:.3f}, spheres {:.3f}, self-collision {:.3f}, render {:.3f}, write "
      "{:.3f}; {:.2f} MB\n",
      robot.seconds.all, robot.seconds.import, robot.seconds.bake.spheres,
      robot.seconds.bake.self_collision, robot.seconds.bake.render, robot.seconds.write,
      static_cast<double>(pack.pack_bytes) / 1e6);
}

}  // namespace galactic::bake
