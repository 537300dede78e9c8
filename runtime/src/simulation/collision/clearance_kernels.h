#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Heights over which maps know what is free, one above the other.
inline constexpr std::uint32_t kClearanceBands = 4;

/// What the distance stored for a cell has to exceed half the edge of the spheres' bounds by, in
/// cells: the cell itself counts one, and the rest is more than any rounding.
inline constexpr float kBeyondHalf = 1.01F;

/// What eight groups of spheres ask the maps of one floor: one lane for each group. Plain arrays,
/// which the kernels load.
struct alignas(32) ClearanceLanes {
  float min_x[kLanes], min_z[kLanes];
  /// Cells for each meter.
  float inverse_cell[kLanes];
  float cells_x[kLanes], cells_z[kLanes];
  /// Heights between which centers have to be, meters.
  float lowest[kLanes], highest[kLanes];
  /// The height of the lowest band, and bands for each meter.
  float band_from[kLanes], inverse_band[kLanes];
  /// Bytes: of the lowest band, and from band to band.
  std::int32_t first[kLanes], band_bytes[kLanes];
  std::int32_t tiles_x[kLanes];
};

/// The kernels of surelyFree(): the same answers on any processor and, eight lanes at a time, with
/// AVX2. `bounds`: of the first of eight groups.
[[nodiscard]] unsigned surelyFreePortable(const ClearanceLanes& lanes, const std::uint8_t* cells,
                                          const float* bounds, std::size_t stride) noexcept;
[[nodiscard]] unsigned surelyFreeAvx2(const ClearanceLanes& lanes, const std::uint8_t* cells,
                                      const float* bounds, std::size_t stride) noexcept;

}  // namespace galactic::simulation
