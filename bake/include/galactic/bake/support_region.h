#pragma once
#include <string>

#include "galactic/pose.h"

namespace galactic::bake {

/// A place for objects that a dataset names: a box over a surface, as Habitat's receptacles
/// (user_defined.receptacle_aabb_*), placed in the world.
struct SupportRegion {
  std::string name;
  Pose world_from_region;
  /// Meters, along the region's axes.
  Vec3 half_extents;
};

}  // namespace galactic::bake
