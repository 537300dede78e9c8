#include "pack_tool/diff/diff_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "pack_tool/support/console.h"
#include "pack_tool/support/text_table.h"

namespace galactic::pack_tool {

namespace {

std::string fieldsText(std::string_view heading, const std::vector<FieldDifference>& fields) {
  if (fields.empty()) return {};
  std::string text = fmt::format("{}\n", heading);
  constexpr std::size_t kMostLines = 100;
  const std::size_t shown = std::min(fields.size(), kMostLines);
  for (const FieldDifference& field : std::span(fields).first(shown)) {
    text += fmt::format("  {}: {} | {}\n", printable(field.field), printable(field.a),
                        printable(field.b));
  }
  if (fields.size() > shown) {
    text += fmt::format("  and {} more; --json lists them all\n", fields.size() - shown);
  }
  return text;
}

std::string worstText(const std::vector<ColumnDifference>& worst) {
  TextTable table(4);
  table.add({"most different columns", "x", "z", "cell", "spans A", "spans B", "height (m)"});
  for (const ColumnDifference& column : worst) {
    table.add({"", fmt::format("{:.4f}", column.center.x), fmt::format("{:.4f}", column.center.z),
               fmt::format("({}, {})", column.cell.i, column.cell.k),
               std::to_string(column.spans_a), std::to_string(column.spans_b),
               fmt::format("{:.6f}", column.height)});
  }
  return table.text();
}

std::string gridText(const GridDifference& grid) {
  const std::string heading = fmt::format("grid of radius {} m", grid.radius);
  if (!grid.frame.empty()) {
    return fieldsText(heading + ": other frame, columns not compared", grid.frame);
  }
  if (!grid.differs()) {
    return fmt::format("{}: {} columns equal\n", heading, grouped(grid.columns));
  }
  std::string text = heading + '\n';
  TextTable table(4);
  table.add({"columns compared", grouped(grid.columns)});
  table.add({"other number of spans", grouped(grid.count_differs)});
  table.add({"other span ends", grouped(grid.ends_differ)});
  table.add({"ends that differ", grouped(grid.ends)});
  table.add({"largest difference (m)", fmt::format("{:.3g}", grid.largest_end)});
  table.add({"mean difference (m)", fmt::format("{:.3g}", grid.mean_end)});
  table.add({"free only in A (m3)", fmt::format("{:.6g}", grid.free_only_in_a)});
  table.add({"free only in B (m3)", fmt::format("{:.6g}", grid.free_only_in_b)});
  return text + table.text() + worstText(grid.worst);
}

Json fieldsJson(const std::vector<FieldDifference>& fields) {
  Json json = Json::array();
  for (const FieldDifference& field : fields) {
    json.push_back({{"field", field.field}, {"a", field.a}, {"b", field.b}});
  }
  return json;
}

Json radiiJson(const std::vector<float>& radii) {
  Json json = Json::array();
  for (const float radius : radii) json.push_back(jsonNumber(radius));
  return json;
}

Json gridJson(const GridDifference& grid) {
  Json json;
  json["radius"] = jsonNumber(grid.radius);
  json["differs"] = grid.differs();
  json["frame"] = fieldsJson(grid.frame);
  json["columns"] = grid.columns;
  json["count_differs"] = grid.count_differs;
  json["ends_differ"] = grid.ends_differ;
  json["ends"] = grid.ends;
  json["largest_end"] = grid.largest_end;
  json["mean_end"] = grid.mean_end;
  json["free_only_in_a"] = grid.free_only_in_a;
  json["free_only_in_b"] = grid.free_only_in_b;
  json["worst"] = Json::array();
  for (const ColumnDifference& column : grid.worst) {
    json["worst"].push_back({{"x", column.center.x},
                             {"z", column.center.z},
                             {"cell", Json::array({column.cell.i, column.cell.k})},
                             {"spans_a", column.spans_a},
                             {"spans_b", column.spans_b},
                             {"height", column.height}});
  }
  return json;
}

}  // namespace

bool PackDifference::differs() const {
  return !provenance.empty() || !content.empty() || !radii_only_in_a.empty() ||
         !radii_only_in_b.empty() ||
         std::any_of(grids.begin(), grids.end(),
                     [](const GridDifference& grid) { return grid.differs(); });
}

std::string diffText(const PackDifference& difference) {
  const std::string_view verdict = difference.identical   ? "identical"
                                   : difference.differs() ? "differ"
                                                          : "equal";
  std::string text =
      fmt::format("A {}\nB {}\n{}\n", printable(difference.a), printable(difference.b), verdict);
  if (difference.identical) return text;
  text += fieldsText("provenance (A | B)", difference.provenance);
  text += fieldsText("content (A | B)", difference.content);
  for (const float radius : difference.radii_only_in_a) {
    text += fmt::format("grid of radius {} m: only in A\n", radius);
  }
  for (const float radius : difference.radii_only_in_b) {
    text += fmt::format("grid of radius {} m: only in B\n", radius);
  }
  for (const GridDifference& grid : difference.grids) text += gridText(grid);
  return text;
}

Json diffJson(const PackDifference& difference) {
  Json json;
  json["a"] = difference.a;
  json["b"] = difference.b;
  json["identical"] = difference.identical;
  json["differs"] = difference.differs();
  json["provenance"] = fieldsJson(difference.provenance);
  json["content"] = fieldsJson(difference.content);
  json["radii_only_in_a"] = radiiJson(difference.radii_only_in_a);
  json["radii_only_in_b"] = radiiJson(difference.radii_only_in_b);
  json["grids"] = Json::array();
  for (const GridDifference& grid : difference.grids) json["grids"].push_back(gridJson(grid));
  return json;
}

}  // namespace galactic::pack_tool
