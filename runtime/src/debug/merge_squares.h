#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <vector>

namespace galactic::debug {

/// A square of a plane of squares. Squares of equal `key` can be joined.
struct KeyedSquare {
  std::array<std::int32_t, 4> key{};
  std::int32_t row = 0;
  std::int32_t column = 0;

  friend auto operator<=>(const KeyedSquare&, const KeyedSquare&) = default;
};

/// Squares [first_row, end_row) x [first_column, end_column) of one key.
struct KeyedRectangle {
  std::array<std::int32_t, 4> key{};
  std::int32_t first_column = 0;
  std::int32_t end_column = 0;
  std::int32_t first_row = 0;
  std::int32_t end_row = 0;

  friend auto operator<=>(const KeyedRectangle&, const KeyedRectangle&) = default;
};

/// Rectangles that cover the squares, which differ from each other, and nothing else, each once:
/// runs along the columns, joined along the rows where they are equally long.
[[nodiscard]] std::vector<KeyedRectangle> mergeSquares(std::vector<KeyedSquare> squares);

}  // namespace galactic::debug
