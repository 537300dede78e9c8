#pragma once
#include <array>

#include "galactic/column_grid.h"
#include "galactic/pose.h"

namespace galactic::detail {

/// A straight line from a point, world frame, meters.
struct StraightLine {
  Vec3 from;
  /// Of unit length.
  std::array<double, 3> along{};
  /// May be infinite.
  double length = 0;
};

[[nodiscard]] double lengthOf(const Vec3& v) noexcept;

/// `direction` must be finite and not zero.
[[nodiscard]] StraightLine straightLine(const Vec3& from, const Vec3& direction,
                                        double length) noexcept;

/// How far a sphere gets along a line, and what stops it: kFree at the end of the line, kBlocked
/// where the sphere touches something, kOutside where the grid ends.
struct FreeWay {
  double length = 0;
  Clearance end = Clearance::kFree;
};

/// How far a sphere of the grid's radius gets when its center moves along a line, which must be
/// finite. Walks from cell to cell (Amanatides and Woo, A Fast Voxel Traversal Algorithm for Ray
/// Tracing, 1987), and follows the line up or down within a span of each: as exact as the grid,
/// except for contactMargin() in height. Neither allocates nor throws; takes as many steps as the
/// line crosses cells.
[[nodiscard]] FreeWay freeWay(const ColumnGrid& grid, const StraightLine& line) noexcept;

}  // namespace galactic::detail
