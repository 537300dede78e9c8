#include "simulation/ways_out/free_slices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <functional>
#include <string_view>
#include <utility>

#include "column_grid/column_grid_kernels.h"

namespace galactic::simulation {
namespace {

/// Height of a slice, meters, and how many there are at most. Higher ones where they do not
/// suffice.
constexpr float kSlice = 0.04F;
constexpr float kMostSlices = 64;
/// What blocks is at least this far from a free slice, meters: more than any rounding.
constexpr float kSlack = 1e-3F;
/// What tileOfRow() can tell: of wider scenes nothing is known.
constexpr std::uint32_t kMostColumnsZ = 1U << 16U;

/// Slices of one column, as bits.
struct ColumnSlices {
  /// Free at all heights; blocked at all heights.
  std::uint64_t free = 0;
  std::uint64_t blocked = 0;
};

/// The slices from `from` up to `to`, counted from the lowest, of `count`.
std::uint64_t slicesWithin(float from, float to, float count) {
  const auto first = static_cast<unsigned>(std::clamp(from, 0.0F, count));
  const auto end = static_cast<unsigned>(std::clamp(to, 0.0F, count));
  std::uint64_t bits = 0;
  for (unsigned slice = first; slice < end; ++slice) bits |= std::uint64_t{1} << slice;
  return bits;
}

ColumnSlices slicesOf(const ColumnGrid& grid, std::uint32_t i, std::uint32_t k, float lowest,
                      float thickness, float count) {
  constexpr std::size_t kMostSpans = 16;
  std::array<Span, kMostSpans> spans;
  const std::size_t found = grid.spans(i, k, spans);
  std::uint64_t free = 0;
  std::uint64_t touched = 0;
  for (std::size_t n = 0; n < std::min(found, kMostSpans); ++n) {
    const auto slice_at = [&](float height) { return (height - lowest) / thickness; };
    free |= slicesWithin(std::ceil(slice_at(spans[n].lo + kSlack)),
                         std::floor(slice_at(spans[n].hi - kSlack)), count);
    touched |= slicesWithin(std::floor(slice_at(spans[n].lo - kSlack)),
                            std::ceil(slice_at(spans[n].hi + kSlack)), count);
  }
  // Of more spans than there is room for, those left out may be free anywhere.
  return {free, found > kMostSpans ? 0 : ~touched & slicesWithin(0, count, count)};
}

std::uint32_t tilesX(const ColumnGrid& grid) {
  return (grid.columnsX() + kTileColumns - 1) / kTileColumns;
}

std::uint32_t tilesZ(const ColumnGrid& grid) {
  return (grid.columnsZ() + kTileRows - 1) / kTileRows;
}

/// Sixteen columns side by side.
using TileRow = std::array<ColumnSlices, 16>;

/// Calls write(slice, bits) for each slice of which some bit is set: those of a row's columns.
template <class Write>
void forEachSlice(const TileRow& row, std::uint64_t ColumnSlices::*which, const Write& write) {
  std::uint64_t all = ~std::uint64_t{0};
  std::uint64_t any = 0;
  for (const ColumnSlices& column : row) {
    all &= column.*which;
    any |= column.*which;
  }
  for (; any != 0; any &= any - 1) {
    const auto slice = static_cast<std::size_t>(std::countr_zero(any));
    unsigned bits = 0xffffU;
    if ((all >> slice & 1U) == 0) {
      bits = 0;
      for (unsigned c = 0; c < row.size(); ++c) {
        bits |= static_cast<unsigned>(row[c].*which >> slice & 1U) << c;
      }
    }
    write(slice, static_cast<std::uint16_t>(bits));
  }
}

/// A column and a slice.
struct SliceCell {
  std::uint32_t i = 0;
  std::uint32_t k = 0;
  std::uint32_t slice = 0;
};

/// The tile that answers for a cell, and where in it the cells around it begin.
struct CellInTile {
  std::uint32_t tile = 0;
  std::uint32_t row = 0;
  std::uint32_t column = 0;
};

CellInTile inTile(const SliceLayout& layout, const TileSet& tiles, const SliceCell& cell) {
  const std::uint32_t tile_z = tileOfRow(cell.k);
  const std::uint32_t tile =
      cell.i / kTileColumns * static_cast<std::uint32_t>(layout.tiles_z) + tile_z;
  const std::uint32_t at = tile * static_cast<std::uint32_t>(layout.slice_count) + cell.slice;
  return {tiles.numbers[layout.first + at], cell.k - tile_z * kTileRows, cell.i % kTileColumns};
}

}  // namespace

FreeSlices::FreeSlices(std::vector<EightSpheres> groups) : groups_(std::move(groups)) {
  for (const EightSpheres& group : groups_) slice_groups_.push_back({{}, group.spheres});
  // The first one: see TileSet. What is outside of slices asks for the first number.
  SliceTile all_free{};
  std::ranges::fill(all_free.free, std::uint16_t{0xffff});
  numbers_.push_back(numberOf(all_free));
  [[maybe_unused]] const std::uint32_t nothing_known = numberOf({});
  assert(nothing_known == kNothingKnown);
}

std::uint32_t FreeSlices::add(const Scene& scene, float floor, const HeightsOverFloor& heights,
                              std::span<const float> lowest_of_radius) {
  // No pack has more.
  assert(scene.grids().size() <= kLanes);
  LayoutOfRadii layouts;
  for (std::uint32_t radius = 0; radius < scene.grids().size(); ++radius) {
    const ColumnGrid& grid = scene.grids()[radius];
    const ColumnGridLayout& from = grid.layout();
    // Nothing can be lower than at contact with the floor, and slices that begin where the lowest
    // sphere is know that it is free over a rug.
    const float over_floor =
        std::max(heights.lowest, lowestOver(lowest_of_radius, radius)) - kSlack;
    const float lowest = floor + std::max(over_floor, grid.radius() + 2 * kSlack);
    const float range = std::max(floor + heights.highest - lowest, kSlice);
    const float slices = std::min(std::ceil(range / kSlice), kMostSlices);
    const float thickness = range / slices;
    SliceLayout& layout = layouts[radius];
    layout = {.min_x = from.min_x,
              .min_z = from.min_z,
              .inverse_spacing = from.inverse_spacing,
              .columns_x = static_cast<float>(from.columns_x),
              .columns_z = from.columns_z < kMostColumnsZ ? static_cast<float>(from.columns_z) : 0,
              .lowest = lowest,
              .inverse_slice = 1 / thickness,
              .slices = slices,
              .slice_count = static_cast<std::int32_t>(slices),
              .tiles_z = static_cast<std::int32_t>(tilesZ(grid)),
              .first = from.columns_z < kMostColumnsZ ? numbers_.size() : 0};
    fill(grid, thickness, layout);
  }
  for (const EightSpheres& group : groups_) {
    slice_groups_.push_back({layouts[group.radius_index], group.spheres});
  }
  layouts_.push_back(layouts);
  return static_cast<std::uint32_t>(layouts_.size() - 1);
}

void FreeSlices::fill(const ColumnGrid& grid, float thickness, const SliceLayout& layout) {
  if (layout.columns_z == 0) return;
  std::vector<ColumnSlices> columns(std::size_t{grid.columnsX()} * grid.columnsZ());
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      columns[std::size_t{k} * grid.columnsX() + i] =
          slicesOf(grid, i, k, layout.lowest, thickness, layout.slices);
    }
  }
  // A tile begins kCellsAround before the cells around which it answers.
  const auto row_at = [&](std::uint32_t tile_x, std::uint32_t k) {
    TileRow row;
    for (std::uint32_t n = 0; n < row.size(); ++n) {
      const std::uint32_t i = tile_x * kTileColumns + n - kCellsAround;
      const bool is_inside = i < grid.columnsX() && k < grid.columnsZ();
      row[n] = is_inside ? columns[std::size_t{k} * grid.columnsX() + i] : ColumnSlices{};
    }
    return row;
  };
  std::vector<SliceTile> tiles(static_cast<std::size_t>(layout.slice_count));
  for (std::uint32_t tile_x = 0; tile_x < tilesX(grid); ++tile_x) {
    for (std::uint32_t tile_z = 0; tile_z < tilesZ(grid); ++tile_z) {
      std::ranges::fill(tiles, SliceTile{});
      for (std::uint32_t n = 0; n < SliceTile::kRows; ++n) {
        const TileRow row = row_at(tile_x, tile_z * kTileRows + n - kCellsAround);
        forEachSlice(row, &ColumnSlices::free,
                     [&](std::size_t slice, std::uint16_t bits) { tiles[slice].free[n] = bits; });
        forEachSlice(row, &ColumnSlices::blocked, [&](std::size_t slice, std::uint16_t bits) {
          tiles[slice].blocked[n] = bits;
        });
      }
      for (const SliceTile& tile : tiles) numbers_.push_back(numberOf(tile));
    }
  }
}

