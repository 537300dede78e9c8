#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/pose.h"
#include "simulation/ways_out/free_slices.h"
#include "simulation/ways_out/way_out.h"

namespace galactic::simulation {

/// Finds in which cells around them spheres are free by asking the columns about cells that slices
/// do not know to be free: slices lose free heights closely above or below something, and with them
/// ways out. Few columns are asked: none that slices know to be blocked, and at first only those of
/// cells in which all spheres so far are free. If some cells remain, those next to them are asked,
/// too, because they decide how much of a move can be taken back. The order of spheres changes
/// nothing.
class ColumnWays {
 public:
  /// Makes room for this many spheres.
  explicit ColumnWays(std::size_t most_spheres) {
    spheres_.reserve(most_spheres);
    clear();
  }

  void clear() noexcept;

  /// Adds a sphere whose radius is that of `grid`. `around`: what slices know of the cells around
  /// it.
  void add(const ColumnGrid& grid, const Vec3& center,
           const std::optional<SurroundingRows>& around) noexcept;

  /// Whether slices know that every cell is blocked for some sphere so far, so that there is no way
  /// out.
  [[nodiscard]] bool isHopeless() const noexcept;

  /// Asks the columns, and adds the spheres to `way`. Returns false, which means no way out, if no
  /// cell is free for all spheres or there are more spheres than there is room for.
  bool addTo(WayOut& way) noexcept;

 private:
  struct Sphere {
    const ColumnGrid* grid = nullptr;
    Vec3 center;
    /// Cells known to be free, and cells known to be free or blocked.
    Surroundings free;
    Surroundings asked;
  };

  static void ask(const Surroundings& cells, Sphere& sphere) noexcept;

  std::vector<Sphere> spheres_;
  /// The cells that slices know to be blocked for no sphere.
  Surroundings may_be_free_;
  bool is_full_ = false;
};

}  // namespace galactic::simulation
