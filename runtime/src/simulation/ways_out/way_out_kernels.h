#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/sphere_batch.h"
#include "simulation/ways_out/free_slices_kernels.h"

namespace galactic::simulation {

/// How far a sphere that enters a cell goes into it, meters.
inline constexpr float kIntoCell = 1e-4F;

/// Cells, relative to their own, in which several spheres are free: rows along Z, of which nine
/// count, and nine bits of each.
struct alignas(32) CommonCells {
  static constexpr std::size_t kRows = 16;
  std::uint16_t rows[kRows];

  [[nodiscard]] static constexpr CommonCells everywhere() {
    constexpr std::uint16_t kAll = 0xffff;
    return {{kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll, kAll,
             kAll, kAll}};
  }
};

/// The cells around their own in which eight spheres are free, and the spheres' positions in their
/// own cells. Plain arrays, which the kernels load.
struct alignas(64) EightWays {
  /// Each sphere's first row, counted from `rows`, and the column of its first bit: bit x +
  /// kCellsAround of row z + kCellsAround from there is set if the sphere is free in cell (x, z).
  /// Spheres that do not count have row 0 and column 0, where all is free.
  std::int32_t row[kLanes];
  std::int32_t column[kLanes];
  /// Each sphere's position in its cell, from 0 to 1.
  float part_x[kLanes];
  float part_z[kLanes];
  /// The cells in which all eight are free.
  CommonCells cells;
  const std::uint16_t* rows;
  /// The spheres that count, as bits.
  unsigned spheres;
};

/// Eight spheres, one of which may limit how much of a move can be taken back.
struct alignas(32) DecidingEight {
  const EightWays* ways;
  /// For each sphere the row in which the move ends and the previous one, side by side.
  std::int32_t rows[kLanes];
};

/// A query for the shortest move after which all spheres are free.
struct WaysQuery {
  const EightWays* ways = nullptr;
  std::size_t count = 0;
  /// Space for as many as there are ways.
  DecidingEight* deciding = nullptr;
  const CommonCells* common = nullptr;
  /// Edge of a cell, meters.
  float spacing = 0;
  /// The way that the robot came, meters along X and Z: no move pushes it further that way.
  float drive_x = 0;
  float drive_z = 0;
  /// The longest move, meters.
  float longest = 0;
};

/// The squared length that means that there is no way.
inline constexpr float kNoWay = __builtin_inff();

/// A move in the ground plane, meters.
struct FoundWay {
  float x = 0;
  float z = 0;
  /// Its squared length, instead of a flag, which would be read together with what was written
  /// beside it and stall.
  float squared = kNoWay;
};

/// Ways are checked this many at a time; the last ones may not count.
inline constexpr std::size_t kWaysAtATime = 8;

/// Up to eight groups of spheres. Ways are made of the spheres of each that are known to be free or
/// blocked; nothing is known of the others.
struct GroupsToAdd {
  /// The start of all rows, from which places count.
  const std::uint16_t* rows = nullptr;
  const EightSpheres* groups = nullptr;
  const EightPlaces* places = nullptr;
  /// The groups to add, as bits.
  unsigned asked = 0;
  /// One bit for each sphere that is blocked.
  std::uint64_t blocked = 0;
};

/// The result of adding groups; groups as bits.
struct AddedGroups {
  /// The number of ways that count.
  std::size_t count = 0;
  /// Groups all of whose spheres are known to be free or blocked.
  unsigned whole = 0;
  /// Groups with such spheres outside of slices, which were not added to ways.
  unsigned outside = 0;
};

/// Kernels for eight spheres at a time. Both versions do the same operations, and agree bit for
/// bit.
struct WayKernels {
  /// Makes ways of the spheres at `places` whose bits are set, and removes the cells in which they
  /// are not free from `common`. `rows`: what places count from. Returns whether the ways count,
  /// which they do not if all cells are free.
  bool (*add)(const std::uint16_t* rows, const EightPlaces& places, unsigned spheres,
              EightWays& ways, CommonCells& common) noexcept = nullptr;
  /// The same for the spheres of groups that are known to be free or blocked. `ways`: space for
  /// each group.
  AddedGroups (*add_groups)(const GroupsToAdd&, EightWays* ways,
                            CommonCells& common) noexcept = nullptr;
  FoundWay (*shortest)(const WaysQuery&) noexcept = nullptr;
  /// Removes from `cells` those that slices know to be blocked for some sphere. Returns whether any
  /// is left.
  bool (*leave_unblocked)(const GroupsToAdd&, CommonCells& cells) noexcept = nullptr;
};

/// For any processor.
[[nodiscard]] WayKernels portableWays() noexcept;
/// For processors with AVX2.
[[nodiscard]] WayKernels avx2Ways() noexcept;
/// The fastest kernels that this processor can run.
[[nodiscard]] WayKernels wayKernels() noexcept;

}  // namespace galactic::simulation
