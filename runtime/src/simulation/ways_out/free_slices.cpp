#include "simulation/ways_out/free_slices.h"

#include <algorithm>
#include <cmath>

#include "column_grid/column_grid_kernels.h"

namespace galactic::simulation {
namespace {

/// Height of a slice, meters, and how many there are at most. Higher ones where they do not
/// suffice.
constexpr float kSlice = 0.04F;
constexpr float kMostSlices = 64;
/// What blocks is at least this far from a free slice, meters: more than any rounding.
constexpr float kSlack = 1e-3F;
/// Rows of zeros behind those of a slice: what is outside of the grid, and what is read unused.
constexpr std::int32_t kRowsBehind = 8;

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

std::int32_t stripCount(const ColumnGrid& grid) {
  return static_cast<std::int32_t>(grid.columnsX() / kStripColumns + 1);
}

}  // namespace

std::uint32_t FreeSlices::add(const Scene& scene, float floor, const HeightsOverFloor& heights) {
  radii_ = scene.grids().size();
  const std::size_t map = layouts_.size() / radii_;
  for (const ColumnGrid& grid : scene.grids()) {
    const ColumnGridLayout& from = grid.layout();
    // Nothing can be lower than at contact with the floor.
    const float lowest = floor + std::max(heights.lowest - kSlack, grid.radius() + 2 * kSlack);
    const float range = std::max(floor + heights.highest - lowest, kSlice);
    const float slices = std::min(std::ceil(range / kSlice), kMostSlices);
    const float thickness = range / slices;
    const SliceLayout layout{
        .min_x = from.min_x,
        .min_z = from.min_z,
        .inverse_spacing = from.inverse_spacing,
        .columns_x = static_cast<float>(from.columns_x),
        .columns_z = static_cast<float>(from.columns_z),
        .lowest = lowest,
        .inverse_slice = 1 / thickness,
        .slices = slices,
        .slice_count = static_cast<std::int32_t>(slices),
        .row_count = static_cast<std::int32_t>(from.columns_z) + kCellsAround + kRowsBehind,
        .first = rows_.size()};
    const std::size_t rows_of_slices = static_cast<std::size_t>(stripCount(grid)) *
                                       static_cast<std::size_t>(layout.slice_count) *
                                       static_cast<std::size_t>(layout.row_count);
    rows_.resize(rows_.size() + rows_of_slices);
    blocked_rows_.resize(rows_.size());
    fill(grid, thickness, layout);
    layouts_.push_back(layout);
  }
  return static_cast<std::uint32_t>(map);
}

void FreeSlices::fill(const ColumnGrid& grid, float thickness, const SliceLayout& layout) {
  const auto row_count = static_cast<std::size_t>(layout.row_count);
  const auto slices = static_cast<std::size_t>(layout.slice_count);
  const std::size_t strip_rows = slices * row_count;
  const auto strips = static_cast<std::size_t>(stripCount(grid));
  std::array<ColumnSlices, kStripColumns> columns;
  // Those of the columns whose slice `n` is one of `which`.
  const auto columns_with = [&](std::uint64_t ColumnSlices::*which, std::size_t n) {
    unsigned with = 0;
    for (unsigned c = 0; c < kStripColumns; ++c) {
      with |= static_cast<unsigned>(columns[c].*which >> n & 1U) << c;
    }
    return with;
  };
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    const std::size_t row = layout.first + k + kCellsAround;
    // A strip begins kCellsAround columns before a multiple of kStripColumns; its second half is
    // the first one of the next.
    for (std::size_t strip = 0; strip <= strips; ++strip) {
      for (std::uint32_t n = 0; n < kStripColumns; ++n) {
        const auto i = static_cast<std::uint32_t>(strip * kStripColumns) + n - kCellsAround;
        columns[n] = i < grid.columnsX()
                         ? slicesOf(grid, i, k, layout.lowest, thickness, layout.slices)
                         : ColumnSlices{};
      }
      for (std::size_t slice = 0; slice < slices; ++slice) {
        const auto write = [&](std::vector<std::uint16_t>& rows, unsigned bits) {
          std::uint16_t* at = rows.data() + row + slice * row_count;
          const auto second = static_cast<std::uint16_t>(bits << kStripColumns);
          if (strip < strips) at[strip * strip_rows] |= static_cast<std::uint16_t>(bits);
          if (strip > 0) at[(strip - 1) * strip_rows] |= second;
        };
        write(rows_, columns_with(&ColumnSlices::free, slice));
        write(blocked_rows_, columns_with(&ColumnSlices::blocked, slice));
      }
    }
  }
}

