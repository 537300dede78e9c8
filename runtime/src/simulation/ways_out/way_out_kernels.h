#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/sphere_batch.h"
#include "simulation/ways_out/free_slices_kernels.h"

namespace galactic::simulation {

/// Words of two rows that hold the nine rows around a sphere.
inline constexpr std::size_t kRowPairs = kCellsAround + 1;

/// In which cells around their own eight spheres are free, and where in their own they are. Plain
/// arrays, which the kernels load.
struct alignas(32) EightWays {
  /// Of each sphere, rows along Z in pairs, the first in the lower half of a word: bit x +
  /// kCellsAround of row z + kCellsAround is set where the sphere is free in cell (x, z).
  std::uint32_t rows[kRowPairs][kLanes];
  /// From 0 to 1.
  float part_x[kLanes];
  float part_z[kLanes];
  /// All bits where a sphere is free in some cells only; none where it is free in all, as an empty
  /// lane is.
  std::uint32_t counts[kLanes];
};

/// The cells in which all of several eights are free, sphere by sphere.
struct alignas(32) AllWays {
  std::uint32_t rows[kRowPairs][kLanes];
};

/// A cell, counted from the one in which a sphere is.
struct WayCell {
  int x = 0;
  int z = 0;
};

/// How much of a move by whole cells can be taken back along one axis.
struct TakeBack {
  bool along_x = false;
  /// Of the move along that axis: 1 or -1.
  int sign = 1;
  /// The cell before the one that the move leads to. Spheres that it blocks stop at its border.
  WayCell before{};
  /// Of the move along the other axis, where some of it has been taken back already; otherwise 0.
  int other_sign = 0;
  /// How much, and how far into a cell spheres go: those that are less than that from the border of
  /// their cell along the other axis are a cell behind along it, and ask about another cell.
  float other_back = 0;
  float margin = 0;
  WayCell before_behind{};
};

/// Adds the spheres of `lanes` at `places` to `all`, and makes `ways` of them. `rows`: of their
/// radius' slices. Whether any of them counts.
bool addWaysPortable(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes,
                     EightWays& ways, AllWays& all) noexcept;
bool addWaysAvx2(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes,
                 EightWays& ways, AllWays& all) noexcept;

/// The largest part of a cell, up to 1, that the move can take back.
[[nodiscard]] float takenBackPortable(const EightWays* ways, std::size_t count,
                                      const TakeBack& back) noexcept;
[[nodiscard]] float takenBackAvx2(const EightWays* ways, std::size_t count,
                                  const TakeBack& back) noexcept;

/// Whether all spheres are free after a move, in cells. `rounding`: may take a sphere that moves
/// so much further.
[[nodiscard]] bool allFreePortable(const EightWays* ways, std::size_t count, float by_x, float by_z,
                                   float rounding) noexcept;
[[nodiscard]] bool allFreeAvx2(const EightWays* ways, std::size_t count, float by_x, float by_z,
                               float rounding) noexcept;

}  // namespace galactic::simulation
