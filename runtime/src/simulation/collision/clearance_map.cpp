#include "simulation/collision/clearance_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "column_grid/column_grid_kernels.h"

namespace galactic::simulation {
namespace {

/// Cells along the edge of a tile: 64 bytes.
constexpr std::uint32_t kTileEdge = 8;
/// What a band's height and the spheres that it clears differ by at least, meters: more than any
/// rounding.
constexpr float kSlack = 1e-3F;
/// How far above the lowest height that it can have a sphere is looked for, meters.
constexpr float kOverContact = 5e-3F;

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

/// Cells of one radius, row by row.
struct Cells {
  std::uint32_t x = 0;
  std::uint32_t z = 0;

  [[nodiscard]] std::uint32_t columnsX() const { return x * kColumnsPerCell; }
  [[nodiscard]] std::uint32_t columnsZ() const { return z * kColumnsPerCell; }
  [[nodiscard]] std::uint32_t tilesX() const { return (x + kTileEdge - 1) / kTileEdge; }
  [[nodiscard]] std::uint32_t tilesZ() const { return (z + kTileEdge - 1) / kTileEdge; }
  [[nodiscard]] std::uint32_t bytes() const { return tilesX() * tilesZ() * kTileEdge * kTileEdge; }
  [[nodiscard]] std::size_t tiled(std::uint32_t i, std::uint32_t k) const {
    const std::uint32_t tile = k / kTileEdge * tilesX() + i / kTileEdge;
    return (std::size_t{tile} * kTileEdge + k % kTileEdge) * kTileEdge + i % kTileEdge;
  }
};

Cells cellsOf(const ColumnGrid& grid) {
  return {(grid.columnsX() + kColumnsPerCell - 1) / kColumnsPerCell,
          (grid.columnsZ() + kColumnsPerCell - 1) / kColumnsPerCell};
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

/// To each column the distance, in moves of a chess king, to the nearest that is not clear or
/// outside; 255 where it is farther. One sweep down and one up (Rosenfeld and Pfaltz 1968).
void spreadDistances(const Cells& cells, std::vector<std::uint8_t>& distance) {
  // A border of zeros around the columns spares all questions about neighbors.
  const std::size_t row = std::size_t{cells.columnsX()} + 2;
  const auto sweep = [&](std::size_t n, std::ptrdiff_t sign) {
    const auto step = static_cast<std::ptrdiff_t>(row);
    std::uint8_t* at = distance.data() + n;
    const int before =
        std::min({at[-sign], at[-sign * step - 1], at[-sign * step], at[-sign * step + 1]});
    *at = static_cast<std::uint8_t>(std::min(static_cast<int>(*at), std::min(before, 254) + 1));
  };
  for (std::size_t k = 1; k <= cells.columnsZ(); ++k) {
    for (std::size_t i = 1; i <= cells.columnsX(); ++i) sweep(k * row + i, 1);
  }
  for (std::size_t k = cells.columnsZ(); k > 0; --k) {
    for (std::size_t i = cells.columnsX(); i > 0; --i) sweep(k * row + i, -1);
  }
}

/// The least distance of the columns of each cell in one plane, tile by tile, to `out`.
void fillPlane(const Cells& cells, std::span<const float> lowest_free, float low,
               std::span<std::uint8_t> out) {
  const std::uint32_t columns = cells.columnsX();
  const std::size_t row = std::size_t{columns} + 2;
  std::vector<std::uint8_t> distance(row * (std::size_t{cells.columnsZ()} + 2));
  const auto at = [row](std::uint32_t i, std::uint32_t k) { return (k + 1) * row + i + 1; };
  for (std::uint32_t k = 0; k < cells.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const bool is_clear = lowest_free[std::size_t{k} * columns + i] <= low - kSlack;
      distance[at(i, k)] = is_clear ? std::uint8_t{255} : std::uint8_t{0};
    }
  }
  spreadDistances(cells, distance);
  std::ranges::fill(out, std::uint8_t{255});
  for (std::uint32_t k = 0; k < cells.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      std::uint8_t& least = out[cells.tiled(i / kColumnsPerCell, k / kColumnsPerCell)];
      least = std::min(least, distance[at(i, k)]);
    }
  }
}

}  // namespace

