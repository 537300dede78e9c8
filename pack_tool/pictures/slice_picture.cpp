#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pack_tool/pictures/axes.h"
#include "pack_tool/pictures/pictures.h"
#include "pack_tool/pictures/sheet.h"
#include "pictures/palette.h"
#include "support/try.h"

namespace galactic::pictures {

namespace {

using pack_tool::GroundPoint;

constexpr int kMargin = 24;
constexpr int kSmallestPlotWidth = 240;
constexpr int kLargestPlotHeight = 900;
constexpr int kLineGap = 36;
constexpr double kLineStrength = 0.18;

double lengthOf(const SliceOptions& options) {
  return std::hypot(options.to.x - options.from.x, options.to.z - options.from.z);
}

GroundPoint pointAt(const SliceOptions& options, double share) {
  return {options.from.x + (options.to.x - options.from.x) * share,
          options.from.z + (options.to.z - options.from.z) * share};
}

double heightRange(const ColumnGrid& grid) {
  return static_cast<double>(grid.heights().hi) - static_cast<double>(grid.heights().lo);
}

PixelRect plotSize(const ColumnGrid& grid, double length, int wanted_width) {
  const int target_width = std::max(wanted_width, kSmallestPlotWidth);
  const double range = std::max(heightRange(grid), 1e-3);
  const double pixels_per_meter =
      std::min(target_width / length, std::max(target_width, kLargestPlotHeight) / range);
  const int width = static_cast<int>(std::lround(length * pixels_per_meter));
  const int height = static_cast<int>(std::lround(range * pixels_per_meter));
  return {0, 0, std::max(width, kSmallestPlotWidth), std::max(height, 1)};
}

/// Paints the free spans of one column into one column of pixels.
void drawSpans(Image& image, const PixelRect& plot, int x, const AxisScale& heights,
               const std::vector<Span>& spans) {
  fillRect(image, {x, plot.y, 1, plot.height}, kBlocked);
  for (const Span& span : spans) {
    // A pixel is free when its center is.
    // Clamped as doubles: a span may lie far outside what an integer holds.
    const auto pixel_of = [&](double position) {
      return static_cast<int>(std::clamp(position, static_cast<double>(plot.y - 1),
                                         static_cast<double>(plot.bottom())));
    };
    const double top = heights.position(static_cast<double>(span.hi));
    const double bottom = heights.position(static_cast<double>(span.lo));
    const int first = std::max(plot.y, pixel_of(std::ceil(top - 0.5)));
    const int last = std::min(plot.bottom() - 1, pixel_of(std::floor(bottom - 0.5)));
    fillRect(image, {x, first, 1, last - first + 1}, kFree);
  }
}

/// Lines at the round heights, faint enough not to be taken for a surface.
void drawHeightLines(Image& image, const PixelRect& plot, const AxisScale& heights) {
  for (const Tick& tick : axisTicks(heights, kLineGap)) {
    if (tick.pixel < plot.y || tick.pixel >= plot.bottom()) continue;
    for (int x = plot.x; x < plot.right(); ++x) {
      image.set(x, tick.pixel, blend(image.at(x, tick.pixel), kFaintInk, kLineStrength));
    }
  }
}

void drawPlot(Image& image, const PixelRect& plot, const ColumnGrid& grid,
              const SliceOptions& options) {
  const AxisScale heights{static_cast<double>(grid.heights().hi),
                          static_cast<double>(grid.heights().lo), plot.y, plot.bottom()};
  std::vector<Span> spans;
  for (int x = 0; x < plot.width; ++x) {
    const pack_tool::GroundPoint point = pointAt(options, (x + 0.5) / plot.width);
    const auto cell = grid.columnAt(static_cast<float>(point.x), static_cast<float>(point.z));
    if (!cell) {
      fillRect(image, {plot.x + x, plot.y, 1, plot.height}, kUncovered);
      continue;
    }
    pack_tool::readSpans(grid, *cell, spans);
    drawSpans(image, plot, plot.x + x, heights, spans);
  }
  drawHeightLines(image, plot, heights);
  drawFrame(image, plot, kInk);
  drawText(image, {plot.x + plot.width / 2, plot.y - kAxisNameHeight, Anchor::kCenter},
           fmt::format("radius {} m", grid.radius()), kInk);
  drawHorizontalAxis(image, plot, {0, lengthOf(options), plot.x, plot.right()},
                     "along the line (m)");
  drawVerticalAxis(image, plot, heights, "height (m)");
}

/// A part of a line, as shares of its length.
struct LinePart {
  double begin = 0;
  double end = 1;

