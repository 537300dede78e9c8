#include "episodes/trial/placement_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "galactic/simulation_options.h"
#include "support/lift.h"

namespace galactic::bake {
namespace {

constexpr float kMostLift = PlacementOptions{}.most_lift;

/// The least lift that makes all spheres free.
std::optional<float> liftOutOfScene(const Scene& scene, const ObjectModel& model,
                                    const Pose& world_from_object) {
  float lift = 0;
  for (int n = 0; n < detail::kMostLifts; ++n) {
    float more = 0;
    for (const SetSphere& sphere : model.spheres) {
      Vec3 center = world_from_object * sphere.center;
      center.y += lift;
      const ColumnGrid& grid = scene.grids()[sphere.radius_index];
      if (grid.clearance(center) == Clearance::kFree) continue;
      more = std::max(more, std::max(detail::liftOutOf(grid, center), detail::kLiftNudge));
    }
    if (more == 0) return lift;
    lift += more + detail::kLiftNudge;
    if (!(lift <= kMostLift)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

bool canBeReleased(const Scene& scene, const ObjectModel& model, const Pose& world_from_object) {
  const std::optional<float> lift = liftOutOfScene(scene, model, world_from_object);
  if (!lift) return false;
  float fall = std::numeric_limits<float>::max();
  for (const SetSphere& sphere : model.spheres) {
    Vec3 center = world_from_object * sphere.center;
    center.y += *lift;
    const ColumnGrid& grid = scene.grids()[sphere.radius_index];
    const float down = grid.contact(center).down;
    if (detail::hasFloor(grid, center.y - down)) fall = std::min(fall, down);
  }
  return std::abs(*lift - fall) <= kMostLift;
}

}  // namespace galactic::bake
