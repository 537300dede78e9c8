#include "column_grid/standing_room.h"

#include <algorithm>
#include <cmath>

namespace galactic::bake {
namespace {

/// Between the surfaces, meters; the centers of spheres stay one radius away from both.
constexpr float kHeight = 1.2F;
/// From the middle of the square to its sides, meters.
constexpr float kHalfWidth = 0.4F;

/// A column of one component. Lists of them are in row order.
struct Cell {
  std::uint32_t i = 0;
  std::uint32_t k = 0;

  friend bool operator==(const Cell&, const Cell&) = default;
};
using Cells = std::vector<Cell>;

/// How many of the cells are the middle of a full square of cells that extends `reach` to each
/// side.
std::size_t middles(const Cells& cells, std::uint32_t reach) {
  const std::uint32_t side = 2 * reach + 1;
  if (cells.size() < std::size_t{side} * side) return 0;
  Cell least = cells.front();
  Cell most = cells.front();
  for (const Cell& cell : cells) {
    least = {std::min(least.i, cell.i), std::min(least.k, cell.k)};
    most = {std::max(most.i, cell.i), std::max(most.k, cell.k)};
  }
  // Summed-area table of the cells.
  const std::size_t width = most.i - least.i + 2;
  const std::size_t rows = most.k - least.k + 2;
  std::vector<std::uint32_t> sums(width * rows);
  const auto sum_at = [&](std::uint32_t i, std::uint32_t k) -> std::uint32_t& {
    return sums[(k - least.k) * width + (i - least.i)];
  };
  for (const Cell& cell : cells) sum_at(cell.i + 1, cell.k + 1) = 1;
  for (std::size_t row = 1; row < rows; ++row) {
    std::uint32_t of_row = 0;
    for (std::size_t n = 1; n < width; ++n) {
      of_row += sums[row * width + n];
      sums[row * width + n] = sums[(row - 1) * width + n] + of_row;
    }
  }
  std::size_t count = 0;
  for (const Cell& cell : cells) {
    if (cell.i < least.i + reach || cell.i + reach > most.i || cell.k < least.k + reach ||
        cell.k + reach > most.k) {
      continue;
    }
    const std::uint32_t i = cell.i - reach;
    const std::uint32_t k = cell.k - reach;
    const std::uint32_t inside =
        sum_at(i + side, k + side) - sum_at(i, k + side) - sum_at(i + side, k) + sum_at(i, k);
    count += inside == side * side ? 1U : 0U;
  }
  return count;
}

}  // namespace

std::vector<StandingRoom> standingRoom(const Columns& columns,
                                       std::span<const std::uint32_t> component_of_span,
                                       std::uint32_t count) {
  const GridFrame& frame = columns.frame;
  const Bounds scene = sceneBounds(frame);
  std::vector<Cells> roofed(count);
  std::vector<Cells> open(count);
  for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      const std::size_t at = columns.index(i, k);
      for (std::uint32_t span = columns.first[at]; span < columns.first[at + 1]; ++span) {
        const Span& heights = columns.spans[span];
        const bool has_floor = heights.lo > scene.min.y;
        const float below = heights.lo - frame.radius;
        const float above = std::min(heights.hi + frame.radius, scene.max.y);
        if (!has_floor || above - below < kHeight) continue;
        Cells& cells = (heights.hi < scene.max.y ? roofed : open)[component_of_span[span]];
        // If a component has two stories in a column, the column counts once.
        if (cells.empty() || cells.back() != Cell{i, k}) cells.push_back({i, k});
      }
    }
  }
  const float half = std::max(kHalfWidth - frame.radius, 0.0F);
  const auto reach = static_cast<std::uint32_t>(std::lround(half / frame.spacing));
  const double area = static_cast<double>(frame.spacing) * static_cast<double>(frame.spacing);
  std::vector<StandingRoom> rooms(count);
  for (std::uint32_t n = 0; n < count; ++n) {
    rooms[n] = {.roofed = area * static_cast<double>(middles(roofed[n], reach)),
                .open = area * static_cast<double>(middles(open[n], reach))};
  }
  return rooms;
}

}  // namespace galactic::bake
