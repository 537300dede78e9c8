#include "simulation/object_placement.h"
namespace galactic::simulation {
std::size_t paddedObjectSpheres(const ObjectModel& m) {
  std::size_t n = 0;
  std::size_t i = 0;
  while (i < m.spheres.size()) {
    std::size_t j = i;
    while (j < m.spheres.size() && m.spheres[j].radius_index == m.spheres[i].radius_index) ++j;
    n += paddedToLanes(j - i);
    i = j;
  }
  return n;
}
SphereBatch holdSpheres(const ObjectModel& m, const Pose& pose, PlacementScratch& s) {
  std::size_t n = s.values.size() / 3;
  float *x = s.values.data(), *y = x + n, *z = y + n;
  std::size_t i = 0, k = 0, r = 0;
  while (i < m.spheres.size()) {
    std::size_t j = i;
    auto first = k;
    while (j < m.spheres.size() && m.spheres[j].radius_index == m.spheres[i].radius_index) {
      Vec3 c = pose * m.spheres[j].centre;
      x[k] = c.x;
      y[k] = c.y;
      z[k] = c.z;
      ++k;
      ++j;
    }
    while (k % 8) {
      x[k] = x[k - 1];
      y[k] = y[k - 1];
      z[k] = z[k - 1];
      ++k;
    }
    s.ranges[r++] = {m.spheres[i].radius_index, 0.015F, static_cast<std::uint32_t>(first),
                     static_cast<std::uint32_t>(j - i)};
    i = j;
  }
  return {x, y, z, std::span<const RadiusRange>(s.ranges, r)};
}
Landing placeObject(const Surroundings&, const ObjectModel&, const Pose& released, RandomStream&,
                    const PlacementOptions&, PlacementScratch&) {
  return {released, false, 1};
}
}  // namespace galactic::simulation
