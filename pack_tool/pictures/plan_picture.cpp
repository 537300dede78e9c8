#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pack_tool/pictures/axes.h"
#include "pack_tool/pictures/pictures.h"
#include "pack_tool/pictures/plan_panel.h"
#include "pack_tool/pictures/sheet.h"
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

/// Size in pixels: a whole number of pixels per cell, or as large as allowed for huge grids.
PixelRect plotSize(const ColumnGrid& grid, int target_width) {
  const auto x = static_cast<double>(grid.columnsX());
  const auto z = static_cast<double>(grid.columnsZ());
  const double pixels = std::min(target_width / x, std::max(target_width, kLargestHeight) / z);
  const double cell = pixels >= 1 ? std::clamp(std::round(pixels), 1.0, kLargestCell) : pixels;
  return {0, 0, std::max(1, static_cast<int>(std::lround(x * cell))),
          std::max(1, static_cast<int>(std::lround(z * cell)))};
}

void drawColumns(Image& image, const PlanPanel& panel, double top_value) {
  paintColumns(image, panel, [top_value](float value) {
    return value == kBlockedValue ? kBlocked : scaleColor(static_cast<double>(value) / top_value);
  });
}

void drawPanel(Image& image, const PlanPanel& panel, double top_value) {
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
double topValue(const std::vector<PlanPanel>& panels) {
  float largest = 0;
  for (const PlanPanel& panel : panels) {
    largest = std::max(largest, *std::max_element(panel.values.begin(), panel.values.end()));
  }
  return largest > 0 ? static_cast<double>(largest) : 1.0;
}

void drawLegend(Image& image, int x, int y, double top_value, PlanValue value) {
  drawText(image, {x, y}, value == PlanValue::kSpanCount ? "spans" : "meters", kInk);
  const PixelRect bar{x, y + kTextHeight + 14, kBarWidth, kBarHeight};
  drawColorBar(image, bar, top_value);
  Legend{{{"blocked", kBlocked}}}.draw(image, {x, bar.bottom() + 22});
}

}  // namespace

Picture drawPlan(std::span<const ColumnGrid> grids, const FloorPlanOptions& options) {
  std::vector<PlanPanel> panels;
  int x = kMargin;
  int bottom = kBarHeight;
  const int top = kMargin + 2 * kTextHeight + kAxisNameHeight;
  for (const ColumnGrid& grid : grids) {
    PlanPanel& panel = panels.emplace_back(PlanPanel{&grid, planValues(grid, options.value), {}});
    panel.plot =
        plotSize(grid, options.width.value_or(grids.size() == 1 ? kSingleWidth : kSheetWidth));
    panel.plot.x = x + kAxisLabelWidth;
    panel.plot.y = top;
    x = panel.plot.right() + kMargin;
    bottom = std::max(bottom, panel.plot.height);
  }
  const int legend_x = x + kMargin;
  const std::string heading = fmt::format("{}: {}, columns {} m apart",
                                          options.title.empty() ? "plan" : titleOf(options.title),
                                          captionOf(options.value), grids.front().spacing());
  const int width = std::max(legend_x + kLegendWidth, 2 * kMargin + textWidth(heading));
  const int height = top + bottom + kAxisBottomHeight + kTextHeight + 8 + kMargin;

  Image image(width, height, kPaper);
  drawText(image, {kMargin, kMargin}, heading, kInk);
  const double top_value = topValue(panels);
  std::vector<PixelRect> plots;
  for (const PlanPanel& panel : panels) {
    drawPanel(image, panel, top_value);
    plots.push_back(panel.plot);
  }
  drawLegend(image, legend_x, top - kAxisNameHeight, top_value, options.value);
  return {std::move(image), std::move(plots)};
}

}  // namespace galactic::pictures
