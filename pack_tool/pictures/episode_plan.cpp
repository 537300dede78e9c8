#include "pack_tool/pictures/episode_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pack_tool/pictures/axes.h"
#include "pack_tool/pictures/figure_view.h"
#include "pack_tool/pictures/plan_panel.h"
#include "pack_tool/pictures/sheet.h"
#include "pictures/palette.h"
#include "support/text/counted.h"
#include "support/text/printable.h"
#include "support/try.h"

namespace galactic::pictures {

namespace {

using pack_tool::GroundPoint;

constexpr int kMargin = kSheetMargin;
constexpr int kLine = kTextHeight + 10;
/// A plot is no higher than this many times its width.
constexpr int kMostHeights = 2;
/// Half the size of a mark, pixels; of a crowd, they are smaller.
constexpr double kPlanMark = 7;
constexpr double kTileMark = 4;
constexpr double kLeastMark = 2.5;
constexpr double kCrowd = 100;
/// So many episodes can be told from each other.
constexpr std::size_t kFew = 12;
/// Free heights from here on, meters, are floor that robots drive on; tables have less.
constexpr double kFloorHeight = 2;
constexpr Rgb kLowSpace{168, 170, 176};
constexpr Rgb kOpenFloor{246, 246, 248};
constexpr Rgb kMutedBlocked{92, 94, 100};
/// Free below a table, meters; what is on solid furniture looks alike.
constexpr float kTableHeight = 0.7F;

/// Of ground with so much free above it, meters.
Rgb freeColor(double height) {
  return blend(kLowSpace, kOpenFloor, std::min(height / kFloorHeight, 1.0));
}

/// What a plot shows of the ground, meters.
struct Window {
  GroundPoint low;
  GroundPoint high;

  [[nodiscard]] double width() const { return high.x - low.x; }
  [[nodiscard]] double depth() const { return high.z - low.z; }
};

std::vector<GroundPoint> pointsOf(const EpisodeMarks& marks) {
  std::vector<GroundPoint> points{marks.start, marks.target, marks.goal};
  points.insert(points.end(), marks.others.begin(), marks.others.end());
  return points;
}

bool showsOthers(const EpisodePlan& plan) {
  return plan.episodes.size() == 1 && !plan.episodes.front().others.empty();
}

Window windowOf(const EpisodePlan& plan) {
  if (plan.grid) {
    const ColumnGridLayout& layout = plan.grid->layout();
    const auto spacing = static_cast<double>(layout.spacing);
    const GroundPoint low{static_cast<double>(layout.min_x), static_cast<double>(layout.min_z)};
    return {low, {low.x + layout.columns_x * spacing, low.z + layout.columns_z * spacing}};
  }
  constexpr double kFar = std::numeric_limits<double>::max();
  constexpr double kAround = 0.5;
  Window window{{kFar, kFar}, {-kFar, -kFar}};
  for (const EpisodeMarks& marks : plan.episodes) {
    for (const GroundPoint& point : pointsOf(marks)) {
      if (!std::isfinite(point.x) || !std::isfinite(point.z)) continue;
      window.low = {std::min(window.low.x, point.x), std::min(window.low.z, point.z)};
      window.high = {std::max(window.high.x, point.x), std::max(window.high.z, point.z)};
    }
  }
  if (window.low.x > window.high.x) return {{-kAround, -kAround}, {kAround, kAround}};
  return {{window.low.x - kAround, window.low.z - kAround},
          {window.high.x + kAround, window.high.z + kAround}};
}

/// A place in a picture that need not be the middle of a pixel.
struct Spot {
  double x = 0;
  double y = 0;
};

/// A window in a picture.
struct Plot {
  Window window;
  PixelRect rect;

  [[nodiscard]] double pixelsPerMeter() const { return rect.width / window.width(); }
  [[nodiscard]] bool holds(const GroundPoint& point) const {
    return point.x >= window.low.x && point.x <= window.high.x && point.z >= window.low.z &&
           point.z <= window.high.z;
  }
  /// Of a point that it holds.
  [[nodiscard]] Spot spotOf(const GroundPoint& point) const {
    // Width and height are whole pixels, each rounded by itself.
    return {rect.x + (point.x - window.low.x) / window.width() * rect.width,
            rect.y + (point.z - window.low.z) / window.depth() * rect.height};
  }
};

/// As large as fits into a width and a height.
Plot fittingPlot(const EpisodePlan& plan, int width, int height) {
  Plot plot{windowOf(plan), {}};
  const double scale = std::min(width / plot.window.width(), height / plot.window.depth());
  const auto length = [scale](double meters) {
    return std::max(1, static_cast<int>(std::lround(meters * scale)));
  };
  plot.rect.width = length(plot.window.width());
  plot.rect.height = length(plot.window.depth());
  return plot;
}

/// Draws shapes with soft edges into a part of a picture.
class MarkPen {
 public:
  MarkPen(Image& image, const PixelRect& part) : image_(image), part_(part) {}

