#pragma once
#include <array>

#include "galactic/column_grid.h"
#include "galactic/pose.h"

namespace galactic::detail {

/// A straight line from a point on, world frame, meters.
struct StraightLine {
  Vec3 from;
  /// Of unit length.
  std::array<double, 3> along{};
  /// May be infinite.
  double length = 0;
};

[[nodiscard]] double lengthOf(const Vec3& v) noexcept;

/// In a direction that is finite and not zero.
[[nodiscard]] StraightLine straightLine(const Vec3& from, const Vec3& direction,
                                        double length) noexcept;

/// How far a sphere gets along a line, and what is there: kFree where the line ends, kBlocked where
/// the sphere touches something, kOutside where the grid ends.
struct FreeWay {
  double length = 0;
  Clearance end = Clearance::kFree;
};

/// How far a sphere of the grid's radius gets whose center moves along a line, which is finite. It
/// goes from cell to cell (Amanatides and Woo, A Fast Voxel Traversal Algorithm for Ray Tracing,
/// 1987), in each of which it rises or sinks within a span: exact as the grid is, but for
/// contactMargin() in height. Neither allocates nor throws; ends after as many steps as the line
/// crosses cells.
[[nodiscard]] FreeWay freeWay(const ColumnGrid& grid, const StraightLine& line) noexcept;

}  // namespace galactic::detail