ClearanceMaps::ClearanceMaps(std::vector<std::uint32_t> radius_of_lane, std::size_t most_bytes)
    : radius_of_lane_(std::move(radius_of_lane)),
      eights_(paddedToLanes(radius_of_lane_.size()) / kLanes),
      most_bytes_(most_bytes) {
  // Lanes beyond the last group repeat the first of their eight, as bounds do.
  for (std::size_t n = radius_of_lane_.size(); n < eights_ * kLanes; ++n) {
    radius_of_lane_.push_back(radius_of_lane_[n / kLanes * kLanes]);
  }
}

std::size_t ClearanceMaps::bytesFor(const Scene& scene) const {
  std::size_t bytes = 0;
  for (std::uint32_t radius = 0; radius < scene.grids().size(); ++radius) {
    if (std::ranges::find(radius_of_lane_, radius) == radius_of_lane_.end()) continue;
    bytes += std::size_t{kClearancePlanes} * cellsOf(scene.grids()[radius]).bytes();
  }
  return bytes;
}

std::uint32_t ClearanceMaps::add(const Scene& scene, float floor, float unevenness,
                                 const HeightsOverFloor& heights,
                                 std::span<const float> lowest_of_radius) {
  if (cells_.size() + bytesFor(scene) > most_bytes_) return kNoClearanceMap;
  const std::size_t map = lanes_.size() / std::max<std::size_t>(eights_, 1);
  lanes_.resize(lanes_.size() + eights_);
  const std::span<ClearanceLanes> lanes = std::span(lanes_).last(eights_);
  constexpr std::size_t kReadBeyond = 3;
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
    const std::size_t first = cells_.empty() ? 0 : cells_.size() - kReadBeyond;
    cells_.resize(first + std::size_t{kClearancePlanes} * cells.bytes() + kReadBeyond);
    for (std::uint32_t plane = 0; plane < kClearancePlanes; ++plane) {
      fillPlane(
          cells, lowest_free, asked.lowOf(plane),
          std::span(cells_).subspan(first + std::size_t{plane} * cells.bytes(), cells.bytes()));
    }
    for (std::size_t n = 0; n < radius_of_lane_.size(); ++n) {
      if (radius_of_lane_[n] != radius) continue;
      ClearanceLanes& to = lanes[n / kLanes];
      const std::size_t lane = n % kLanes;
      to.min_x[lane] = grid.layout().min_x;
      to.min_z[lane] = grid.layout().min_z;
      to.inverse_cell[lane] = grid.layout().inverse_spacing / static_cast<float>(kColumnsPerCell);
      to.column[lane] = grid.layout().spacing;
      to.cells_x[lane] = static_cast<float>(cells.x);
      to.cells_z[lane] = static_cast<float>(cells.z);
      to.lowest[lane] = asked.lowest;
      to.low[lane] = asked.low;
      to.highest[lane] = asked.highest;
      to.band_from[lane] = asked.band_from;
      to.inverse_band[lane] = 1 / asked.band_height;
      to.first[lane] = static_cast<std::int32_t>(first);
      to.band_bytes[lane] = static_cast<std::int32_t>(cells.bytes());
      to.tiles_x[lane] = static_cast<std::int32_t>(cells.tilesX());
    }
  }
  return static_cast<std::uint32_t>(map);
}

void ClearanceMaps::surelyFree(std::uint32_t map, std::size_t eight, const GroupBounds& bounds,
                               SureGroups& sure) const noexcept {
  if (map == kNoClearanceMap) {
    sure = {};
    return;
  }
  const ClearanceQuestion question{&lanes_[map * eights_ + eight], bounds.values};
  answer({&question, 1}, bounds.stride, &sure);
}

void ClearanceMaps::surelyFree(std::span<const std::uint32_t> maps, std::size_t eight,
                               const GroupBounds& bounds, std::size_t env_stride,
                               std::span<SureGroups> sure) const noexcept {
  std::array<ClearanceQuestion, kMostAsked> questions;
  for (std::size_t n = 0; n < maps.size(); ++n) {
    const std::size_t map = maps[n] == kNoClearanceMap ? 0 : maps[n];
    questions[n] = {lanes_.data() + map * eights_ + eight, bounds.values + n * env_stride};
  }
  if (!lanes_.empty()) {
    answer(std::span(questions).first(maps.size()), bounds.stride, sure.data());
  }
  for (std::size_t n = 0; n < maps.size(); ++n) {
    if (maps[n] == kNoClearanceMap) sure[n] = {};
  }
}

