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

/// Moves a camera at `wanted`, which follows a robot whose base is at `base`, to where it sees the
/// robot: nothing of the scene stands between them, according to one of the scene's column grids.
/// If something does, the camera goes around the target, rises or comes nearer, whichever changes
/// the picture least. Its target is the point where its axis passes the base, or a lower point if
/// that one is inside something. The camera stays at `wanted` if the grid has no free place above
/// the base, or if `wanted` looks away from the vertical line through the base: a user who turned
/// it that far does not want to see the robot. Neither allocates nor throws; thread-safe.
[[nodiscard]] SightLine inSight(const Scene& scene, const Vec3& base,
                                const RigidTransform& wanted) noexcept;

}  // namespace galactic
