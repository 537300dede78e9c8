#include "column_grid/free_way.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "column_grid/column_grid_kernels.h"

namespace galactic::detail {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The cells that a line crosses along one axis of the ground.
class Crossing {
 public:
  /// `from`: in cells of the grid, which has `count` of them; `along`: cells per meter.
  Crossing(double from, double along, std::uint32_t cell, std::uint32_t count)
      : from_(from),
        meters_per_cell_(1 / along),
        step_(along > 0 ? 1 : (along < 0 ? -1 : 0)),
        cell_(cell),
        count_(count) {}

  [[nodiscard]] std::uint32_t cell() const { return static_cast<std::uint32_t>(cell_); }
  [[nodiscard]] bool isInside() const { return cell_ >= 0 && cell_ < count_; }

  /// Where the line leaves the cell, in meters along the line.
  [[nodiscard]] double leaves() const {
    if (step_ == 0) return kNever;
    const auto border = static_cast<double>(step_ > 0 ? cell_ + 1 : cell_);
    return (border - from_) * meters_per_cell_;
  }
  void enterNext() { cell_ += step_; }

 private:
  double from_;
  double meters_per_cell_;
  std::int64_t step_;
  std::int64_t cell_;
  std::int64_t count_;
};

/// What blocks a line at a height: the end of the grid's range, whose last code lies less than a
/// quantum below the upper end, or something in the scene.
Clearance endAt(const ColumnGridLayout& grid, double y) {
  const auto slack = static_cast<double>(grid.quantum + 2 * contactMargin(grid));
  const bool is_within = y > static_cast<double>(grid.heights.lo) + slack &&
                         y < static_cast<double>(grid.heights.hi) - slack;
  return is_within ? Clearance::kBlocked : Clearance::kOutside;
}

}  // namespace

double lengthOf(const Vec3& v) noexcept {
  const auto x = static_cast<double>(v.x);
  const auto y = static_cast<double>(v.y);
  const auto z = static_cast<double>(v.z);
  return std::sqrt(x * x + y * y + z * z);
}

StraightLine straightLine(const Vec3& from, const Vec3& direction, double length) noexcept {
  const double whole = lengthOf(direction);
  return {from,
          {static_cast<double>(direction.x) / whole, static_cast<double>(direction.y) / whole,
           static_cast<double>(direction.z) / whole},
          length};
}

FreeWay freeWay(const ColumnGrid& grid, const StraightLine& line) noexcept {
  const ColumnGridLayout& layout = grid.layout();
  const Contact start = grid.contact(line.from);
  if (start.clearance != Clearance::kFree) return {0, start.clearance};
  const ColumnIndex first = *grid.columnAt(line.from.x, line.from.z);
  // Queries multiply by the inverse spacing: cell borders have to lie where queries see them.
  const auto cells_per_meter = static_cast<double>(layout.inverse_spacing);
  const auto in_cells = [&](float at, float least) {
    return (static_cast<double>(at) - static_cast<double>(least)) * cells_per_meter;
  };
  Crossing x(in_cells(line.from.x, layout.min_x), line.along[0] * cells_per_meter, first.i,
             layout.columns_x);
  Crossing z(in_cells(line.from.z, layout.min_z), line.along[2] * cells_per_meter, first.k,
             layout.columns_z);
  const double rise = line.along[1];
  const auto height = [&](double way) { return static_cast<double>(line.from.y) + rise * way; };
  const double meters_per_height = 1 / std::fabs(rise);
  double way = 0;
  while (x.isInside() && z.isInside()) {
    const double y = height(way);
    const Contact here = grid.contact({x.cell(), z.cell()}, static_cast<float>(y));
    if (here.clearance != Clearance::kFree) return {way, endAt(layout, y)};
    const auto room = static_cast<double>(rise < 0 ? here.down : here.up);
    const double touches = rise == 0 ? kNever : way + room * meters_per_height;
    // The query of the first cell rounds, so the line may have left that cell already.
    const double leaves = std::max(way, std::min(x.leaves(), z.leaves()));
    if (line.length <= std::min(touches, leaves)) return {line.length, Clearance::kFree};
    if (touches <= leaves) return {touches, endAt(layout, height(touches))};
    way = leaves;
    const bool leaves_x = x.leaves() <= leaves;
    const bool leaves_z = z.leaves() <= leaves;
    if (leaves_x) x.enterNext();
    if (leaves_z) z.enterNext();
  }
  return {way, Clearance::kOutside};
}

}  // namespace galactic::detail
