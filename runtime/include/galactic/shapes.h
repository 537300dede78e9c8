#pragma once
#include <cstdint>

#include "galactic/pose.h"

namespace galactic {

/// A box in the frame of its object.
struct OrientedBox {
  /// object_from_box: center and rotation.
  Pose pose;
  /// Meters, > 0.
  Vec3 half_extents;

  friend bool operator==(const OrientedBox&, const OrientedBox&) = default;
};

/// A sphere of an object or link, in its frame. The memory layout is that of a pack.
struct SetSphere {
  /// Meters.
  Vec3 center;
  /// Index into the working set of radii.
  std::uint32_t radius_index = 0;

  friend bool operator==(const SetSphere&, const SetSphere&) = default;
};

/// A plane with all of an object on one side: dot(normal, p) <= offset for each of its points. The
/// memory layout is that of a pack.
struct HullPlane {
  /// Unit length, pointing out of the object, in the object's frame.
  Vec3 normal;
  /// Meters from the frame's origin, along the normal.
  float offset = 0;

  friend bool operator==(const HullPlane&, const HullPlane&) = default;
};

/// A pose in which an object rests on a horizontal plane. The memory layout is that of a pack.
struct StablePose {
  /// plane_from_object: turns the object so that its support face lies down (-Y).
  Quat rotation;
  /// Height of the object's origin above the plane, meters.
  float height = 0;
  /// Fraction of random drops that end in this pose, 0 to 1. The fractions of all poses of an
  /// object add up to 1; if only some of the poses are kept, theirs add up to less.
  float likelihood = 0;

  friend bool operator==(const StablePose&, const StablePose&) = default;
};

}  // namespace galactic
