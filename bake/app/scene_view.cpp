#include <fmt/format.h>

#include <array>

#include "support/text/counted.h"
#include "support/text/printable.h"
#include "terminal.h"
#include "views.h"

namespace galactic::bake {
namespace {

/// Indexed by Region.
constexpr std::array<const char*, kRegionCount> kRegionNames{"room", "outside", "enclosed"};

std::string castCheckText(const GridFigures& grid) {
  if (!grid.cast_check) return "not checked";
  const CastCheck& check = *grid.cast_check;
  if (check.errors > 0) return fmt::format("{:.1f} mm WRONG", check.errors * 1e3);
  return counted(check.columns, "column") + " checked, none wrong";
}

/// Differences between casts and grid where the grid is right; see docs/column_grids.md.
std::string castDifferences(const GridFigures& grid) {
  if (!grid.cast_check) return {};
  const CastCheck& check = *grid.cast_check;
  return fmt::format(", casts differ in {} columns: at most {:.1f} mm by method, {:.2f} mm ties",
                     check.columns_differing, check.longest * 1e3, check.longest_tie * 1e3);
}

void printGrids(const SceneFigures& scene) {
  fmt::print("  {:>7} {:>9} {:>9} {:>9} {:>8} {:>9} {:>9} {:>9}  {}\n", "radius", "columns", "raw",
             "spans", "MB", "room m3", "outside", "enclosed", "sphere casts");
  for (const GridFigures& grid : scene.grids) {
    fmt::print("  {:>7} {:>9} {:>9} {:>9} {:>8.2f} {:>9.2f} {:>9.2f} {:>9.2f}  {}\n",
               fmt::format("{}", grid.radius), std::uint64_t{grid.columns[0]} * grid.columns[1],
               grid.raw_spans, grid.spans, static_cast<double>(grid.stored_bytes) / 1e6,
               grid.regions[0].volume, grid.regions[1].volume, grid.regions[2].volume,
               castCheckText(grid));
  }
}

void printDetails(const SceneFigures& scene) {
  for (const GridFigures& grid : scene.grids) {
    fmt::print(
        "  radius {}: {} merged gaps, {} slivers, at most {} spans in a column, {} parts{}\n",
        grid.radius, grid.merged_gaps, grid.slivers, grid.max_spans_per_column, grid.parts,
        castDifferences(grid));
    for (const GridFigures::Part& part : grid.largest_parts) {
      fmt::print("    {:>8} {:10.4f} m3  ({:.2f}, {:.2f}, {:.2f}) to ({:.2f}, {:.2f}, {:.2f})\n",
                 kRegionNames[static_cast<std::size_t>(part.region)], part.volume,
                 part.bounds.min.x, part.bounds.min.y, part.bounds.min.z, part.bounds.max.x,
                 part.bounds.max.y, part.bounds.max.z);
    }
  }
}

}  // namespace

void printTable(const SceneFigures& scene, const PackFigures& pack, Verbosity verbosity) {
  const Bounds& bounds = scene.bounds;
  fmt::print("{} -> {}\n", scene.input, targetOf(pack));
  fmt::print("  {}, {}; {}, {}\n", scene.imported.format, withFlags(scene.convention),
             counted(scene.imported.meshes, "mesh"), counted(scene.imported.instances, "instance"));
  fmt::print(
      "  {} ({} degenerate, {} duplicate dropped), {:.2f} x {:.2f} m and {:.2f} m "
      "high, y from {:.3f} to {:.3f} m\n",
      counted(scene.imported.triangles, "triangle"), scene.imported.counts.degenerate,
      scene.imported.counts.duplicate, bounds.max.x - bounds.min.x, bounds.max.z - bounds.min.z,
      bounds.max.y - bounds.min.y, bounds.min.y, bounds.max.y);
  printGrids(scene);
  printRenderMeshes(scene.render_meshes);
  if (verbosity == Verbosity::kVerbose) printDetails(scene);
  printWarnings(scene.warnings, verbosity);
  const StageTimes& t = scene.seconds;
  const double total =
      t.import + t.clean + t.columns + t.regions + t.encode + t.check + t.render + t.write;
  fmt::print(
      "  {:.3f} s: import {:.3f}, clean {:.3f}, columns {:.3f}, regions {:.3f}, encode "
      "{:.3f}, check {:.3f}, render {:.3f}, write {:.3f}; {:.2f} MB\n",
      total, t.import, t.clean, t.columns, t.regions, t.encode, t.check, t.render, t.write,
      static_cast<double>(pack.pack_bytes) / 1e6);
}

}  // namespace galactic::bake