void FreeSlices::findPlaces(std::uint32_t map, std::uint32_t radius, const float* x, const float* y,
                            const float* z, EightPlaces& places) const noexcept {
  if (map == kNoClearanceMap) {
    places.inside = places.free = places.blocked = 0;
    return;
  }
  const SliceLayout& layout = layouts_[map * radii_ + radius];
  const SliceRows rows{rows_.data() + layout.first, blocked_rows_.data() + layout.first};
  if (detail::hasAvx2()) {
    findPlacesAvx2(layout, rows, x, y, z, places);
  } else {
    findPlacesPortable(layout, rows, x, y, z, places);
  }
}

void findPlacesPortable(const SliceLayout& layout, const SliceRows& rows, const float* x,
                        const float* y, const float* z, EightPlaces& places) noexcept {
  places.inside = places.free = places.blocked = 0;
  for (std::size_t n = 0; n < kLanes; ++n) {
    const float cell_x = (x[n] - layout.min_x) * layout.inverse_spacing;
    const float cell_z = (z[n] - layout.min_z) * layout.inverse_spacing;
    const float height = (y[n] - layout.lowest) * layout.inverse_slice;
    const bool inside = cell_x >= 0 && cell_x < layout.columns_x && cell_z >= 0 &&
                        cell_z < layout.columns_z && height >= 0 && height < layout.slices;
    if (!inside) continue;
    const auto i = static_cast<std::int32_t>(cell_x);
    const auto k = static_cast<std::int32_t>(cell_z);
    constexpr auto kColumns = static_cast<std::int32_t>(kStripColumns);
    const std::int32_t of_slice =
        i / kColumns * layout.slice_count + static_cast<std::int32_t>(height);
    places.row[n] = of_slice * layout.row_count + k;
    places.column[n] = i % kColumns;
    places.part_x[n] = cell_x - static_cast<float>(i);
    places.part_z[n] = cell_z - static_cast<float>(k);
    const unsigned bit = 1U << n;
    places.inside |= bit;
    const unsigned own = static_cast<unsigned>(places.column[n]) + kCellsAround;
    const std::int32_t own_row = places.row[n] + kCellsAround;
    if ((rows.free[own_row] >> own & 1U) != 0) places.free |= bit;
    if ((rows.blocked[own_row] >> own & 1U) != 0) places.blocked |= bit;
  }
}

std::optional<SurroundingRows> FreeSlices::around(std::uint32_t map, std::uint32_t radius,
                                                  const Vec3& center) const noexcept {
  if (map == kNoClearanceMap) return std::nullopt;
  const SliceLayout& layout = layouts_[map * radii_ + radius];
  const float x = (center.x - layout.min_x) * layout.inverse_spacing;
  const float z = (center.z - layout.min_z) * layout.inverse_spacing;
  const float height = (center.y - layout.lowest) * layout.inverse_slice;
  const bool inside = x >= 0 && x < layout.columns_x && z >= 0 && z < layout.columns_z &&
                      height >= 0 && height < layout.slices;
  if (!inside) return std::nullopt;
  const auto i = static_cast<std::int32_t>(x);
  constexpr auto kColumns = static_cast<std::int32_t>(kStripColumns);
  const std::int32_t of_slice =
      i / kColumns * layout.slice_count + static_cast<std::int32_t>(height);
  const std::int32_t row = of_slice * layout.row_count + static_cast<std::int32_t>(z);
  const std::size_t first = layout.first + static_cast<std::size_t>(row);
  return SurroundingRows{rows_.data() + first, blocked_rows_.data() + first,
                         static_cast<unsigned>(i % kColumns)};
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
