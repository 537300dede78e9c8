#include "simulation/held_spheres.h"

#include <cassert>

namespace galactic::simulation {

HeldSpheres::HeldSpheres(std::size_t most_spheres, std::span<const float> radii)
    : radii_(radii.begin(), radii.end()), ranges_(radii.size()) {
  // Each radius may leave part of its last group open.
  const std::size_t room = paddedToLanes(most_spheres) + kLanes * radii.size();
  x_.resize(room);
  y_.resize(room);
  z_.resize(room);
}

SphereBatch holdSpheres(const ObjectModel& object, const Pose& world_from_object,
                        HeldSpheres& room) noexcept {
  // The rotation as a matrix, by columns: a sphere then takes nine multiplications.
  const Quat& rotation = world_from_object.rotation;
  const Vec3 from_x = rotate(rotation, {1, 0, 0});
  const Vec3 from_y = rotate(rotation, {0, 1, 0});
  const Vec3 from_z = rotate(rotation, {0, 0, 1});
  const Vec3& origin = world_from_object.translation;
  float* const x = room.x_.data();
  float* const y = room.y_.data();
  float* const z = room.z_.data();

  const std::span<const SetSphere> spheres = object.spheres;
  std::size_t range_count = 0;
  std::size_t to = 0;
  for (std::size_t from = 0; from < spheres.size();) {
    const std::uint32_t radius_index = spheres[from].radius_index;
    assert(range_count < room.ranges_.size() && radius_index < room.radii_.size());
    const std::size_t first = to;
    for (; from < spheres.size() && spheres[from].radius_index == radius_index; ++from, ++to) {
      const Vec3& p = spheres[from].centre;
      x[to] = from_x.x * p.x + from_y.x * p.y + from_z.x * p.z + origin.x;
      y[to] = from_x.y * p.x + from_y.y * p.y + from_z.y * p.z + origin.y;
      z[to] = from_x.z * p.x + from_y.z * p.y + from_z.z * p.z + origin.z;
    }
    room.ranges_[range_count++] = {radius_index, room.radii_[radius_index],
                                   static_cast<std::uint32_t>(first),
                                   static_cast<std::uint32_t>(to - first)};
    for (const std::size_t last = to - 1; to % kLanes != 0; ++to) {
      x[to] = x[last];
      y[to] = y[last];
      z[to] = z[last];
    }
  }
  return {x, y, z, std::span(room.ranges_).first(range_count)};
}

}  // namespace galactic::simulation
