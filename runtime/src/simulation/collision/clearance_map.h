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

// How most spheres are known to be free without a look at their columns.
//
// Around each place of a scene's floor there is a rectangle in which nothing stands higher than
// some height. A map stores how far that rectangle reaches beyond each cell on each side, for a few
// heights (bands) and each radius of the robot: two bytes per cell and band. Eight spheres whose
// bounds lie within the rectangle, and between the band's height and the map's highest one, are
// free: one look-up answers for eight columns. A map only ever says "surely free"; wherever it does
// not, the columns are asked.
//
// Floors differ by what lies on them: a rug. What is so low that a rug would block it gets a band
// of its own, which is clear where there is none.

/// The bounds of eight groups of one env, as BodyArrays::bounds has them.
struct GroupBounds {
  const float* values = nullptr;
  /// From one bound to the next: groups, padded to lanes.
  std::size_t stride = 0;
};

/// The number of the floor of which nothing is known, here and wherever floors go by the numbers of
/// their maps.
inline constexpr std::uint32_t kNoClearanceMap = 0;

/// The maps of the floors of all scenes. Any thread may ask.
class ClearanceMaps {
 public:
  /// `radius_of_lane`: index into the working set, of each group that will be asked about.
  /// `most_bytes`: of all maps, at most what look-ups can count.
  explicit ClearanceMaps(std::vector<std::uint32_t> radius_of_lane = {},
                         std::size_t most_bytes = kMostBytes);
  static constexpr std::size_t kMostBytes = (std::size_t{1} << 31) * sizeof(RoomAround);

  /// Adds the maps of a floor. Returns the number by which surelyFree() knows it: 1, 2, ...;
  /// kNoClearanceMap where there is no room for it.
  std::uint32_t add(const FloorClearance& floor);
  /// Makes room for so many cells of all floors to come.
  void reserve(std::size_t cells);
  /// Whether a floor of so many cells can be added.
  [[nodiscard]] bool hasRoomFor(std::size_t cells) const noexcept {
    return (cells_.size() + cells) * sizeof(RoomAround) <= most_bytes_;
  }

  /// Which of eight groups are surely free: those of the lanes from 8 * `eight` on, with these
  /// bounds. `map`: as add() returned it; none are for kNoClearanceMap.
  void surelyFree(std::uint32_t map, std::size_t eight, const GroupBounds& bounds,
                  SureGroups& sure) const noexcept;

  /// The same for several envs, kMostAsked at most, each in its own map. `bounds`: of the first
  /// one; `env_stride`: from the bounds of one env to those of the next.
  void surelyFree(std::span<const std::uint32_t> maps, std::size_t eight, const GroupBounds& bounds,
                  std::size_t env_stride, std::span<SureGroups> sure) const noexcept;
  static constexpr std::size_t kMostAsked = 16;

  /// Which of eight groups are surely free that have the same bounds, for several of these,
  /// kMostAsked at most, each in its own map. `free`: of each, those that are, as bits.
  void surelyFree(std::span<const std::uint32_t> maps, std::size_t eight,
                  std::span<const CenterBounds> bounds, std::span<unsigned> free) const noexcept;

  /// The groups, as bits, that are surely free after a move along X and Z, too, meters. `sure`:
  /// what surelyFree() said of them.
  [[nodiscard]] unsigned freeAfter(std::uint32_t map, std::size_t eight, const SureGroups& sure,
                                   float x, float z) const noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept {
    return std::span(cells_).size_bytes() + std::span(lanes_).size_bytes();
  }

  /// How many eights of lanes there are.
  [[nodiscard]] std::size_t eights() const { return eights_; }

 private:
  [[nodiscard]] const ClearanceLanes* lanesOf(std::uint32_t map, std::size_t eight) const noexcept {
    return &lanes_[map * eights_ + eight];
  }
  void answer(std::span<const ClearanceQuestion> questions, std::size_t stride,
              SureGroups* sure) const noexcept;

  /// Whether any lane is of that radius.
  [[nodiscard]] bool isAsked(std::uint32_t radius) const;

  std::vector<std::uint32_t> radius_of_lane_;
  std::size_t eights_ = 0;
  std::size_t most_bytes_ = kMostBytes;
  /// Maps, that of kNoClearanceMap among them.
  std::uint32_t count_ = 1;
  /// Shape: maps x eights_; those of kNoClearanceMap are as wide as nothing.
  std::vector<ClearanceLanes> lanes_;
  /// Of all maps, after one for what is outside of them.
  std::pmr::vector<RoomAround> cells_;
};

}  // namespace galactic::simulation
