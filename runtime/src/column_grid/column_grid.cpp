#include "galactic/column_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "column_grid/column_grid_kernels.h"
#include "layout/column_cell.h"
#include "support/processor.h"

namespace galactic {
namespace {

/// A cell's two inline spans, in codes.
struct InlineSpans {
  std::uint32_t lo0, hi0, lo1, hi1;
};

InlineSpans inlineSpans(std::uint64_t cell) {
  constexpr std::uint64_t kCodeMask = 0xffff;
  return {static_cast<std::uint32_t>(cell & kCodeMask),
          static_cast<std::uint32_t>((cell >> 16U) & kCodeMask),
          static_cast<std::uint32_t>((cell >> 32U) & kCodeMask),
          static_cast<std::uint32_t>(cell >> 48U)};
}

std::uint32_t tileBase(const ColumnGridLayout& grid, std::uint32_t cell_index) {
  return grid.tile_base == nullptr ? 0U : grid.tile_base[cell_index / kCellsPerTile];
}

/// The answer for a center that is not over the grid or is not a number.
Clearance clearanceElsewhere(Vec3 center) {
  const bool is_nan = std::isnan(center.x) || std::isnan(center.y) || std::isnan(center.z);
  return is_nan ? Clearance::kBlocked : Clearance::kOutside;
}

/// The position of a height among the codes of a tile.
inline float codeOf(const ColumnGridLayout& grid, float y, std::uint32_t tile_base) {
  return (y - grid.heights.lo) * grid.inverse_quantum -
         static_cast<float>(kCodesPerTileBase * tile_base);
}

/// The heights at the ends of spans: those of the codes, rounded to heights at which a query finds
/// the span. Codes never descend as heights ascend, so that a query finds everything between two
/// ends, too.
class SpanEnds {
 public:
  SpanEnds(const ColumnGridLayout& grid, std::uint32_t tile_base)
      : grid_(grid), tile_base_(tile_base) {}

  [[nodiscard]] float lowest(std::uint32_t code) const {
    float y = height(code);
    while (codeOf(grid_, y, tile_base_) < static_cast<float>(code)) {
      y = std::max(std::nextafter(y, std::numeric_limits<float>::infinity()), y + step());
    }
    return y;
  }

  [[nodiscard]] float highest(std::uint32_t code) const {
    float y = std::min(height(code), grid_.heights.hi);
    while (codeOf(grid_, y, tile_base_) > static_cast<float>(code)) {
      y = std::min(std::nextafter(y, -std::numeric_limits<float>::infinity()), y - step());
    }
    return y;
  }

 private:
  [[nodiscard]] float height(std::uint32_t code) const {
    const std::uint32_t above = code + kCodesPerTileBase * tile_base_;
    return static_cast<float>(static_cast<double>(grid_.heights.lo) +
                              static_cast<double>(grid_.quantum) * above);
  }

  /// About the rounding error of a code: near height 0, the next float is too small a step.
  [[nodiscard]] float step() const { return 0x1p-24F * (grid_.heights.hi - grid_.heights.lo); }

  const ColumnGridLayout& grid_;
  std::uint32_t tile_base_;
};

/// A distance to contact with the margin taken off; never negative.
float clearOf(float distance, float margin) {
  const float clear = distance - margin;
  return clear > 0 ? clear : 0;
}

float lesser(float a, float b) { return a < b ? a : b; }

/// A point of the ground in units of cells.
struct GroundPoint {
  float x, z;

