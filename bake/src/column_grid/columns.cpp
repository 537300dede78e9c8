#include "galactic/bake/columns.h"

#include <fmt/format.h>

#include <cmath>

#include "layout/column_cell.h"

namespace galactic::bake {
namespace {

/// Free height above and below the padded scene, which connects everything outside into one region.
/// Meters.
constexpr double kHeightMargin = 0.01;

struct Axis {
  float min = 0;
  double count = 0;
};

Axis layOut(float scene_min, float scene_max, double padding, double spacing) {
  Axis axis;
  axis.min = static_cast<float>(static_cast<double>(scene_min) - padding);
  const double end = static_cast<double>(scene_max) + padding;
  axis.count = std::ceil((end - static_cast<double>(axis.min)) / spacing);
  return axis;
}

}  // namespace

Bounds sceneBounds(const GridFrame& frame) {
  const float in_plane = frame.radius + frame.spacing;
  const float in_height = frame.radius + static_cast<float>(kHeightMargin);
  return {{frame.min_x + in_plane, frame.heights.lo + in_height, frame.min_z + in_plane},
          {frame.min_x + static_cast<float>(frame.columns_x) * frame.spacing - in_plane,
           frame.heights.hi - in_height,
           frame.min_z + static_cast<float>(frame.columns_z) * frame.spacing - in_plane}};
}

Result<GridFrame> makeGridFrame(const Bounds& bounds, float radius, float spacing) {
  if (!(spacing >= kLeastSpacing) || !std::isfinite(spacing)) {
    return fail(ErrorCode::kInvalidInput, "`spacing`",
                fmt::format("is {} m, expected at least {} m", spacing, kLeastSpacing));
  }
  if (!std::isfinite(radius) || !(radius >= spacing / 2)) {
    return fail(ErrorCode::kInvalidInput, "`radii`",
                fmt::format("radius {} m is under half the spacing of {} m: neighboring columns "
                            "could lie on both sides of a closed wall and the room would leak; "
                            "use a spacing of at most {} m",
                            radius, spacing, 2 * radius));
  }
  const double r = static_cast<double>(radius);
  const double h = static_cast<double>(spacing);
  const Axis x = layOut(bounds.min.x, bounds.max.x, r + h, h);
  const Axis z = layOut(bounds.min.z, bounds.max.z, r + h, h);
  // Compared in double, because the product of absurd extents does not fit an integer.
  const double padded_cells = (x.count + kTileColumnsX) * (z.count + kTileColumnsZ);
  if (!(padded_cells <= static_cast<double>(kMaxCells))) {
    return fail(
        ErrorCode::kInvalidInput, "`spacing`",
        fmt::format("{} m over a scene of {:.1f} x {:.1f} m needs {:.0f} columns, a grid has "
                    "at most {}; use a wider spacing, or check the scene's unit (`scale`)",
                    spacing, x.count * h, z.count * h, x.count * z.count, kMaxCells));
  }
  GridFrame frame;
  frame.radius = radius;
  frame.spacing = spacing;
  frame.min_x = x.min;
  frame.min_z = z.min;
  frame.columns_x = static_cast<std::uint32_t>(x.count);
  frame.columns_z = static_cast<std::uint32_t>(z.count);
  frame.heights = {static_cast<float>(static_cast<double>(bounds.min.y) - r - kHeightMargin),
                   static_cast<float>(static_cast<double>(bounds.max.y) + r + kHeightMargin)};
  return frame;
}

}  // namespace galactic::bake
