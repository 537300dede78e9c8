#include "galactic/column_grid.h"

#include <cassert>
#include <cmath>

#include "column_grid_kernels.h"
#include "galactic/column_cell.h"

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

/// The answer for a centre that is not over the grid or is not a number.
Clearance clearanceElsewhere(Vec3 centre) {
  const bool is_nan = std::isnan(centre.x) || std::isnan(centre.y) || std::isnan(centre.z);
  return is_nan ? Clearance::kBlocked : Clearance::kOutside;
}

/// The one definition of a query. contactAvx2 repeats it operation by operation.
inline Contact contactAt(const ColumnGridLayout& grid, Vec3 centre) {
  const float cell_x = (centre.x - grid.min_x) * grid.inverse_spacing;
  const float cell_z = (centre.z - grid.min_z) * grid.inverse_spacing;
  // Every comparison is false for NaN.
  const bool inside = cell_x >= 0 && cell_x < static_cast<float>(grid.columns_x) && cell_z >= 0 &&
                      cell_z < static_cast<float>(grid.columns_z) && centre.y >= grid.heights.lo &&
                      centre.y <= grid.heights.hi;
  if (!inside) return {.clearance = clearanceElsewhere(centre)};

  const std::uint32_t index = cellIndex(static_cast<std::uint32_t>(cell_x),
                                        static_cast<std::uint32_t>(cell_z), grid.tiles_x);
  const std::uint64_t cell = grid.cells[index];
  if (isOverflow(cell)) return detail::contactInOverflow(grid, overflowStart(cell), centre.y);

  const float code = (centre.y - grid.heights.lo) * grid.inverse_quantum -
                     static_cast<float>(kCodesPerTileBase * tileBase(grid, index));
  const InlineSpans spans = inlineSpans(cell);
  const bool in_second =
      code >= static_cast<float>(spans.lo1) && code <= static_cast<float>(spans.hi1);
  const auto lo = static_cast<float>(in_second ? spans.lo1 : spans.lo0);
  const auto hi = static_cast<float>(in_second ? spans.hi1 : spans.hi0);
  if (!(code >= lo && code <= hi)) return {};
  return {Clearance::kFree, (code - lo) * grid.quantum, (hi - code) * grid.quantum};
}

}  // namespace

namespace detail {

Span overflowSpan(const ColumnGridLayout& grid, std::uint32_t n) noexcept {
  if (grid.overflow_codes == nullptr) return grid.overflow_spans[n];
  const std::uint32_t codes = grid.overflow_codes[n];
  if (codes == kEndOfCodes) return kEndOfSpans;
  return {grid.heights.lo + grid.quantum * static_cast<float>(lowCode(codes)),
          grid.heights.lo + grid.quantum * static_cast<float>(highCode(codes))};
}

Contact contactInOverflow(const ColumnGridLayout& grid, std::uint32_t start, float y) noexcept {
  // The end mark lies above every height: the walk stops there.
  std::uint32_t n = start;
  Span span = overflowSpan(grid, n);
  while (y > span.hi) span = overflowSpan(grid, ++n);
  if (y < span.lo) return {};
  return {Clearance::kFree, y - span.lo, span.hi - y};
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

std::size_t firstNotFreePortable(const ColumnGridLayout& grid, const CentreBatch& batch) noexcept {
  for (std::size_t n = 0; n < batch.count; ++n) {
    const Contact contact = contactAt(grid, {batch.x[n], batch.y[n], batch.z[n]});
    if (contact.clearance != Clearance::kFree) return n;
  }
  return batch.count;
}

bool hasAvx2() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace detail

Clearance ColumnGrid::clearance(Vec3 centre) const noexcept {
  return contactAt(layout_, centre).clearance;
}

Contact ColumnGrid::contact(Vec3 centre) const noexcept { return contactAt(layout_, centre); }

void ColumnGrid::contact(const SphereCentres& centres, const ContactArrays& out) const noexcept {
  const std::size_t count = centres.x.size();
  assert(centres.y.size() == count && centres.z.size() == count);
  assert(out.clearance.size() == count);
  assert(out.down.size() == out.up.size() && (out.down.empty() || out.down.size() == count));
  const bool distances = !out.down.empty();
  const detail::ContactBatch batch{.x = centres.x.data(),
                                   .y = centres.y.data(),
                                   .z = centres.z.data(),
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

std::size_t ColumnGrid::firstNotFree(const SphereCentres& centres) const noexcept {
  const std::size_t count = centres.x.size();
  assert(centres.y.size() == count && centres.z.size() == count);
  const detail::CentreBatch batch{centres.x.data(), centres.y.data(), centres.z.data(), count};
  return detail::hasAvx2() ? detail::firstNotFreeAvx2(layout_, batch)
                           : detail::firstNotFreePortable(layout_, batch);
}

std::size_t ColumnGrid::spanCount(std::uint32_t i, std::uint32_t k) const noexcept {
  return spans(i, k, {});
}

std::size_t ColumnGrid::spans(std::uint32_t i, std::uint32_t k,
                              std::span<Span> out) const noexcept {
  assert(i < layout_.columns_x && k < layout_.columns_z);
  const std::uint32_t index = cellIndex(i, k, layout_.tiles_x);
  const std::uint64_t cell = layout_.cells[index];
  if (isOverflow(cell)) {
    std::size_t count = 0;
    for (std::uint32_t n = overflowStart(cell);; ++n, ++count) {
      const Span span = detail::overflowSpan(layout_, n);
      if (span == kEndOfSpans) return count;
      if (count < out.size()) out[count] = span;
    }
  }
  const std::uint32_t base = kCodesPerTileBase * tileBase(layout_, index);
  const auto height = [&](std::uint32_t code) {
    return static_cast<float>(static_cast<double>(layout_.heights.lo) +
                              static_cast<double>(layout_.quantum) * (code + base));
  };
  const InlineSpans codes = inlineSpans(cell);
  std::size_t count = 0;
  const auto append = [&](std::uint32_t lo, std::uint32_t hi) {
    if (lo > hi) return;
    if (count < out.size()) out[count] = {height(lo), height(hi)};
    ++count;
  };
  append(codes.lo0, codes.hi0);
  append(codes.lo1, codes.hi1);
  return count;
}

}  // namespace galactic
