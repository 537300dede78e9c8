#include "sphere_set/solid/point_grid.h"

namespace galactic::bake::sphere_set {
namespace {

constexpr double kMostCells = 1e6;

}  // namespace

PointGrid::PointGrid(std::span<const Vec3d> points, double cell) : cell_(cell) {
  if (points.empty()) return;
  Box box;
  for (const Vec3d& p : points) box.grow(p);
  origin_ = {box.min.x, box.min.y, box.min.z};
  const Vec3d size = box.size();
  while (true) {
    const auto along = [&](double extent) { return std::floor(extent / cell_) + 1; };
    const std::array<double, 3> count{along(size.x), along(size.y), along(size.z)};
    if (count[0] * count[1] * count[2] <= kMostCells) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        size_[axis] = static_cast<std::size_t>(count[axis]);
      }
      break;
    }
    cell_ *= 1.25;
  }
  first_.assign(size_[0] * size_[1] * size_[2] + 1, 0);
  for (const Vec3d& p : points) ++first_[cellOf(p) + 1];
  for (std::size_t at = 1; at < first_.size(); ++at) first_[at] += first_[at - 1];
  sorted_.resize(points.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t index = 0; index < points.size(); ++index) {
    sorted_[next[cellOf(points[index])]++] = {points[index], index};
  }
}

PointGrid::Range PointGrid::cellsAlong(std::size_t axis, double at, double radius) const {
  const auto most = static_cast<double>(size_[axis]);
  const double first = std::floor((at - radius - origin_[axis]) / cell_);
  const double end = std::floor((at + radius - origin_[axis]) / cell_) + 1;
  return {static_cast<std::size_t>(std::clamp(first, 0.0, most)),
          static_cast<std::size_t>(std::clamp(end, 0.0, most))};
}

std::size_t PointGrid::cellOf(const Vec3d& p) const {
  const auto along = [&](double coordinate, std::size_t axis) {
    const double cell = std::floor((coordinate - origin_[axis]) / cell_);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(size_[axis] - 1)));
  };
  return (along(p.z, 2) * size_[1] + along(p.y, 1)) * size_[0] + along(p.x, 0);
}

}  // namespace galactic::bake::sphere_set
