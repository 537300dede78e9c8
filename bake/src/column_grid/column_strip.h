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
/// one current interval, kept in plain arrays so that many columns are extended at once; an
/// interval disjoint from it goes to a short list, which becomes an ordered map where it gets long.
/// Memory is proportional to the columns and their gaps, not to the triangles.
class ColumnStrip {
 public:
  /// Widest vector that may be loaded at any column of a row.
  static constexpr std::size_t kPadding = 16;

  /// Rows first_row up to, not including, end_row of the frame's grid, all free.
  ColumnStrip(const GridFrame& frame, std::uint32_t first_row, std::uint32_t end_row);

  [[nodiscard]] std::uint32_t firstRow() const { return first_row_; }
  [[nodiscard]] std::uint32_t endRow() const { return end_row_; }

  /// Current intervals row by row, stride() of each; empty ones have lo > hi.
  [[nodiscard]] float* lo() { return lo_.data(); }
  [[nodiscard]] float* hi() { return hi_.data(); }
  [[nodiscard]] std::size_t stride() const { return stride_; }

  /// Adds an interval disjoint from the column's current one. Where it overlaps one of the list
  /// they merge and become the current one, which goes to the list: the next triangle of the mesh
  /// is most likely near this one.
  void spill(std::uint32_t row, std::uint32_t column, float lo, float hi);

  /// Adds any interval (the scalar way in).
  void add(std::uint32_t row, std::uint32_t column, float lo, float hi);

  /// Whether the column's current interval holds all of [lo, hi].
  [[nodiscard]] bool covers(std::uint32_t row, std::uint32_t column, float lo, float hi) const {
    const std::size_t at = rowStart(row) + column;
    return lo_[at] <= lo && hi <= hi_[at];
  }

  /// Appends the free spans of all columns to `spans`, and how many each column has to `counts`.
  /// Returns the number of gaps closed because they were within kMergeTolerance.
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
  /// spill() in such a column.
  void spillTall(std::size_t at, BlockedInterval added);

  GridFrame frame_;
  std::uint32_t first_row_;
  std::uint32_t end_row_;
  std::size_t stride_;
  std::vector<float> lo_;
  std::vector<float> hi_;
  /// Index of each column's first node, or that it has none, or that it is in tall_.
  std::vector<std::int32_t> head_;
  std::vector<Node> nodes_;
  /// Of columns with many intervals: the higher end of each by its lower one, disjoint.
  std::unordered_map<std::size_t, std::map<float, float>> tall_;
};

}  // namespace galactic::bake
