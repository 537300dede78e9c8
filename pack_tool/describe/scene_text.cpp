#include <fmt/format.h>

#include <functional>

#include "pack_tool/describe/asset_text.h"
#include "pack_tool/describe/text_parts.h"
#include "pack_tool/support/text_table.h"

namespace galactic::pack_tool {

namespace {

std::string headText(const Json& scene) {
  const Json& low = scene.at("bounds").at("min");
  const Json& high = scene.at("bounds").at("max");
  const auto range = [&](std::size_t axis) {
    return fmt::format("{} to {}", lengthOf(low.at(axis)), lengthOf(high.at(axis)));
  };
  const Json& import = scene.at("import");
  std::string text = labeled("scene", textOf(scene.at("name")));
  text += labeled("bounds", fmt::format("x {}, y {}, z {} m", range(0), range(1), range(2)));
  text += labeled("import", fmt::format("{}, {}, {}", textOf(import.at("format")),
                                        countedOf(import.at("meshes"), "mesh"),
                                        countedOf(import.at("instances"), "instance")));
  text += labeled(
      "triangles",
      fmt::format("{} read, {} degenerate and {} duplicate dropped, {} kept",
                  countOf(import.at("triangles_read")), countOf(import.at("triangles_degenerate")),
                  countOf(import.at("triangles_duplicate")), countOf(import.at("triangles"))));
  return text;
}

using GridField = std::function<std::string(const Json&)>;

/// A line of the table: what it tells, and each grid's value.
void addRow(TextTable& table, const Json& grids, std::string label, const GridField& field) {
  std::vector<std::string> line{std::move(label)};
  for (const Json& grid : grids) line.push_back(field(grid));
  table.add(std::move(line));
}

void addFrameRows(TextTable& table, const Json& grids) {
  const auto length = [&](std::string label, const char* key) {
    addRow(table, grids, std::move(label),
           [key](const Json& grid) { return lengthOf(grid.at(key)); });
  };
  length("radius (m)", "radius");
  length("spacing (m)", "spacing");
  addRow(table, grids, "coverage", [](const Json& grid) { return textOf(grid.at("coverage")); });
  addRow(table, grids, "columns x, z", [](const Json& grid) {
    return fmt::format("{} x {}", countOf(grid.at("columns_x")), countOf(grid.at("columns_z")));
  });
  length("from x (m)", "min_x");
  length("from z (m)", "min_z");
  addRow(table, grids, "heights (m)", [](const Json& grid) {
    return fmt::format("{:.3f} to {:.3f}", numberOf(grid.at("heights").at(0)),
                       numberOf(grid.at("heights").at(1)));
  });
  addRow(table, grids, "quantum (um)", [](const Json& grid) {
    return fmt::format("{:.1f}", numberOf(grid.at("quantum")) * 1e6);
  });
  addRow(table, grids, "bytes", [](const Json& grid) { return countOf(grid.at("bytes")); });
}

void addContentRows(TextTable& table, const Json& grids) {
  const auto content = [&](std::string label, const char* key) {
    addRow(table, grids, std::move(label),
           [key](const Json& grid) { return countOf(grid.at("content").at(key)); });
  };
  const auto statistic = [&](std::string label, const char* key) {
    addRow(table, grids, std::move(label),
           [key](const Json& grid) { return countOf(grid.at("statistics").at(key)); });
  };
  content("cells", "cells");
  content("columns with spans", "free_columns");
  content("spans", "spans");
  addRow(table, grids, "spans per such column", [](const Json& grid) {
    return fmt::format("{:.3f}", grid.at("content").at("spans_per_free_column").get<double>());
  });
  content("most spans in a column", "max_spans");
  content("overflow cells", "overflow_cells");
  statistic("spans before the choice", "raw_spans");
  statistic("slivers dropped", "slivers");
  statistic("gaps merged", "merged_gaps");
}

/// The region of this name, null when the bake did not report it.
Json regionOf(const Json& grid, std::string_view name) {
  for (const Json& region : grid.at("statistics").at("regions")) {
    if (region.at("region") == name) return region;
  }
  return nullptr;
}

void addRegionRows(TextTable& table, const Json& grids) {
  for (const char* name : {"room", "outside", "enclosed"}) {
    addRow(table, grids, fmt::format("{} (m3)", name), [name](const Json& grid) {
      const Json region = regionOf(grid, name);
      return region.is_null() ? "-" : fmt::format("{:.3f}", region.at("volume").get<double>());
    });
    addRow(table, grids, fmt::format("{} (parts, spans)", name), [name](const Json& grid) {
      const Json region = regionOf(grid, name);
      if (region.is_null()) return std::string("-");
      return fmt::format("{}, {}", countOf(region.at("components")), countOf(region.at("spans")));
    });
  }
}

void addCastRows(TextTable& table, const Json& grids) {
  const auto cast = [&](std::string label, const std::function<std::string(const Json&)>& field) {
    addRow(table, grids, std::move(label), [&field](const Json& grid) {
      const Json& check = grid.at("statistics").at("cast_check");
      return check.is_null() ? "-" : field(check);
    });
  };
  const auto meters = [&](std::string label, const char* key) {
    cast(std::move(label),
         [key](const Json& check) { return fmt::format("{:.6g}", check.at(key).get<double>()); });
  };
  cast("casts: columns", [](const Json& check) { return countOf(check.at("columns")); });
  cast("casts: differing",
       [](const Json& check) { return countOf(check.at("columns_differing")); });
  meters("casts: compared (m)", "compared");
  meters("casts: method (m)", "method");
  meters("casts: ties (m)", "ties");
  meters("casts: errors (m)", "errors");
}

}  // namespace

std::string sceneText(const Json& scene) {
  const Json& grids = scene.at("column_grids");
  TextTable table(4);
  addFrameRows(table, grids);
  addContentRows(table, grids);
  addRegionRows(table, grids);
  addCastRows(table, grids);
  return headText(scene) + "  column grids\n" + table.text();
}

}  // namespace galactic::pack_tool
