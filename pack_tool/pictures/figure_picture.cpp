#include "pack_tool/pictures/figure_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pack_tool/pictures/axes.h"
#include "pack_tool/pictures/figure_view.h"
#include "pack_tool/pictures/sheet.h"
#include "pictures/palette.h"
#include "support/text/printable.h"
#include "support/try.h"

namespace galactic::pictures {

namespace {

using pack_tool::Figure;
using pack_tool::FigureKind;
using pack_tool::FigurePart;

constexpr int kMargin = kSheetMargin;
constexpr int kLine = kTextHeight + 10;

Legend legendOf(std::span<const Figure> figures, std::span<const float> radii) {
  const auto any = [figures](auto&& has) { return std::ranges::any_of(figures, has); };
  const auto any_part = [&any](auto&& has) {
    return any([&has](const Figure& figure) { return std::ranges::any_of(figure.parts, has); });
  };
  const bool robot = any([](const Figure& f) { return f.kind == FigureKind::kRobot; });
  Legend legend;
  const bool textured =
      any_part([](const FigurePart& part) { return part.render_model.has_value(); });
  if (textured || any_part([](const FigurePart& part) { return !part.surface.empty(); })) {
    legend.entries.push_back({robot || textured ? "mesh, in its own colors" : "mesh", kMeshGray});
  }
  for (std::size_t rank = 0; rank < radii.size(); ++rank) {
    legend.entries.push_back(
        {fmt::format("{}{} m", rank == 0 ? "spheres of radius " : "", radii[rank]),
         sphereColor(rank)});
  }
  if (any_part([](const FigurePart& part) { return part.box.has_value(); })) {
    legend.entries.push_back({"oriented box", kBoxEdge});
  }
  if (any([](const Figure& f) { return f.grasp.has_value(); })) {
    legend.entries.push_back({"grasp point", kGraspMark});
  }
  if (any([](const Figure& f) { return f.camera.has_value(); })) {
    legend.entries.push_back({"camera", kCameraMark});
  }
  if (any([](const Figure& f) { return !f.footprint.empty(); })) {
    legend.entries.push_back({"footprint", kFootprintMark});
  }
  return legend;
}

/// One view of a figure's picture.
struct NamedView {
  std::string_view name;
  ViewAxes axes;
};

constexpr std::string_view kSheetNote = "gap: mean/p95/max; every object at its own scale";

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

/// `radii`: as of FigureView.
void drawTile(Image& image, const PixelRect& tile, int view_size, const Figure& figure,
              std::span<const float> radii) {
  const ViewPlace place{tile.x, tile.y, view_size};
  const int width = tile.width;
  const ViewAxes axes = threeQuarterView();
  const double scale = fittingScale(windowOf(figure, axes).extent(), place.size);
  drawText(image, {place.left, place.top}, shortened(printable(figure.name), width), kInk);
  int y = place.top + kLine;
  for (const std::string& line : figure.short_caption) {
    drawText(image, {place.left, y}, shortened(line, width), kFaintInk);
    y += kLine;
  }
  const ViewPlace view{place.left, place.top + 3 * kLine, place.size};
  drawFigureView(image, view, figure, {.axes = axes, .pixels_per_meter = scale, .radii = radii});
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
  const std::string name = titleOf(figure.name);
  const std::vector<float> radii = radiiOf({&figure, 1});
  const Legend legend = legendOf({&figure, 1}, radii);
  const int legend_width = legend.width();
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
                   {.axes = view.axes, .pixels_per_meter = scale, .radii = radii});
    drawFrame(image, {x, views_top, view_size, view_size}, kFaintInk);
    x += view_size + kMargin;
  }
  legend.draw(image, {kMargin, legend_top});
  drawScaleBar(image, {kMargin, legend_top + kLine}, scale, view_size / 2);
  return image;
}

Result<Image> drawContactSheet(std::span<const Figure> figures, int view_size) {
  const std::vector<float> radii = radiiOf(figures);
  const Legend legend = legendOf(figures, radii);
  const int width = tileWidth(figures, view_size);
  // Name and two lines of caption above, the scale bar below.
  constexpr int kTileTextHeight = 4 * kLine;
  ASSIGN_OR_RETURN(auto sheet,
                   Sheet::create({.count = figures.size(),
                                  .things = "objects",
                                  .view_size = view_size,
                                  .tile_width = width,
                                  .tile_height = view_size + kTileTextHeight,
                                  .foot_width = std::max(legend.width(), textWidth(kSheetNote)),
                                  .foot_height = 2 * kLine}));
  for (std::size_t n = 0; n < figures.size(); ++n) {
    drawTile(sheet.image, sheet.tile(n), view_size, figures[n], radii);
  }
  legend.draw(sheet.image, {kMargin, sheet.foot_top});
  drawText(sheet.image, {kMargin, sheet.foot_top + kLine}, kSheetNote, kFaintInk);
  return std::move(sheet.image);
}

}  // namespace galactic::pictures
