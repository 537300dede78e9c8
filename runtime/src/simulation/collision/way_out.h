#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "simulation/collision/free_slices.h"
#include "simulation/collision/push.h"

namespace galactic::simulation {

/// A sphere that enters a cell goes this far into it, meters.
inline constexpr float kIntoCell = 1e-4F;

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
  /// Room for that many spheres.
  explicit WayOut(std::size_t most_spheres) : spheres_(most_spheres), exact_(most_spheres) {}

  /// Forgets all spheres. `spacing`: edge of a cell, meters.
  void clear(float spacing) noexcept {
    count_ = 0;
    exact_count_ = 0;
    spacing_ = spacing;
    all_.rows.fill(~std::uint64_t{0});
  }

  /// Adds a sphere: in which cells around its own it is free, and where in that it is, 0 to 1. The
  /// rows must stay where they are.
  void add(const SurroundingRows& around, float part_x, float part_z) noexcept {
    const Surroundings cells = around.cells();
    if (cells.isAllFree()) return;
    all_ &= cells;
    // Too many to remember: no move is known to be free.
    if (count_ == spheres_.size()) {
      all_ = {};
    } else {
      spheres_[count_++] = {around, part_x, part_z};
    }
  }
  /// The same, copying.
  void add(const Surroundings& around, float part_x, float part_z) noexcept {
    if (exact_count_ == exact_.size()) {
      all_ = {};
      return;
    }
    exact_[exact_count_] = around;
    add(SurroundingRows{exact_[exact_count_++].words(), 0}, part_x, part_z);
  }

  /// At most `longest` meters, and not on along `drive`, the way that the robot came: nothing
  /// pushes it through an obstacle. None where there is no such move.
  [[nodiscard]] std::optional<Push> shortest(const Push& drive, float longest) const noexcept;

 private:
  struct Sphere {
    SurroundingRows around;
    float part_x = 0;
    float part_z = 0;
  };

  [[nodiscard]] Push shortened(int x, int z, bool along_x_first) const noexcept;
  [[nodiscard]] Push shortened(int x, int z) const noexcept;
  [[nodiscard]] bool suits(const Push& push) const noexcept;
  template <class MayBe>
  [[nodiscard]] std::optional<Push> shortestOf(float longest, const MayBe& may_be) const noexcept;

  float spacing_ = 0;
  Surroundings all_;
  std::size_t count_ = 0;
  std::size_t exact_count_ = 0;
  std::vector<Sphere> spheres_;
  std::vector<Surroundings> exact_;
};

}  // namespace galactic::simulation
