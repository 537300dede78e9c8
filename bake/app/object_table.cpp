#include <fmt/format.h>

#include <algorithm>

#include "galactic/printable.h"
#include "object_outcome.h"
#include "render_job.h"
#include "warning_list.h"

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

void printObject(const BakedObject& object, std::size_t radii, int name_width) {
  const OrientedBox& box = object.box.box;
  const ObjectTimes& times = object.times;
  fmt::print(
      "  {:<{}} {:>9} {:>17} {:>4} {:>6.3f} {:>5} {:>8} {:>4} {:>16} {:>16} {:>5} {:>7.3f}{}\n",
      printable(object.name), name_width, object.imported.triangles,
      fmt::format("{:.0f}x{:.0f}x{:.0f}", 2e3F * box.half_extents.x, 2e3F * box.half_extents.y,
                  2e3F * box.half_extents.z),
      nameOf(object.box.used), object.box.volume / object.box.axis_aligned_volume,
      object.stable_poses.size(), sphereCounts(object.spheres.spheres, radii),
      object.spheres.spheres.size(), millimetres(object.spheres.quality.gap),
      millimetres(object.spheres.quality.protrusion), object.spheres.quality.thin_points,
      times.box + times.stable_poses + times.spheres, object.authored_spheres ? "  as given" : "");
}

/// The figures of all objects together. Textures that two objects share count twice.
void printAllRenderMeshes(const std::vector<BakedObject>& objects) {
  RenderBakeStatistics sum;
  std::size_t textures = 0;
  bool any = false;
  for (const BakedObject& object : objects) {
    if (!object.render_meshes) continue;
    any = true;
    sum += object.render_meshes->statistics();
    textures += object.render_meshes->materials.textures.size();
  }
  if (any) printRenderMeshes(sum, textures);
}

}  // namespace

std::string sphereCounts(const std::vector<SetSphere>& spheres, std::size_t radii) {
  std::vector<std::size_t> counts(radii);
  for (const SetSphere& sphere : spheres) ++counts[sphere.radius_index];
  std::reverse(counts.begin(), counts.end());
  return fmt::format("{}", fmt::join(counts, "+"));
}

std::string millimetres(const LengthStatistics& lengths) {
  return fmt::format("{:.1f}/{:.1f}/{:.1f}", 1e3 * lengths.mean, 1e3 * lengths.p95,
                     1e3 * lengths.max);
}

void printObjectTable(const ObjectSetOutcome& outcome, const std::vector<BakedObject>& objects,
                      Verbosity verbosity) {
  std::size_t longest = 6;
  for (const BakedObject& object : objects) longest = std::max(longest, object.name.size());
  const int name_width = static_cast<int>(longest);
  std::vector<float> radii(outcome.radii.rbegin(), outcome.radii.rend());
  fmt::print("{} object{} -> {}\n", objects.size(), objects.size() == 1 ? "" : "s",
             outcome.pack_bytes > 0 ? outcome.output.string() : "(dry run)");
  fmt::print("  {:<{}} {:>9} {:>17} {:>4} {:>6} {:>5} {:>8} {:>4} {:>16} {:>16} {:>5} {:>7}\n",
             "object", name_width, "triangles", "box mm", "fit", "/aabb", "poses", "spheres", "all",
             "gap mm", "protrusion mm", "thin", "seconds");
  for (const BakedObject& object : objects) {
    printObject(object, outcome.radii.size(), name_width);
  }
  printAllRenderMeshes(objects);
  std::vector<std::string> warnings = outcome.warnings;
  for (const BakedObject& object : objects) {
    for (const std::string& warning : object.warnings) {
      warnings.push_back(fmt::format("object '{}': {}", object.name, warning));
    }
  }
  printWarnings(warnings, verbosity);
  fmt::print("  spheres of radius {} m; gap and protrusion: mean/p95/max\n", fmt::join(radii, "+"));
  fmt::print("  {:.3f} s; {:.2f} MB\n", outcome.seconds,
             static_cast<double>(outcome.pack_bytes) / 1e6);
}

}  // namespace galactic::bake