  /// `distance`: from the edge of the shape, pixels, negative inside, at (right, down) of `spot`.
  /// `reach`: how far from there the shape may go.
  template <class Distance>
  void draw(const Spot& spot, double reach, Rgb color, const Distance& distance) {
    const auto first = [reach](double position, int low) {
      return std::max(low, static_cast<int>(std::floor(position - reach)));
    };
    const auto end = [reach](double position, int high) {
      return std::min(high, static_cast<int>(std::ceil(position + reach)));
    };
    for (int y = first(spot.y, part_.y); y < end(spot.y, part_.bottom()); ++y) {
      for (int x = first(spot.x, part_.x); x < end(spot.x, part_.right()); ++x) {
        const double covered =
            std::clamp(0.5 - distance(x + 0.5 - spot.x, y + 0.5 - spot.y), 0.0, 1.0);
        if (covered > 0) image_.set(x, y, blend(image_.at(x, y), color, covered));
      }
    }
  }

  /// With a bright rim, to be seen on any ground.
  template <class Distance>
  void drawMark(const Spot& spot, double size, Rgb color, const Distance& distance) {
    constexpr double kRim = 1.3;
    const double reach = 2 * size + 2 * kRim;
    draw(spot, reach, kPaper, [&](double x, double y) { return distance(x, y) - kRim; });
    draw(spot, reach, color, distance);
  }

  void drawStart(const Spot& spot, double size, double yaw) {
    // An arrowhead: its tip this many sizes before its middle.
    constexpr double kTip = 1.7;
    const double forward_x = std::cos(yaw);
    const double forward_y = -std::sin(yaw);
    drawMark(spot, size, kStartMark, [=](double x, double y) {
      const double ahead = x * forward_x + y * forward_y;
      const double aside = std::abs(x * forward_y - y * forward_x);
      const double side = (ahead + aside * (1 + kTip) - kTip * size) / std::hypot(1, 1 + kTip);
      return std::max(-ahead - size, side);
    });
  }

  void drawStartAhead(const Spot& spot, double size) { drawStart(spot, 0.8 * size, 0); }

  void drawTarget(const Spot& spot, double size) {
    drawMark(spot, size, kTargetMark, [=](double x, double y) { return std::hypot(x, y) - size; });
  }

  void drawGoal(const Spot& spot, double size) {
    drawMark(spot, size, kGoalMark,
             [=](double x, double y) { return std::max(std::abs(x), std::abs(y)) - 0.9 * size; });
  }

  void drawOther(const Spot& spot, double size) {
    draw(spot, size, kInk,
         [=](double x, double y) { return std::abs(std::hypot(x, y) - 0.5 * size) - 1; });
  }

  void drawLine(const Spot& from, const Spot& to) {
    const Spot middle{0.5 * (from.x + to.x), 0.5 * (from.y + to.y)};
    const Spot half{0.5 * (to.x - from.x), 0.5 * (to.y - from.y)};
    const double square = half.x * half.x + half.y * half.y;
    draw(middle, std::sqrt(square) + 2, kInk, [=](double x, double y) {
      const double way =
          square > 0 ? std::clamp((x * half.x + y * half.y) / square, -1.0, 1.0) : 0.0;
      return std::hypot(x - way * half.x, y - way * half.y) - 0.6;
    });
  }

