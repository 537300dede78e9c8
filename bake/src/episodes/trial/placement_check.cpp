#include "episodes/trial/placement_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "episodes/home/columns_view.h"
#include "galactic/simulation_options.h"

namespace galactic::bake {
namespace {

constexpr float kMostLift = PlacementOptions{}.most_lift;
/// As in the run: rounding does not ask for the same lift again, meters.
constexpr float kNudge = 1e-4F;
constexpr int kMostLifts = 16;

/// How far up a center has to go to be free; none when there is no free height above it.
std::optional<float> liftOutOf(const ColumnGrid& grid, const Vec3& center) {
  if (grid.clearance(center) == Clearance::kFree) return 0.0F;
  const std::optional<ColumnIndex> column = grid.columnAt(center.x, center.z);
  if (!column) return std::nullopt;
  for (const Span& span : ColumnSpans(grid, column->i, column->k)) {
    // A column may call a height free that the query, which counts in quanta, does not.
    if (span.hi > center.y) return std::max(span.lo - center.y, kNudge);
  }
  return std::nullopt;
}

/// The lowest lift with which all spheres are free.
std::optional<float> liftOutOfScene(const Scene& scene, const ObjectModel& model,
                                    const Pose& world_from_object) {
  float lift = 0;
  for (int n = 0; n < kMostLifts; ++n) {
    float more = 0;
    for (const SetSphere& sphere : model.spheres) {
      Vec3 center = world_from_object * sphere.center;
      center.y += lift;
      const auto needed = liftOutOf(scene.grids()[sphere.radius_index], center);
      if (!needed) return std::nullopt;
      more = std::max(more, *needed);
    }
    if (more == 0) return lift;
    lift += more + kNudge;
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
    fall = std::min(fall, scene.grids()[sphere.radius_index].contact(center).down);
  }
  return std::abs(*lift - fall) <= kMostLift;
}

}  // namespace galactic::bake