std::uint32_t FreeSlices::numberOf(const SliceTile& tile) {
  const std::string_view bytes(reinterpret_cast<const char*>(&tile), sizeof(tile));
  const std::size_t hash = std::hash<std::string_view>{}(bytes);
  const auto [first, end] = known_.equal_range(hash);
  for (auto at = first; at != end; ++at) {
    if (std::memcmp(&tiles_[at->second], &tile, sizeof(tile)) == 0) return at->second;
  }
  // Rows are counted in 32 bits.
  constexpr std::size_t kMostTiles = (std::size_t{1} << 31) / kTileStride;
  if (tiles_.size() == kMostTiles) return kNothingKnown;
  const auto number = static_cast<std::uint32_t>(tiles_.size());
  tiles_.push_back(tile);
  known_.emplace(hash, number);
  return number;
}

const SliceGroup* FreeSlices::groupsOf(std::uint32_t map) const {
  return slice_groups_.data() + map * groups_.size();
}

InSlices FreeSlices::findPlaces(std::uint32_t map, std::size_t first,
                                const SomeGroups& some) const noexcept {
  const PlacesQuery query{.groups = groupsOf(map) + first, .tiles = tiles(), .some = &some};
  return detail::hasAvx2() ? findPlacesAvx2(query) : findPlacesPortable(query);
}

