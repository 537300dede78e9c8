#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "galactic/scene.h"
#include "layout/column_cell.h"
#include "pack_tool/describe/asset_json.h"
#include "pack_tool/describe/json_parts.h"

namespace galactic::pack_tool {

namespace {

std::string regionName(schema::Region region) {
  switch (region) {
    case schema::Region::Room:
      return "room";
    case schema::Region::Outside:
      return "outside";
    case schema::Region::Enclosed:
      return "enclosed";
  }
  return fmt::format("unknown ({})", static_cast<unsigned>(region));
}

std::string coverageName(schema::Coverage coverage) {
  switch (coverage) {
    case schema::Coverage::Column:
      return "column";
    case schema::Coverage::Cell:
      return "cell";
  }
  return fmt::format("unknown ({})", static_cast<unsigned>(coverage));
}

Json describeStatistics(const schema::GridStatistics& statistics) {
  Json json;
  json["raw_spans"] = statistics.raw_spans();
  json["spans"] = statistics.spans();
  json["max_spans_per_column"] = statistics.max_spans_per_column();
  json["slivers"] = statistics.slivers();
  json["merged_gaps"] = statistics.merged_gaps();
  json["regions"] = Json::array();
  if (statistics.regions() != nullptr) {
    for (const auto* region : *statistics.regions()) {
      json["regions"].push_back({{"region", regionName(region->region())},
                                 {"components", region->components()},
                                 {"spans", region->spans()},
                                 {"volume", region->volume()}});
    }
  }
  json["cast_check"] = nullptr;
  if (const schema::CastCheck* check = statistics.cast_check()) {
    json["cast_check"] = {
        {"columns", check->columns()},   {"columns_differing", check->columns_differing()},
        {"compared", check->compared()}, {"method", check->method()},
        {"ties", check->ties()},         {"errors", check->errors()}};
  }
  return json;
}

/// What the cells themselves say, whatever the statistics claim.
Json countCells(const ColumnGrid& grid) {
  std::uint64_t free_columns = 0;
  std::uint64_t spans = 0;
  std::uint64_t overflow_cells = 0;
  std::uint64_t most = 0;
  const ColumnGridLayout& layout = grid.layout();
  for (std::uint32_t k = 0; k < layout.columns_z; ++k) {
    for (std::uint32_t i = 0; i < layout.columns_x; ++i) {
      const std::uint64_t count = grid.spanCount(i, k);
      spans += count;
      if (count > 0) ++free_columns;
      most = std::max(most, count);
      if (isOverflow(layout.cells[cellIndex(i, k, layout.tiles_x)])) ++overflow_cells;
    }
  }
  const std::uint64_t cells = std::uint64_t{layout.columns_x} * layout.columns_z;
  const double per_column =
      static_cast<double>(spans) / static_cast<double>(std::max<std::uint64_t>(free_columns, 1));
  return {{"cells", cells},    {"free_columns", free_columns},
          {"spans", spans},    {"spans_per_free_column", per_column},
          {"max_spans", most}, {"overflow_cells", overflow_cells}};
}

Json describeGrid(const schema::ColumnGrid& stored, const ColumnGrid& grid) {
  Json json;
  json["radius"] = jsonNumber(stored.radius());
  json["spacing"] = jsonNumber(stored.spacing());
  json["coverage"] = coverageName(stored.coverage());
  json["min_x"] = jsonNumber(stored.min_x());
  json["min_z"] = jsonNumber(stored.min_z());
  json["columns_x"] = stored.columns_x();
  json["columns_z"] = stored.columns_z();
  json["heights"] = Json::array({jsonNumber(grid.heights().lo), jsonNumber(grid.heights().hi)});
  json["quantum"] = jsonNumber(stored.quantum());
  json["bytes"] = std::uint64_t{stored.cells()->size()} * sizeof(std::uint64_t) +
                  std::uint64_t{stored.tile_base()->size()} * sizeof(std::uint16_t) +
                  std::uint64_t{stored.overflow_codes()->size()} * sizeof(std::uint32_t) +
                  std::uint64_t{stored.overflow_spans()->size()} * sizeof(schema::Span);
  json["content"] = countCells(grid);
  json["statistics"] = describeStatistics(*stored.statistics());
  return json;
}

}  // namespace

Json describeScene(const PackFile& pack) {
  const auto scene = Scene::from(pack);
  if (!scene) return nullptr;
  const schema::Scene& stored = *pack.root().asset_as_Scene();
  Json json;
  json["name"] = stored.name()->str();
  json["bounds"] = {{"min", describePoint(stored.bounds()->min())},
                    {"max", describePoint(stored.bounds()->max())}};
  json["import"] = describeImport(*stored.import_statistics());
  json["column_grids"] = Json::array();
  for (std::size_t g = 0; g < scene->grids().size(); ++g) {
    const auto index = static_cast<flatbuffers::uoffset_t>(g);
    json["column_grids"].push_back(
        describeGrid(*stored.column_grids()->Get(index), scene->grids()[g]));
  }
  return json;
}

}  // namespace galactic::pack_tool
