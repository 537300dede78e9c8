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

/// The number of the tile in which no cell is known to be free or blocked.
inline constexpr std::uint32_t kNothingKnown = 1;

/// A set of tiles that stores each distinct one once. Two are there from the start: see TileSet and
/// kNothingKnown.
class DistinctTiles {
 public:
  DistinctTiles();

  /// The number of a tile, which is added if it is new and there is room for it.
  [[nodiscard]] std::uint32_t numberOf(const SliceTile& tile);

  /// The same for all tiles of another set, in their order.
  [[nodiscard]] std::vector<std::uint32_t> numbersOf(const DistinctTiles& others);

  /// The tiles in the order of their numbers.
  [[nodiscard]] std::span<const SliceTile> tiles() const noexcept { return tiles_; }

  [[nodiscard]] std::size_t bytes() const noexcept {
    return tiles().size_bytes() + std::span(hashes_).size_bytes() + std::span(slots_).size_bytes();
  }

 private:
  using Hash = std::uint64_t;
  /// One more than the number of a tile, and a part of its hash; 0 for an empty slot.
  struct Slot {
    std::uint32_t count = 0;
    std::uint32_t hash = 0;
  };

  /// Wraps the index of a slot around the end of the table.
  [[nodiscard]] std::size_t wrapped(std::size_t at) const { return at & (slots_.size() - 1); }
  /// The slot of a tile, or the empty slot where it belongs.
  [[nodiscard]] std::size_t slotOf(const SliceTile& tile, Hash hash) const;
  [[nodiscard]] std::uint32_t numberOf(const SliceTile& tile, Hash hash);
  void growSlots();
  /// Prefetch what a search for a tile reads: its first slot, then the tile that the slot refers
  /// to.
  void prefetchSlot(Hash hash) const;
  void prefetchTile(Hash hash) const;

  std::pmr::vector<SliceTile> tiles_;
  std::vector<Hash> hashes_;
  /// Each tile is in the first free slot from that of its hash on. Their number is a power of two,
  /// and at most half of them are taken.
  std::vector<Slot> slots_;
};

/// The slices of a floor, one layout per radius.
using SlicesOfRadii = std::array<SliceLayout, kLanes>;

/// The slices of one floor, independent of other floors.
struct FloorSlices {
  /// Their `first` counts from the start of `numbers`.
  SlicesOfRadii layouts;
  /// Numbers of tiles in `tiles`.
  std::vector<std::uint32_t> numbers;
  DistinctTiles tiles;
};

/// Cuts the room above a floor into slices. `floor`: its height, meters; the robot's centers are
/// `heights` above it. `lowest_of_radius`: see lowestOver().
[[nodiscard]] FloorSlices makeFloorSlices(const Scene& scene, float floor,
                                          const HeightsOverFloor& heights,
                                          std::span<const float> lowest_of_radius = {});

}  // namespace galactic::simulation
