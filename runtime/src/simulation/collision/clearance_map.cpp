#include "simulation/collision/clearance_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "column_grid/column_grid_kernels.h"

namespace galactic::simulation {
namespace {

/// Cells along the edge of a tile.
constexpr std::uint32_t kTileEdge = 8;
/// What a band's height and the spheres that it clears differ by at least, meters: more than any
/// rounding.
constexpr float kSlack = 1e-3F;
/// How far above the lowest height that it can have a sphere is looked for, meters.
constexpr float kOverContact = 5e-3F;
/// Cells after the last one: look-ups read two at a time.
constexpr std::size_t kReadBeyond = 1;

struct Heights {
  float lowest = 0;
  float low = 0;
  float highest = 0;
  float band_from = 0;
  float band_height = 0;

  /// The least height of a center that a plane clears: the lower one, then the bands.
  [[nodiscard]] float lowOf(std::uint32_t plane) const {
    if (plane == 0) return lowest;
    return plane == 1 ? low : band_from + static_cast<float>(plane - 1) * band_height;
  }
};

/// Columns along a step: enough to count room that reaches far, and a power of two, so that no
/// rounding tells a sphere's cell from its column's.
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
  [[nodiscard]] std::uint32_t tilesX() const { return (x + kTileEdge - 1) / kTileEdge; }
  [[nodiscard]] std::uint32_t tilesZ() const { return (z + kTileEdge - 1) / kTileEdge; }
  [[nodiscard]] std::uint32_t count() const { return tilesX() * tilesZ() * kTileEdge * kTileEdge; }
  [[nodiscard]] std::size_t tiled(std::uint32_t i, std::uint32_t k) const {
    const std::uint32_t tile = k / kTileEdge * tilesX() + i / kTileEdge;
    return (std::size_t{tile} * kTileEdge + k % kTileEdge) * kTileEdge + i % kTileEdge;
  }
};

Cells cellsOf(const ColumnGrid& grid) {
  Cells cells{.step = columnsOfStep(grid.spacing())};
  cells.x = (grid.columnsX() + cells.edge() - 1) / cells.edge();
  cells.z = (grid.columnsZ() + cells.edge() - 1) / cells.edge();
  return cells;
}

/// For each column of the cells the height from which on it is free up to `highest`; infinity where
/// it is not, or is missing.
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

/// How many columns of a rectangle are not clear: sums over all columns before each, along both
/// axes (Crow 1984). What lies outside of the grid is not clear.
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

/// The largest square around a cell that is clear, which then grows by a step on each side after
/// the other, where there is room beside it.
RoomAround roomAround(const Cells& cells, const NotClear& not_clear, std::uint32_t i,
                      std::uint32_t k) {
  const std::int64_t step = cells.step;
  std::int64_t x = std::int64_t{i} * cells.edge();
  std::int64_t z = std::int64_t{k} * cells.edge();
  std::int64_t end_x = x + cells.edge();
  std::int64_t end_z = z + cells.edge();
  const auto is_clear_around = [&](std::int64_t by) {
    return not_clear.none(x - by, end_x + by, z - by, end_z + by);
  };
  if (!is_clear_around(0)) return 0;
  std::int64_t square = 0;
  for (std::int64_t blocked = kMostRoom; blocked - square > 1;) {
    const std::int64_t between = (square + blocked) / 2;
    (is_clear_around(between * step) ? square : blocked) = between;
  }
  x -= square * step;
  z -= square * step;
  end_x += square * step;
  end_z += square * step;
  RoomAround room = 0;
  const auto add = [&](int side, std::int64_t steps) {
    room = static_cast<RoomAround>(room + (steps << side));
  };
  for (const int side : {kRoomDownX, kRoomUpX, kRoomDownZ, kRoomUpZ}) add(side, square + 1);
  const auto grow = [&](int side, bool is_clear, std::int64_t& border, std::int64_t by) {
    if (!is_clear || (static_cast<unsigned>(room) >> side & kMostRoom) == kMostRoom) return false;
    border += by;
    add(side, 1);
    return true;
  };
  for (bool grows = true; grows;) {
    grows = grow(kRoomDownX, not_clear.none(x - step, x, z, end_z), x, -step);
    grows |= grow(kRoomUpX, not_clear.none(end_x, end_x + step, z, end_z), end_x, step);
    grows |= grow(kRoomDownZ, not_clear.none(x, end_x, z - step, z), z, -step);
    grows |= grow(kRoomUpZ, not_clear.none(x, end_x, end_z, end_z + step), end_z, step);
  }
  return room;
}

/// The room around each cell in one plane, tile by tile, to `out`.
void fillPlane(const Cells& cells, std::span<const float> lowest_free, float low,
               std::span<RoomAround> out) {
  const NotClear not_clear(cells, lowest_free, low);
  for (std::uint32_t k = 0; k < cells.z; ++k) {
    for (std::uint32_t i = 0; i < cells.x; ++i) {
      out[cells.tiled(i, k)] = roomAround(cells, not_clear, i, k);
    }
  }
}

}  // namespace

