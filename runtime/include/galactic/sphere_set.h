#pragma once
#include <cstdint>

#include "galactic/vec3.h"

namespace galactic {

/// A sphere of an object or link, in its frame. The memory layout is that of a pack.
struct SetSphere {
  /// Meters.
  Vec3 center;
  /// Index into the working set of radii.
  std::uint32_t radius_index = 0;

  friend bool operator==(const SetSphere&, const SetSphere&) = default;
};

}  // namespace galactic
