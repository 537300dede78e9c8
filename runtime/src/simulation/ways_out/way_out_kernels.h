#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/sphere_batch.h"
#include "simulation/ways_out/free_slices_kernels.h"

namespace galactic::simulation {

/// A sphere that enters a cell goes this far into it, meters.
inline constexpr float kIntoCell = 1e-4F;

/// Cells in which several spheres are free: rows along Z, of which nine count, as do nine bits of
/// each.
struct alignas(32) CommonCells {
  static constexpr std::size_t kRows = 16;
  std::uint16_t rows[kRows];

  [[nodiscard]] static constexpr CommonCells everywhere() {
    constexpr std::uint16_t kAll = 0xffff;
    return {{kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll,
             kAll, kAll}};
  }
};

/// In which cells around their own eight spheres are free, and where in their own they are. Plain
/// arrays, which the kernels load.
struct alignas(64) EightWays {
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

/// Asks for the shortest move after which all spheres are free.
struct WaysQuery {
  const EightWays* ways = nullptr;
  std::size_t count = 0;
  /// Room for as many as there are ways.
  DecidingEight* deciding = nullptr;
  const CommonCells* common = nullptr;
  /// Edge of a cell, meters.
  float spacing = 0;
  /// The way that the robot came, meters along X and Z: nothing pushes it on along that.
  float drive_x = 0;
  float drive_z = 0;
  /// Meters.
  float longest = 0;
};

/// The squared length of a way that there is not.
inline constexpr float kNoWay = __builtin_inff();

/// A move in the ground plane, meters.
struct FoundWay {
  float x = 0;
  float z = 0;
  /// Its squared length. Not a flag, which would be read in one piece with what was written beside
  /// it, and wait for both.
  float squared = kNoWay;
};

/// Ways are looked at in so many, of which the last may not count.
inline constexpr std::size_t kWaysAtATime = 8;

/// Up to eight groups of spheres: of each, ways are made of the spheres that are free or blocked,
/// and of no others, as nobody knows what they are.
struct GroupsToAdd {
  /// What places count from.
  const std::uint16_t* rows = nullptr;
  const EightSpheres* groups = nullptr;
  const EightPlaces* places = nullptr;
  /// Which of the groups, as bits.
  unsigned asked = 0;
  /// One bit for each sphere that is blocked.
  std::uint64_t blocked = 0;
};

/// What became of them; groups as bits.
struct AddedGroups {
  /// Ways that count.
  std::size_t count = 0;
  /// Groups all of whose spheres are free or blocked.
  unsigned whole = 0;
  /// Groups with such spheres outside of slices, of which no ways were made.
  unsigned outside = 0;
};

/// What is asked of eight spheres at a time. Both versions do the same operations, and agree bit
/// for bit.
struct WayKernels {
  /// Makes ways of the spheres at `places` whose bits are set, and takes the cells in which they
  /// are not free from `common`. `rows`: what places count from. Whether any of them counts.
  bool (*add)(const std::uint16_t* rows, const EightPlaces& places, unsigned spheres,
              EightWays& ways, CommonCells& common) noexcept = nullptr;
  /// The same for the spheres of groups that are free or blocked. `ways`: room for each group.
  AddedGroups (*add_groups)(const GroupsToAdd&, EightWays* ways,
                            CommonCells& common) noexcept = nullptr;
  FoundWay (*shortest)(const WaysQuery&) noexcept = nullptr;
  /// Takes from `cells` those in which slices call a sphere of groups blocked. Whether any is left.
  bool (*leave_unblocked)(const GroupsToAdd&, CommonCells& cells) noexcept = nullptr;
};

/// For any processor.
[[nodiscard]] WayKernels portableWays() noexcept;
/// For processors with AVX2.
[[nodiscard]] WayKernels avx2Ways() noexcept;
/// The fastest ones that this processor can run.
[[nodiscard]] WayKernels wayKernels() noexcept;

}  // namespace galactic::simulation
