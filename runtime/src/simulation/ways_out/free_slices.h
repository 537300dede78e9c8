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

// Finds with three loads in which cells around its own a sphere would be free. The heights above a
// floor are cut into slices. For each slice and radius there is one bit per column: whether a
// center is free at all heights of the slice. The bits lie in tiles of sixteen columns along X and
// 32 rows along Z that overlap by eight, so that the 9 x 9 cells around any cell are nine
// consecutive words of sixteen bits. Most tiles are entirely free, entirely blocked, or the same in
// many slices, so each distinct tile is stored once, and the data that thousands of robots ask for
// stays in the cache. A set bit means "surely free"; a set bit in a second bitmap means "surely
// blocked". If neither is set, the column may be asked.

/// One bit for each of the 9 x 9 cells around a sphere's own, set if the sphere would be free there
/// at its height. Rows along Z have sixteen bits, of which nine count.
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
  /// The nine cells of row `n` along Z, counted from 0.
  [[nodiscard]] std::uint32_t row(std::size_t n) const {
    constexpr std::uint64_t kNine = 0x1ff;
    return static_cast<std::uint32_t>(rows[n / 4] >> (n % 4 * 16) & kNine);
  }

 private:
  static constexpr unsigned bitOf(int x, int z) {
    return static_cast<unsigned>(16 * (z + kCellsAround) + x + kCellsAround);
  }
};

/// The same as a view of a tile in memory: rows whose first `column` bits do not count.
struct SurroundingRows {
  const std::uint16_t* first = nullptr;
  const std::uint16_t* first_blocked = nullptr;
  unsigned column = 0;

  [[nodiscard]] Surroundings cells() const { return cellsFrom(first); }
  /// The cells that are surely blocked.
  [[nodiscard]] Surroundings blockedCells() const { return cellsFrom(first_blocked); }
  /// See Surroundings::isFree().
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
    // Only one row of the last word counts. It is written as a whole word, because reading a partly
    // written word would stall.
    found.rows[kWhole] = row[std::size_t{2} * kCellsAround];
    for (std::uint64_t& rows : found.rows) rows >>= column;
    return found;
  }
};

/// The slices of the floors of all scenes. Const members may be called from any thread.
class FreeSlices {
 public:
  /// `groups`: the groups of eight spheres that findPlaces() will be asked about.
  explicit FreeSlices(std::vector<EightSpheres> groups = {});

  /// Adds the slices of a floor. Returns its number for the other functions: 1, 2, ...
  std::uint32_t add(const FloorSlices& floor);

  /// Finds the places of the spheres of some groups from `first` on. `map`: as add() returned it;
  /// for kNoClearanceMap nothing is known.
  InSlices findPlaces(std::uint32_t map, std::size_t first, const SomeGroups& some) const noexcept;

  /// The same for several envs, kEnvsAsked at most, each on its own map.
  void findPlaces(std::span<const std::uint32_t> maps, std::size_t first,
                  const GroupsOfEnvs& some) const noexcept;

  /// The start of all rows, from which the places of spheres count.
  [[nodiscard]] const std::uint16_t* rows() const noexcept { return tiles_.tiles().data()->free; }

  /// The cells around any center; none if it is outside of slices.
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
  /// A floor's first group.
  [[nodiscard]] const SliceGroup* groupsOf(std::uint32_t map) const;
  [[nodiscard]] TileSet tiles() const { return {numbers_.data(), tiles_.tiles().data()}; }

  std::vector<EightSpheres> groups_;
  /// Layouts per map and radius; the first ones, for kNoClearanceMap, have no width.
  std::vector<SlicesOfRadii> layouts_ = std::vector<SlicesOfRadii>(1);
  /// Shape: maps x groups, including those of kNoClearanceMap.
  std::vector<SliceGroup> slice_groups_;
  std::pmr::vector<std::uint32_t> numbers_;
  DistinctTiles tiles_;
};

/// The surroundings of a center at any height from the columns themselves: exact, but slow.
[[nodiscard]] Surroundings surroundingsOf(const ColumnGrid& grid, const Vec3& center) noexcept;

}  // namespace galactic::simulation
