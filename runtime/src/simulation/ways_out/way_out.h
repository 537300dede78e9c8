#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/collision/push.h"
#include "simulation/ways_out/free_slices.h"
#include "simulation/ways_out/way_out_kernels.h"

namespace galactic::simulation {

/// The shortest move in the ground plane after which the spheres that were added are free of the
/// scene. Their order changes nothing.
///
/// A sphere is free where the column of its cell is, so where it may be is a union of cells, and
/// where a robot may be is what its spheres' unions, each moved by where the sphere is, have in
/// common. The search goes over moves by whole cells, all spheres at once as bits, and takes back
/// of each that may be the shortest what can be taken back: up to the border of a cell that blocks
/// a sphere.
class WayOut {
 public:
  /// Room for that many times eight spheres.
  explicit WayOut(std::size_t most_eights, const WayKernels& kernels = wayKernels());

  /// Forgets all spheres. `spacing`: edge of a cell, meters.
  void clear(float spacing) noexcept;

  /// From now on no move is free, until clear().
  void close() noexcept;

  /// Whether there is a cell around their own in which all spheres are free.
  [[nodiscard]] bool isOpen() const noexcept;

  /// Adds the spheres of `lanes` at `places`. `rows`: of the slices for their radius.
  void add(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes) noexcept;

  /// Adds the spheres of several groups that are free or blocked, but for those outside of slices.
  AddedGroups add(const GroupsToAdd& groups) noexcept;

  /// Adds a sphere: in which cells around its own it is free, and where in that it is, 0 to 1.
  void add(const Surroundings& around, float part_x, float part_z) noexcept;
  /// The same for a sphere at `center`; of the grid's frame, the cells alone count.
  void add(const Surroundings& around, const ColumnGridLayout& grid, const Vec3& center) noexcept;

  /// At most `longest` meters, and not on along `drive`, the way that the robot came: nothing
  /// pushes it through an obstacle.
  [[nodiscard]] FoundWay shortest(const Push& drive, float longest) noexcept;

  /// Takes from `cells` those in which slices call a sphere of groups blocked. Whether any is left.
  [[nodiscard]] bool leaveUnblocked(const GroupsToAdd& groups, CommonCells& cells) const noexcept {
    return kernels_.leave_unblocked(groups, cells);
  }

 private:
  /// Room for eight spheres more; null where there is none, and no move is known to be free.
  [[nodiscard]] EightWays* next() noexcept;

  WayKernels kernels_;
  float spacing_ = 0;
  CommonCells common_;
  std::size_t most_ = 0;
  std::vector<EightWays> ways_;
  std::vector<DecidingEight> deciding_;
  std::size_t count_ = 0;
  /// The rows of spheres added one by one, sixteen each; first those of one that is free anywhere.
  std::vector<std::uint16_t> single_rows_;
  /// The eight that these spheres go into, how many it has, and how many there are.
  std::size_t singles_ = 0;
  std::size_t in_eight_ = kLanes;
  std::size_t single_count_ = 0;
};

}  // namespace galactic::simulation
