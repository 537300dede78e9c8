#include "sensors/scan_plane.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace galactic::sensors {
namespace {

/// Width of the ring on each side, cells.
constexpr std::uint32_t kRing = 1;

/// The bytes of the cells, row by row.
struct Cells {
  std::vector<std::uint8_t>& bytes;
  std::size_t columns_x;
  std::size_t columns_z;
};

/// Sets the cells whose columns are free between `heights` to 1, the others to 0; returns how many
/// are free.
std::size_t markFree(const ColumnGrid& grid, const Span& heights, const Cells& cells) {
  const ColumnGridLayout& layout = grid.layout();
  const std::size_t count = grid.columnsX();
  std::vector<float> x(count);
  std::vector<float> z(count);
  const std::vector<float> y(count, heights.lo);
  std::vector<Clearance> answers(count);
  std::vector<float> down(count);
  std::vector<float> up(count);
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing;
  }
  std::size_t free = 0;
  for (std::size_t k = 0; k < grid.columnsZ(); ++k) {
    std::ranges::fill(z, layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing);
    grid.contact({x, y, z}, {answers, down, up});
    std::uint8_t* row = cells.bytes.data() + (k + kRing) * cells.columns_x + kRing;
    for (std::size_t i = 0; i < count; ++i) {
      row[i] = answers[i] == Clearance::kFree && heights.lo + up[i] >= heights.hi ? 1 : 0;
      free += row[i];
    }
  }
  return free;
}

/// For each cell the distance along its column, measured in cells from square to square, to the
/// nearest cell that is blocked or next to a blocked one in its row. The ring's first and last row
/// are blocked, so every column has such a cell.
std::vector<std::int32_t> columnDistances(const Cells& cells) {
  const std::size_t nx = cells.columns_x;
  const std::size_t nz = cells.columns_z;
  std::vector<std::int32_t> steps(nx * nz, 0);
  for (std::size_t k = 1; k + 1 < nz; ++k) {
    const std::uint8_t* row = cells.bytes.data() + k * nx;
    for (std::size_t i = 1; i + 1 < nx; ++i) {
      const bool is_wide = row[i - 1] == 0 || row[i] == 0 || row[i + 1] == 0;
      steps[k * nx + i] = is_wide ? 0 : steps[(k - 1) * nx + i] + 1;
    }
  }
  for (std::size_t k = nz - 1; k-- > 0;) {
    for (std::size_t i = 0; i < nx; ++i) {
      steps[k * nx + i] = std::min(steps[k * nx + i], steps[(k + 1) * nx + i] + 1);
    }
  }
  // The distance between squares is one less than the distance between their middles.
  for (std::int32_t& step : steps) step = std::max(step - 1, 0);
  return steps;
}

/// The lower envelope of the parabolas (i - p)^2 + step[p]^2 over one row (Felzenszwalb and
/// Huttenlocher, Distance transforms of sampled functions, 2012), computed in integers as in
/// Meijster et al. 2000.
class Envelope {
 public:
  explicit Envelope(std::size_t columns) : middle_(columns), from_(columns) {}

  /// Calls visit(i, lowest) for each i, ascending.
  template <class Visit>
  void sweep(std::span<const std::int32_t> steps, const Visit& visit) {
    const auto count = static_cast<std::int64_t>(steps.size());
    const auto square = [&](std::int64_t p) {
      const std::int64_t step = steps[static_cast<std::size_t>(p)];
      return step * step;
    };
    const auto at = [&](std::int64_t i, std::int64_t p) { return (i - p) * (i - p) + square(p); };
    std::size_t pieces = 1;
    middle_[0] = 0;
    from_[0] = 0;
    for (std::int64_t p = 1; p < count; ++p) {
      while (pieces > 0 && at(from_[pieces - 1], p) <= at(from_[pieces - 1], middle_[pieces - 1])) {
        --pieces;
      }
      std::int64_t first = 0;
      if (pieces > 0) {
        const std::int64_t other = middle_[pieces - 1];
        first = (p * p - other * other + square(p) - square(other)) / (2 * (p - other)) + 1;
      }
      if (first >= count) continue;
      middle_[pieces] = p;
      from_[pieces++] = first;
    }
    std::size_t piece = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      while (piece + 1 < pieces && from_[piece + 1] <= i) ++piece;
      visit(static_cast<std::size_t>(i), at(i, middle_[piece]));
    }
  }

 private:
  /// For each piece of the envelope: its parabola, and the first i at which this one is the lowest.
  std::vector<std::int64_t> middle_;
  std::vector<std::int64_t> from_;
};

/// The byte of a free cell whose nearest blocked square is at this squared distance, in cells.
std::uint8_t promiseOf(std::int64_t squared) {
  constexpr double kMost = 254;
  const double jumps =
      std::floor(std::sqrt(static_cast<double>(squared)) / static_cast<double>(kJump));
  return static_cast<std::uint8_t>(1 + std::min(jumps, kMost));
}

}  // namespace

ScanPlane::ScanPlane(const ColumnGrid& grid, const Span& heights) {
  const ColumnGridLayout& layout = grid.layout();
  const std::size_t nx = grid.columnsX() + std::size_t{2} * kRing;
  const std::size_t nz = grid.columnsZ() + std::size_t{2} * kRing;
  cells_.assign(nx * nz + kReadBeyond, 0);
  const Cells cells{cells_, nx, nz};
  free_cells_ = markFree(grid, heights, cells);
  // The distance between two squares is the distance between their middles after one of them has
  // grown by its eight neighbors. columnDistances() grows the blocked squares along x, and along z
  // by subtracting one cell.
  const std::vector<std::int32_t> steps = columnDistances(cells);
  Envelope envelope(nx);
  for (std::size_t k = 0; k < nz; ++k) {
    std::uint8_t* row = cells_.data() + k * nx;
    envelope.sweep(std::span(steps).subspan(k * nx, nx), [&](std::size_t i, std::int64_t least) {
      if (row[i] != 0) row[i] = promiseOf(least);
    });
  }
  view_ = {.cells = nullptr,
           .columns_x = static_cast<std::int32_t>(nx),
           .columns_z = static_cast<std::int32_t>(nz),
           .min_x = layout.min_x - layout.spacing,
           .min_z = layout.min_z - layout.spacing,
           .spacing = layout.spacing,
           .inverse_spacing = layout.inverse_spacing};
}

ScanPlaneView ScanPlane::view() const noexcept {
  ScanPlaneView view = view_;
  view.cells = cells_.data();
  return view;
}

}  // namespace galactic::sensors