ClearanceMaps::ClearanceMaps(std::vector<std::uint32_t> radius_of_lane, std::size_t most_bytes)
    : radius_of_lane_(std::move(radius_of_lane)),
      eights_(paddedToLanes(radius_of_lane_.size()) / kLanes),
      most_bytes_(most_bytes),
      lanes_(eights_),
      cells_(1 + kReadBeyond) {
  // Lanes beyond the last group repeat the first of their eight, as bounds do.
  for (std::size_t n = radius_of_lane_.size(); n < eights_ * kLanes; ++n) {
    radius_of_lane_.push_back(radius_of_lane_[n / kLanes * kLanes]);
  }
}

std::size_t ClearanceMaps::bytesFor(const Scene& scene) const {
  std::size_t bytes = 0;
  for (std::uint32_t radius = 0; radius < scene.grids().size(); ++radius) {
    if (std::ranges::find(radius_of_lane_, radius) == radius_of_lane_.end()) continue;
    bytes +=
        std::size_t{kClearancePlanes} * cellsOf(scene.grids()[radius]).count() * sizeof(RoomAround);
  }
  return bytes;
}

std::uint32_t ClearanceMaps::add(const Scene& scene, float floor, float unevenness,
                                 const HeightsOverFloor& heights,
                                 std::span<const float> lowest_of_radius) {
  if (cells_.size() * sizeof(RoomAround) + bytesFor(scene) > most_bytes_) return kNoClearanceMap;
  const std::uint32_t map = count_++;
  lanes_.resize(count_ * eights_);
  const std::span<ClearanceLanes> lanes = std::span(lanes_).last(eights_);
  for (std::uint32_t radius = 0; radius < scene.grids().size(); ++radius) {
    if (std::ranges::find(radius_of_lane_, radius) == radius_of_lane_.end()) continue;
    const ColumnGrid& grid = scene.grids()[radius];
    const float from = floor + heights.lowest - 2 * kSlack;
    const float highest = floor + unevenness + heights.highest + 2 * kSlack;
    const float over_contact = floor + grid.radius() + kOverContact;
    // Over what lies on the floor and is lower than all spheres of the radius, they are free, too.
    const float lowest = std::max(heights.lowest, lowestOver(lowest_of_radius, radius));
    const Heights asked{.lowest = std::max(floor + lowest - 2 * kSlack, over_contact),
                        .low = std::max(from, over_contact + unevenness),
                        .highest = highest,
                        .band_from = from,
                        .band_height = (highest - from) / static_cast<float>(kClearanceBands)};
    const Cells cells = cellsOf(grid);
    const std::vector<float> lowest_free = lowestFree(grid, cells, highest);
    const std::size_t first = cells_.size() - kReadBeyond;
    cells_.resize(first + std::size_t{kClearancePlanes} * cells.count() + kReadBeyond);
    for (std::uint32_t plane = 0; plane < kClearancePlanes; ++plane) {
      fillPlane(
          cells, lowest_free, asked.lowOf(plane),
          std::span(cells_).subspan(first + std::size_t{plane} * cells.count(), cells.count()));
    }
    for (std::size_t n = 0; n < radius_of_lane_.size(); ++n) {
      if (radius_of_lane_[n] != radius) continue;
      ClearanceLanes& to = lanes[n / kLanes];
      const std::size_t lane = n % kLanes;
      to.min_x[lane] = grid.layout().min_x;
      to.min_z[lane] = grid.layout().min_z;
      to.inverse_step[lane] = grid.layout().inverse_spacing / static_cast<float>(cells.step);
      to.steps_x[lane] = static_cast<float>(cells.x * kStepsPerCell);
      to.steps_z[lane] = static_cast<float>(cells.z * kStepsPerCell);
      to.lowest[lane] = asked.lowest;
      to.low[lane] = asked.low;
      to.highest[lane] = asked.highest;
      to.band_from[lane] = asked.band_from;
      to.inverse_band[lane] = 1 / asked.band_height;
      to.first[lane] = static_cast<std::int32_t>(first);
      to.band_cells[lane] = static_cast<std::int32_t>(cells.count());
      to.tiles_x[lane] = static_cast<std::int32_t>(cells.tilesX());
    }
  }
  return map;
}

