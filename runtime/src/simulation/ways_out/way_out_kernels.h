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

/// What parts of a cell, up to 1, a move by whole cells can take back along x and z: as much as
/// leaves all spheres free, which those that the cell before blocks decide.
struct TakenBack {
  float x = 1;
  float z = 1;
};

/// The same, first along one axis as if the whole way along the other were gone, then along the
/// other, each sphere from the cell along the first in which it is then.
struct TakenBackBoth {
  TakenBack along_x_first;
  TakenBack along_z_first;
};

/// Added to cells before they are rounded: truncation rounds down what is positive.
inline constexpr float kAboveCells = 64;

/// A move, in cells.
struct CellPush {
  float x = 0;
  float z = 0;
};

/// Where a move ends, and how far into a cell spheres go, as a part of it: those that are less than
/// that from the border of their cell along the first axis are a cell behind along it.
struct CellMove {
  WayCell to;
  float margin = 0;
};

/// 1, 0 or -1.
constexpr int signOf(int value) { return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0); }

/// Adds the spheres of `lanes` at `places` to `all`, and makes `ways` of them. `rows`: of their
/// radius' slices. Whether any of them counts.
bool addWaysPortable(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes,
                     EightWays& ways, AllWays& all) noexcept;
bool addWaysAvx2(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes,
                 EightWays& ways, AllWays& all) noexcept;

/// What a move to where all spheres are free can take back.
[[nodiscard]] TakenBackBoth takenBackPortable(const EightWays* ways, std::size_t count,
                                              const CellMove& move) noexcept;
[[nodiscard]] TakenBackBoth takenBackAvx2(const EightWays* ways, std::size_t count,
                                          const CellMove& move) noexcept;

/// Whether no sphere is nearer than `distance` to a border of its cell after a move, in cells.
[[nodiscard]] bool noneAtBorderPortable(const EightWays* ways, std::size_t count,
                                        const CellPush& by, float distance) noexcept;
[[nodiscard]] bool noneAtBorderAvx2(const EightWays* ways, std::size_t count, const CellPush& by,
                                    float distance) noexcept;

/// Whether all spheres are free after a move, in cells. `rounding`: may take a sphere that moves
/// so much further.
[[nodiscard]] bool allFreePortable(const EightWays* ways, std::size_t count, const CellPush& by,
                                   float rounding) noexcept;
[[nodiscard]] bool allFreeAvx2(const EightWays* ways, std::size_t count, const CellPush& by,
                               float rounding) noexcept;

}  // namespace galactic::simulation