unsigned ClearanceMaps::freeWithin(const SureGroups& sure, float reach) noexcept {
  return detail::hasAvx2() ? freeWithinAvx2(sure, reach) : freeWithinPortable(sure, reach);
}

void ClearanceMaps::answer(std::span<const ClearanceQuestion> questions, std::size_t stride,
                           SureGroups* sure) const noexcept {
  const auto ask = detail::hasAvx2() ? surelyFreeAvx2 : surelyFreePortable;
  ask(questions.data(), questions.size(), cells_.data(), stride, sure);
}

namespace {

/// How many columns bounds reach beyond a cell along one axis. `edge`: theirs, in cells. `part`:
/// where in its cell their middle is, 0 to 1.
float reachBeyond(float edge, float part) {
  constexpr auto kColumns = static_cast<float>(kColumnsPerCell);
  const float to_border = 1 - part < part ? 1 - part : part;
  return kColumns * (0.5F * edge - to_border);
}

SureGroups surelyFree(const ClearanceLanes& lanes, const std::uint8_t* cells, const float* bounds,
                      std::size_t stride) {
  SureGroups sure;
  for (std::size_t n = 0; n < kLanes; ++n) {
    const float* at = bounds + n;
    const bool is_low = !(at[2 * stride] >= lanes.low[n]);
    if (is_low) sure.low |= 1U << n;
    const float x = (0.5F * (at[0] + at[stride]) - lanes.min_x[n]) * lanes.inverse_cell[n];
    const float z =
        (0.5F * (at[4 * stride] + at[5 * stride]) - lanes.min_z[n]) * lanes.inverse_cell[n];
    const bool inside = x >= 0 && x < lanes.cells_x[n] && z >= 0 && z < lanes.cells_z[n] &&
                        at[2 * stride] >= lanes.lowest[n] && at[3 * stride] <= lanes.highest[n];
    if (!inside) continue;
    const auto i = static_cast<std::uint32_t>(x);
    const auto k = static_cast<std::uint32_t>(z);
    const float above = (at[2 * stride] - lanes.band_from[n]) * lanes.inverse_band[n];
    const std::int32_t plane = is_low ? 0
                                      : std::min(static_cast<std::int32_t>(above) + 1,
                                                 static_cast<std::int32_t>(kClearancePlanes) - 1);
    const std::uint32_t tile =
        k / kTileEdge * static_cast<std::uint32_t>(lanes.tiles_x[n]) + i / kTileEdge;
    const std::size_t cell =
        (std::size_t{tile} * kTileEdge + k % kTileEdge) * kTileEdge + i % kTileEdge;
    const std::uint8_t distance =
        cells[static_cast<std::size_t>(lanes.first[n] + plane * lanes.band_bytes[n]) + cell];
    const float wide = (at[stride] - at[0]) * lanes.inverse_cell[n];
    const float deep = (at[5 * stride] - at[4 * stride]) * lanes.inverse_cell[n];
    const float along_x = reachBeyond(wide, x - static_cast<float>(i));
    const float along_z = reachBeyond(deep, z - static_cast<float>(k));
    const float reach = along_z > along_x ? along_z : along_x;
    const float slack = static_cast<float>(distance) - (reach + kBeyondReach);
    if (!(slack >= 0)) continue;
    sure.free |= 1U << n;
    sure.slack[n] = slack * lanes.column[n];
  }
  return sure;
}

}  // namespace

void surelyFreePortable(const ClearanceQuestion* questions, std::size_t count,
                        const std::uint8_t* cells, std::size_t stride, SureGroups* sure) noexcept {
  for (std::size_t n = 0; n < count; ++n) {
    sure[n] = surelyFree(*questions[n].lanes, cells, questions[n].bounds, stride);
  }
}

unsigned freeWithinPortable(const SureGroups& sure, float reach) noexcept {
  unsigned free = 0;
  for (std::size_t n = 0; n < kLanes; ++n) free |= (sure.slack[n] >= reach ? 1U : 0U) << n;
  return free;
}

}  // namespace galactic::simulation
