#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/column_grid.h"
#include "sensors/scan_kernels.h"

namespace galactic::sensors {

/// A horizontal plane through a scene, ready for beams: a byte for each cell of a column grid, 0 if
/// a sphere of the grid's radius is not free at that height, otherwise how far a beam may go from
/// anywhere in the cell before it has to look again. A ring of blocked cells surrounds the plane:
/// space that the grid does not cover stops a beam, as it stops the robot. Immutable.
class ScanPlane {
 public:
  /// No cells.
  ScanPlane() = default;
  /// The plane of everything between `heights`, world frame, meters. O(cells).
  ScanPlane(const ColumnGrid& grid, const Span& heights);

  [[nodiscard]] ScanPlaneView view() const noexcept;
  /// Cells that block no beam.
  [[nodiscard]] std::size_t freeCells() const noexcept { return free_cells_; }
  [[nodiscard]] std::size_t bytes() const noexcept { return cells_.size(); }

 private:
  ScanPlaneView view_;
  std::vector<std::uint8_t> cells_;
  std::size_t free_cells_ = 0;
};

}  // namespace galactic::sensors