void ClearanceMaps::surelyFree(std::uint32_t map, std::size_t eight, const GroupBounds& bounds,
                               SureGroups& sure) const noexcept {
  const ClearanceQuestion question{lanesOf(map, eight), bounds.values};
  answer({&question, 1}, bounds.stride, &sure);
}

void ClearanceMaps::surelyFree(std::span<const std::uint32_t> maps, std::size_t eight,
                               const GroupBounds& bounds, std::size_t env_stride,
                               std::span<SureGroups> sure) const noexcept {
  std::array<ClearanceQuestion, kMostAsked> questions;
  for (std::size_t n = 0; n < maps.size(); ++n) {
    questions[n] = {lanesOf(maps[n], eight), bounds.values + n * env_stride};
  }
  answer(std::span(questions).first(maps.size()), bounds.stride, sure.data());
}

void ClearanceMaps::surelyFree(std::span<const std::uint32_t> maps, std::size_t eight,
                               std::span<const CenterBounds> bounds,
                               std::span<unsigned> free) const noexcept {
  std::array<BoxQuestion, kMostAsked> questions;
  for (std::size_t n = 0; n < maps.size(); ++n) {
    questions[n] = {lanesOf(maps[n], eight), &bounds[n]};
  }
  const auto ask = detail::hasAvx2() ? boxesSurelyFreeAvx2 : boxesSurelyFreePortable;
  ask(questions.data(), maps.size(), cells_.data(), free.data());
}

unsigned ClearanceMaps::freeAfter(std::uint32_t map, std::size_t eight, const SureGroups& sure,
                                  float x, float z) const noexcept {
  const ClearanceLanes& lanes = *lanesOf(map, eight);
  return detail::hasAvx2() ? freeAfterAvx2(lanes, sure, x, z)
                           : freeAfterPortable(lanes, sure, x, z);
}

void ClearanceMaps::answer(std::span<const ClearanceQuestion> questions, std::size_t stride,
                           SureGroups* sure) const noexcept {
  const auto ask = detail::hasAvx2() ? surelyFreeAvx2 : surelyFreePortable;
  ask(questions.data(), questions.size(), cells_.data(), stride, sure);
}

