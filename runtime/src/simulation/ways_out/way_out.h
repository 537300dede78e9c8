#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/collision/push.h"
#include "simulation/ways_out/free_slices.h"
#include "simulation/ways_out/way_out_kernels.h"

namespace galactic::simulation {

/// Finds the shortest move in the ground plane after which all added spheres are free of the scene.
/// Their order changes nothing. A sphere is free where the column of its cell is free, so its free
/// places are a union of cells. The free places of the robot are the intersection of these unions,
/// each shifted by its sphere's position. The search tries moves by whole cells, with all spheres
/// at once as bits. Each move that may become the shortest is then shortened as far as possible: up
/// to the border of a cell that blocks a sphere.
class WayOut {
 public:
  /// Makes room for this many groups of eight spheres.
  explicit WayOut(std::size_t most_eights, const WayKernels& kernels = wayKernels());

  /// Forgets all spheres. `spacing`: edge of a cell, meters.
  void clear(float spacing) noexcept;

  /// Rules out all moves until clear().
  void close() noexcept;

  /// Whether all spheres are free after some move by whole cells, or where they are.
  [[nodiscard]] bool isOpen() const noexcept;

  /// Adds the spheres of `lanes` at `places`. `rows`: what places count from.
  void add(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes) noexcept;

  /// Adds the spheres of several groups that are known to be free or blocked, except for those
  /// outside of slices.
  AddedGroups add(const GroupsToAdd& groups) noexcept;

  /// Adds a sphere. `around`: the cells around its own in which it is free; `part_x`, `part_z`: its
  /// position in its own cell, 0 to 1.
  void add(const Surroundings& around, float part_x, float part_z) noexcept;
  /// The same for a sphere at `center`; only the grid's cells matter, not its content.
  void add(const Surroundings& around, const ColumnGridLayout& grid, const Vec3& center) noexcept;

  /// The shortest move, at most `longest` meters long. Does not push the robot further along
  /// `drive`, the way that it came, because that could take it through an obstacle.
  [[nodiscard]] FoundWay shortest(const Push& drive, float longest) noexcept;

  /// Removes from `cells` those that slices know to be blocked for some sphere of `groups`. Returns
  /// whether any is left.
  [[nodiscard]] bool leaveUnblocked(const GroupsToAdd& groups, CommonCells& cells) const noexcept {
    return kernels_.leave_unblocked(groups, cells);
  }

 private:
  /// Space for eight more spheres; if there is none, rules out all moves and returns null.
  [[nodiscard]] EightWays* next() noexcept;

  WayKernels kernels_;
  float spacing_ = 0;
  CommonCells common_;
  std::size_t most_ = 0;
  std::vector<EightWays> ways_;
  std::vector<DecidingEight> deciding_;
  std::size_t count_ = 0;
  /// The rows of spheres that were added one by one, sixteen each, after those of a sphere that is
  /// free anywhere.
  std::vector<std::uint16_t> single_rows_;
  /// The index of the EightWays that the next such sphere goes into, how many spheres that has, and
  /// the number of all such spheres.
  std::size_t singles_ = 0;
  std::size_t in_eight_ = kLanes;
  std::size_t single_count_ = 0;
};

}  // namespace galactic::simulation
