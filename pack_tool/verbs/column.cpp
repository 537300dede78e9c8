#include <fmt/format.h>

#include "pack_tool/describe/pack_description.h"
#include "pack_tool/support/open_scene.h"
#include "pack_tool/support/text_table.h"
#include "pack_tool/verbs/verbs.h"

namespace galactic::pack_tool {

namespace {

/// The column of one grid nearest to the point; without a cell where the grid does not reach.
struct ColumnAnswer {
  ColumnGrid grid;
  std::optional<ColumnIndex> cell;
  std::vector<Span> spans;
};

ColumnAnswer askGrid(const ColumnGrid& grid, GroundPoint at) {
  ColumnAnswer answer{grid, grid.columnAt(static_cast<float>(at.x), static_cast<float>(at.z)), {}};
  if (answer.cell) readSpans(grid, *answer.cell, answer.spans);
  return answer;
}

Json answerJson(const ColumnAnswer& answer) {
  Json json;
  json["radius"] = jsonNumber(answer.grid.radius());
  json["inside"] = answer.cell.has_value();
  if (!answer.cell) return json;
  const GroundPoint center = columnCenter(answer.grid, *answer.cell);
  json["cell"] = {answer.cell->i, answer.cell->k};
  json["center"] = {center.x, center.z};
  json["spans"] = Json::array();
  for (const Span& span : answer.spans) {
    json["spans"].push_back({{"lo", jsonNumber(span.lo)},
                             {"hi", jsonNumber(span.hi)},
                             {"surface_below", jsonNumber(span.lo - answer.grid.radius())},
                             {"surface_above", jsonNumber(span.hi + answer.grid.radius())}});
  }
  return json;
}

std::string answerText(const ColumnAnswer& answer) {
  const float radius = answer.grid.radius();
  if (!answer.cell) return fmt::format("radius {} m: outside this grid\n", radius);
  const GroundPoint center = columnCenter(answer.grid, *answer.cell);
  const std::string heading =
      fmt::format("radius {} m: cell ({}, {}), column at x {:.6g}, z {:.6g}", radius,
                  answer.cell->i, answer.cell->k, center.x, center.z);
  if (answer.spans.empty()) return heading + ": blocked at all heights\n";
  TextTable table(2);
  table.add({"span", "center from", "center to", "height", "surface below", "surface above"});
  for (std::size_t s = 0; s < answer.spans.size(); ++s) {
    const Span& span = answer.spans[s];
    const auto meters = [](float value) { return fmt::format("{:.4f}", value); };
    table.add({std::to_string(s), meters(span.lo), meters(span.hi), meters(span.hi - span.lo),
               meters(span.lo - radius), meters(span.hi + radius)});
  }
  return heading + '\n' + table.text();
}

Error outsideError(const OpenScene& open, const ColumnGrid& grid, GroundPoint at) {
  const ColumnGridLayout& layout = grid.layout();
  const auto spacing = static_cast<double>(layout.spacing);
  const auto min_x = static_cast<double>(layout.min_x);
  const auto min_z = static_cast<double>(layout.min_z);
  return {ErrorCode::kInvalidInput, open.pack.where(),
          fmt::format("the point x {}, z {} is outside the grid of radius {} m; give one with x in "
                      "[{:.4f}, {:.4f}) and z in [{:.4f}, {:.4f})",
                      at.x, at.z, layout.radius, min_x, min_x + layout.columns_x * spacing, min_z,
                      min_z + layout.columns_z * spacing)};
}

}  // namespace

int runColumn(const ColumnOptions& options, const Console& console) {
  const auto open = OpenScene::open(options.pack, options.trust);
  if (!open) return reportError(console, open.error());
  const auto grids = gridsOf(open->scene, open->pack.where(), options.radius);
  if (!grids) return reportError(console, grids.error());

  std::vector<ColumnAnswer> answers;
  bool inside = false;
  for (const ColumnGrid& grid : *grids) {
    inside |= answers.emplace_back(askGrid(grid, options.at)).cell.has_value();
  }
  // Grids are padded by their radius: near the border only the larger ones answer.
  if (!inside) return reportError(console, outsideError(*open, grids->back(), options.at));

  if (options.form == OutputForm::kJson) {
    Json json;
    json["file"] = open->pack.where();
    json["at"] = {options.at.x, options.at.z};
    json["columns"] = Json::array();
    for (const ColumnAnswer& answer : answers) json["columns"].push_back(answerJson(answer));
    console.out << jsonText(json);
  } else {
    for (const ColumnAnswer& answer : answers) console.out << answerText(answer);
  }
  return kExitOk;
}

}  // namespace galactic::pack_tool
