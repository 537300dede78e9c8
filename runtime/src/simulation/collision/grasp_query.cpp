#include "simulation/collision/grasp_query.h"

#include <algorithm>

namespace galactic::simulation {

float distanceToHullPlanes(const ObjectModel& object, const Pose& world_from_object,
                           const Vec3& point) noexcept {
  if (object.hull_planes.empty()) return 0;
  const Vec3 in_object = inverse(world_from_object) * point;
  float farthest = 0;
  for (const HullPlane& plane : object.hull_planes) {
    farthest = std::max(farthest, dot(plane.normal, in_object) - plane.offset);
  }
  return farthest;
}

float squaredGraspDistance(const ObjectModel& object, const RestingBox& box,
                           const Pose& world_from_object, const Vec3& point,
                           GraspShape shape) noexcept {
  const float to_box = squaredDistance(box, point);
  if (shape == GraspShape::kBox) return to_box;
  const float to_planes = distanceToHullPlanes(object, world_from_object, point);
  return std::max(to_box, to_planes * to_planes);
}

}  // namespace galactic::simulation
