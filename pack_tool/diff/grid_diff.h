#pragma once
#include <cstdint>
#include <vector>

#include "galactic/column_grid.h"
#include "pack_tool/diff/field_diff.h"
#include "pack_tool/mesh/grid_view.h"

namespace galactic::pack_tool {

/// A column that is not the same on both sides.
struct ColumnDifference {
  ColumnIndex cell;
  GroundPoint center;
  std::size_t spans_a = 0;
  std::size_t spans_b = 0;
  /// Height that is free on one side only, meters.
  double height = 0;
};

/// How two grids of one radius differ.
struct GridDifference {
  float radius = 0;
  /// Frame fields that differ. When there are any, the columns are not compared.
  std::vector<FieldDifference> frame;
  /// Columns compared, those whose numbers of spans differ, and those whose numbers agree but an
  /// end differs by more than the tolerance.
  std::uint64_t columns = 0;
  std::uint64_t count_differs = 0;
  std::uint64_t ends_differ = 0;
  /// Span ends that differ by more than the tolerance in the columns of ends_differ: how many, the
  /// largest and the mean difference in meters.
  std::uint64_t ends = 0;
  double largest_end = 0;
  double mean_end = 0;
  /// Volume of sphere centers that is free on one side only, in all columns, cubic meters.
  double free_only_in_a = 0;
  double free_only_in_b = 0;
  /// The differing columns with the most height that is free on one side only, at most
  /// kWorstColumns, largest first.
  std::vector<ColumnDifference> worst;

  [[nodiscard]] bool differs() const {
    return !frame.empty() || count_differs > 0 || ends_differ > 0;
  }
};

inline constexpr std::size_t kWorstColumns = 5;

/// Compares two grids column by column. Frame lengths and span ends that differ by no more than
/// `tolerance` (meters) are equal.
[[nodiscard]] GridDifference compareGrids(const ColumnGrid& a, const ColumnGrid& b,
                                          double tolerance);

/// Height that is free in both of two lists of ascending, disjoint spans, meters.
[[nodiscard]] double commonHeight(const std::vector<Span>& a, const std::vector<Span>& b);

}  // namespace galactic::pack_tool
