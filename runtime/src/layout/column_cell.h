#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>

#include "galactic/pose.h"

namespace galactic {

// The one place that defines the layout of a column grid's cells, for the writer, the reader and
// the checker alike. docs/packs.md has a picture.

inline constexpr std::uint32_t kTileColumnsX = 4;
inline constexpr std::uint32_t kTileColumnsZ = 2;
inline constexpr std::uint32_t kCellsPerTile = kTileColumnsX * kTileColumnsZ;
/// Bytes of a tile: one cache line. Tiles start at multiples of it in the file.
inline constexpr std::size_t kTileBytes = kCellsPerTile * sizeof(std::uint64_t);
/// Unused elements in the vector of cells. They allow shifting the tiles to a cache line: a
/// FlatBuffers vector is aligned to 32 bytes at most.
inline constexpr std::size_t kTilePaddingCells = 4;
/// Highest code that a stored span uses.
inline constexpr std::uint32_t kMaxCode = 65534;
/// Codes per unit of a tile's base.
inline constexpr std::uint32_t kCodesPerTileBase = 1024;
/// Smallest edge of a cell, meters: bounds the time of a walk from cell to cell.
inline constexpr float kLeastSpacing = 1e-5F;
/// Most cells of a grid: batched queries compute cell indices in signed 32-bit integers.
inline constexpr std::uint64_t kMaxCells = std::uint64_t{1} << 27;

inline constexpr std::uint64_t kEmptySpanCode = 0x0000ffffU;  // lo = 65535, hi = 0
inline constexpr std::uint64_t kBlockedCell = kEmptySpanCode | (kEmptySpanCode << 32U);
inline constexpr std::uint64_t kOverflowMark = 0xffffffffU;  // lo = hi = 65535
/// The mark after the last span of an overflow cell, as a pair of codes and as heights.
inline constexpr std::uint32_t kEndOfCodes = 0xffffffffU;  // lo = hi = 65535
inline constexpr Span kEndOfSpans{std::numeric_limits<float>::max(),
                                  std::numeric_limits<float>::max()};

/// Tiles along an axis of `columns` cells.
[[nodiscard]] constexpr std::uint32_t tileCount(std::uint32_t columns, std::uint32_t tile_columns) {
  return (columns + tile_columns - 1) / tile_columns;
}

/// Cells of a whole grid, including the unused ones of the border tiles.
[[nodiscard]] constexpr std::uint64_t cellCount(std::uint32_t columns_x, std::uint32_t columns_z) {
  return std::uint64_t{tileCount(columns_x, kTileColumnsX)} * tileCount(columns_z, kTileColumnsZ) *
         kCellsPerTile;
}

/// Index of cell (i, k) in the vector of cells, which is ordered tile by tile.
[[nodiscard]] constexpr std::uint32_t cellIndex(std::uint32_t i, std::uint32_t k,
                                                std::uint32_t tiles_x) {
  const std::uint32_t tile = (k / kTileColumnsZ) * tiles_x + i / kTileColumnsX;
  return tile * kCellsPerTile + (k % kTileColumnsZ) * kTileColumnsX + i % kTileColumnsX;
}

/// The two codes of a span as the 32 bits of half a cell.
[[nodiscard]] constexpr std::uint64_t spanCode(std::uint32_t lo, std::uint32_t hi) {
  return std::uint64_t{lo} | (std::uint64_t{hi} << 16U);
}

/// The two codes of a span.
[[nodiscard]] constexpr std::uint32_t lowCode(std::uint32_t span_code) {
  return span_code & 0xffffU;
}
[[nodiscard]] constexpr std::uint32_t highCode(std::uint32_t span_code) { return span_code >> 16U; }

[[nodiscard]] constexpr bool isOverflow(std::uint64_t cell) {
  return (cell & 0xffffffffU) == kOverflowMark;
}

/// Where the spans of an overflow cell begin in overflow_codes or overflow_spans.
[[nodiscard]] constexpr std::uint32_t overflowStart(std::uint64_t cell) {
  return static_cast<std::uint32_t>(cell >> 32U);
}

[[nodiscard]] constexpr std::uint64_t overflowCell(std::uint32_t start) {
  return kOverflowMark | (std::uint64_t{start} << 32U);
}

/// Elements to skip at the beginning of a vector of cells whose first element is at byte `offset`
/// of the file.
[[nodiscard]] constexpr std::size_t tilePadding(std::size_t offset) {
  return ((kTileBytes - offset % kTileBytes) % kTileBytes) / sizeof(std::uint64_t);
}

}  // namespace galactic
