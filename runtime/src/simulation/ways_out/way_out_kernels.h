#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/sphere_batch.h"
#include "simulation/ways_out/free_slices_kernels.h"

namespace galactic::simulation {

/// Cells in which several spheres are free: rows along Z, of which nine count, as do nine bits of
/// each.
struct alignas(32) CommonCells {
  static constexpr std::size_t kRows = 16;
  std::uint16_t rows[kRows];
};

/// In which cells around their own eight spheres are free, and where in their own they are. Plain
/// arrays, which the kernels load.
struct alignas(32) EightWays {
  /// Of each sphere its first row, counted from `rows`, and the column of its first bit: bit
  /// x + kCellsAround of row z + kCellsAround from there is set where the sphere is free in cell
  /// (x, z). Row 0 and column 0, where all is free, of those that do not count.
  std::int32_t row[kLanes];
  std::int32_t column[kLanes];
  /// From 0 to 1.
  float part_x[kLanes];
  float part_z[kLanes];
  /// In which all are free.
  CommonCells cells;
  const std::uint16_t* rows;
  /// Those that count, as bits.
  unsigned spheres;
};

/// Eight spheres one of which may decide how much of a move can be taken back.
struct alignas(32) DecidingEight {
  const EightWays* ways;
  /// The row of each in which the move ends, and that before it.
  std::int32_t rows[kLanes];
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

/// A move, in cells, after which rounding may take spheres `rounding` further.
struct CellPush {
  float x = 0;
  float z = 0;
  float rounding = 0;
  /// Spheres that end nearer than this to the border of a cell are looked at: the others are free.
  float near = 0;
};

/// Where a move ends, and how far into a cell spheres go, as a part of it: those that are less than
/// that from the border of their cell along the first axis are a cell behind along it.
struct CellMove {
  WayCell to;
  float margin = 0;
};

/// 1, 0 or -1.
constexpr int signOf(int value) { return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0); }

/// Ways can be read in so many, of which the last may not count: a loop whose end can be guessed.
inline constexpr std::size_t kWaysAtATime = 4;

/// What is asked of eight spheres at a time. Both versions do the same operations, and agree bit
/// for bit.
struct WayKernels {
  /// Makes ways of the spheres at `places` whose bits are set, and takes the cells in which they
  /// are not free from `common`. `rows`: what places count from. Whether any of them counts.
  bool (*add)(const std::uint16_t* rows, const EightPlaces& places, unsigned spheres,
              EightWays& ways, CommonCells& common) noexcept = nullptr;
  /// `deciding`: room for one more than there are ways.
  TakenBackBoth (*taken_back)(const EightWays* ways, std::size_t count, const CellMove& move,
                              DecidingEight* deciding) noexcept = nullptr;
  /// Whether all spheres that end near a border are free in all cells in which they may be.
  bool (*are_free)(const EightWays* ways, std::size_t count, const CellPush& by) noexcept = nullptr;
};

/// For any processor.
[[nodiscard]] WayKernels portableWays() noexcept;
/// For processors with AVX2.
[[nodiscard]] WayKernels avx2Ways() noexcept;
/// The fastest ones that this processor can run.
[[nodiscard]] WayKernels wayKernels() noexcept;

}  // namespace galactic::simulation
