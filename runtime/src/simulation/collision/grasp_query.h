#pragma once
#include <cstdint>

#include "galactic/object_set.h"
#include "galactic/pose.h"
#include "galactic/simulation_options.h"
#include "simulation/collision/resting_objects.h"
#include "support/optional_index.h"

namespace galactic::simulation {

/// How far a point (world frame) lies beyond the outermost plane of the object's convex hull,
/// meters: 0 if it is behind all planes, or the object has none. Never more than the distance to
/// the hull.
[[nodiscard]] float distanceToHullPlanes(const ObjectModel& object, const Pose& world_from_object,
                                         const Vec3& point) noexcept;

/// Squared distance from a point (world frame) to the grasp shape of an object that rests as `box`,
/// square meters: to its box or, with GraspShape::kHull, the larger of the distances to its box and
/// to its hull's planes.
[[nodiscard]] float squaredGraspDistance(const ObjectModel& object, const RestingBox& box,
                                         const Pose& world_from_object, const Vec3& point,
                                         GraspShape shape) noexcept;

/// The sphere with which a hand grasps, in the world frame; meters.
struct GraspSphere {
  Vec3 center;
  float radius = 0;
};

/// The resting object nearest to the center of `sphere` (whose radius is at most the objects'
/// largest) among those that it touches; the lower index if equally near. `model(index)` and
/// `pose(index)` return those of an object.
template <class Model, class ObjectPose>
[[nodiscard]] OptionalIndex nearestToGrasp(const RestingObjects& resting, const GraspSphere& sphere,
                                           GraspShape shape, const Model& model,
                                           const ObjectPose& pose) {
  const Vec3& center = sphere.center;
  if (shape == GraspShape::kBox) return resting.nearest(center, sphere.radius);
  OptionalIndex best;
  float least = sphere.radius * sphere.radius;
  resting.forEachInColumnOf(center, [&](std::uint32_t index) {
    const RestingBox& box = resting.box(index);
    // Only boxes that are near enough need a look at the planes.
    if (!(squaredDistance(box, center) < least)) return;
    const float squared = squaredGraspDistance(model(index), box, pose(index), center, shape);
    if (!(squared < least)) return;
    least = squared;
    best = index;
  });
  return best;
}

}  // namespace galactic::simulation
