#include "pack_tool/pictures/plan_panel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "pack_tool/mesh/grid_view.h"

namespace galactic::pictures {

namespace {

/// The columns that a row or column of pixels shows: each is shown once, unless it is larger.
struct CellRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::vector<CellRange> cellRanges(int pixels, std::uint32_t cells) {
  std::vector<CellRange> ranges;
  const auto count = static_cast<std::size_t>(pixels);
  for (std::size_t pixel = 0; pixel < count; ++pixel) {
    const std::size_t begin = pixel * cells / count;
    ranges.push_back({begin, std::max(begin + 1, (pixel + 1) * cells / count)});
  }
  return ranges;
}

/// The least value of the columns of a pixel, blocked before all: walls one column thick stay
/// closed, and are drawn no thicker than a pixel.
float leastValue(const PlanPanel& panel, const CellRange& columns, const CellRange& rows) {
  float least = std::numeric_limits<float>::max();
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    const auto first = panel.values.begin() +
                       static_cast<std::ptrdiff_t>(row * panel.grid->columnsX() + columns.begin);
    const auto count = static_cast<std::ptrdiff_t>(columns.end - columns.begin);
    least = std::min(least, *std::min_element(first, first + count));
  }
  return least;
}

/// Spans that begin this close to the lower edge of the grid lie under the scene. Meters: more than
/// the rounding of their ends, less than what a grid extends beyond its scene.
constexpr float kAtEdge = 1e-3F;

/// The lowest span in the scene: what is free from the grid's lower edge on lies under the floor of
/// a scene that is open to the outside, and counts only where nothing is above it.
const Span& lowestOf(const std::vector<Span>& spans, float edge) {
  const bool is_under = spans.front().lo <= edge + kAtEdge && spans.size() > 1;
  return is_under ? spans[1] : spans[0];
}

float valueOf(const std::vector<Span>& spans, PlanValue value, float edge) {
  if (spans.empty()) return kBlockedValue;
  if (value == PlanValue::kSpanCount) return static_cast<float>(spans.size());
  if (value == PlanValue::kLowestHeight) {
    const Span& lowest = lowestOf(spans, edge);
    return lowest.hi - lowest.lo;
  }
  float total = 0;
  for (const Span& span : spans) total += span.hi - span.lo;
  return total;
}

/// A storey is this much of what is under its floor, such as the lower part of a split level, and
/// this much above it, such as a cupboard: meters.
constexpr float kBelowFloor = 1;
constexpr float kAboveFloor = 2.2F;
constexpr Span kNoSpan{std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::quiet_NaN()};

/// The one that begins nearest to the floor.
Span storeySpan(const std::vector<Span>& spans, float floor) {
  Span nearest = kNoSpan;
  for (const Span& span : spans) {
    if (span.lo < floor - kBelowFloor || span.lo > floor + kAboveFloor) continue;
    const bool is_nearer = !(std::abs(nearest.lo - floor) <= std::abs(span.lo - floor));
    if (is_nearer) nearest = span;
  }
  return nearest;
}

/// `value_of(spans)` for each column, row by row along Z.
template <class ValueOf>
auto valuesOf(const ColumnGrid& grid, const ValueOf& value_of) {
  std::vector<decltype(value_of(std::vector<Span>()))> values;
  values.reserve(std::size_t{grid.columnsX()} * grid.columnsZ());
  std::vector<Span> spans;
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      pack_tool::readSpans(grid, {i, k}, spans);
      values.push_back(value_of(spans));
    }
  }
  return values;
}

}  // namespace

std::vector<float> planValues(const ColumnGrid& grid, PlanValue value) {
  return valuesOf(grid, [&grid, value](const std::vector<Span>& spans) {
    return valueOf(spans, value, grid.heights().lo);
  });
}

std::vector<Span> storeySpans(const ColumnGrid& grid, std::optional<float> floor) {
  return valuesOf(grid, [&grid, floor](const std::vector<Span>& spans) {
    if (floor) return storeySpan(spans, *floor);
    return spans.empty() ? kNoSpan : lowestOf(spans, grid.heights().lo);
  });
}

void paintColumns(Image& image, const PlanPanel& panel, const std::function<Rgb(float)>& color_of) {
  const PixelRect& plot = panel.plot;
  const auto columns = cellRanges(plot.width, panel.grid->columnsX());
  const auto rows = cellRanges(plot.height, panel.grid->columnsZ());
  for (std::size_t y = 0; y < rows.size(); ++y) {
    for (std::size_t x = 0; x < columns.size(); ++x) {
      image.set(plot.x + static_cast<int>(x), plot.y + static_cast<int>(y),
                color_of(leastValue(panel, columns[x], rows[y])));
    }
  }
}

}  // namespace galactic::pictures
