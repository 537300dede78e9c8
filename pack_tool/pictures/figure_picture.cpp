#include "pack_tool/pictures/figure_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "galactic/printable.h"
#include "pack_tool/pictures/axes.h"
#include "pack_tool/pictures/figure_view.h"
#include "pack_tool/pictures/palette.h"

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
  Rgb colour;
  std::string meaning;
};

std::vector<LegendEntry> legendOf(const Figure& figure) {
  const auto any = [&figure](auto&& has) {
    return std::any_of(figure.parts.begin(), figure.parts.end(), has);
  };
  const bool robot = figure.kind == FigureKind::kRobot;
  std::vector<LegendEntry> legend;
  if (any([](const FigurePart& part) { return !part.surface.empty(); })) {
    legend.push_back({kMeshGrey, "mesh"});
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

/// One view of a figure's picture.
struct NamedView {
  std::string_view name;
  ViewAxes axes;
};

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
  int legend_width = 0;
  for (const LegendEntry& entry : legend) legend_width += swatchWidth(entry.meaning);
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
    drawText(image, {x + view_size / 2, kMargin + 2 * kLine, Anchor::kCentre}, view.name, kInk);
    drawFigureView(image, {x, views_top, view_size}, figure, view.axes, scale);
    drawFrame(image, {x, views_top, view_size, view_size}, kFaintInk);
    x += view_size + kMargin;
  }
  x = kMargin;
  for (const LegendEntry& entry : legend) {
    x += drawSwatch(image, x, legend_top, entry.colour, entry.meaning);
  }
  drawScaleBar(image, {kMargin, legend_top + kLine}, scale, view_size / 2);
  return image;
}

Result<Image> drawContactSheet(std::span<const Figure> figures, int view_size) {
  const auto count = static_cast<double>(figures.size());
  const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
  const int rows = static_cast<int>(std::ceil(count / columns));
  const int tile_width = view_size + kMargin;
  // Name, caption in two lines, view, scale bar.
  const int tile_height = view_size + 4 * kLine + kMargin;
  const std::uint64_t width =
      std::uint64_t(kMargin) + std::uint64_t(columns) * std::uint64_t(tile_width);
  const std::uint64_t height =
      std::uint64_t(kMargin) + std::uint64_t(rows) * std::uint64_t(tile_height);
  if (width * height > kMostPixels) {
    return fail(ErrorCode::kUnsupported, "",
                fmt::format("a sheet of {} objects at {} pixels each has {} x {} pixels, more than "
                            "a picture may have; choose a smaller --size or one --object",
                            figures.size(), view_size, width, height));
  }
  Image image(static_cast<int>(width), static_cast<int>(height), kPaper);
  const ViewAxes axes = threeQuarterView();
  for (std::size_t n = 0; n < figures.size(); ++n) {
    const Figure& figure = figures[n];
    const int x = kMargin + static_cast<int>(n) % columns * tile_width;
    const int y = kMargin + static_cast<int>(n) / columns * tile_height;
    const double scale = fittingScale(windowOf(figure, axes).extent(), view_size);
    drawText(image, {x, y}, shortened(printable(figure.name), view_size), kInk);
    int text_y = y + kLine;
    for (const std::string& line : figure.short_caption) {
      drawText(image, {x, text_y}, shortened(line, view_size), kFaintInk);
      text_y += kLine;
    }
    const int top = y + 3 * kLine;
    drawFigureView(image, {x, top, view_size}, figure, axes, scale);
    drawFrame(image, {x, top, view_size, view_size}, kFaintInk);
    drawScaleBar(image, {x, top + view_size + 6}, scale, view_size / 2);
  }
  return image;
}

}  // namespace galactic::pictures
