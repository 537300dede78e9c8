#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "galactic/column_grid.h"

namespace galactic::detail {

/// One batched query as bare pointers, each to `count` elements: code built for AVX2 must not
/// instantiate library templates, which the linker could then share with code for any processor.
struct ContactBatch {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t count = 0;
  Clearance* clearance = nullptr;
  /// Both null when only the clearance is wanted.
  float* down = nullptr;
  float* up = nullptr;
};

/// Answers a batch one sphere at a time, on any processor.
void contactPortable(const ColumnGridLayout& grid, const ContactBatch& batch) noexcept;

/// Answers a batch eight spheres at a time. Call it only if hasAvx2(). The answers equal those of
/// contactPortable bit for bit: both do the same operations in the same order, without contraction.
void contactAvx2(const ColumnGridLayout& grid, const ContactBatch& batch) noexcept;

/// The centers of one batched query as bare pointers, each to `count` elements.
struct CenterBatch {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t count = 0;
};

/// Index of the first center that is not free; `count` if all are free. One version for any
/// processor, the other for eight centers at a time if hasAvx2().
[[nodiscard]] std::size_t firstNotFreePortable(const ColumnGridLayout& grid,
                                               const CenterBatch& batch) noexcept;
[[nodiscard]] std::size_t firstNotFreeAvx2(const ColumnGridLayout& grid,
                                           const CenterBatch& batch) noexcept;

/// Up to eight groups of eight centers.
struct EightsOfCenters {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  /// Bit mask of the groups that are asked about.
  unsigned eights = 1;
};

/// Bit mask of the centers that are not free, among those asked about.
[[nodiscard]] std::uint64_t notFreePortable(const ColumnGridLayout& grid,
                                            const EightsOfCenters& centers) noexcept;
[[nodiscard]] std::uint64_t notFreeAvx2(const ColumnGridLayout& grid,
                                        const EightsOfCenters& centers) noexcept;

/// What is subtracted from distances to contact, meters: more than all rounding from a height to
/// its code and back, so that a caller who moves by a distance and asks again finds the place free.
// The code of a height is off by less than 2^-21 of its height above the grid's lowest one: four
// roundings of a product and a difference. It is computed twice, once to get the distance and once
// when the new place is asked about; the distance and the place itself are rounded, too.
[[nodiscard, gnu::always_inline]] constexpr float contactMargin(
    const ColumnGridLayout& grid) noexcept {
  constexpr float kOfHeight = 0x1p-19F;
  constexpr float kOfCoordinate = 0x1p-22F;
  const float below = grid.heights.lo < 0 ? -grid.heights.lo : grid.heights.lo;
  const float above = grid.heights.hi < 0 ? -grid.heights.hi : grid.heights.hi;
  const float farthest = below < above ? above : below;
  return kOfHeight * (grid.heights.hi - grid.heights.lo) + kOfCoordinate * farthest;
}

/// Element `n` of the spans of overflow cells, as heights; kEndOfSpans for an end mark.
[[nodiscard]] Span overflowSpan(const ColumnGridLayout& grid, std::uint32_t n) noexcept;

/// The answer for a center at height `y`, inside the grid's heights, in the overflow cell whose
/// spans begin at element `start`.
[[nodiscard]] Contact contactInOverflow(const ColumnGridLayout& grid, std::uint32_t start,
                                        float y) noexcept;

/// Whether contactInOverflow() would answer "free".
[[nodiscard]] bool isFreeInOverflow(const ColumnGridLayout& grid, std::uint32_t start,
                                    float y) noexcept;

/// The free height nearest to `y` in a column of the grid; none if no height is free.
[[nodiscard]] std::optional<float> nearestFreeHeight(const ColumnGridLayout& grid,
                                                     ColumnIndex column, float y) noexcept;

}  // namespace galactic::detail
