#include "simulation/collision/held_spheres.h"

#include <cassert>

namespace galactic::simulation {
namespace {

/// A pose as the columns of a matrix, so that each sphere takes nine multiplications.
struct Columns {
  explicit Columns(const Pose& pose)
      : x(rotate(pose.rotation, {1, 0, 0})),
        y(rotate(pose.rotation, {0, 1, 0})),
        z(rotate(pose.rotation, {0, 0, 1})),
        origin(pose.translation) {}

  Vec3 x, y, z, origin;
};

struct Target {
  float* x;
  float* y;
  float* z;
};

/// Writes the centers and pads the last group. A plain counted loop over arrays that do not
/// overlap, so that compilers vectorize it.
void place(std::span<const SetSphere> spheres, const Columns& columns, const Target& target) {
  const SetSphere* from = spheres.data();
  const std::size_t count = spheres.size();
  float* __restrict x = target.x;
  float* __restrict y = target.y;
  float* __restrict z = target.z;
  const Columns m = columns;
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 p = from[n].center;
    x[n] = m.x.x * p.x + m.y.x * p.y + m.z.x * p.z + m.origin.x;
    y[n] = m.x.y * p.x + m.y.y * p.y + m.z.y * p.z + m.origin.y;
    z[n] = m.x.z * p.x + m.y.z * p.y + m.z.z * p.z + m.origin.z;
  }
  for (std::size_t n = count; n % kLanes != 0; ++n) {
    x[n] = x[count - 1];
    y[n] = y[count - 1];
    z[n] = z[count - 1];
  }
}

}  // namespace

HeldSpheres::HeldSpheres(std::size_t most_spheres, std::span<const float> radii)
    : radii_(radii.begin(), radii.end()), ranges_(radii.size()) {
  // Each radius may need padding in its last group.
  const std::size_t room = paddedToLanes(most_spheres) + kLanes * radii.size();
  x_.resize(room);
  y_.resize(room);
  z_.resize(room);
}

SphereBatch holdSpheres(const ObjectModel& object, const Pose& world_from_object,
                        HeldSpheres& room) noexcept {
  const Columns world_from_set(world_from_object);
  const SetSphere* const spheres = object.spheres.data();
  const std::size_t count = object.spheres.size();
  std::size_t range_count = 0;
  std::size_t to = 0;
  for (std::size_t from = 0; from < count;) {
    const std::uint32_t radius_index = spheres[from].radius_index;
    assert(range_count < room.ranges_.size() && radius_index < room.radii_.size());
    std::size_t end = from + 1;
    while (end < count && spheres[end].radius_index == radius_index) ++end;
    const Target target{room.x_.data() + to, room.y_.data() + to, room.z_.data() + to};
    place({spheres + from, end - from}, world_from_set, target);
    room.ranges_[range_count++] = {radius_index, room.radii_[radius_index],
                                   static_cast<std::uint32_t>(to),
                                   static_cast<std::uint32_t>(end - from)};
    to += paddedToLanes(end - from);
    from = end;
  }
  return {room.x_.data(), room.y_.data(), room.z_.data(),
          std::span(room.ranges_).first(range_count)};
}

}  // namespace galactic::simulation
