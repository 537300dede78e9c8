#pragma once
#include <optional>
#include <span>

#include "galactic/bake/columns.h"

namespace galactic::bake {

/// The narrowest place on the way from a room to the outside that it is connected to.
struct WayOut {
  /// The middle of the passage, world frame.
  Vec3 at;
  /// Approximate width or height of the passage for the centers of spheres, to within two cells;
  /// meters.
  float width = 0;
};

/// The narrowest place of the widest way from inside a room to beyond the bounds of its scene. The
/// way starts at `seeds` (world frame) or, without any, at the place under a roof with the most
/// room around it. Of all ways, this one's narrowest place is as wide as possible (Dijkstra's
/// algorithm over bottlenecks). `room`: only the spans of the room. None if no way leads out or
/// nothing narrows it.
[[nodiscard]] std::optional<WayOut> findWayOut(const Columns& room, std::span<const Vec3> seeds);

}  // namespace galactic::bake
