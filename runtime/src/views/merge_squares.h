#pragma once
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace galactic::views {

/// A square in a plane of squares. Squares with equal `key` can be joined.
struct KeyedSquare {
  std::array<std::int32_t, 4> key{};
  std::int32_t row = 0;
  std::int32_t column = 0;

  friend bool operator==(const KeyedSquare&, const KeyedSquare&) = default;
  friend bool operator<(const KeyedSquare& a, const KeyedSquare& b) {
    return std::tie(a.key, a.row, a.column) < std::tie(b.key, b.row, b.column);
  }
};

/// Squares [first_row, end_row) x [first_column, end_column), all with the same key.
struct KeyedRectangle {
  std::array<std::int32_t, 4> key{};
  std::int32_t first_column = 0;
  std::int32_t end_column = 0;
  std::int32_t first_row = 0;
  std::int32_t end_row = 0;

  friend bool operator==(const KeyedRectangle&, const KeyedRectangle&) = default;
  /// Sorts by key, then columns, then rows, so that rectangles that can be joined are neighbors.
  friend bool operator<(const KeyedRectangle& a, const KeyedRectangle& b) {
    return std::tie(a.key, a.first_column, a.end_column, a.first_row) <
           std::tie(b.key, b.first_column, b.end_column, b.first_row);
  }
};

/// Rectangles that cover each of the squares once, and nothing else: runs along the columns, joined
/// along the rows if they have the same ends. The squares must differ from each other.
[[nodiscard]] std::vector<KeyedRectangle> mergeSquares(std::vector<KeyedSquare> squares);

}  // namespace galactic::views
