#include "pack_tool/pictures/figure_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pack_tool/pictures/axes.h"
#include "pack_tool/pictures/figure_view.h"
#include "pictures/palette.h"
#include "support/printable.h"

namespace galactic::pictures {

namespace {

using pack_tool::Figure;
using pack_tool::FigureKind;
using pack_tool::FigurePart;

constexpr int kMargin = 20;
constexpr int kLine = kTextHeight + 10;
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

/// The beginning of a text, as much of it as is no wider than `pixels`.
std::string shortened(const std::string& text, int pixels) {
  if (textWidth(text) <= pixels) return text;
  const auto room = static_cast<std::size_t>(std::max(0, pixels / kTextAdvance - 2));
  return text.substr(0, room) + "..";
}

struct LegendEntry {
  Rgb color;
  std::string meaning;
};

std::vector<LegendEntry> legendOf(const Figure& figure) {
  const auto any = [&figure](auto&& has) {
    return std::any_of(figure.parts.begin(), figure.parts.end(), has);
  };
  const bool robot = figure.kind == FigureKind::kRobot;
  std::vector<LegendEntry> legend;
  const bool textured = any([](const FigurePart& part) { return part.render_model.has_value(); });
  if (textured || any([](const FigurePart& part) { return !part.surface.empty(); })) {
    legend.push_back({kMeshGray, robot || textured ? "mesh, in its own colors" : "mesh"});
  }
  if (any([](const FigurePart& part) { return !part.spheres.empty(); })) {
    std::string radii;
    for (auto r = figure.radii.rbegin(); r != figure.radii.rend(); ++r) {
      radii += fmt::format("{}{}", radii.empty() ? "" : ", ", *r);
    }
    legend.push_back(
        {robot ? kRobotSpheres : kObjectSpheres, fmt::format("spheres of radius {} m", radii)});
  }
  if (any([](const FigurePart& part) { return part.box.has_value(); })) {
    legend.push_back({kBoxEdge, "oriented box"});
  }
  if (figure.grasp) legend.push_back({kGraspMark, "grasp point"});
  if (figure.camera) legend.push_back({kCameraMark, "camera"});
  if (!figure.footprint.empty()) legend.push_back({kFootprintMark, "footprint"});
  return legend;
}

int legendWidth(const std::vector<LegendEntry>& legend) {
  int width = 0;
  for (const LegendEntry& entry : legend) width += swatchWidth(entry.meaning);
  return width;
}

void drawLegend(Image& image, const std::vector<LegendEntry>& legend, int y) {
  int x = kMargin;
  for (const LegendEntry& entry : legend) {
    x += drawSwatch(image, x, y, entry.color, entry.meaning);
  }
}

/// One view of a figure's picture.
struct NamedView {
  std::string_view name;
  ViewAxes axes;
};

constexpr std::string_view kSheetNote = "gap: mean/p95/max; every object at its own scale";

/// How a contact sheet is divided: about as many columns as rows.
struct SheetLayout {
  std::uint64_t columns = 1;
  std::uint64_t rows = 1;
  /// Pixels.
  std::uint64_t tile_width = 0;
  std::uint64_t tile_height = 0;
};

/// As wide as a view, or as the widest text over one; names that never end are cut off.
int tileWidth(std::span<const Figure> figures, int view_size) {
  int widest = view_size;
  for (const Figure& figure : figures) {
    widest = std::max(widest, textWidth(printable(figure.name)));
    for (const std::string& line : figure.short_caption) widest = std::max(widest, textWidth(line));
  }
  constexpr int kMostText = 500;
  return std::min(widest, std::max(view_size, kMostText));
}

SheetLayout layOut(std::span<const Figure> figures, int view_size) {
  SheetLayout layout;
  const std::size_t count = figures.size();
  while (layout.columns * layout.columns < count) ++layout.columns;
  layout.rows = (count + layout.columns - 1) / layout.columns;
  layout.tile_width = static_cast<std::uint64_t>(tileWidth(figures, view_size) + kMargin);
  // Name and two lines of caption above, the scale bar below.
  constexpr int kTileTextHeight = 4 * kLine + kMargin;
  layout.tile_height = static_cast<std::uint64_t>(view_size) + kTileTextHeight;
  return layout;
}

/// `width` is what texts may take.
void drawTile(Image& image, const ViewPlace& place, int width, const Figure& figure) {
  const ViewAxes axes = threeQuarterView();
  const double scale = fittingScale(windowOf(figure, axes).extent(), place.size);
  drawText(image, {place.left, place.top}, shortened(printable(figure.name), width), kInk);
  int y = place.top + kLine;
  for (const std::string& line : figure.short_caption) {
    drawText(image, {place.left, y}, shortened(line, width), kFaintInk);
    y += kLine;
  }
  const ViewPlace view{place.left, place.top + 3 * kLine, place.size};
  drawFigureView(image, view, figure, {.axes = axes, .pixels_per_meter = scale});
  drawFrame(image, {view.left, view.top, view.size, view.size}, kFaintInk);
  drawScaleBar(image, {view.left, view.top + view.size + 6}, scale, view.size / 2);
}

}  // namespace

Image drawFigure(const Figure& figure, int view_size) {
  const std::array<NamedView, 4> views{{{"front", kFrontView},
                                        {"side", kSideView},
                                        {"top", kTopView},
                                        {"three-quarter", threeQuarterView()}}};
  double extent = 0;
  for (const NamedView& view : views) {
    extent = std::max(extent, windowOf(figure, view.axes).extent());
  }
  const double scale = fittingScale(extent, view_size);
  const std::string name = printable(figure.name);
  const std::vector<LegendEntry> legend = legendOf(figure);
  const int legend_width = legendWidth(legend);
  const int views_width = static_cast<int>(views.size()) * (view_size + kMargin) - kMargin;
  const int width = 2 * kMargin + std::max({views_width, legend_width, textWidth(name),
                                            textWidth(figure.caption)});
  const int views_top = kMargin + 3 * kLine;
  const int legend_top = views_top + view_size + kMargin;

  Image image(width, legend_top + 2 * kLine + kMargin, kPaper);
  drawText(image, {kMargin, kMargin}, name, kInk);
  drawText(image, {kMargin, kMargin + kLine}, figure.caption, kFaintInk);
  int x = kMargin;
  for (const NamedView& view : views) {
    drawText(image, {x + view_size / 2, kMargin + 2 * kLine, Anchor::kCenter}, view.name, kInk);
    drawFigureView(image, {x, views_top, view_size}, figure,
                   {.axes = view.axes, .pixels_per_meter = scale});
    drawFrame(image, {x, views_top, view_size, view_size}, kFaintInk);
    x += view_size + kMargin;
  }
  drawLegend(image, legend, legend_top);
  drawScaleBar(image, {kMargin, legend_top + kLine}, scale, view_size / 2);
  return image;
}

Result<Image> drawContactSheet(std::span<const Figure> figures, int view_size) {
  const SheetLayout layout = layOut(figures, view_size);
  const std::vector<LegendEntry> legend = legendOf(figures.front());
  const std::uint64_t width =
      std::max(std::uint64_t(kMargin) + layout.columns * layout.tile_width,
               std::uint64_t(2 * kMargin + std::max(legendWidth(legend), textWidth(kSheetNote))));
  const std::uint64_t height =
      std::uint64_t(kMargin + 2 * kLine + kMargin) + layout.rows * layout.tile_height;
  if (width > kMostPixels || height > kMostPixels || width * height > kMostPixels) {
    return fail(ErrorCode::kUnsupported, "",
                fmt::format("a sheet of {} objects at {} pixels each has {} x {} pixels, more than "
                            "a picture may have; choose a smaller --size or one --object",
                            figures.size(), view_size, width, height));
  }
  Image image(static_cast<int>(width), static_cast<int>(height), kPaper);
  for (std::size_t n = 0; n < figures.size(); ++n) {
    const auto x = static_cast<int>(kMargin + n % layout.columns * layout.tile_width);
    const auto y = static_cast<int>(kMargin + n / layout.columns * layout.tile_height);
    drawTile(image, {x, y, view_size}, static_cast<int>(layout.tile_width) - kMargin, figures[n]);
  }
  const int legend_top = static_cast<int>(kMargin + layout.rows * layout.tile_height);
  drawLegend(image, legend, legend_top);
  drawText(image, {kMargin, legend_top + kLine}, kSheetNote, kFaintInk);
  return image;
}

}  // namespace galactic::pictures
