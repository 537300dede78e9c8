#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "galactic/scene.h"
#include "simulation/collision/heights_over_floor.h"
#include "simulation/ways_out/free_slices_kernels.h"

namespace galactic::simulation {

/// The number of a tile of which no cell is surely free nor surely blocked.
inline constexpr std::uint32_t kNothingKnown = 1;

/// Tiles of which one of each kind is kept. Two are there from the start: see TileSet, and
/// kNothingKnown.
class DistinctTiles {
 public:
  DistinctTiles();

  /// Of a tile, which is kept if it is of a new kind and there is room for it.
  [[nodiscard]] std::uint32_t numberOf(const SliceTile& tile);

  /// In the order of their numbers.
  [[nodiscard]] std::span<const SliceTile> tiles() const noexcept { return tiles_; }

 private:
  std::vector<SliceTile> tiles_;
  /// The numbers of tiles, by the hashes of their bytes.
  std::unordered_multimap<std::size_t, std::uint32_t> known_;
};

/// The slices of a floor, of each radius.
using SlicesOfRadii = std::array<SliceLayout, kLanes>;

/// The slices of one floor, which know nothing of other floors.
struct FloorSlices {
  /// They count from the first of `numbers`.
  SlicesOfRadii layouts;
  /// Of `tiles`.
  std::vector<std::uint32_t> numbers;
  DistinctTiles tiles;
};

/// `floor`: its height, meters; the robot's centers are `heights` above it. `lowest_of_radius`: see
/// lowestOver().
[[nodiscard]] FloorSlices makeFloorSlices(const Scene& scene, float floor,
                                          const HeightsOverFloor& heights,
                                          std::span<const float> lowest_of_radius = {});

}  // namespace galactic::simulation
