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

/// Height of a slice, meters, and how many there are at most. Higher ones where they do not
/// suffice.
constexpr float kSlice = 0.04F;
constexpr std::size_t kMostSlices = 64;
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

/// The bits of the lowest slices, so many.
std::uint64_t lowestSlices(unsigned count) {
  return count == kMostSlices ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

/// How many of `count` slices lie whole below a height, in slices over the lowest.
unsigned slicesBelow(float height, float count) {
  return static_cast<unsigned>(std::clamp(height, 0.0F, count));
}

/// The same, with the one in which the height is.
unsigned slicesUpTo(float height, float count) {
  const float inside = std::clamp(height, 0.0F, count);
  const auto below = static_cast<unsigned>(inside);
  return below + (static_cast<float>(below) < inside ? 1U : 0U);
}

/// Cuts columns into slices.
class ColumnSlicer {
 public:
  /// `lowest`: where the slices begin, of which there are `count`. Meters.
  ColumnSlicer(const ColumnGrid& grid, float lowest, float thickness, float count)
      : grid_(grid), lowest_(lowest), thickness_(thickness), count_(count) {}

  ColumnSlices at(std::uint32_t i, std::uint32_t k) {
    SomeSpans& spans = spans_[current_];
    const std::size_t found = grid_.spans(i, k, spans);
    // Most columns are like the one before.
    const std::size_t kept = std::min(found, spans.size());
    if (found == last_found_ && std::ranges::equal(std::span(spans).first(kept),
                                                   std::span(spans_[1 - current_]).first(kept))) {
      return last_;
    }
    last_found_ = found;
    last_ = slicesOf(std::span(spans).first(kept));
    // Of more spans than there is room for, those left out may be free anywhere.
    if (found > kept) last_.blocked = 0;
    current_ = 1 - current_;
    return last_;
  }

 private:
  /// Room for what is free in a column: more spans than nearly any has.
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
  /// Of the column that is asked about, the current ones, and of the one that was cut last.
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

/// Swaps rows and columns: halves, then halves of these, and so on (Warren, Hacker's Delight, 7-3).
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

/// One bit for each slice and column: a plane for each slice, in rows along X of words, of which
/// those of one column of words lie side by side. They begin kCellsAround before the first column,
/// and so do rows along Z, so that tiles begin with the bit and the row at which they stand.
class BitPlanes {
 public:
  BitPlanes(const ColumnGrid& grid, std::size_t slices)
      : slices_(slices),
        words_((std::size_t{tilesX(grid)} * kTileColumns + kRowBits + kWordBits - 1) / kWordBits),
        rows_(std::size_t{tilesZ(grid)} * kTileRows + SliceTile::kRows - kTileRows),
        bits_(slices_ * rows_ * words_) {}

  /// Sets 64 columns of row `k`, those of word `word`: one number of slices as bits for each.
  void set(std::uint32_t k, std::size_t word, BitMatrix& columns) {
    transpose(columns);
    for (std::size_t slice = 0; slice < slices_; ++slice) {
      bits_[(slice * words_ + word) * rows_ + k + kCellsAround] = columns[slice];
    }
  }
  [[nodiscard]] std::size_t words() const { return words_; }

  /// The rows of a tile of a slice.
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
  /// Of a row; and rows of a plane.
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
        // Most are those of the slice below.
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
  // What is looked at lies anywhere in memory: so far ahead it is asked for.
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
  // Rows are counted in 32 bits.
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
  // No pack has more.
  assert(scene.grids().size() <= kLanes);
  FloorSlices made;
  for (std::uint32_t radius = 0; radius < scene.grids().size(); ++radius) {
    const ColumnGrid& grid = scene.grids()[radius];
    const ColumnGridLayout& from = grid.layout();
    // Nothing can be lower than at contact with the floor, and slices that begin where the lowest
    // sphere is know that it is free over a rug.
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
