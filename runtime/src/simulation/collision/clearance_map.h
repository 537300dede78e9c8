#pragma once
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "simulation/collision/clearance_kernels.h"
#include "simulation/collision/floor_clearance.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

// How most spheres are found to be free without a look at their columns. Around each place of a
// scene's floor there is a rectangle in which nothing stands higher than some height. A map stores
// how far the rectangle around each cell reaches on each side, for a few heights (bands) and each
// radius of the robot: two bytes per cell and band. Eight spheres are free if their bounds lie
// within the rectangle, and between the band's height and the map's highest one: one look-up
// replaces those of eight columns. A map can only prove that spheres are free; where it cannot, the
// columns are asked. Low things may lie on a floor, such as a rug. Spheres so low that a rug would
// block them get a band of their own, which is clear away from the rug.

/// The bounds of eight groups of one env, laid out as in BodyArrays::bounds.
struct GroupBounds {
  const float* values = nullptr;
  /// From one bound to the next: the number of groups, padded to lanes.
  std::size_t stride = 0;
};

/// The number of a floor without a map, here and wherever floors have the numbers of their maps.
inline constexpr std::uint32_t kNoClearanceMap = 0;

/// The maps of the floors of all scenes. Const members may be called from any thread.
class ClearanceMaps {
 public:
  /// `radius_of_lane`: index into the working set, for each group that will be asked about.
  /// `most_bytes`: limit for all maps, at most as many as the indices of look-ups can address.
  explicit ClearanceMaps(std::vector<std::uint32_t> radius_of_lane = {},
                         std::size_t most_bytes = kMostBytes);
  static constexpr std::size_t kMostBytes = (std::size_t{1} << 31) * sizeof(RoomAround);

  /// Adds the maps of a floor. Returns its number for surelyFree(): 1, 2, ...; kNoClearanceMap if
  /// there is no room for it.
  std::uint32_t add(const FloorClearance& floor);
  /// Reserves memory for `cells` cells, those of all floors to be added.
  void reserve(std::size_t cells);
  /// Whether a floor with `cells` cells can be added.
  [[nodiscard]] bool hasRoomFor(std::size_t cells) const noexcept {
    return (cells_.size() + cells) * sizeof(RoomAround) <= most_bytes_;
  }

  /// Finds which of eight groups are surely free: those of the lanes from 8 * `eight` on, with
  /// these bounds. `map`: as add() returned it; for kNoClearanceMap no group is.
  void surelyFree(std::uint32_t map, std::size_t eight, const GroupBounds& bounds,
                  SureGroups& sure) const noexcept;

  /// The same for several envs, kMostAsked at most, each in its own map. `bounds`: of the first
  /// env; `env_stride`: from the bounds of one env to those of the next.
  void surelyFree(std::span<const std::uint32_t> maps, std::size_t eight, const GroupBounds& bounds,
                  std::size_t env_stride, std::span<SureGroups> sure) const noexcept;
  static constexpr std::size_t kMostAsked = 16;

  /// The same for eight groups that share their bounds, with several such bounds, kMostAsked at
  /// most, each in its own map. `free`: for each bounds the groups that are surely free, as bits.
  void surelyFree(std::span<const std::uint32_t> maps, std::size_t eight,
                  std::span<const CenterBounds> bounds, std::span<unsigned> free) const noexcept;

  /// The groups, as bits, that are still surely free after a move along X and Z, meters. `sure`:
  /// the result of surelyFree() before the move.
  [[nodiscard]] unsigned freeAfter(std::uint32_t map, std::size_t eight, const SureGroups& sure,
                                   float x, float z) const noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept {
    return std::span(cells_).size_bytes() + std::span(lanes_).size_bytes();
  }

  /// The number of eights of lanes.
  [[nodiscard]] std::size_t eights() const { return eights_; }

 private:
  [[nodiscard]] const ClearanceLanes* lanesOf(std::uint32_t map, std::size_t eight) const noexcept {
    return &lanes_[map * eights_ + eight];
  }
  void answer(std::span<const ClearanceQuestion> questions, std::size_t stride,
              SureGroups* sure) const noexcept;

  /// Whether any lane has this radius.
  [[nodiscard]] bool isAsked(std::uint32_t radius) const;

  std::vector<std::uint32_t> radius_of_lane_;
  std::size_t eights_ = 0;
  std::size_t most_bytes_ = kMostBytes;
  /// The number of maps, including that of kNoClearanceMap.
  std::uint32_t count_ = 1;
  /// Shape: maps x eights_; those of kNoClearanceMap have no width.
  std::vector<ClearanceLanes> lanes_;
  /// The cells of all maps, after one that answers for places outside of maps.
  std::pmr::vector<RoomAround> cells_;
};

}  // namespace galactic::simulation
