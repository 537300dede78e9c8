#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "galactic/bake/columns.h"

namespace galactic::bake {

/// The cell that holds the coordinate `at` along an axis of a grid that begins at `min`; negative
/// or too large if `at` lies outside. All callers use this one rounding, so that they find the same
/// cell.
[[nodiscard]] inline double cellAlong(double at, float min, float spacing) {
  return std::floor((at - static_cast<double>(min)) / static_cast<double>(spacing));
}

/// The column whose cell holds a point; none outside the grid.
[[nodiscard]] inline std::optional<std::size_t> columnAt(const Columns& columns, const Vec3& p) {
  const GridFrame& frame = columns.frame;
  const double i = cellAlong(static_cast<double>(p.x), frame.min_x, frame.spacing);
  const double k = cellAlong(static_cast<double>(p.z), frame.min_z, frame.spacing);
  const bool is_inside = i >= 0 && k >= 0 && i < frame.columns_x && k < frame.columns_z;
  if (!is_inside) return std::nullopt;
  return columns.index(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k));
}

/// The cell nearest to the coordinate `at` along an axis of `count` cells.
[[nodiscard]] inline std::uint32_t nearestCell(double at, float min, float spacing,
                                               std::uint32_t count) {
  return static_cast<std::uint32_t>(
      std::clamp(cellAlong(at, min, spacing), 0.0, static_cast<double>(count - 1)));
}

}  // namespace galactic::bake
