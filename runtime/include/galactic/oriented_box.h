#pragma once
#include "galactic/pose.h"
#include "galactic/vec3.h"

namespace galactic {

/// A box in the frame of its object.
struct OrientedBox {
  /// object_from_box: center and rotation.
  Pose pose;
  /// Meters, > 0.
  Vec3 half_extents;

  friend bool operator==(const OrientedBox&, const OrientedBox&) = default;
};

}  // namespace galactic
