#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "support/printable.h"
#include "terminal.h"
#include "views.h"

namespace galactic::bake {
namespace {

constexpr std::array<const char*, kRegionCount> kRegionNames{"room", "outside", "enclosed"};

std::string castCheckText(const BakedGrid& grid) {
  if (!grid.cast_check) return "not checked";
  const CastCheck& check = *grid.cast_check;
  if (check.errors > 0) return fmt::format("{:.1f} mm WRONG", check.errors * 1e3);
  if (check.columns_differing == 0) {
    return fmt::format("0 errors, {} columns agree", check.columns);
  }
  if (check.longest == 0) {
    return fmt::format("0 errors, {} of {} columns differ in ties: surfaces just at the radius",
                       check.columns_differing, check.columns);
  }
  return fmt::format(
      "0 errors, {} of {} columns differ, by {:.1f} mm at most: steps and pad of the casts",
      check.columns_differing, check.columns, check.longest * 1e3);
}

void printGrids(const BakedScene& scene) {
  fmt::print("  {:>7} {:>9} {:>9} {:>9} {:>8} {:>9} {:>9} {:>9}  {}\n", "radius", "columns", "raw",
             "spans", "MB", "room m3", "outside", "enclosed", "sphere casts");
  for (const BakedGrid& grid : scene.grids) {
    fmt::print("  {:>7} {:>9} {:>9} {:>9} {:>8.2f} {:>9.2f} {:>9.2f} {:>9.2f}  {}\n",
               fmt::format("{}", grid.grid.frame.radius), grid.grid.frame.columnCount(),
               grid.raw_spans, grid.grid.spans, static_cast<double>(storedBytes(grid.grid)) / 1e6,
               grid.totals[0].volume, grid.totals[1].volume, grid.totals[2].volume,
               castCheckText(grid));
  }
}

void printDetails(const BakedScene& scene) {
  constexpr std::size_t kShown = 8;
  for (const BakedGrid& grid : scene.grids) {
    fmt::print("  radius {}: {} merged gaps, {} slivers, at most {} spans in a column, {} parts\n",
               grid.grid.frame.radius, grid.merged_gaps, grid.grid.slivers,
               grid.grid.max_spans_per_column, grid.components.size());
    for (std::size_t i = 0; i < std::min(kShown, grid.components.size()); ++i) {
      const Component& part = grid.components[i];
      fmt::print("    {:>8} {:10.4f} m3  ({:.2f}, {:.2f}, {:.2f}) to ({:.2f}, {:.2f}, {:.2f})\n",
                 kRegionNames[static_cast<std::size_t>(part.region)], part.volume,
                 part.bounds.min.x, part.bounds.min.y, part.bounds.min.z, part.bounds.max.x,
                 part.bounds.max.y, part.bounds.max.z);
    }
  }
}

Json toJson(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json toJson(const Bounds& bounds) {
  return {{"min", toJson(bounds.min)}, {"max", toJson(bounds.max)}};
}

Json toJson(const CastCheck& check) {
  return {{"columns", check.columns},   {"columns_differing", check.columns_differing},
          {"compared", check.compared}, {"method", check.method},
          {"ties", check.ties},         {"errors", check.errors},
          {"longest", check.longest}};
}

Json toJson(const BakedGrid& baked) {
  const EncodedGrid& grid = baked.grid;
  Json json{{"radius", grid.frame.radius},
            {"spacing", grid.frame.spacing},
            {"columns", Json::array({grid.frame.columns_x, grid.frame.columns_z})},
            {"raw_spans", baked.raw_spans},
            {"spans", grid.spans},
            {"max_spans_per_column", grid.max_spans_per_column},
            {"overflow_columns", grid.overflow_columns},
            {"merged_gaps", baked.merged_gaps},
            {"slivers", grid.slivers}};
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    const RegionTotals& totals = baked.totals[region];
    json["regions"][kRegionNames[region]] = {
        {"components", totals.components}, {"spans", totals.spans}, {"volume", totals.volume}};
  }
  if (baked.cast_check) json["cast_check"] = toJson(*baked.cast_check);
  return json;
}

}  // namespace

void printTable(const SceneOutcome& outcome, const Made& made, Verbosity verbosity) {
  const BakedScene& scene = outcome.scene;
  const Bounds& bounds = scene.bounds;
  fmt::print("{} -> {}\n", outcome.input.string(),
             made.pack_bytes > 0 ? made.output.string() : "(dry run)");
  fmt::print("  {}, {}; {} meshes, {} instances\n", scene.imported.format,
             withFlags(outcome.convention), scene.imported.meshes, scene.imported.instances);
  fmt::print(
      "  {} triangles ({} degenerate, {} duplicate dropped), {:.2f} x {:.2f} x {:.2f} m, "
      "y from {:.3f} to {:.3f} m\n",
      scene.imported.triangles, scene.imported.counts.degenerate, scene.imported.counts.duplicate,
      bounds.max.x - bounds.min.x, bounds.max.y - bounds.min.y, bounds.max.z - bounds.min.z,
      bounds.min.y, bounds.max.y);
  printGrids(scene);
  printRenderMeshes(scene.render_meshes);
  if (verbosity == Verbosity::kVerbose) printDetails(scene);
  printWarnings(scene.warnings, verbosity);
  const StageTimes& t = outcome.times;
  const double total =
      t.import + t.clean + t.columns + t.regions + t.encode + t.check + t.render + t.write;
  fmt::print(
      "  {:.3f} s: import {:.3f}, clean {:.3f}, columns {:.3f}, regions {:.3f}, encode "
      "{:.3f}, check {:.3f}, render {:.3f}, write {:.3f}; {:.2f} MB\n",
      total, t.import, t.clean, t.columns, t.regions, t.encode, t.check, t.render, t.write,
      static_cast<double>(made.pack_bytes) / 1e6);
}

Json reportEntries(const SceneOutcome& outcome, const Made& made) {
  const BakedScene& scene = outcome.scene;
  const StageTimes& times = outcome.times;
  Json json{{"input", outcome.input.string()},
            {"output", made.output.string()},
            {"pack_bytes", made.pack_bytes},
            {"format", scene.imported.format},
            {"convention", withFlags(outcome.convention)},
            {"bounds", toJson(scene.bounds)},
            {"triangles",
             {{"read", scene.imported.counts.read},
              {"degenerate", scene.imported.counts.degenerate},
              {"duplicate", scene.imported.counts.duplicate},
              {"kept", scene.imported.triangles}}},
            {"seconds",
             {{"import", times.import},
              {"clean", times.clean},
              {"columns", times.columns},
              {"regions", times.regions},
              {"encode", times.encode},
              {"check", times.check},
              {"render", times.render},
              {"write", times.write}}},
            {"warnings", withFlags(scene.warnings)}};
  if (scene.render_meshes) json["render_meshes"] = renderReport(*scene.render_meshes);
  json["grids"] = Json::array();
  for (const BakedGrid& grid : scene.grids) json["grids"].push_back(toJson(grid));
  return Json::array({std::move(json)});
}

}  // namespace galactic::bake
