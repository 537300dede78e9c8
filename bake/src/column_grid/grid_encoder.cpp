#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "galactic/bake/columns.h"
#include "layout/column_cell.h"

namespace galactic::bake {
namespace {

/// Codes of one span, rounded toward the blocked side; lo > hi if no code lies in the span.
struct Codes {
  std::int64_t lo = 0;
  std::int64_t hi = -1;
};

/// Translates heights to codes above the grid's lowest height.
class Quantizer {
 public:
  explicit Quantizer(const Span& heights) : base_(static_cast<double>(heights.lo)) {
    const double range = static_cast<double>(heights.hi) - base_;
    const double fitting = range / static_cast<double>(kMaxCode);
    tall_ = fitting > static_cast<double>(kMaxQuantum);
    // Rounded up to the next float, so that the codes span the whole range.
    quantum_ =
        tall_ ? kMaxQuantum
              : std::nextafter(static_cast<float>(fitting), std::numeric_limits<float>::infinity());
    inverse_ = 1 / static_cast<double>(quantum_);
  }

  [[nodiscard]] float quantum() const { return quantum_; }
  /// Whether tiles need a base because one range of codes is too short for the grid.
  [[nodiscard]] bool tall() const { return tall_; }

  [[nodiscard]] Codes encode(const Span& span) const {
    // Heights are not below the base, so truncation is the floor without a library call.
    const double lo = (static_cast<double>(span.lo) - base_) * inverse_;
    const double hi = (static_cast<double>(span.hi) - base_) * inverse_;
    const auto floor_of_lo = static_cast<std::int64_t>(lo);
    return {floor_of_lo + (static_cast<double>(floor_of_lo) < lo ? 1 : 0),
            static_cast<std::int64_t>(hi)};
  }

 private:
  double base_;
  double inverse_ = 0;
  float quantum_ = 0;
  bool tall_ = false;
};

/// What a cell stores of its column, which has room for at most two spans.
struct CodedColumn {
  std::array<Codes, 2> codes;
  /// Number of spans that contain at least one code.
  std::uint32_t count = 0;
  /// Highest code of all spans.
  std::int64_t highest = 0;
};

class GridEncoder {
 public:
  explicit GridEncoder(const Columns& columns)
      : columns_(columns), quantizer_(columns.frame.heights) {}

  EncodedGrid encode() {
    const GridFrame& frame = columns_.frame;
    grid_.frame = frame;
    grid_.quantum = quantizer_.quantum();
    grid_.cells.reserve(cellCount(frame.columns_x, frame.columns_z));
    const std::uint32_t tiles_x = tileCount(frame.columns_x, kTileColumnsX);
    const std::uint32_t tiles_z = tileCount(frame.columns_z, kTileColumnsZ);
    for (std::uint32_t tile_z = 0; tile_z < tiles_z; ++tile_z) {
      for (std::uint32_t tile_x = 0; tile_x < tiles_x; ++tile_x) encodeTile(tile_x, tile_z);
    }
    return std::move(grid_);
  }

 private:
  /// The spans of the column of each cell in a tile; none beyond the grid's border.
  using TileSpans = std::array<std::span<const Span>, kCellsPerTile>;

  [[nodiscard]] TileSpans spansOf(std::uint32_t tile_x, std::uint32_t tile_z) const {
    TileSpans spans;
    for (std::uint32_t cell = 0; cell < kCellsPerTile; ++cell) {
      const std::uint32_t i = tile_x * kTileColumnsX + cell % kTileColumnsX;
      const std::uint32_t k = tile_z * kTileColumnsZ + cell / kTileColumnsX;
      if (i >= columns_.frame.columns_x || k >= columns_.frame.columns_z) continue;
      spans[cell] = columns_.column(columns_.index(i, k));
    }
    return spans;
  }

