#include "sphere_set/solid/distance_grid.h"

#include "galactic/bake/parallel_for.h"

namespace galactic::bake::sphere_set {

DistanceGrid::DistanceGrid(const ExteriorSolid& solid, double margin, double most_nodes,
                           unsigned threads) {
  const Box box = solid.bounds().widened(margin);
  const Vec3d size = box.size();
  step_ = std::cbrt(size.x * size.y * size.z / most_nodes);
  origin_ = box.min;
  const auto along = [&](double extent) {
    return static_cast<std::size_t>(std::ceil(extent / step_)) + 1;
  };
  size_ = {along(size.x), along(size.y), along(size.z)};
  distance_.resize(size_[0] * size_[1] * size_[2]);
  parallelFor(threads, size_[2], [&](std::size_t z) {
    std::uint32_t hint = kNoFacet;
    const std::size_t plane = size_[0] * size_[1];
    for (std::size_t node = z * plane; node < (z + 1) * plane; ++node) {
      const SurfaceDistance surface = solid.distance(position(node), hint);
      hint = surface.facet;
      distance_[node] = static_cast<float>(surface.distance);
    }
  });
}

Vec3d DistanceGrid::position(std::size_t node) const {
  const std::size_t row = node / size_[0];
  const std::size_t plane = row / size_[1];
  return origin_ + Vec3d{static_cast<double>(node % size_[0]), static_cast<double>(row % size_[1]),
                         static_cast<double>(plane)} *
                       step_;
}

double DistanceGrid::at(const Vec3d& p) const {
  struct Place {
    std::size_t node = 0;
    double share = 0;
  };
  const auto along = [&](double coordinate, double origin, std::size_t axis) {
    const double most = static_cast<double>(size_[axis] - 1);
    const double cells = std::clamp((coordinate - origin) / step_, 0.0, most);
    const auto node = std::min(static_cast<std::size_t>(cells), size_[axis] - 2);
    return Place{node, cells - static_cast<double>(node)};
  };
  const Place x = along(p.x, origin_.x, 0);
  const Place y = along(p.y, origin_.y, 1);
  const Place z = along(p.z, origin_.z, 2);
  const float* const corner = &distance_[(z.node * size_[1] + y.node) * size_[0] + x.node];
  const auto row = [&](std::size_t offset) {
    const auto from = static_cast<double>(corner[offset]);
    return from + x.share * (static_cast<double>(corner[offset + 1]) - from);
  };
  const auto plane = [&](std::size_t offset) {
    const double from = row(offset);
    return from + y.share * (row(offset + size_[0]) - from);
  };
  const double from = plane(0);
  return from + z.share * (plane(size_[0] * size_[1]) - from);
}

}  // namespace galactic::bake::sphere_set
