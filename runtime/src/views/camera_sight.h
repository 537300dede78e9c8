#pragma once
#include "galactic/pose.h"
#include "galactic/scene.h"

namespace galactic {

/// A camera that looks at something, and what it looks at.
struct SightLine {
  RigidTransform world_from_camera;
  /// On the camera's axis.
  Vec3 target;
};

/// Where a camera at `wanted`, which follows a robot whose base is at `base`, sees it: nothing of
/// the scene stands between, as one of the scene's column grids can tell. Where something does, the
/// camera goes round the target, rises and comes nearer, whichever changes the picture least. It
/// still looks at where its axis passes the base, or lower, where that is inside of something.
/// Stays as it is where the grid has no free place above the base, and where `wanted` looks away
/// from the vertical line through the base: whoever turned it that far asked for something else
/// than the robot. Neither allocates nor throws; thread-safe.
[[nodiscard]] SightLine inSight(const Scene& scene, const Vec3& base,
                                const RigidTransform& wanted) noexcept;

}  // namespace galactic
