#pragma once
#include "galactic/pose.h"

namespace galactic {

/// A way in which an object rests on a horizontal plane. The memory layout is that of a pack.
struct StablePose {
  /// plane_from_object: turns the object so that its support face lies down (-Y).
  Quat rotation;
  /// Height of the object's origin above the plane, meters.
  float height = 0;
  /// Share of random drops that end in this pose, 0 to 1. All poses of an object add up to 1; where
  /// there are more than are kept, the kept ones do not, and their shares stay as they are.
  float likelihood = 0;

  friend bool operator==(const StablePose&, const StablePose&) = default;
};

}  // namespace galactic
