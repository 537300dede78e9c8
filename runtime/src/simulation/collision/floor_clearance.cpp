#include "simulation/collision/floor_clearance.h"

#include <algorithm>
#include <limits>
#include <span>

#include "column_grid/column_grid_kernels.h"

namespace galactic::simulation {
namespace {

/// The least difference between a band's height and the spheres that it clears, meters: more than
/// any rounding.
constexpr float kSlack = 1e-3F;
/// Spheres are considered from this far above the lowest height that they can have, meters.
constexpr float kOverContact = 5e-3F;

struct Heights {
  float lowest = 0;
  float low = 0;
  float highest = 0;
  float band_from = 0;
  float band_height = 0;

  /// The least height of a center that a plane clears. Plane 0 is the one below all bands.
  [[nodiscard]] float lowOf(std::uint32_t plane) const {
    if (plane == 0) return lowest;
    return plane == 1 ? low : band_from + static_cast<float>(plane - 1) * band_height;
  }
};

/// Columns along a step: enough for rooms that reach far, and a power of two, so that rounding
/// cannot assign a sphere to another cell than its column.
std::uint32_t columnsOfStep(float spacing) {
  constexpr float kFar = 0.25F;
  constexpr std::uint32_t kMost = 64;
  std::uint32_t columns = 1;
  while (columns < kMost && static_cast<float>(kMostRoom * columns) * spacing < kFar) columns *= 2;
  return columns;
}

/// Cells of one radius, row by row.
struct Cells {
  std::uint32_t x = 0;
  std::uint32_t z = 0;
  /// Columns along a step.
  std::uint32_t step = 1;

  /// Columns along the edge of a cell.
  [[nodiscard]] std::uint32_t edge() const { return step * kStepsPerCell; }
  [[nodiscard]] std::uint32_t columnsX() const { return x * edge(); }
  [[nodiscard]] std::uint32_t columnsZ() const { return z * edge(); }
  [[nodiscard]] std::uint32_t tilesX() const { return (x + kClearanceTile - 1) / kClearanceTile; }
  [[nodiscard]] std::uint32_t tilesZ() const { return (z + kClearanceTile - 1) / kClearanceTile; }
  [[nodiscard]] std::uint32_t count() const {
    return tilesX() * tilesZ() * kClearanceTile * kClearanceTile;
  }
  [[nodiscard]] std::size_t tiled(std::uint32_t i, std::uint32_t k) const {
    const std::uint32_t tile = k / kClearanceTile * tilesX() + i / kClearanceTile;
    return (std::size_t{tile} * kClearanceTile + k % kClearanceTile) * kClearanceTile +
           i % kClearanceTile;
  }
};

Cells cellsOf(const ColumnGrid& grid) {
  Cells cells{.step = columnsOfStep(grid.spacing())};
  cells.x = (grid.columnsX() + cells.edge() - 1) / cells.edge();
  cells.z = (grid.columnsZ() + cells.edge() - 1) / cells.edge();
  return cells;
}

/// For each column of the cells the height from which it is free up to `highest`; infinity if it is
/// not free there, or the column does not exist.
std::vector<float> lowestFree(const ColumnGrid& grid, const Cells& cells, float highest) {
  const ColumnGridLayout& layout = grid.layout();
  const std::uint32_t columns = cells.columnsX();
  std::vector<float> x(columns);
  const std::vector<float> y(columns, highest);
  std::vector<float> z(columns);
  std::vector<Clearance> clearance(columns);
  std::vector<float> down(columns);
  std::vector<float> up(columns);
  for (std::uint32_t i = 0; i < columns; ++i) {
    x[i] = layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing;
  }
  std::vector<float> lowest(std::size_t{columns} * cells.columnsZ());
  for (std::uint32_t k = 0; k < cells.columnsZ(); ++k) {
    std::ranges::fill(z, layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing);
    grid.contact({x, y, z}, {clearance, down, up});
    float* row = lowest.data() + std::size_t{k} * columns;
    for (std::uint32_t i = 0; i < columns; ++i) {
      const bool is_free = clearance[i] == Clearance::kFree;
      row[i] = is_free ? highest - down[i] : std::numeric_limits<float>::infinity();
    }
  }
  return lowest;
}

/// Counts the columns of a rectangle that are not clear, with a summed-area table (Crow 1984).
/// Places outside of the grid are not clear.
class NotClear {
 public:
  NotClear(const Cells& cells, std::span<const float> lowest_free, float low)
      : columns_x_(cells.columnsX()),
        columns_z_(cells.columnsZ()),
        sums_(std::size_t{columns_x_ + 1} * (columns_z_ + 1)) {
    for (std::uint32_t k = 0; k < columns_z_; ++k) {
      std::uint32_t row = 0;
      for (std::uint32_t i = 0; i < columns_x_; ++i) {
        const bool is_clear = lowest_free[std::size_t{k} * columns_x_ + i] <= low - kSlack;
        row += is_clear ? 0U : 1U;
        sums_[at(i + 1, k + 1)] = sums_[at(i + 1, k)] + row;
      }
    }
  }

