#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "galactic/object_set.h"
#include "galactic/pose.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Space for the spheres of one held object in the world; after construction nothing allocates.
class HeldSpheres {
 public:
  /// `most_spheres`: of any object. `radii`: of the working set, meters.
  HeldSpheres(std::size_t most_spheres, std::span<const float> radii);

 private:
  friend SphereBatch holdSpheres(const ObjectModel& object, const Pose& world_from_object,
                                 HeldSpheres& room) noexcept;

  std::vector<float> radii_;
  std::vector<float> x_, y_, z_;
  /// One per radius; only the first ones are in use.
  std::vector<RadiusRange> ranges_;
};

/// Places the spheres of `object` at `world_from_object` (rotation of unit length) in `room`, where
/// they stay until the next call. No other code places a held object's spheres. Each radius becomes
/// one range, in the order of the object's spheres, which must keep spheres of the same radius
/// together.
[[nodiscard]] SphereBatch holdSpheres(const ObjectModel& object, const Pose& world_from_object,
                                      HeldSpheres& room) noexcept;

}  // namespace galactic::simulation
