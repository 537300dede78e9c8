#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Heights over which maps know what is free, one above the other.
inline constexpr std::uint32_t kClearanceBands = 4;
/// The same, and what is lower.
inline constexpr std::uint32_t kClearancePlanes = kClearanceBands + 1;

/// Which of eight groups of spheres are surely free.
struct alignas(64) SureGroups {
  /// How far each can go along both axes and still be, meters; below 0 where it is not.
  float slack[kLanes] = {-1, -1, -1, -1, -1, -1, -1, -1};
  /// The same as bits.
  unsigned free = 0;
  /// Free or not: so low that a floor not much higher would block them.
  unsigned low = 0;

  friend bool operator==(const SureGroups&, const SureGroups&) = default;
};

/// Columns of a grid along the edge of a cell. A power of two: no rounding tells a sphere's cell
/// from its column's.
inline constexpr std::uint32_t kColumnsPerCell = 2;

/// What the distance stored for a cell, in columns, has to exceed by what the spheres' bounds reach
/// beyond the cell: its own columns count one, and the rest is more than any rounding.
inline constexpr float kBeyondReach = 1.01F;

/// What eight groups of spheres ask the maps of one floor: one lane for each group. Plain arrays,
/// which the kernels load.
struct alignas(32) ClearanceLanes {
  float min_x[kLanes], min_z[kLanes];
  /// Cells for each meter, and the edge of a column, meters.
  float inverse_cell[kLanes], column[kLanes];
  float cells_x[kLanes], cells_z[kLanes];
  /// Heights between which centers have to be, meters; below `low` they are low.
  float lowest[kLanes], low[kLanes], highest[kLanes];
  /// The height of the lowest band, and bands for each meter.
  float band_from[kLanes], inverse_band[kLanes];
  /// Bytes: of what is lower than all bands, and from there to the lowest band, from band to band.
  std::int32_t first[kLanes], band_bytes[kLanes];
  std::int32_t tiles_x[kLanes];
};

/// What is asked about eight groups: in which map, and of the first of them its first bound.
struct ClearanceQuestion {
  const ClearanceLanes* lanes = nullptr;
  const float* bounds = nullptr;
};

/// The kernels of surelyFree(): the same answers on any processor and, eight lanes at a time, with
/// AVX2. `stride`: from one bound to the next.
void surelyFreePortable(const ClearanceQuestion* questions, std::size_t count,
                        const std::uint8_t* cells, std::size_t stride, SureGroups* sure) noexcept;
void surelyFreeAvx2(const ClearanceQuestion* questions, std::size_t count,
                    const std::uint8_t* cells, std::size_t stride, SureGroups* sure) noexcept;

/// The groups, as bits, that can go so far along both axes, meters, and still be surely free.
[[nodiscard]] unsigned freeWithinPortable(const SureGroups& sure, float reach) noexcept;
[[nodiscard]] unsigned freeWithinAvx2(const SureGroups& sure, float reach) noexcept;

}  // namespace galactic::simulation