 private:
  Image& image_;
  PixelRect part_;
};

/// Heights of the floors, ascending, meters: of the commonest ground, and of others that are large.
/// Houses may have split levels, or storeys beside each other on a slope; furniture is smaller.
std::vector<float> floorsOf(std::span<const Span> ground) {
  constexpr float kBin = 0.1F;
  constexpr double kLarge = 0.2;
  struct Bin {
    double sum = 0;
    std::size_t count = 0;
  };
  std::map<long, Bin> bins;
  std::size_t most = 0;
  for (const Span& span : ground) {
    if (std::isnan(span.lo)) continue;
    Bin& bin = bins[std::lround(span.lo / kBin)];
    bin.sum += static_cast<double>(span.lo);
    most = std::max(most, ++bin.count);
  }
  std::vector<float> floors;
  for (const auto& [number, bin] : bins) {
    const auto count = static_cast<double>(bin.count);
    if (count >= kLarge * static_cast<double>(most)) {
      floors.push_back(static_cast<float>(bin.sum / count));
    }
  }
  return floors;
}

/// The free height over each column of a storey, but no more than over a table where its ground is
/// solid furniture: further above a floor than a base climbs.
std::vector<float> heightsOverFloors(std::span<const Span> storey) {
  constexpr float kClimbed = 0.1F;
  const std::vector<float> floors = floorsOf(storey);
  std::vector<float> heights;
  heights.reserve(storey.size());
  for (const Span& span : storey) {
    const auto above = std::ranges::upper_bound(floors, span.lo);
    const bool is_raised = above != floors.begin() && span.lo - *std::prev(above) > kClimbed;
    const float height = span.hi - span.lo;
    heights.push_back(std::isnan(height) ? kBlockedValue
                      : is_raised        ? std::min(height, kTableHeight)
                                         : height);
  }
  return heights;
}

void drawGround(Image& image, const EpisodePlan& plan, const Plot& plot) {
  if (plan.grid) {
    const std::vector<Span> storey = storeySpans(*plan.grid, plan.floor);
    const PlanPanel panel{&*plan.grid, heightsOverFloors(storey), plot.rect};
    paintColumns(image, panel, [](float value) {
      if (value == kBlockedValue) return kMutedBlocked;
      return freeColor(static_cast<double>(value));
    });
  }
  drawFrame(image, plot.rect, kFaintInk);
}

/// `largest`: half the size of a mark where there are few.
void drawMarks(Image& image, const EpisodePlan& plan, const Plot& plot, double largest) {
  const std::size_t count = plan.episodes.size();
  const double crowd = std::max(static_cast<double>(count) / kCrowd, 1.0);
  const double size = std::max(largest / std::sqrt(crowd), kLeastMark);
  MarkPen pen(image, plot.rect);
  using Draw = void (MarkPen::*)(const Spot& spot, double size);
  const auto draw = [&](const GroundPoint& point, Draw mark) {
    if (plot.holds(point)) (pen.*mark)(plot.spotOf(point), size);
  };
  for (const EpisodeMarks& marks : plan.episodes) {
    if (count <= kFew && plot.holds(marks.target) && plot.holds(marks.goal)) {
      pen.drawLine(plot.spotOf(marks.target), plot.spotOf(marks.goal));
    }
    if (!showsOthers(plan)) continue;
    for (const GroundPoint& other : marks.others) draw(other, &MarkPen::drawOther);
  }
  for (const EpisodeMarks& marks : plan.episodes) {
    draw(marks.goal, &MarkPen::drawGoal);
    draw(marks.target, &MarkPen::drawTarget);
  }
  for (const EpisodeMarks& marks : plan.episodes) {
    if (plot.holds(marks.start)) pen.drawStart(plot.spotOf(marks.start), size, marks.yaw);
  }
}

void drawNumbers(Image& image, const EpisodePlan& plan, const Plot& plot) {
  if (plan.episodes.size() > kFew) return;
  for (const EpisodeMarks& marks : plan.episodes) {
    if (!plot.holds(marks.start)) continue;
    const Spot spot = plot.spotOf(marks.start);
    constexpr int kBeside = 14;
    drawText(image,
             {static_cast<int>(spot.x) + kBeside, static_cast<int>(spot.y) - kTextHeight / 2},
             std::to_string(marks.number), kStartMark);
  }
}

std::string nameOf(const EpisodePlan& plan) {
  if (plan.storeys == 1) return printable(plan.scene);
  return fmt::format("{}, storey {} of {}", printable(plan.scene), plan.storey, plan.storeys);
}

/// How many episodes there are, and what of them is not in sight.
std::string captionOf(const EpisodePlan& plan, const Plot& plot) {
  std::ptrdiff_t outside = 0;
  for (const EpisodeMarks& marks : plan.episodes) {
    outside += std::ranges::count_if(pointsOf(marks),
                                     [&](const GroundPoint& point) { return !plot.holds(point); });
  }
  std::string caption = plan.episodes.size() == 1
                            ? fmt::format("episode {}", plan.episodes.front().number)
                            : counted(plan.episodes.size(), "episode");
  if (plan.storeys > 1) caption += fmt::format(", at {:.1f} m", plan.floor.value_or(0));
  if (!plan.grid) caption += ", the pack of its scene is not here";
  if (outside > 0) caption += fmt::format(", {} outside", counted(outside, "mark"));
  return caption;
}

using DrawMark = void (MarkPen::*)(const Spot& spot, double size);

/// An entry of the legend that shows a mark.
Legend::Entry entryOf(std::string meaning, DrawMark draw) {
  const auto mark = [draw](Image& image, const PixelRect& square) {
    MarkPen pen(image, {0, 0, image.width(), image.height()});
    (pen.*draw)({square.x + 0.5 * square.width, square.y + 0.5 * square.height}, kPlanMark);
  };
  return {std::move(meaning), kInk, mark};
}

Legend legendOf(std::span<const EpisodePlan> plans) {
  const auto any = [&plans](auto&& has) { return std::ranges::any_of(plans, has); };
  Legend legend{{entryOf("start", &MarkPen::drawStartAhead),
                 entryOf("target", &MarkPen::drawTarget), entryOf("goal", &MarkPen::drawGoal)}};
  if (any([](const EpisodePlan& plan) { return showsOthers(plan); })) {
    legend.entries.push_back(entryOf("other object", &MarkPen::drawOther));
  }
  if (any([](const EpisodePlan& plan) { return plan.grid.has_value(); })) {
    legend.entries.push_back({"floor", kOpenFloor});
    legend.entries.push_back(
        {"on furniture, or less than 2 m free", freeColor(static_cast<double>(kTableHeight))});
    legend.entries.push_back({"blocked", kMutedBlocked});
  }
  return legend;
}

}  // namespace

Picture drawEpisodePlan(const EpisodePlan& plan, int width) {
  Plot plot = fittingPlot(plan, width, kMostHeights * width);
  plot.rect.x = kMargin + kAxisLabelWidth;
  plot.rect.y = kMargin + 2 * kLine + kAxisNameHeight;
  const std::string name = titleOf(nameOf(plan));
  std::string caption = captionOf(plan, plot);
  if (plan.grid) caption += fmt::format("; grid of radius {} m", plan.grid->radius());
  const Legend legend = legendOf({&plan, 1});
  const int foot_top = plot.rect.bottom() + kAxisBottomHeight + kMargin;
  Image image(std::max({plot.rect.right() + kMargin, 2 * kMargin + textWidth(name),
                        2 * kMargin + textWidth(caption), 2 * kMargin + legend.width()}),
              foot_top + 2 * kLine + kMargin, kPaper);
  drawText(image, {kMargin, kMargin}, name, kInk);
  drawText(image, {kMargin, kMargin + kLine}, caption, kFaintInk);
  drawGround(image, plan, plot);
  const auto& [low, high] = plot.window;
  drawHorizontalAxis(image, plot.rect, {low.x, high.x, plot.rect.x, plot.rect.right()}, "x (m)");
  drawVerticalAxis(image, plot.rect, {low.z, high.z, plot.rect.y, plot.rect.bottom()}, "z (m)");
  drawMarks(image, plan, plot, kPlanMark);
  drawNumbers(image, plan, plot);
  legend.draw(image, {kMargin, foot_top});
  drawScaleBar(image, {kMargin, foot_top + kLine}, plot.pixelsPerMeter());
  return {std::move(image), {plot.rect}};
}

Result<Image> drawEpisodeSheet(std::span<const EpisodePlan> plans, int view_size) {
  const Legend legend = legendOf(plans);
  // Name and caption above, the scale bar below.
  ASSIGN_OR_RETURN(auto sheet, Sheet::create({.count = plans.size(),
                                              .things = "plans",
                                              .view_size = view_size,
                                              .tile_width = view_size,
                                              .tile_height = view_size + 3 * kLine,
                                              .foot_width = legend.width(),
                                              .foot_height = kTextHeight}));
  for (std::size_t n = 0; n < plans.size(); ++n) {
    const EpisodePlan& plan = plans[n];
    const PixelRect tile = sheet.tile(n);
    Plot plot = fittingPlot(plan, view_size, view_size);
    plot.rect.x = tile.x + (view_size - plot.rect.width) / 2;
    plot.rect.y = tile.y + 2 * kLine;
    drawText(sheet.image, {tile.x, tile.y}, shortened(nameOf(plan), tile.width), kInk);
    drawText(sheet.image, {tile.x, tile.y + kLine}, shortened(captionOf(plan, plot), tile.width),
             kFaintInk);
    drawGround(sheet.image, plan, plot);
    drawMarks(sheet.image, plan, plot, kTileMark);
    drawScaleBar(sheet.image, {tile.x, plot.rect.bottom() + 6}, plot.pixelsPerMeter(),
                 view_size / 2);
  }
  legend.draw(sheet.image, {kMargin, sheet.foot_top});
  return std::move(sheet.image);
}

}  // namespace galactic::pictures
