#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Heights over which maps know what is free, one above the other.
inline constexpr std::uint32_t kClearanceBands = 4;
/// The same, and what is lower.
inline constexpr std::uint32_t kClearancePlanes = kClearanceBands + 1;

/// The room around a cell is counted in steps, of which a cell has so many along its edge.
inline constexpr std::uint32_t kStepsPerCell = 2;

/// Of eight groups of spheres, how many steps each can go one way along an axis and still be surely
/// free; of those that are not, any number.
struct alignas(32) SlackOfGroups {
  float values[kLanes];
};

/// Which of eight groups of spheres are surely free.
struct alignas(32) SureGroups {
  /// Down and up X, down and up Z.
  SlackOfGroups down_x, up_x, down_z, up_z;
  /// Those that are, as bits.
  unsigned free = 0;
};

/// What is free around a cell: a rectangle in which nothing stands higher than some height. Of each
/// side four bits, how many steps it reaches beyond the cell, and one more; 0 where the cell itself
/// is not free.
using RoomAround = std::uint16_t;
inline constexpr std::uint32_t kMostRoom = 15;
/// The bits of a side, counted from the first.
inline constexpr int kRoomBits = 4;
inline constexpr int kRoomDownX = 0;
inline constexpr int kRoomUpX = kRoomBits;
inline constexpr int kRoomDownZ = 2 * kRoomBits;
inline constexpr int kRoomUpZ = 3 * kRoomBits;

/// Cells along the edge of a tile, of which a plane consists.
inline constexpr std::uint32_t kClearanceTile = 8;

/// What is taken from each slack after a move, in steps: more than any rounding.
inline constexpr float kMoveRounding = 0.01F;

/// What eight groups of spheres ask the maps of one floor: one lane for each group. Plain arrays,
/// which the kernels load.
struct alignas(32) ClearanceLanes {
  float min_x[kLanes], min_z[kLanes];
  /// Steps for each meter, and of the whole map.
  float inverse_step[kLanes];
  float steps_x[kLanes], steps_z[kLanes];
  /// Heights between which centers have to be, meters; below `low`, no band clears them.
  float lowest[kLanes], low[kLanes], highest[kLanes];
  /// The height of the lowest band, and bands for each meter.
  float band_from[kLanes], inverse_band[kLanes];
  /// Cells: the first of what is lower than all bands, and from there to the lowest band, from band
  /// to band.
  std::int32_t first[kLanes], band_cells[kLanes];
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
                        const RoomAround* cells, std::size_t stride, SureGroups* sure) noexcept;
void surelyFreeAvx2(const ClearanceQuestion* questions, std::size_t count, const RoomAround* cells,
                    std::size_t stride, SureGroups* sure) noexcept;

/// What is asked about eight groups that have the same bounds.
struct BoxQuestion {
  const ClearanceLanes* lanes = nullptr;
  const CenterBounds* bounds = nullptr;
};

/// The kernels of surelyFree() for such groups. `free`: of each question those that are, as bits.
void boxesSurelyFreePortable(const BoxQuestion* questions, std::size_t count,
                             const RoomAround* cells, unsigned* free) noexcept;
void boxesSurelyFreeAvx2(const BoxQuestion* questions, std::size_t count, const RoomAround* cells,
                         unsigned* free) noexcept;

/// The groups, as bits, that are surely free after a move along X and Z, too, meters.
[[nodiscard]] unsigned freeAfterPortable(const ClearanceLanes& lanes, const SureGroups& sure,
                                         float x, float z) noexcept;
[[nodiscard]] unsigned freeAfterAvx2(const ClearanceLanes& lanes, const SureGroups& sure, float x,
                                     float z) noexcept;

}  // namespace galactic::simulation
