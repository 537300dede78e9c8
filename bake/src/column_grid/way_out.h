#pragma once
#include <optional>
#include <span>

#include "galactic/bake/columns.h"

namespace galactic::bake {

/// Where a room that is one with the outside is narrowest on the way there.
struct WayOut {
  /// World frame: in the middle of the passage.
  Vec3 at;
  /// About how wide or high it is for the centers of spheres, to within two cells; meters.
  float width = 0;
};

/// The narrowest place of the widest way from inside of a room to beyond the bounds of its scene:
/// from `seeds` (world frame) or, without any, from the place with the most room around it that has
/// something above. Of all ways, one whose narrowest place is as wide as possible (Dijkstra's
/// algorithm over bottlenecks). `room`: spans of the room alone. Nothing where no way leads out, or
/// nothing narrows it.
[[nodiscard]] std::optional<WayOut> findWayOut(const Columns& room, std::span<const Vec3> seeds);

}  // namespace galactic::bake
