#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "support/printable.h"
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
      object.spheres.spheres.size(), millimeters(object.spheres.quality.gap),
      millimeters(object.spheres.quality.protrusion), object.spheres.quality.thin_points,
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

Json toJson(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

/// Order of text: w, x, y, z.
Json toJson(const Quat& q) { return Json::array({q.w, q.x, q.y, q.z}); }

Json toJson(const LengthStatistics& lengths) {
  return {{"mean", lengths.mean}, {"p95", lengths.p95}, {"max", lengths.max}};
}

Json toJson(const BoxFitResult& fit) {
  return {{"center", toJson(fit.box.pose.translation)},
          {"rotation_wxyz", toJson(fit.box.pose.rotation)},
          {"half_extents", toJson(fit.box.half_extents)},
          {"volume", fit.volume},
          {"axis_aligned_volume", fit.axis_aligned_volume},
          {"pca_volume", fit.pca_volume}};
}

Json objectEntry(const BakedObject& object, const ObjectSetOutcome::Origin& origin,
                 std::size_t radii) {
  Json json{{"name", object.name},
            {"format", object.imported.format},
            {"triangles",
             {{"read", object.imported.counts.read},
              {"degenerate", object.imported.counts.degenerate},
              {"duplicate", object.imported.counts.duplicate},
              {"kept", object.imported.triangles}}},
            {"box", toJson(object.box)},
            {"authored_spheres", object.authored_spheres},
            {"spheres", sphereSetReport(object.spheres, radii)}};
  json["stable_poses"] = Json::array();
  for (const StablePose& pose : object.stable_poses) {
    json["stable_poses"].push_back({{"rotation_wxyz", toJson(pose.rotation)},
                                    {"height", pose.height},
                                    {"likelihood", pose.likelihood}});
  }
  json["seconds"] = {{"import", origin.import_seconds},
                     {"box", object.times.box},
                     {"stable_poses", object.times.stable_poses},
                     {"spheres", object.times.spheres},
                     {"render", object.times.render}};
  if (object.render_meshes) json["render_meshes"] = renderReport(*object.render_meshes);
  json["warnings"] = withFlags(object.warnings);
  return json;
}

}  // namespace

std::string sphereCounts(const std::vector<SetSphere>& spheres, std::size_t radii) {
  std::vector<std::size_t> counts(radii);
  for (const SetSphere& sphere : spheres) ++counts[sphere.radius_index];
  std::reverse(counts.begin(), counts.end());
  return fmt::format("{}", fmt::join(counts, "+"));
}

std::string millimeters(const LengthStatistics& lengths) {
  return fmt::format("{:.1f}/{:.1f}/{:.1f}", 1e3 * lengths.mean, 1e3 * lengths.p95,
                     1e3 * lengths.max);
}

void printTable(const ObjectSetOutcome& outcome, const Made& made, Verbosity verbosity) {
  const std::vector<BakedObject>& objects = outcome.objects;
  std::size_t longest = 6;
  for (const BakedObject& object : objects) longest = std::max(longest, object.name.size());
  const int name_width = static_cast<int>(longest);
  std::vector<float> radii(outcome.radii.rbegin(), outcome.radii.rend());
  fmt::print("{} object{} -> {}\n", objects.size(), objects.size() == 1 ? "" : "s",
             made.pack_bytes > 0 ? made.output.string() : "(dry run)");
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
             static_cast<double>(made.pack_bytes) / 1e6);
}

Json sphereSetReport(const SphereSet& set, std::size_t radii) {
  std::vector<std::size_t> counts(radii);
  for (const SetSphere& sphere : set.spheres) ++counts[sphere.radius_index];
  const SphereSetQuality& quality = set.quality;
  return {{"count", set.spheres.size()},
          {"count_per_radius", counts},
          {"gap", toJson(quality.gap)},
          {"protrusion", toJson(quality.protrusion)},
          {"volume_ratio", quality.volume_ratio},
          {"thin_points", quality.thin_points},
          {"samples", quality.samples},
          {"guaranteed_gap", set.guaranteed_gap},
          {"guaranteed_protrusion", set.guaranteed_protrusion},
          {"meets_tolerances", set.meets_tolerances}};
}

Json reportEntries(const ObjectSetOutcome& outcome, const Made& made) {
  Json entries = Json::array();
  for (std::size_t n = 0; n < outcome.objects.size(); ++n) {
    Json entry{{"input", outcome.origins[n].input.string()},
               {"output", made.output.string()},
               {"pack_bytes", made.pack_bytes}};
    entry.update(objectEntry(outcome.objects[n], outcome.origins[n], outcome.radii.size()));
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace galactic::bake
