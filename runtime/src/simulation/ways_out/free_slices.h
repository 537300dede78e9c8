#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "galactic/scene.h"
#include "simulation/collision/clearance_map.h"
#include "simulation/collision/collision.h"
#include "simulation/ways_out/floor_slices.h"
#include "simulation/ways_out/free_slices_kernels.h"

namespace galactic::simulation {

// In which cells around a sphere it would be free, found with three loads.
//
// The heights over a floor are cut into slices. For each slice and each radius there is one bit for
// each column: whether a center is free at all heights of the slice. The bits lie in tiles of
// sixteen columns along X and 32 rows along Z that overlap by eight: the 9 x 9 cells around any
// cell are nine words of sixteen bits, one after the other. Most tiles are all free, all blocked,
// or the same in slice after slice, so each kind is kept once, and what thousands of robots ask
// about stays in the cache. A bit only ever says "surely free", and another one, apart, "surely
// blocked"; where neither does, the column may be asked.

/// Bits of the 9 x 9 cells around a sphere's own, rows along Z of sixteen bits, of which nine
/// count: set where the sphere would be free at its height.
struct Surroundings {
  static constexpr std::size_t kWords = 3;
  std::array<std::uint64_t, kWords> rows{};

  /// `x`, `z`: cells from the sphere's own, from -kCellsAround to kCellsAround.
  [[nodiscard]] bool isFree(int x, int z) const {
    const unsigned bit = bitOf(x, z);
    return (rows[bit / 64] >> (bit % 64) & 1U) != 0;
  }
  constexpr void setFree(int x, int z) {
    const unsigned bit = bitOf(x, z);
    rows[bit / 64] |= std::uint64_t{1} << (bit % 64);
  }
  [[nodiscard]] static constexpr Surroundings everywhere() {
    return {{0x01ff'01ff'01ff'01ff, 0x01ff'01ff'01ff'01ff, 0x01ff}};
  }
  [[nodiscard]] bool isEmpty() const { return (rows[0] | rows[1] | rows[2]) == 0; }
  /// The nine cells of row `n` along Z, from 0 on.
  [[nodiscard]] std::uint32_t row(std::size_t n) const {
    constexpr std::uint64_t kNine = 0x1ff;
    return static_cast<std::uint32_t>(rows[n / 4] >> (n % 4 * 16) & kNine);
  }

 private:
  static constexpr unsigned bitOf(int x, int z) {
    return static_cast<unsigned>(16 * (z + kCellsAround) + x + kCellsAround);
  }
};

/// The same as it lies in memory: rows whose first bits do not count.
struct SurroundingRows {
  const std::uint16_t* first = nullptr;
  const std::uint16_t* first_blocked = nullptr;
  unsigned column = 0;

  [[nodiscard]] Surroundings cells() const { return cellsFrom(first); }
  /// Those that are surely blocked.
  [[nodiscard]] Surroundings blockedCells() const { return cellsFrom(first_blocked); }
  /// As that of Surroundings.
  [[nodiscard]] bool isFree(int x, int z) const {
    return (static_cast<unsigned>(first[z + kCellsAround]) >>
                (column + static_cast<unsigned>(x + kCellsAround)) &
            1U) != 0;
  }

 private:
  [[nodiscard]] Surroundings cellsFrom(const std::uint16_t* row) const {
    Surroundings found;
    constexpr std::size_t kWhole = Surroundings::kWords - 1;
    __builtin_memcpy(found.rows.data(), row, kWhole * sizeof(found.rows[0]));
    // Of the last word one row counts. Written in a part, it would be waited for.
    found.rows[kWhole] = row[std::size_t{2} * kCellsAround];
    for (std::uint64_t& rows : found.rows) rows >>= column;
    return found;
  }
};

/// The slices of the floors of all scenes. Any thread may ask.
class FreeSlices {
 public:
  /// `groups`: eights of spheres that will be asked about with findPlaces().
  explicit FreeSlices(std::vector<EightSpheres> groups = {});

  /// Adds the slices of a floor. Returns the number by which the others know it: 1, 2, ...
  std::uint32_t add(const FloorSlices& floor);

  /// Finds where the spheres of some of the groups from `first` on are. `map`: as add() returned
  /// it; nothing is known for kNoClearanceMap.
  InSlices findPlaces(std::uint32_t map, std::size_t first, const SomeGroups& some) const noexcept;

  /// The same for several envs, kEnvsAsked at most, each on its own map.
  void findPlaces(std::span<const std::uint32_t> maps, std::size_t first,
                  const GroupsOfEnvs& some) const noexcept;

  /// What the places of spheres count from.
  [[nodiscard]] const std::uint16_t* rows() const noexcept { return tiles_.tiles().data()->free; }

  /// The cells around any center; none where it is outside of slices.
  [[nodiscard]] std::optional<SurroundingRows> around(std::uint32_t map, std::uint32_t radius,
                                                      const Vec3& center) const noexcept;
  /// The cells around one of eight centers that is inside of slices.
  [[nodiscard]] SurroundingRows around(const EightPlaces& places, std::size_t lane) const noexcept {
    const std::uint16_t* first = rows() + places.row[lane];
    return {first, first + SliceTile::kRows, static_cast<unsigned>(places.column[lane])};
  }

  [[nodiscard]] std::size_t bytes() const noexcept {
    return tiles_.bytes() + std::span(numbers_).size_bytes();
  }

 private:
  /// The first of a floor's groups.
  [[nodiscard]] const SliceGroup* groupsOf(std::uint32_t map) const;
  [[nodiscard]] TileSet tiles() const { return {numbers_.data(), tiles_.tiles().data()}; }

  std::vector<EightSpheres> groups_;
  /// Of each map, of each radius, after those of no map, which are as wide as nothing.
  std::vector<SlicesOfRadii> layouts_ = std::vector<SlicesOfRadii>(1);
  /// Shape: maps x groups, those of no map among them.
  std::vector<SliceGroup> slice_groups_;
  std::pmr::vector<std::uint32_t> numbers_;
  DistinctTiles tiles_;
};

/// The same at any height, from the columns themselves: exact, and slow.
[[nodiscard]] Surroundings surroundingsOf(const ColumnGrid& grid, const Vec3& center) noexcept;

}  // namespace galactic::simulation
