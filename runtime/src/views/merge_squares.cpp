#include "views/merge_squares.h"

#include <algorithm>

namespace galactic::views {

std::vector<KeyedRectangle> mergeSquares(std::vector<KeyedSquare> squares) {
  std::sort(squares.begin(), squares.end());
  std::vector<KeyedRectangle> runs;
  for (const KeyedSquare& square : squares) {
    const bool goes_on = !runs.empty() && runs.back().key == square.key &&
                         runs.back().first_row == square.row &&
                         runs.back().end_column == square.column;
    if (goes_on) {
      ++runs.back().end_column;
      continue;
    }
    runs.push_back({square.key, square.column, square.column + 1, square.row, square.row + 1});
  }
  std::sort(runs.begin(), runs.end());
  std::vector<KeyedRectangle> rectangles;
  for (const KeyedRectangle& run : runs) {
    const bool goes_on = !rectangles.empty() && rectangles.back().key == run.key &&
                         rectangles.back().first_column == run.first_column &&
                         rectangles.back().end_column == run.end_column &&
                         rectangles.back().end_row == run.first_row;
    if (goes_on) {
      rectangles.back().end_row = run.end_row;
    } else {
      rectangles.push_back(run);
    }
  }
  return rectangles;
}

}  // namespace galactic::views
