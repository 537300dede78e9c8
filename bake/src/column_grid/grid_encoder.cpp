#include "galactic/bake/grid_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "galactic/column_cell.h"

namespace galactic::bake {
namespace {

/// Codes of one span; absent when no code lies in it.
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
    // Rounded up to the next float, so that the whole range has codes.
    quantum_ = tall_ ? kMaxQuantum
                     : std::nextafter(static_cast<float>(fitting),
                                      std::numeric_limits<float>::infinity());
  }

  [[nodiscard]] float quantum() const { return quantum_; }
  /// Whether tiles need a base because one range of codes is too short for the grid.
  [[nodiscard]] bool tall() const { return tall_; }

  /// The codes inside `span`: rounded to the blocked side.
  [[nodiscard]] Codes encode(const Span& span) const {
    const double step = static_cast<double>(quantum_);
    return {static_cast<std::int64_t>(std::ceil((static_cast<double>(span.lo) - base_) / step)),
            static_cast<std::int64_t>(std::floor((static_cast<double>(span.hi) - base_) / step))};
  }

 private:
  double base_;
  float quantum_ = 0;
  bool tall_ = false;
};

/// Free spans of one column in codes, thin ones left out.
struct CodedColumn {
  std::vector<Codes> codes;
  std::vector<Span> spans;
};

class GridEncoder {
 public:
  explicit GridEncoder(const Columns& columns)
      : columns_(columns), quantizer_(columns.frame.heights) {}

  EncodedGrid encode() {
    const GridFrame& frame = columns_.frame;
    grid_.frame = frame;
    grid_.quantum = quantizer_.quantum();
    grid_.cells.assign(cellCount(frame.columns_x, frame.columns_z), kBlockedCell);
    grid_.overflow_start.push_back(0);
    const std::uint32_t tiles_x = tileCount(frame.columns_x, kTileColumnsX);
    const std::uint32_t tiles_z = tileCount(frame.columns_z, kTileColumnsZ);
    for (std::uint32_t tile_z = 0; tile_z < tiles_z; ++tile_z) {
      for (std::uint32_t tile_x = 0; tile_x < tiles_x; ++tile_x) encodeTile(tile_x, tile_z);
    }
    return std::move(grid_);
  }

 private:
  void encodeTile(std::uint32_t tile_x, std::uint32_t tile_z) {
    const GridFrame& frame = columns_.frame;
    std::int64_t lowest = std::numeric_limits<std::int64_t>::max();
    std::array<CodedColumn, kCellsPerTile> coded;
    for (std::uint32_t cell = 0; cell < kCellsPerTile; ++cell) {
      const std::uint32_t i = tile_x * kTileColumnsX + cell % kTileColumnsX;
      const std::uint32_t k = tile_z * kTileColumnsZ + cell / kTileColumnsX;
      if (i >= frame.columns_x || k >= frame.columns_z) continue;
      coded[cell] = encodeColumn(columns_.index(i, k));
      if (!coded[cell].codes.empty()) lowest = std::min(lowest, coded[cell].codes.front().lo);
    }
    std::int64_t base = 0;
    if (quantizer_.tall()) {
      if (lowest == std::numeric_limits<std::int64_t>::max()) lowest = 0;
      base = std::min<std::int64_t>(lowest / kCodesPerTileBase,
                                    std::numeric_limits<std::uint16_t>::max());
      grid_.tile_base.push_back(static_cast<std::uint16_t>(base));
    }
    const std::uint32_t tiles_x = tileCount(frame.columns_x, kTileColumnsX);
    const std::size_t first_cell = (std::size_t{tile_z} * tiles_x + tile_x) * kCellsPerTile;
    for (std::uint32_t cell = 0; cell < kCellsPerTile; ++cell) {
      grid_.cells[first_cell + cell] = cellOf(coded[cell], base * kCodesPerTileBase);
    }
  }

  CodedColumn encodeColumn(std::size_t column) {
    CodedColumn coded;
    for (const Span& span : columns_.column(column)) {
      const Codes codes = quantizer_.encode(span);
      if (codes.lo > codes.hi) {
        ++grid_.slivers;
        continue;
      }
      coded.codes.push_back(codes);
      coded.spans.push_back(span);
    }
    grid_.spans += coded.spans.size();
    grid_.max_spans_per_column =
        std::max(grid_.max_spans_per_column, static_cast<std::uint32_t>(coded.spans.size()));
    return coded;
  }

  std::uint64_t cellOf(const CodedColumn& coded, std::int64_t base) {
    if (coded.codes.empty()) return kBlockedCell;
    if (coded.codes.size() > 2 || coded.codes.back().hi - base > kMaxCode) {
      const auto index = static_cast<std::uint32_t>(grid_.overflow_start.size() - 1);
      grid_.overflow_spans.insert(grid_.overflow_spans.end(), coded.spans.begin(),
                                  coded.spans.end());
      grid_.overflow_start.push_back(static_cast<std::uint32_t>(grid_.overflow_spans.size()));
      return overflowCell(index);
    }
    const auto half = [&](std::size_t index) {
      if (index >= coded.codes.size()) return kEmptySpanCode;
      return spanCode(static_cast<std::uint32_t>(coded.codes[index].lo - base),
                      static_cast<std::uint32_t>(coded.codes[index].hi - base));
    };
    return half(0) | (half(1) << 32U);
  }

  const Columns& columns_;
  Quantizer quantizer_;
  EncodedGrid grid_;
};

}  // namespace

EncodedGrid encodeGrid(const Columns& columns) { return GridEncoder(columns).encode(); }

}  // namespace galactic::bake
