#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "support/text/counted.h"
#include "support/text/printable.h"
#include "terminal.h"
#include "views.h"

namespace galactic::bake {
namespace {

const char* nameOf(BoxFit fit) {
  switch (fit) {
    case BoxFit::kYaw:
      return "yaw";
    case BoxFit::kMinimum:
      return "min";
    case BoxFit::kAxisAligned:
      return "aabb";
  }
  return "";
}

void printObject(const ObjectFigures& object, int name_width) {
  const OrientedBox& box = object.box.box;
  const ObjectTimes& times = object.seconds.bake;
  fmt::print(
      "  {:<{}} {:>9} {:>17} {:>4} {:>6.3f} {:>5} {:>8} {:>4} {:>16} {:>16} {:>5} {:>7.3f}{}\n",
      printable(object.name), name_width, object.imported.triangles,
      fmt::format("{:.0f}x{:.0f}x{:.0f}", 2e3F * box.half_extents.x, 2e3F * box.half_extents.y,
                  2e3F * box.half_extents.z),
      nameOf(object.box.used), object.box.volume / object.box.axis_aligned_volume,
      object.stable_poses.size(), sphereCounts(object.spheres), object.spheres.count,
      millimeters(object.spheres.quality.gap), millimeters(object.spheres.quality.protrusion),
      object.spheres.quality.thin_points, times.box + times.stable_poses + times.spheres,
      object.authored_spheres ? "  as given" : "");
}

/// The figures of all objects together. Textures that two objects share count twice.
void printAllRenderMeshes(const std::vector<ObjectFigures>& objects) {
  RenderBakeStatistics sum;
  std::size_t textures = 0;
  bool any = false;
  for (const ObjectFigures& object : objects) {
    if (!object.render_meshes) continue;
    any = true;
    sum += object.render_meshes->all;
    textures += object.render_meshes->textures;
  }
  if (any) printRenderMeshes(sum, textures);
}

}  // namespace

std::string sphereCounts(const SphereFigures& spheres) {
  std::vector<std::uint64_t> counts(spheres.count_per_radius.rbegin(),
                                    spheres.count_per_radius.rend());
  return fmt::format("{}", fmt::join(counts, "+"));
}

std::string millimeters(const LengthStatistics& lengths) {
  return fmt::format("{:.1f}/{:.1f}/{:.1f}", 1e3 * lengths.mean, 1e3 * lengths.p95,
                     1e3 * lengths.max);
}

void printTable(const ObjectSetFigures& set, const PackFigures& pack, Verbosity verbosity) {
  const std::vector<ObjectFigures>& objects = set.objects;
  std::size_t longest = 6;
  for (const ObjectFigures& object : objects) longest = std::max(longest, object.name.size());
  const int name_width = static_cast<int>(longest);
  std::vector<float> radii(set.radii.rbegin(), set.radii.rend());
  fmt::print("{} -> {}\n", counted(objects.size(), "object"), targetOf(pack));
  fmt::print("  {:<{}} {:>9} {:>17} {:>4} {:>6} {:>5} {:>8} {:>4} {:>16} {:>16} {:>5} {:>7}\n",
             "object", name_width, "triangles", "box mm", "fit", "/aabb", "poses", "spheres", "all",
             "gap mm", "protrusion mm", "thin", "seconds");
  for (const ObjectFigures& object : objects) {
    printObject(object, name_width);
  }
  printAllRenderMeshes(objects);
  std::vector<std::string> warnings = set.warnings;
  for (const ObjectFigures& object : objects) {
    for (const std::string& warning : object.warnings) {
      warnings.push_back(fmt::format("object '{}': {}", object.name, warning));
    }
  }
  printWarnings(warnings, verbosity);
  fmt::print("  spheres of radius {} m; gap and protrusion: mean/p95/max\n", fmt::join(radii, "+"));
  fmt::print("  {:.3f} s; {:.2f} MB\n", set.seconds, static_cast<double>(pack.pack_bytes) / 1e6);
}

}  // namespace galactic::bake
