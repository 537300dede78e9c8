#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "galactic/object_set.h"
#include "galactic/pose.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Room for the spheres of one held object in the world; after construction nothing allocates.
class HeldSpheres {
 public:
  /// `most_spheres` that any object has; `radii` of the working set, meters.
  HeldSpheres(std::size_t most_spheres, std::span<const float> radii);

 private:
  friend SphereBatch holdSpheres(const ObjectModel& object, const Pose& world_from_object,
                                 HeldSpheres& room) noexcept;

  std::vector<float> radii_;
  std::vector<float> x_, y_, z_;
  /// One per radius; the first so many are in use.
  std::vector<RadiusRange> ranges_;
};

/// The spheres of `object` at `world_from_object` (rotation of unit length), in `room`, where they
/// stay until the next call: the one place that loops over a held object's spheres to place them.
/// Each radius is one range, in the order of the object's spheres, so they may come in any order
/// that keeps radii together.
[[nodiscard]] SphereBatch holdSpheres(const ObjectModel& object, const Pose& world_from_object,
                                      HeldSpheres& room) noexcept;

}  // namespace galactic::simulation