  [[nodiscard]] bool isEmpty() const { return !(begin < end); }
  /// Leaves what is also between two values of a coordinate that goes from `from` to `to`.
  void clip(double from, double to, double low, double high) {
    const double way = to - from;
    if (way == 0) {
      if (from < low || from > high) end = begin;
      return;
    }
    const auto [first, last] = std::minmax({(low - from) / way, (high - from) / way});
    begin = std::max(begin, first);
    end = std::min(end, last);
  }
};

/// What of the line is over the grid (Liang and Barsky, "A new concept and method for line
/// clipping", 1984).
LinePart partOver(const ColumnGrid& grid, const SliceOptions& options) {
  const ColumnGridLayout& layout = grid.layout();
  const auto spacing = static_cast<double>(layout.spacing);
  const auto low_x = static_cast<double>(layout.min_x);
  const auto low_z = static_cast<double>(layout.min_z);
  LinePart part;
  part.clip(options.from.x, options.to.x, low_x, low_x + layout.columns_x * spacing);
  part.clip(options.from.z, options.to.z, low_z, low_z + layout.columns_z * spacing);
  return part;
}

/// What of the line is over any of the grids, and between.
LinePart partOver(std::span<const ColumnGrid> grids, const SliceOptions& options) {
  LinePart all{1, 0};
  for (const ColumnGrid& grid : grids) {
    const LinePart part = partOver(grid, options);
    if (part.isEmpty()) continue;
    all = {std::min(all.begin, part.begin), std::max(all.end, part.end)};
  }
  return all;
}

/// The line, or where hardly any of it is over the grids that part alone, and at least a cell.
SliceOptions withoutVoid(std::span<const ColumnGrid> grids, const SliceOptions& options) {
  constexpr double kLeastShare = 0.05;
  const LinePart part = partOver(grids, options);
  const double share = part.end - part.begin;
  if (share >= kLeastShare) return options;
  const double cell = static_cast<double>(grids.front().spacing()) / lengthOf(options);
  const double more = std::max(0.0, cell - share) / 2;
  SliceOptions shorter = options;
  shorter.from = pointAt(options, std::max(part.begin - more, 0.0));
  shorter.to = pointAt(options, std::min(part.end + more, 1.0));
  return shorter;
}

Result<void> checkLine(std::span<const ColumnGrid> grids, const SliceOptions& options) {
  const std::string line = fmt::format("the line from x {}, z {} to x {}, z {}", options.from.x,
                                       options.from.z, options.to.x, options.to.z);
  const double length = lengthOf(options);
  const auto spacing = static_cast<double>(grids.front().spacing());
  if (!(length >= spacing) || !std::isfinite(length)) {
    return fail(ErrorCode::kInvalidInput, "slice",
                fmt::format("{} is {} m long; give two points at least a cell ({} m) apart", line,
                            length, grids.front().spacing()));
  }
  if (!partOver(grids, options).isEmpty()) return {};
  const ColumnGridLayout& layout = grids.front().layout();
  const GroundPoint low{static_cast<double>(layout.min_x), static_cast<double>(layout.min_z)};
  return fail(ErrorCode::kInvalidInput, "slice",
              fmt::format("{} misses the grid; it covers x {:.3f} to {:.3f}, z {:.3f} to {:.3f} m",
                          line, low.x, low.x + layout.columns_x * spacing, low.z,
                          low.z + layout.columns_z * spacing));
}

void drawMeanings(Image& image, int x, int y) {
  const Legend legend{{{"free for the sphere's center", kFree},
                       {"blocked", kBlocked},
                       {"outside the grid", kUncovered}}};
  legend.draw(image, {x, y});
}

}  // namespace

Result<Picture> drawSlice(std::span<const ColumnGrid> grids, const SliceOptions& wanted) {
  RETURN_IF_ERROR(checkLine(grids, wanted));
  const SliceOptions options = withoutVoid(grids, wanted);
  std::vector<PixelRect> plots;
  int y = kMargin + kTextHeight + 14;
  int plot_width = 0;
  for (const ColumnGrid& grid : grids) {
    PixelRect& plot = plots.emplace_back(plotSize(grid, lengthOf(options), options.width));
    plot.x = kMargin + kAxisLabelWidth;
    plot.y = y + kAxisNameHeight;
    y = plot.bottom() + kAxisBottomHeight + 16;
    plot_width = std::max(plot_width, plot.width);
  }
  const std::string heading =
      fmt::format("{}{}slice from x {:g}, z {:g} to x {:g}, z {:g}", titleOf(options.title),
                  options.title.empty() ? "" : ": ", options.from.x, options.from.z, options.to.x,
                  options.to.z);
  const int width = std::max({kMargin + kAxisLabelWidth + plot_width + 2 * kMargin,
                              2 * kMargin + textWidth(heading), 900});
  Image image(width, y + kTextHeight + kMargin, kPaper);
  drawText(image, {kMargin, kMargin}, heading, kInk);
  for (std::size_t g = 0; g < grids.size(); ++g) drawPlot(image, plots[g], grids[g], options);
  drawMeanings(image, kMargin + kAxisLabelWidth, y);
  return Picture{std::move(image), std::move(plots)};
}

}  // namespace galactic::pictures