namespace {

/// How far room reaches on one side, in steps from the middle of its cell.
float roomOn(int side, RoomAround room) {
  return static_cast<float>(static_cast<unsigned>(room) >> side & kMostRoom);
}

SureGroups surelyFree(const ClearanceLanes& lanes, const RoomAround* cells, const float* bounds,
                      std::size_t stride) {
  SureGroups sure;
  for (std::size_t n = 0; n < kLanes; ++n) {
    const auto steps = [&](std::size_t bound, float from) {
      return (bounds[bound * stride + n] - from) * lanes.inverse_step[n];
    };
    const float least_x = steps(0, lanes.min_x[n]);
    const float most_x = steps(1, lanes.min_x[n]);
    const float least_z = steps(4, lanes.min_z[n]);
    const float most_z = steps(5, lanes.min_z[n]);
    const float x = 0.5F * (least_x + most_x);
    const float z = 0.5F * (least_z + most_z);
    const float least_y = bounds[2 * stride + n];
    const float most_y = bounds[3 * stride + n];
    const bool inside = x >= 0 && x < lanes.steps_x[n] && z >= 0 && z < lanes.steps_z[n] &&
                        least_y >= lanes.lowest[n] && most_y <= lanes.highest[n];
    if (!inside) continue;
    const auto i = static_cast<std::uint32_t>(x) / kStepsPerCell;
    const auto k = static_cast<std::uint32_t>(z) / kStepsPerCell;
    const float above = (least_y - lanes.band_from[n]) * lanes.inverse_band[n];
    const std::int32_t plane = least_y >= lanes.low[n]
                                   ? std::min(static_cast<std::int32_t>(above) + 1,
                                              static_cast<std::int32_t>(kClearancePlanes) - 1)
                                   : 0;
    const std::uint32_t tile =
        k / kTileEdge * static_cast<std::uint32_t>(lanes.tiles_x[n]) + i / kTileEdge;
    const std::size_t cell =
        (std::size_t{tile} * kTileEdge + k % kTileEdge) * kTileEdge + i % kTileEdge;
    const RoomAround room =
        cells[static_cast<std::size_t>(lanes.first[n] + plane * lanes.band_cells[n]) + cell];
    // What room is counted from: a cell that is not free has none.
    const auto middle_x = static_cast<float>(i * kStepsPerCell + 1);
    const auto middle_z = static_cast<float>(k * kStepsPerCell + 1);
    const float down_x = least_x - (middle_x - roomOn(kRoomDownX, room));
    const float up_x = middle_x + roomOn(kRoomUpX, room) - most_x;
    const float down_z = least_z - (middle_z - roomOn(kRoomDownZ, room));
    const float up_z = middle_z + roomOn(kRoomUpZ, room) - most_z;
    sure.down_x.values[n] = down_x;
    sure.up_x.values[n] = up_x;
    sure.down_z.values[n] = down_z;
    sure.up_z.values[n] = up_z;
    const bool is_free = down_x > 0 && up_x > 0 && down_z > 0 && up_z > 0;
    sure.free |= (is_free ? 1U : 0U) << n;
  }
  return sure;
}

}  // namespace

void surelyFreePortable(const ClearanceQuestion* questions, std::size_t count,
                        const RoomAround* cells, std::size_t stride, SureGroups* sure) noexcept {
  for (std::size_t n = 0; n < count; ++n) {
    sure[n] = surelyFree(*questions[n].lanes, cells, questions[n].bounds, stride);
  }
}

void boxesSurelyFreePortable(const BoxQuestion* questions, std::size_t count,
                             const RoomAround* cells, unsigned* free) noexcept {
  for (std::size_t n = 0; n < count; ++n) {
    std::array<float, kBounds * kLanes> of_all;
    for (std::size_t k = 0; k < of_all.size(); ++k) {
      of_all[k] = questions[n].bounds->values[k / kLanes];
    }
    free[n] = surelyFree(*questions[n].lanes, cells, of_all.data(), kLanes).free;
  }
}

unsigned freeAfterPortable(const ClearanceLanes& lanes, const SureGroups& sure, float x,
                           float z) noexcept {
  unsigned free = 0;
  for (std::size_t n = 0; n < kLanes; ++n) {
    const float by_x = x * lanes.inverse_step[n];
    const float by_z = z * lanes.inverse_step[n];
    const auto goes = [n](const SlackOfGroups& slack, float by) {
      return slack.values[n] >= by + kMoveRounding;
    };
    const bool is_free = goes(sure.down_x, -by_x) && goes(sure.up_x, by_x) &&
                         goes(sure.down_z, -by_z) && goes(sure.up_z, by_z);
    free |= (is_free ? 1U : 0U) << n;
  }
  return free & sure.free;
}

}  // namespace galactic::simulation