void FreeSlices::findPlaces(std::span<const std::uint32_t> maps, std::size_t first,
                            const GroupsOfEnvs& some) const noexcept {
  std::array<const SliceGroup*, kEnvsAsked> groups;
  for (std::size_t n = 0; n < maps.size(); ++n) groups[n] = groupsOf(maps[n]) + first;
  const EnvPlacesQuery query{.groups = groups.data(), .tiles = tiles(), .some = &some};
  if (detail::hasAvx2()) {
    findPlacesOfEnvsAvx2(query);
  } else {
    findPlacesOfEnvsPortable(query);
  }
}

namespace {

/// The places of eight centers.
void findEight(const SliceLayout& layout, const TileSet& tiles, const float* x, const float* y,
               const float* z, EightPlaces& places) {
  places.inside = places.free = places.blocked = 0;
  for (std::size_t n = 0; n < kLanes; ++n) {
    const float cell_x = (x[n] - layout.min_x) * layout.inverse_spacing;
    const float cell_z = (z[n] - layout.min_z) * layout.inverse_spacing;
    const float height = (y[n] - layout.lowest) * layout.inverse_slice;
    const bool inside = cell_x >= 0 && cell_x < layout.columns_x && cell_z >= 0 &&
                        cell_z < layout.columns_z && height >= 0 && height < layout.slices;
    if (!inside) continue;
    const auto i = static_cast<std::uint32_t>(cell_x);
    const auto k = static_cast<std::uint32_t>(cell_z);
    const CellInTile cell = inTile(layout, tiles, {i, k, static_cast<std::uint32_t>(height)});
    places.row[n] =
        static_cast<std::int32_t>(cell.tile) * kTileStride + static_cast<std::int32_t>(cell.row);
    places.column[n] = static_cast<std::int32_t>(cell.column);
    places.part_x[n] = cell_x - static_cast<float>(i);
    places.part_z[n] = cell_z - static_cast<float>(k);
    const unsigned bit = 1U << n;
    places.inside |= bit;
    const unsigned own = cell.column + kCellsAround;
    const SliceTile& tile = tiles.tiles[cell.tile];
    if ((tile.free[cell.row + kCellsAround] >> own & 1U) != 0) places.free |= bit;
    if ((tile.blocked[cell.row + kCellsAround] >> own & 1U) != 0) places.blocked |= bit;
  }
}

}  // namespace

