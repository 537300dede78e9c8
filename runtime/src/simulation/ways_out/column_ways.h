#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/pose.h"
#include "simulation/ways_out/free_slices.h"
#include "simulation/ways_out/way_out.h"

namespace galactic::simulation {

/// Finds in which cells around them spheres are free by asking the columns, where slices do not say
/// so: slices lose what lies closely above or below something, and with it ways out.
///
/// Few columns are asked: none of which slices know that they are blocked, and first only those of
/// cells that all spheres so far leave free; where some cells remain, those next to them too, which
/// decide how much of a move can be taken back. The order of spheres changes nothing.
class ColumnWays {
 public:
  /// Room for that many spheres.
  explicit ColumnWays(std::size_t most_spheres) {
    spheres_.reserve(most_spheres);
    clear();
  }

  void clear() noexcept;

  /// Adds a sphere of a grid. `around`: what slices know.
  void add(const ColumnGrid& grid, const Vec3& center,
           const std::optional<SurroundingRows>& around) noexcept;

  /// Whether slices call every cell blocked for one of the spheres so far: there is no way out.
  [[nodiscard]] bool isHopeless() const noexcept;

  /// Asks the columns, and adds the spheres to `way`. False where they leave no cell free, or there
  /// were more of them than there is room for: there is no way out.
  bool addTo(WayOut& way) noexcept;

 private:
  struct Sphere {
    const ColumnGrid* grid = nullptr;
    Vec3 center;
    /// Known to be free; known either way.
    Surroundings free;
    Surroundings asked;
  };

  static void ask(const Surroundings& cells, Sphere& sphere) noexcept;

  std::vector<Sphere> spheres_;
  /// The cells that slices call blocked for no sphere.
  Surroundings may_be_free_;
  bool is_full_ = false;
};

}  // namespace galactic::simulation