  [[nodiscard]] bool isInside(const ColumnGridLayout& grid) const {
    // Every comparison is false for NaN.
    return x >= 0 && x < static_cast<float>(grid.columns_x) && z >= 0 &&
           z < static_cast<float>(grid.columns_z);
  }
  [[nodiscard]] ColumnIndex column() const {
    return {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(z)};
  }
};

inline GroundPoint groundPoint(const ColumnGridLayout& grid, float x, float z) {
  return {(x - grid.min_x) * grid.inverse_spacing, (z - grid.min_z) * grid.inverse_spacing};
}

inline bool isWithin(const ColumnGridLayout& grid, float y) {
  return y >= grid.heights.lo && y <= grid.heights.hi;
}

/// For a column of the grid and a height inside its range.
inline Contact contactInColumn(const ColumnGridLayout& grid, ColumnIndex column, float y) {
  const std::uint32_t index = cellIndex(column.i, column.k, grid.tiles_x);
  const std::uint64_t cell = grid.cells[index];
  if (isOverflow(cell)) return detail::contactInOverflow(grid, overflowStart(cell), y);

  const float code = codeOf(grid, y, tileBase(grid, index));
  const InlineSpans spans = inlineSpans(cell);
  const bool in_second =
      code >= static_cast<float>(spans.lo1) && code <= static_cast<float>(spans.hi1);
  const auto lo = static_cast<float>(in_second ? spans.lo1 : spans.lo0);
  const auto hi = static_cast<float>(in_second ? spans.hi1 : spans.hi0);
  if (!(code >= lo && code <= hi)) return {};
  const float margin = detail::contactMargin(grid);
  // The highest code may lie above the grid's heights.
  const float up = lesser((hi - code) * grid.quantum, grid.heights.hi - y);
  return {Clearance::kFree, clearOf((code - lo) * grid.quantum, margin), clearOf(up, margin)};
}

/// The one definition of a query. contactAvx2() repeats it operation by operation.
inline Contact contactAt(const ColumnGridLayout& grid, Vec3 center) {
  const GroundPoint point = groundPoint(grid, center.x, center.z);
  const bool inside = point.isInside(grid) && isWithin(grid, center.y);
  if (!inside) return {.clearance = clearanceElsewhere(center)};
  return contactInColumn(grid, point.column(), center.y);
}

}  // namespace

namespace detail {

namespace {

// One number at a time: a compiler would write the halves of a span separately and read them back
// as a whole.

float overflowLow(const ColumnGridLayout& grid, std::uint32_t n) {
  if (grid.overflow_codes == nullptr) return grid.overflow_spans[n].lo;
  const std::uint32_t codes = grid.overflow_codes[n];
  if (codes == kEndOfCodes) return kEndOfSpans.lo;
  return grid.heights.lo + grid.quantum * static_cast<float>(lowCode(codes));
}

float overflowHigh(const ColumnGridLayout& grid, std::uint32_t n) {
  if (grid.overflow_codes == nullptr) return grid.overflow_spans[n].hi;
  const std::uint32_t codes = grid.overflow_codes[n];
  if (codes == kEndOfCodes) return kEndOfSpans.hi;
  return grid.heights.lo + grid.quantum * static_cast<float>(highCode(codes));
}

/// The index of the span that contains a height, or of the first span above it. The end mark lies
/// above every height, so the walk stops there.
std::uint32_t overflowAt(const ColumnGridLayout& grid, std::uint32_t start, float y) {
  std::uint32_t n = start;
  while (y > overflowHigh(grid, n)) ++n;
  return n;
}

}  // namespace

Span overflowSpan(const ColumnGridLayout& grid, std::uint32_t n) noexcept {
  return {overflowLow(grid, n), overflowHigh(grid, n)};
}

Contact contactInOverflow(const ColumnGridLayout& grid, std::uint32_t start, float y) noexcept {
  const std::uint32_t n = overflowAt(grid, start, y);
  const float low = overflowLow(grid, n);
  if (y < low) return {};
  const float margin = contactMargin(grid);
  const float up = lesser(overflowHigh(grid, n), grid.heights.hi) - y;
  return {Clearance::kFree, clearOf(y - low, margin), clearOf(up, margin)};
}

bool isFreeInOverflow(const ColumnGridLayout& grid, std::uint32_t start, float y) noexcept {
  return !(y < overflowLow(grid, overflowAt(grid, start, y)));
}

void contactPortable(const ColumnGridLayout& grid, const ContactBatch& batch) noexcept {
  for (std::size_t n = 0; n < batch.count; ++n) {
    const Contact contact = contactAt(grid, {batch.x[n], batch.y[n], batch.z[n]});
    batch.clearance[n] = contact.clearance;
    if (batch.down == nullptr) continue;
    batch.down[n] = contact.down;
    batch.up[n] = contact.up;
  }
}

std::size_t firstNotFreePortable(const ColumnGridLayout& grid, const CenterBatch& batch) noexcept {
  for (std::size_t n = 0; n < batch.count; ++n) {
    const Contact contact = contactAt(grid, {batch.x[n], batch.y[n], batch.z[n]});
    if (contact.clearance != Clearance::kFree) return n;
  }
  return batch.count;
}

std::uint64_t notFreePortable(const ColumnGridLayout& grid,
                              const EightsOfCenters& centers) noexcept {
  constexpr unsigned kEight = 8;
  std::uint64_t not_free = 0;
  for (unsigned n = 0; n < kEight * kEight; ++n) {
    if ((centers.eights >> n / kEight & 1U) == 0) continue;
    const Contact contact = contactAt(grid, {centers.x[n], centers.y[n], centers.z[n]});
    not_free |= std::uint64_t{contact.clearance != Clearance::kFree} << n;
  }
  return not_free;
}

}  // namespace detail

namespace {

/// Calls `visit(span)` for each free span of a column of the grid, ascending.
template <class Visit>
void forEachSpan(const ColumnGridLayout& grid, ColumnIndex column, const Visit& visit) {
  const std::uint32_t index = cellIndex(column.i, column.k, grid.tiles_x);
  const std::uint64_t cell = grid.cells[index];
  const auto visit_real = [&](const Span& span) {
    if (span.lo <= span.hi) visit(span);
  };
  if (isOverflow(cell)) {
    for (std::uint32_t n = overflowStart(cell);; ++n) {
      const Span span = detail::overflowSpan(grid, n);
      if (span == kEndOfSpans) return;
      visit_real({span.lo, lesser(span.hi, grid.heights.hi)});
    }
  }
  const SpanEnds ends(grid, tileBase(grid, index));
  const InlineSpans codes = inlineSpans(cell);
  if (codes.lo0 <= codes.hi0) visit_real({ends.lowest(codes.lo0), ends.highest(codes.hi0)});
  if (codes.lo1 <= codes.hi1) visit_real({ends.lowest(codes.lo1), ends.highest(codes.hi1)});
}

}  // namespace

std::optional<float> detail::nearestFreeHeight(const ColumnGridLayout& grid, ColumnIndex column,
                                               float y) noexcept {
  std::optional<float> nearest;
  forEachSpan(grid, column, [&](const Span& span) {
    const float height = std::clamp(y, span.lo, span.hi);
    if (!nearest || std::fabs(height - y) < std::fabs(*nearest - y)) nearest = height;
  });
  return nearest;
}

Clearance ColumnGrid::clearance(Vec3 center) const noexcept {
  return contactAt(layout_, center).clearance;
}

Contact ColumnGrid::contact(Vec3 center) const noexcept { return contactAt(layout_, center); }

Contact ColumnGrid::contact(ColumnIndex column, float y) const noexcept {
  if (std::isnan(y)) return {};
  const bool inside =
      column.i < layout_.columns_x && column.k < layout_.columns_z && isWithin(layout_, y);
  return inside ? contactInColumn(layout_, column, y) : Contact{.clearance = Clearance::kOutside};
}

void ColumnGrid::contact(const SphereCenters& centers, const ContactArrays& out) const noexcept {
  const std::size_t count = centers.x.size();
  assert(centers.y.size() == count && centers.z.size() == count);
  assert(out.clearance.size() == count);
  assert(out.down.size() == out.up.size() && (out.down.empty() || out.down.size() == count));
  const bool distances = !out.down.empty();
  const detail::ContactBatch batch{.x = centers.x.data(),
                                   .y = centers.y.data(),
                                   .z = centers.z.data(),
                                   .count = count,
                                   .clearance = out.clearance.data(),
                                   .down = distances ? out.down.data() : nullptr,
                                   .up = distances ? out.up.data() : nullptr};
  if (detail::hasAvx2()) {
    detail::contactAvx2(layout_, batch);
  } else {
    detail::contactPortable(layout_, batch);
  }
}

std::size_t ColumnGrid::firstNotFree(const SphereCenters& centers) const noexcept {
  const std::size_t count = centers.x.size();
  assert(centers.y.size() == count && centers.z.size() == count);
  const detail::CenterBatch batch{centers.x.data(), centers.y.data(), centers.z.data(), count};
  return detail::hasAvx2() ? detail::firstNotFreeAvx2(layout_, batch)
                           : detail::firstNotFreePortable(layout_, batch);
}

std::optional<ColumnIndex> ColumnGrid::columnAt(float x, float z) const noexcept {
  const GroundPoint point = groundPoint(layout_, x, z);
  if (!point.isInside(layout_)) return std::nullopt;
  return point.column();
}

std::size_t ColumnGrid::spanCount(std::uint32_t i, std::uint32_t k) const noexcept {
  return spans(i, k, {});
}

std::size_t ColumnGrid::spans(std::uint32_t i, std::uint32_t k,
                              std::span<Span> out) const noexcept {
  if (i >= layout_.columns_x || k >= layout_.columns_z) return 0;
  std::size_t count = 0;
  forEachSpan(layout_, {i, k}, [&](const Span& span) {
    if (count < out.size()) out[count] = span;
    ++count;
  });
  return count;
}

}  // namespace galactic