  /// Whether all columns from (x, z) up to (end_x, end_z) are clear.
  [[nodiscard]] bool none(std::int64_t x, std::int64_t end_x, std::int64_t z,
                          std::int64_t end_z) const {
    if (x < 0 || z < 0 || end_x > columns_x_ || end_z > columns_z_) return false;
    return sums_[at(end_x, end_z)] - sums_[at(x, end_z)] == sums_[at(end_x, z)] - sums_[at(x, z)];
  }

 private:
  [[nodiscard]] std::size_t at(std::int64_t i, std::int64_t k) const {
    return static_cast<std::size_t>(k) * (columns_x_ + 1) + static_cast<std::size_t>(i);
  }

  std::uint32_t columns_x_, columns_z_;
  std::vector<std::uint32_t> sums_;
};

/// Stands for the square around a cell that is not clear itself.
constexpr std::int64_t kNotClear = -1;

/// The largest clear square around a cell, in steps beyond the cell. `before`: that of the previous
/// cell along X, kNotClear for the first one. From cell to cell it changes by at most the steps of
/// a cell.
std::int64_t squareAround(const Cells& cells, const NotClear& not_clear, std::int64_t x,
                          std::int64_t z, std::int64_t before) {
  const auto is_clear = [&](std::int64_t square) {
    const std::int64_t by = square * cells.step;
    return not_clear.none(x - by, x + cells.edge() + by, z - by, z + cells.edge() + by);
  };
  std::int64_t square = std::max(before - kStepsPerCell, kNotClear);
  for (std::int64_t blocked = std::min<std::int64_t>(before + kStepsPerCell + 1, kMostRoom);
       blocked - square > 1;) {
    const std::int64_t between = (square + blocked) / 2;
    (is_clear(between) ? square : blocked) = between;
  }
  return square;
}

/// The room around a cell: its clear square, extended by a step on each side in turn as long as
/// there is room beside it.
RoomAround roomAround(const Cells& cells, const NotClear& not_clear, std::int64_t x, std::int64_t z,
                      std::int64_t square) {
  if (square == kNotClear) return 0;
  const std::int64_t step = cells.step;
  std::int64_t end_x = x + cells.edge() + square * step;
  std::int64_t end_z = z + cells.edge() + square * step;
  x -= square * step;
  z -= square * step;
  RoomAround room = 0;
  const auto add = [&](int side, std::int64_t steps) {
    room = static_cast<RoomAround>(room + (steps << side));
  };
  for (const int side : {kRoomDownX, kRoomUpX, kRoomDownZ, kRoomUpZ}) add(side, square + 1);
  // A side that is blocked once stays blocked as the others grow.
  unsigned blocked = 0;
  const auto grow = [&](int side, std::int64_t& border, std::int64_t by, const auto& is_clear) {
    if ((blocked >> side & 1U) != 0) return;
    const bool is_wide = (static_cast<unsigned>(room) >> side & kMostRoom) == kMostRoom;
    if (is_wide || !is_clear()) {
      blocked |= 1U << side;
      return;
    }
    border += by;
    add(side, 1);
  };
  constexpr unsigned kAllSides =
      1U << kRoomDownX | 1U << kRoomUpX | 1U << kRoomDownZ | 1U << kRoomUpZ;
  while (blocked != kAllSides) {
    grow(kRoomDownX, x, -step, [&] { return not_clear.none(x - step, x, z, end_z); });
    grow(kRoomUpX, end_x, step, [&] { return not_clear.none(end_x, end_x + step, z, end_z); });
    grow(kRoomDownZ, z, -step, [&] { return not_clear.none(x, end_x, z - step, z); });
    grow(kRoomUpZ, end_z, step, [&] { return not_clear.none(x, end_x, end_z, end_z + step); });
  }
  return room;
}

/// Writes the room around each cell in one plane to `out`, tile by tile.
void fillPlane(const Cells& cells, std::span<const float> lowest_free, float low,
               std::span<RoomAround> out) {
  const NotClear not_clear(cells, lowest_free, low);
  for (std::uint32_t k = 0; k < cells.z; ++k) {
    const std::int64_t z = std::int64_t{k} * cells.edge();
    std::int64_t square = kNotClear;
    for (std::uint32_t i = 0; i < cells.x; ++i) {
      const std::int64_t x = std::int64_t{i} * cells.edge();
      square = squareAround(cells, not_clear, x, z, square);
      out[cells.tiled(i, k)] = roomAround(cells, not_clear, x, z, square);
    }
  }
}

}  // namespace

std::size_t clearanceCells(const Scene& scene) {
  std::size_t cells = 0;
  for (const ColumnGrid& grid : scene.grids()) {
    cells += std::size_t{kClearancePlanes} * cellsOf(grid).count();
  }
  return cells;
}

FloorClearance makeFloorClearance(const Scene& scene, float floor, float unevenness,
                                  const HeightsOverFloor& heights,
                                  std::span<const float> lowest_of_radius) {
  FloorClearance made;
  for (std::uint32_t radius = 0; radius < scene.grids().size(); ++radius) {
    const ColumnGrid& grid = scene.grids()[radius];
    const float from = floor + heights.lowest - 2 * kSlack;
    const float highest = floor + unevenness + heights.highest + 2 * kSlack;
    const float over_contact = floor + grid.radius() + kOverContact;
    // Spheres of the radius are also free above anything on the floor that is lower than all of
    // them.
    const float lowest = std::max(heights.lowest, lowestOver(lowest_of_radius, radius));
    const Heights asked{.lowest = std::max(floor + lowest - 2 * kSlack, over_contact),
                        .low = std::max(from, over_contact + unevenness),
                        .highest = highest,
                        .band_from = from,
                        .band_height = (highest - from) / static_cast<float>(kClearanceBands)};
    const Cells cells = cellsOf(grid);
    const std::vector<float> lowest_free = lowestFree(grid, cells, highest);
    RadiusClearance& to = made.emplace_back();
    to.min_x = grid.layout().min_x;
    to.min_z = grid.layout().min_z;
    to.inverse_step = grid.layout().inverse_spacing / static_cast<float>(cells.step);
    to.steps_x = static_cast<float>(cells.x * kStepsPerCell);
    to.steps_z = static_cast<float>(cells.z * kStepsPerCell);
    to.lowest = asked.lowest;
    to.low = asked.low;
    to.highest = asked.highest;
    to.band_from = asked.band_from;
    to.inverse_band = 1 / asked.band_height;
    to.tiles_x = static_cast<std::int32_t>(cells.tilesX());
    to.band_cells = static_cast<std::int32_t>(cells.count());
    to.cells.resize(std::size_t{kClearancePlanes} * cells.count());
    for (std::uint32_t plane = 0; plane < kClearancePlanes; ++plane) {
      fillPlane(cells, lowest_free, asked.lowOf(plane),
                std::span(to.cells).subspan(std::size_t{plane} * cells.count(), cells.count()));
    }
  }
  return made;
}

}  // namespace galactic::simulation
