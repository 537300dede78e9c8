#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Number of bands: heights above which maps know what is free.
inline constexpr std::uint32_t kClearanceBands = 4;
/// The planes of a map: one per band, and one for centers below all bands.
inline constexpr std::uint32_t kClearancePlanes = kClearanceBands + 1;

/// The room around a cell is counted in steps; the edge of a cell is this many steps long.
inline constexpr std::uint32_t kStepsPerCell = 2;

/// For eight groups of spheres, how many steps each can move in one direction along an axis and
/// still be surely free; undefined for a group that is not surely free.
struct alignas(32) SlackOfGroups {
  float values[kLanes];
};

/// Which of eight groups of spheres are surely free.
struct alignas(32) SureGroups {
  /// Toward lower and higher X, then toward lower and higher Z.
  SlackOfGroups down_x, up_x, down_z, up_z;
  /// The groups that are surely free, as bits.
  unsigned free = 0;
};

/// What is free around a cell: a rectangle in which nothing stands higher than some height. Four
/// bits per side hold how many steps it reaches from the middle of the cell; 0 if the cell itself
/// is not free.
using RoomAround = std::uint16_t;
inline constexpr std::uint32_t kMostRoom = 15;
/// The number of bits of a side, and the first bit of each side.
inline constexpr int kRoomBits = 4;
inline constexpr int kRoomDownX = 0;
inline constexpr int kRoomUpX = kRoomBits;
inline constexpr int kRoomDownZ = 2 * kRoomBits;
inline constexpr int kRoomUpZ = 3 * kRoomBits;

/// Cells along the edge of a tile; a plane consists of square tiles.
inline constexpr std::uint32_t kClearanceTile = 8;

/// Subtracted from each slack after a move, in steps: more than any rounding.
inline constexpr float kMoveRounding = 0.01F;

/// The maps of one floor for eight groups of spheres, one lane per group. Plain arrays, which the
/// kernels load.
struct alignas(32) ClearanceLanes {
  float min_x[kLanes], min_z[kLanes];
  /// Steps per meter, and the size of the whole map in steps.
  float inverse_step[kLanes];
  float steps_x[kLanes], steps_z[kLanes];
  /// Centers have to lie between `lowest` and `highest`, meters; no band clears those below `low`.
  float lowest[kLanes], low[kLanes], highest[kLanes];
  /// The height of the lowest band, and bands per meter.
  float band_from[kLanes], inverse_band[kLanes];
  /// Index of the first cell of the plane below all bands, and the number of cells from one plane
  /// to the next.
  std::int32_t first[kLanes], band_cells[kLanes];
  std::int32_t tiles_x[kLanes];
};

/// A query about eight groups: the map, and the first bound of the first group.
struct ClearanceQuestion {
  const ClearanceLanes* lanes = nullptr;
  const float* bounds = nullptr;
};

/// The kernels of surelyFree(), one for any processor and one for AVX2, with eight lanes at a time;
/// both give the same answers. `stride`: from one bound to the next.
void surelyFreePortable(const ClearanceQuestion* questions, std::size_t count,
                        const RoomAround* cells, std::size_t stride, SureGroups* sure) noexcept;
void surelyFreeAvx2(const ClearanceQuestion* questions, std::size_t count, const RoomAround* cells,
                    std::size_t stride, SureGroups* sure) noexcept;

/// A query about eight groups that have the same bounds.
struct BoxQuestion {
  const ClearanceLanes* lanes = nullptr;
  const CenterBounds* bounds = nullptr;
};

/// The kernels of surelyFree() for such groups. `free`: the free groups of each question, as bits.
void boxesSurelyFreePortable(const BoxQuestion* questions, std::size_t count,
                             const RoomAround* cells, unsigned* free) noexcept;
void boxesSurelyFreeAvx2(const BoxQuestion* questions, std::size_t count, const RoomAround* cells,
                         unsigned* free) noexcept;

/// The groups, as bits, that are still surely free after a move along X and Z, meters.
[[nodiscard]] unsigned freeAfterPortable(const ClearanceLanes& lanes, const SureGroups& sure,
                                         float x, float z) noexcept;
[[nodiscard]] unsigned freeAfterAvx2(const ClearanceLanes& lanes, const SureGroups& sure, float x,
                                     float z) noexcept;

}  // namespace galactic::simulation