  void encodeTile(std::uint32_t tile_x, std::uint32_t tile_z) {
    const TileSpans spans = spansOf(tile_x, tile_z);
    std::array<CodedColumn, kCellsPerTile> coded;
    for (std::uint32_t cell = 0; cell < kCellsPerTile; ++cell) coded[cell] = encode(spans[cell]);
    const std::int64_t base = quantizer_.tall() ? chooseBase(coded) : 0;
    for (std::uint32_t cell = 0; cell < kCellsPerTile; ++cell) {
      const CodedColumn& column = coded[cell];
      const bool fits = column.count <= 2 && column.highest - base <= kMaxCode;
      grid_.cells.push_back(fits ? inlineCell(column, base) : overflowCellOf(spans[cell]));
    }
  }

  CodedColumn encode(std::span<const Span> spans) {
    CodedColumn column;
    for (const Span& span : spans) {
      const Codes codes = quantizer_.encode(span);
      if (codes.lo > codes.hi) {
        ++grid_.slivers;
        continue;
      }
      if (column.count < column.codes.size()) column.codes[column.count] = codes;
      column.highest = codes.hi;
      ++column.count;
    }
    grid_.spans += column.count;
    grid_.max_spans_per_column = std::max(grid_.max_spans_per_column, column.count);
    return column;
  }

  /// Chooses the offset of a tile's codes, that of its lowest span, and stores it in the grid.
  std::int64_t chooseBase(const std::array<CodedColumn, kCellsPerTile>& coded) {
    constexpr std::int64_t kHighest = std::numeric_limits<std::uint16_t>::max();
    std::int64_t lowest = kHighest * kCodesPerTileBase;
    bool any = false;
    for (const CodedColumn& column : coded) {
      if (column.count == 0) continue;
      lowest = std::min(lowest, column.codes[0].lo);
      any = true;
    }
    const std::int64_t base = any ? lowest / kCodesPerTileBase : 0;
    grid_.tile_base.push_back(static_cast<std::uint16_t>(base));
    return base * kCodesPerTileBase;
  }

  static std::uint64_t inlineCell(const CodedColumn& column, std::int64_t base) {
    const auto half = [&](std::uint32_t index) {
      if (index >= column.count) return kEmptySpanCode;
      return spanCode(static_cast<std::uint32_t>(column.codes[index].lo - base),
                      static_cast<std::uint32_t>(column.codes[index].hi - base));
    };
    return half(0) | (half(1) << 32U);
  }

  std::uint64_t overflowCellOf(std::span<const Span> spans) {
    ++grid_.overflow_columns;
    const std::size_t start = grid_.overflow_codes.size() + grid_.overflow_spans.size();
    for (const Span& span : spans) {
      const Codes codes = quantizer_.encode(span);
      if (codes.lo > codes.hi) continue;
      if (quantizer_.tall()) {
        grid_.overflow_spans.push_back(span);
      } else {
        grid_.overflow_codes.push_back(static_cast<std::uint32_t>(
            spanCode(static_cast<std::uint32_t>(codes.lo), static_cast<std::uint32_t>(codes.hi))));
      }
    }
    if (quantizer_.tall()) {
      grid_.overflow_spans.push_back(kEndOfSpans);
    } else {
      grid_.overflow_codes.push_back(kEndOfCodes);
    }
    return overflowCell(static_cast<std::uint32_t>(start));
  }

  const Columns& columns_;
  Quantizer quantizer_;
  EncodedGrid grid_;
};

}  // namespace

EncodedGrid encodeGrid(const Columns& columns) { return GridEncoder(columns).encode(); }

std::uint64_t storedBytes(const EncodedGrid& grid) {
  return grid.cells.size() * sizeof(std::uint64_t) + grid.tile_base.size() * sizeof(std::uint16_t) +
         grid.overflow_codes.size() * sizeof(std::uint32_t) +
         grid.overflow_spans.size() * sizeof(Span);
}

}  // namespace galactic::bake
