#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
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

  /// The same of all tiles of another set, in their order.
  [[nodiscard]] std::vector<std::uint32_t> numbersOf(const DistinctTiles& others);

  /// In the order of their numbers.
  [[nodiscard]] std::span<const SliceTile> tiles() const noexcept { return tiles_; }

  [[nodiscard]] std::size_t bytes() const noexcept {
    return tiles().size_bytes() + std::span(hashes_).size_bytes() + std::span(slots_).size_bytes();
  }

 private:
  using Hash = std::uint64_t;
  /// A tile, as one more than its number, and a part of its hash; 0 where there is none.
  struct Slot {
    std::uint32_t count = 0;
    std::uint32_t hash = 0;
  };

  /// A number of a slot that may be too large, from the first one on again.
  [[nodiscard]] std::size_t wrapped(std::size_t at) const { return at & (slots_.size() - 1); }
  /// Where a tile stands in `slots_`, or where there is room for it.
  [[nodiscard]] std::size_t slotOf(const SliceTile& tile, Hash hash) const;
  [[nodiscard]] std::uint32_t numberOf(const SliceTile& tile, Hash hash);
  void growSlots();
  /// Ask the memory for what looks for a tile read: its first slot; and then what that leads to.
  void prefetchSlot(Hash hash) const;
  void prefetchTile(Hash hash) const;

  std::pmr::vector<SliceTile> tiles_;
  std::vector<Hash> hashes_;
  /// Each tile at the first free slot from that of its hash on. As many as a power of two, at most
  /// half of them taken.
  std::vector<Slot> slots_;
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
