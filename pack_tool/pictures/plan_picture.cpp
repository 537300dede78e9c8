#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "pack_tool/pictures/axes.h"
#include "pack_tool/pictures/pictures.h"
#include "pictures/palette.h"

namespace galactic::pictures {

namespace {

constexpr int kMargin = 24;
constexpr int kBarWidth = 24;
constexpr int kBarHeight = 320;
/// Room for the color bar, its labels and its caption.
constexpr int kLegendWidth = 12 * kTextAdvance;
/// Width that a single plot and one of several plots aim at where nothing is asked for.
constexpr int kSingleWidth = 1000;
constexpr int kSheetWidth = 560;
/// Of a plot, where it is not asked to be as wide.
constexpr int kLargestHeight = 2000;
/// Pixels of a cell's edge: more would only make tiny grids huge.
constexpr double kLargestCell = 32;
constexpr float kBlockedValue = -1;

/// One grid's part of the picture.
struct Panel {
  const ColumnGrid* grid = nullptr;
  /// One per column, row by row; kBlockedValue where there is no span.
  std::vector<float> values;
  PixelRect plot;
};

/// Spans that begin this close to the lower edge of the grid lie under the scene. Meters: more than
/// the rounding of their ends, less than what a grid extends beyond its scene.
constexpr float kAtEdge = 1e-3F;

/// The height of the lowest span in the scene: what is free from the grid's lower edge on lies
/// under the floor of a scene that is open to the outside, and counts only where nothing is above
/// it.
float lowestHeight(const std::vector<Span>& spans, float edge) {
  const bool is_under = spans.front().lo <= edge + kAtEdge && spans.size() > 1;
  const Span& lowest = is_under ? spans[1] : spans[0];
  return lowest.hi - lowest.lo;
}

float valueOf(const std::vector<Span>& spans, PlanValue value, float edge) {
  if (spans.empty()) return kBlockedValue;
  if (value == PlanValue::kSpanCount) return static_cast<float>(spans.size());
  if (value == PlanValue::kLowestHeight) return lowestHeight(spans, edge);
  float total = 0;
  for (const Span& span : spans) total += span.hi - span.lo;
  return total;
}

std::vector<float> planValues(const ColumnGrid& grid, PlanValue value) {
  std::vector<float> values;
  values.reserve(std::size_t{grid.columnsX()} * grid.columnsZ());
  std::vector<Span> spans;
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      pack_tool::readSpans(grid, {i, k}, spans);
      values.push_back(valueOf(spans, value, grid.heights().lo));
    }
  }
  return values;
}

/// Size in pixels: a whole number of pixels per cell, or as large as allowed for huge grids.
PixelRect plotSize(const ColumnGrid& grid, int target_width) {
  const auto x = static_cast<double>(grid.columnsX());
  const auto z = static_cast<double>(grid.columnsZ());
  const double pixels = std::min(target_width / x, std::max(target_width, kLargestHeight) / z);
  const double cell = pixels >= 1 ? std::clamp(std::round(pixels), 1.0, kLargestCell) : pixels;
  return {0, 0, std::max(1, static_cast<int>(std::lround(x * cell))),
          std::max(1, static_cast<int>(std::lround(z * cell)))};
}

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
float leastValue(const Panel& panel, const CellRange& columns, const CellRange& rows) {
  float least = std::numeric_limits<float>::max();
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    const auto first = panel.values.begin() +
                       static_cast<std::ptrdiff_t>(row * panel.grid->columnsX() + columns.begin);
    const auto count = static_cast<std::ptrdiff_t>(columns.end - columns.begin);
    least = std::min(least, *std::min_element(first, first + count));
  }
  return least;
}

void drawColumns(Image& image, const Panel& panel, double top_value) {
  const PixelRect& plot = panel.plot;
  const auto columns = cellRanges(plot.width, panel.grid->columnsX());
  const auto rows = cellRanges(plot.height, panel.grid->columnsZ());
  for (std::size_t y = 0; y < rows.size(); ++y) {
    for (std::size_t x = 0; x < columns.size(); ++x) {
      const float value = leastValue(panel, columns[x], rows[y]);
      const bool blocked = value == kBlockedValue;
      image.set(plot.x + static_cast<int>(x), plot.y + static_cast<int>(y),
                blocked ? kBlocked : scaleColor(static_cast<double>(value) / top_value));
    }
  }
}

