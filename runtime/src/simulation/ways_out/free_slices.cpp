#include "simulation/ways_out/free_slices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "support/huge_pages.h"
#include "support/processor.h"

namespace galactic::simulation {
namespace {

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

FreeSlices::FreeSlices(std::vector<EightSpheres> groups)
    : groups_(std::move(groups)), numbers_(detail::hugePages()) {
  for (const EightSpheres& group : groups_) slice_groups_.push_back({{}, group.spheres});
  // Places outside of slices look up the first number.
  numbers_.push_back(0);
}

std::uint32_t FreeSlices::add(const FloorSlices& floor) {
  SlicesOfRadii layouts = floor.layouts;
  for (SliceLayout& layout : layouts) {
    if (layout.columns_z > 0) layout.first += numbers_.size();
  }
  const std::vector<std::uint32_t> numbers = tiles_.numbersOf(floor.tiles);
  for (const std::uint32_t number : floor.numbers) numbers_.push_back(numbers[number]);
  for (const EightSpheres& group : groups_) {
    slice_groups_.push_back({layouts[group.radius_index], group.spheres});
  }
  layouts_.push_back(layouts);
  return static_cast<std::uint32_t>(layouts_.size() - 1);
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
  const SliceTile& tile = tiles().tiles[cell.tile];
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