InSlices findPlacesPortable(const PlacesQuery& query) noexcept {
  InSlices found;
  const SomeGroups& some = *query.some;
  for (unsigned left = some.asked; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(std::countr_zero(left));
    const std::size_t first = n * kLanes;
    findEight(query.groups[n].layout, query.tiles, some.x + first, some.y + first, some.z + first,
              some.places[n]);
    addGroup(some.places[n], query.groups[n].spheres, n, found);
  }
  return found;
}

void findPlacesOfEnvsPortable(const EnvPlacesQuery& query) noexcept {
  const GroupsOfEnvs& some = *query.some;
  for (std::size_t e = 0; e < kEnvsAsked; ++e) {
    const auto asked = static_cast<unsigned>(some.asked >> (kLanes * e)) & 0xffU;
    if (asked == 0) continue;
    const SomeGroups groups{.x = some.x + e * some.stride,
                            .y = some.y + e * some.stride,
                            .z = some.z + e * some.stride,
                            .asked = asked,
                            .places = some.places + e * some.places_stride};
    const InSlices found =
        findPlacesPortable({.groups = query.groups[e], .tiles = query.tiles, .some = &groups});
    some.found[e].blocked |= found.blocked;
    some.found[e].unknown |= found.unknown;
  }
}

std::optional<SurroundingRows> FreeSlices::around(std::uint32_t map, std::uint32_t radius,
                                                  const Vec3& center) const noexcept {
  const SliceLayout& layout = layouts_[map][radius];
  const float x = (center.x - layout.min_x) * layout.inverse_spacing;
  const float z = (center.z - layout.min_z) * layout.inverse_spacing;
  const float height = (center.y - layout.lowest) * layout.inverse_slice;
  const bool inside = x >= 0 && x < layout.columns_x && z >= 0 && z < layout.columns_z &&
                      height >= 0 && height < layout.slices;
  if (!inside) return std::nullopt;
  const CellInTile cell = inTile(layout, tiles(),
                                 {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(z),
                                  static_cast<std::uint32_t>(height)});
  const SliceTile& tile = tiles_[cell.tile];
  return SurroundingRows{tile.free + cell.row, tile.blocked + cell.row, cell.column};
}

Surroundings surroundingsOf(const ColumnGrid& grid, const Vec3& center) noexcept {
  const ColumnGridLayout& layout = grid.layout();
  const float own_x = std::floor((center.x - layout.min_x) * layout.inverse_spacing) + 0.5F;
  const float own_z = std::floor((center.z - layout.min_z) * layout.inverse_spacing) + 0.5F;
  constexpr std::size_t kEdge = 2 * kCellsAround + 1;
  constexpr std::size_t kCount = paddedToLanes(kEdge);
  std::array<float, kCount> x;
  std::array<float, kCount> y;
  std::array<float, kCount> z;
  std::array<Clearance, kCount> clearance;
  for (std::size_t n = 0; n < kCount; ++n) {
    const float cells = static_cast<float>(n) - static_cast<float>(kCellsAround);
    x[n] = layout.min_x + (own_x + cells) * layout.spacing;
  }
  y.fill(center.y);
  Surroundings found;
  for (int row = -kCellsAround; row <= kCellsAround; ++row) {
    z.fill(layout.min_z + (own_z + static_cast<float>(row)) * layout.spacing);
    grid.contact({x, y, z}, {clearance, {}, {}});
    for (std::size_t n = 0; n < kEdge; ++n) {
      if (clearance[n] == Clearance::kFree) found.setFree(static_cast<int>(n) - kCellsAround, row);
    }
  }
  return found;
}

}  // namespace galactic::simulation