void drawPanel(Image& image, const Panel& panel, double top_value) {
  const ColumnGridLayout& layout = panel.grid->layout();
  const PixelRect& plot = panel.plot;
  const auto spacing = static_cast<double>(layout.spacing);
  const auto min_x = static_cast<double>(layout.min_x);
  const auto min_z = static_cast<double>(layout.min_z);
  drawColumns(image, panel, top_value);
  drawFrame(image, plot, kInk);
  drawText(image, {plot.x + plot.width / 2, plot.y - kAxisNameHeight, Anchor::kCenter},
           fmt::format("radius {} m", layout.radius), kInk);
  const AxisScale x_scale{min_x, min_x + layout.columns_x * spacing, plot.x, plot.right()};
  drawHorizontalAxis(image, plot, x_scale, "x (m)");
  drawVerticalAxis(image, plot, {min_z, min_z + layout.columns_z * spacing, plot.y, plot.bottom()},
                   "z (m)");
  drawScaleBar(image, {plot.x, plot.bottom() + kAxisBottomHeight + 8}, x_scale.pixelsPerUnit());
}

std::string_view captionOf(PlanValue value) {
  switch (value) {
    case PlanValue::kLowestHeight:
      return "height of the lowest free span";
    case PlanValue::kSpanCount:
      return "number of free spans";
    case PlanValue::kTotalHeight:
      break;
  }
  return "total free height";
}

/// The top of the color scale: the largest value, or 1 when everything is blocked.
double topValue(const std::vector<Panel>& panels) {
  float largest = 0;
  for (const Panel& panel : panels) {
    largest = std::max(largest, *std::max_element(panel.values.begin(), panel.values.end()));
  }
  return largest > 0 ? static_cast<double>(largest) : 1.0;
}

void drawLegend(Image& image, int x, int y, double top_value, PlanValue value) {
  drawText(image, {x, y}, value == PlanValue::kSpanCount ? "spans" : "meters", kInk);
  const PixelRect bar{x, y + kTextHeight + 14, kBarWidth, kBarHeight};
  drawColorBar(image, bar, top_value);
  drawSwatch(image, x, bar.bottom() + 22, kBlocked, "blocked");
}

}  // namespace

Picture drawPlan(std::span<const ColumnGrid> grids, const FloorPlanOptions& options) {
  std::vector<Panel> panels;
  int x = kMargin;
  int bottom = kBarHeight;
  const int top = kMargin + 2 * kTextHeight + kAxisNameHeight;
  for (const ColumnGrid& grid : grids) {
    Panel& panel = panels.emplace_back(Panel{&grid, planValues(grid, options.value), {}});
    panel.plot =
        plotSize(grid, options.width.value_or(grids.size() == 1 ? kSingleWidth : kSheetWidth));
    panel.plot.x = x + kAxisLabelWidth;
    panel.plot.y = top;
    x = panel.plot.right() + kMargin;
    bottom = std::max(bottom, panel.plot.height);
  }
  const int legend_x = x + kMargin;
  const std::string heading =
      fmt::format("{}: {}, columns {} m apart", options.title.empty() ? "plan" : options.title,
                  captionOf(options.value), grids.front().spacing());
  const int width = std::max(legend_x + kLegendWidth, 2 * kMargin + textWidth(heading));
  const int height = top + bottom + kAxisBottomHeight + kTextHeight + 8 + kMargin;

  Image image(width, height, kPaper);
  drawText(image, {kMargin, kMargin}, heading, kInk);
  const double top_value = topValue(panels);
  std::vector<PixelRect> plots;
  for (const Panel& panel : panels) {
    drawPanel(image, panel, top_value);
    plots.push_back(panel.plot);
  }
  drawLegend(image, legend_x, top - kAxisNameHeight, top_value, options.value);
  return {std::move(image), std::move(plots)};
}

}  // namespace galactic::pictures
