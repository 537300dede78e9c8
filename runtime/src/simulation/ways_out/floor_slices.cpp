#include "simulation/ways_out/floor_slices.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

#include "galactic/column_grid.h"
#include "support/huge_pages.h"

namespace galactic::simulation {
namespace {

/// The height of a slice, meters, and the most slices. If these do not suffice, slices become
/// higher.
constexpr float kSlice = 0.04F;
constexpr std::size_t kMostSlices = 64;
/// Obstacles are at least this far from a free slice, meters: more than any rounding.
constexpr float kSlack = 1e-3F;
/// The limit of tileOfRow(): nothing is known of wider scenes.
constexpr std::uint32_t kMostColumnsZ = 1U << 16U;

/// Slices of one column, as bits.
struct ColumnSlices {
  /// Slices that are free at all heights, and slices that are blocked at all heights.
  std::uint64_t free = 0;
  std::uint64_t blocked = 0;
};

/// The bits of the `count` lowest slices.
std::uint64_t lowestSlices(unsigned count) {
  return count == kMostSlices ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

/// How many of `count` slices lie entirely below a height, which is given in slices above the
/// lowest.
unsigned slicesBelow(float height, float count) {
  return static_cast<unsigned>(std::clamp(height, 0.0F, count));
}

/// The same, including the slice that contains the height.
unsigned slicesUpTo(float height, float count) {
  const float inside = std::clamp(height, 0.0F, count);
  const auto below = static_cast<unsigned>(inside);
  return below + (static_cast<float>(below) < inside ? 1U : 0U);
}

/// Cuts columns into slices.
class ColumnSlicer {
 public:
  /// `lowest`: where the `count` slices begin. Meters.
  ColumnSlicer(const ColumnGrid& grid, float lowest, float thickness, float count)
      : grid_(grid), lowest_(lowest), thickness_(thickness), count_(count) {}

  ColumnSlices at(std::uint32_t i, std::uint32_t k) {
    SomeSpans& spans = spans_[current_];
    const std::size_t found = grid_.spans(i, k, spans);
    // Most columns equal the previous one.
    const std::size_t kept = std::min(found, spans.size());
    if (found == last_found_ && std::ranges::equal(std::span(spans).first(kept),
                                                   std::span(spans_[1 - current_]).first(kept))) {
      return last_;
    }
    last_found_ = found;
    last_ = slicesOf(std::span(spans).first(kept));
    // If there were too many spans, those left out may be free anywhere.
    if (found > kept) last_.blocked = 0;
    current_ = 1 - current_;
    return last_;
  }

 private:
  /// The free spans of a column: more than almost any has.
  using SomeSpans = std::array<Span, 16>;

  [[nodiscard]] ColumnSlices slicesOf(std::span<const Span> spans) const {
    std::uint64_t free = 0;
    std::uint64_t touched = 0;
    const auto slice_at = [&](float height) { return (height - lowest_) / thickness_; };
    for (const Span& span : spans) {
      free |= lowestSlices(slicesBelow(slice_at(span.hi - kSlack), count_)) &
              ~lowestSlices(slicesUpTo(slice_at(span.lo + kSlack), count_));
      touched |= lowestSlices(slicesUpTo(slice_at(span.hi + kSlack), count_)) &
                 ~lowestSlices(slicesBelow(slice_at(span.lo - kSlack), count_));
    }
    return {free, ~touched & lowestSlices(static_cast<unsigned>(count_))};
  }

  const ColumnGrid& grid_;
  float lowest_, thickness_, count_;
  /// The spans of the current column, at `current_`, and of the column that was cut last.
  std::array<SomeSpans, 2> spans_;
  std::size_t current_ = 0;
  std::size_t last_found_ = std::numeric_limits<std::size_t>::max();
  ColumnSlices last_;
};

std::uint32_t tilesX(const ColumnGrid& grid) {
  return (grid.columnsX() + kTileColumns - 1) / kTileColumns;
}

std::uint32_t tilesZ(const ColumnGrid& grid) {
  return (grid.columnsZ() + kTileRows - 1) / kTileRows;
}

using BitMatrix = std::array<std::uint64_t, 64>;

/// Swaps rows and columns: first in halves, then in halves of these, and so on (Warren, Hacker's
/// Delight, 7-3).
void transpose(BitMatrix& matrix) {
  std::uint64_t low_half = 0x0000'0000'ffff'ffff;
  for (std::size_t half = 32; half != 0; half /= 2, low_half ^= low_half << half) {
    for (std::size_t row = 0; row < matrix.size(); row = (row + half + 1) & ~half) {
      const std::uint64_t swapped = (matrix[row] >> half ^ matrix[row + half]) & low_half;
      matrix[row] ^= swapped << half;
      matrix[row + half] ^= swapped;
    }
  }
}

/// One bit for each slice and column. Each slice is a plane of rows of words along X; words at the
/// same place in their rows are adjacent in memory. Planes begin kCellsAround before the first
/// column, along X and Z, so that the bits and rows around a tile's first column begin at the
/// tile's own position.
class BitPlanes {
 public:
  BitPlanes(const ColumnGrid& grid, std::size_t slices)
      : slices_(slices),
        words_((std::size_t{tilesX(grid)} * kTileColumns + kRowBits + kWordBits - 1) / kWordBits),
        rows_(std::size_t{tilesZ(grid)} * kTileRows + SliceTile::kRows - kTileRows),
        bits_(slices_ * rows_ * words_) {}

  /// Sets the 64 columns of word `word` of row `k`. `columns`: the slices of each as bits.
  void set(std::uint32_t k, std::size_t word, BitMatrix& columns) {
    transpose(columns);
    for (std::size_t slice = 0; slice < slices_; ++slice) {
      bits_[(slice * words_ + word) * rows_ + k + kCellsAround] = columns[slice];
    }
  }
  [[nodiscard]] std::size_t words() const { return words_; }

  /// Cuts the rows of one tile out of a slice.
  void cut(std::size_t slice, std::uint32_t tile_x, std::uint32_t tile_z,
           std::uint16_t (&rows)[SliceTile::kRows]) const {
    const std::size_t bit = std::size_t{tile_x} * kTileColumns;
    const std::size_t shift = bit % kWordBits;
    const std::uint64_t* from =
        &bits_[(slice * words_ + bit / kWordBits) * rows_ + std::size_t{tile_z} * kTileRows];
    if (shift + kRowBits <= kWordBits) {
      for (std::size_t n = 0; n < SliceTile::kRows; ++n) {
        rows[n] = static_cast<std::uint16_t>(from[n] >> shift);
      }
      return;
    }
    const std::uint64_t* rest = from + rows_;
    for (std::size_t n = 0; n < SliceTile::kRows; ++n) {
      rows[n] = static_cast<std::uint16_t>(from[n] >> shift | rest[n] << (kWordBits - shift));
    }
  }

 private:
  static constexpr std::size_t kWordBits = 64;
  static constexpr std::size_t kRowBits = 16;

  std::size_t slices_;
  /// Words of a row, and rows of a plane.
  std::size_t words_, rows_;
  std::vector<std::uint64_t> bits_;
};

struct Planes {
  BitPlanes free;
  BitPlanes blocked;
};

Planes planesOf(const ColumnGrid& grid, float thickness, const SliceLayout& layout) {
  const auto slices = static_cast<std::size_t>(layout.slice_count);
  Planes planes{BitPlanes(grid, slices), BitPlanes(grid, slices)};
  ColumnSlicer slicer(grid, layout.lowest, thickness, layout.slices);
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::size_t word = 0; word < planes.free.words(); ++word) {
      BitMatrix free{};
      BitMatrix blocked{};
      for (std::size_t n = 0; n < free.size(); ++n) {
        const std::size_t padded = word * free.size() + n;
        if (padded < kCellsAround || padded - kCellsAround >= grid.columnsX()) continue;
        const auto i = static_cast<std::uint32_t>(padded - kCellsAround);
        const ColumnSlices column = slicer.at(i, k);
        free[n] = column.free;
        blocked[n] = column.blocked;
      }
      planes.free.set(k, word, free);
      planes.blocked.set(k, word, blocked);
    }
  }
  return planes;
}

bool isSame(const SliceTile& a, const SliceTile& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

/// Appends the tiles of one radius.
void addTiles(const ColumnGrid& grid, float thickness, const SliceLayout& layout,
              FloorSlices& floor) {
  const Planes planes = planesOf(grid, thickness, layout);
  const auto slices = static_cast<std::size_t>(layout.slice_count);
  std::uint32_t number = kNothingKnown;
  for (std::uint32_t tile_x = 0; tile_x < tilesX(grid); ++tile_x) {
    for (std::uint32_t tile_z = 0; tile_z < tilesZ(grid); ++tile_z) {
      for (std::size_t slice = 0; slice < slices; ++slice) {
        SliceTile tile;
        planes.free.cut(slice, tile_x, tile_z, tile.free);
        planes.blocked.cut(slice, tile_x, tile_z, tile.blocked);
        // Most tiles equal that of the slice below.
        if (!isSame(tile, floor.tiles.tiles()[number])) number = floor.tiles.numberOf(tile);
        floor.numbers.push_back(number);
      }
    }
  }
}

}  // namespace

DistinctTiles::DistinctTiles() : tiles_(detail::hugePages()), slots_(16) {
  SliceTile all_free{};
  std::ranges::fill(all_free.free, std::uint16_t{0xffff});
  [[maybe_unused]] const std::uint32_t free_everywhere = numberOf(all_free);
  [[maybe_unused]] const std::uint32_t nothing_known = numberOf({});
  assert(free_everywhere == 0 && nothing_known == kNothingKnown);
}

std::uint32_t DistinctTiles::numberOf(const SliceTile& tile) {
  return numberOf(tile, XXH3_64bits(&tile, sizeof(tile)));
}

std::vector<std::uint32_t> DistinctTiles::numbersOf(const DistinctTiles& others) {
  // Look-ups hit scattered memory, so they are prefetched this far ahead.
  constexpr std::size_t kSlotsAhead = 24;
  constexpr std::size_t kTilesAhead = 12;
  const std::span<const Hash> hashes = others.hashes_;
  std::vector<std::uint32_t> numbers;
  numbers.reserve(hashes.size());
  for (std::size_t n = 0; n < hashes.size(); ++n) {
    if (n + kSlotsAhead < hashes.size()) prefetchSlot(hashes[n + kSlotsAhead]);
    if (n + kTilesAhead < hashes.size()) prefetchTile(hashes[n + kTilesAhead]);
    numbers.push_back(numberOf(others.tiles_[n], hashes[n]));
  }
  return numbers;
}

std::uint32_t DistinctTiles::numberOf(const SliceTile& tile, Hash hash) {
  const std::size_t slot = slotOf(tile, hash);
  if (slots_[slot].count != 0) return slots_[slot].count - 1;
  // Indices of rows have 32 bits.
  constexpr std::size_t kMostTiles = (std::size_t{1} << 31) / kTileStride;
  if (tiles_.size() == kMostTiles) return kNothingKnown;
  tiles_.push_back(tile);
  hashes_.push_back(hash);
  const auto count = static_cast<std::uint32_t>(tiles_.size());
  slots_[slot] = {count, static_cast<std::uint32_t>(hash >> 32U)};
  if (2 * tiles_.size() > slots_.size()) growSlots();
  return count - 1;
}

std::size_t DistinctTiles::slotOf(const SliceTile& tile, Hash hash) const {
  const auto part = static_cast<std::uint32_t>(hash >> 32U);
  std::size_t at = wrapped(hash);
  while (slots_[at].count != 0 &&
         (slots_[at].hash != part || !isSame(tiles_[slots_[at].count - 1], tile))) {
    at = wrapped(at + 1);
  }
  return at;
}

void DistinctTiles::growSlots() {
  slots_.assign(2 * slots_.size(), {});
  for (std::uint32_t n = 0; n < tiles_.size(); ++n) {
    std::size_t at = wrapped(hashes_[n]);
    while (slots_[at].count != 0) at = wrapped(at + 1);
    slots_[at] = {n + 1, static_cast<std::uint32_t>(hashes_[n] >> 32U)};
  }
}

void DistinctTiles::prefetchSlot(Hash hash) const { __builtin_prefetch(&slots_[wrapped(hash)]); }

void DistinctTiles::prefetchTile(Hash hash) const {
  const std::uint32_t count = slots_[wrapped(hash)].count;
  if (count == 0) return;
  __builtin_prefetch(tiles_[count - 1].free);
  __builtin_prefetch(tiles_[count - 1].blocked);
}

FloorSlices makeFloorSlices(const Scene& scene, float floor, const HeightsOverFloor& heights,
                            std::span<const float> lowest_of_radius) {
  // No pack has more radii.
  assert(scene.grids().size() <= kLanes);
  FloorSlices made;
  for (std::uint32_t radius = 0; radius < scene.grids().size(); ++radius) {
    const ColumnGrid& grid = scene.grids()[radius];
    const ColumnGridLayout& from = grid.layout();
    // No sphere can be lower than at contact with the floor. Slices that begin at the lowest sphere
    // know that it is free above a rug.
    const float over_floor =
        std::max(heights.lowest, lowestOver(lowest_of_radius, radius)) - kSlack;
    const float lowest = floor + std::max(over_floor, grid.radius() + 2 * kSlack);
    const float range = std::max(floor + heights.highest - lowest, kSlice);
    const float slices = std::min(std::ceil(range / kSlice), static_cast<float>(kMostSlices));
    const float thickness = range / slices;
    const bool is_known = from.columns_z < kMostColumnsZ;
    SliceLayout& layout = made.layouts[radius];
    layout = {.min_x = from.min_x,
              .min_z = from.min_z,
              .inverse_spacing = from.inverse_spacing,
              .columns_x = static_cast<float>(from.columns_x),
              .columns_z = is_known ? static_cast<float>(from.columns_z) : 0,
              .lowest = lowest,
              .inverse_slice = 1 / thickness,
              .slices = slices,
              .slice_count = static_cast<std::int32_t>(slices),
              .tiles_z = static_cast<std::int32_t>(tilesZ(grid)),
              .first = is_known ? made.numbers.size() : 0};
    if (is_known) addTiles(grid, thickness, layout, made);
  }
  return made;
}

}  // namespace galactic::simulation
