#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/error.h"
#include "pack_tool/mesh/grid_view.h"
#include "pictures/drawing.h"
#include "pictures/image.h"

namespace galactic::pictures {

/// A finished picture and where in it the grids are drawn, one plot per grid in their order.
struct Picture {
  Image image;
  std::vector<PixelRect> plots;
};

/// What the color of a column in a plan says.
enum class PlanValue {
  kTotalHeight,   ///< Sum of the heights of its free spans, meters.
  kLowestHeight,  ///< Height of its lowest free span in the scene, meters; see plan_picture.cpp.
  kSpanCount,     ///< Number of its free spans.
};

/// The width that a plot of a grid may be asked to have, pixels.
inline constexpr int kLargestPlot = 4096;

struct FloorPlanOptions {
  PlanValue value = PlanValue::kTotalHeight;
  /// About how wide each plot is, pixels, up to kLargestPlot. Not given: 1000, or 560 of several.
  std::optional<int> width = std::nullopt;
  /// First words of the heading, usually the scene's name.
  std::string title = {};
};

/// Draws the grids from above, side by side on one color scale: x to the right, z down, as seen
/// looking down the Y axis. Blocked columns are dark gray. A cell is a whole number of pixels where
/// it is at least one; a pixel that shows several cells has the least of their values, and is
/// blocked where one of them is: no wall is lost. `grids` must not be empty. Safe to call from many
/// threads.
[[nodiscard]] Picture drawPlan(std::span<const ColumnGrid> grids, const FloorPlanOptions& options);

struct SliceOptions {
  /// The line that the vertical slice stands on.
  pack_tool::GroundPoint from;
  pack_tool::GroundPoint to;
  /// How wide a plot is, pixels, up to kLargestPlot; less where it would be higher than wide and
  /// higher than 900.
  int width = 1000;
  /// First words of the heading, usually the scene's name.
  std::string title = {};
};

/// Draws a vertical slice through the grids, one below the other: free heights of the sphere's
/// center are light, blocked ones dark. One scale for both axes unless the line is very short. Of a
/// line that has less than a 20th of its length over the grids, only that part is drawn. Fails with
/// kInvalidInput when the line is shorter than a cell, is not finite, or misses every grid. `grids`
/// must not be empty. Safe to call from many threads.
[[nodiscard]] Result<Picture> drawSlice(std::span<const ColumnGrid> grids,
                                        const SliceOptions& options);

}  // namespace galactic::pictures
