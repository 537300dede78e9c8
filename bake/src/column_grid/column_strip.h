#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "column_grid/blocked_intervals.h"
#include "galactic/bake/columns.h"

namespace galactic::bake {

/// The blocked heights of a strip of rows while triangles are scattered into it. Each column has
/// one current interval, kept in plain arrays so that many columns are extended at once. Intervals
/// disjoint from it go to a short list, which becomes an ordered map when it gets long. Memory is
/// proportional to the columns and their gaps, not to the triangles.
class ColumnStrip {
 public:
  /// Floats in the widest vector that may be loaded at any column of a row.
  static constexpr std::size_t kPadding = 16;

  /// Rows first_row to end_row - 1 of the frame's grid, all free.
  ColumnStrip(const GridFrame& frame, std::uint32_t first_row, std::uint32_t end_row);

  [[nodiscard]] std::uint32_t firstRow() const { return first_row_; }
  [[nodiscard]] std::uint32_t endRow() const { return end_row_; }

  /// Current intervals row by row, stride() per row. Empty ones have lo > hi.
  [[nodiscard]] float* lo() { return lo_.data(); }
  [[nodiscard]] float* hi() { return hi_.data(); }
  [[nodiscard]] std::size_t stride() const { return stride_; }

  /// Adds an interval disjoint from the column's current one. Merged with an interval of the list
  /// that it overlaps, if any, it becomes the current one, and the previous current one goes to the
  /// list: the next triangle of the mesh is most likely near this one.
  void spill(std::uint32_t row, std::uint32_t column, float lo, float hi);

  /// Adds any interval (the scalar counterpart of the kernels).
  void add(std::uint32_t row, std::uint32_t column, float lo, float hi);

  /// Whether the column's current interval contains [lo, hi].
  [[nodiscard]] bool covers(std::uint32_t row, std::uint32_t column, float lo, float hi) const {
    const std::size_t at = rowStart(row) + column;
    return lo_[at] <= lo && hi <= hi_[at];
  }

  /// Appends the free spans of all columns to `spans`, and their number per column to `counts`.
  /// Returns the number of gaps that were closed because they were within kMergeTolerance.
  std::uint64_t appendFree(std::vector<std::uint32_t>& counts, std::vector<Span>& spans) const;

 private:
  struct Node {
    float lo;
    float hi;
    std::int32_t next;
  };

  [[nodiscard]] std::size_t rowStart(std::uint32_t row) const {
    return std::size_t{row - first_row_} * stride_;
  }

  /// Moves the list of the column at `at` to tall_.
  void makeTall(std::size_t at);
  /// spill() for such a column.
  void spillTall(std::size_t at, BlockedInterval added);

  GridFrame frame_;
  std::uint32_t first_row_;
  std::uint32_t end_row_;
  std::size_t stride_;
  std::vector<float> lo_;
  std::vector<float> hi_;
  /// Index of each column's first node, or a marker that it has none or that it is in tall_.
  std::vector<std::int32_t> head_;
  std::vector<Node> nodes_;
  /// The disjoint intervals of columns that have many: from lower to higher end.
  std::unordered_map<std::size_t, std::map<float, float>> tall_;
};

}  // namespace galactic::bake
