#include "episodes/home/placed_object.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace galactic::bake {
namespace {

/// Half the extent of a footprint along a horizontal direction of length 1.
float halfExtent(const Footprint& footprint, float x, float z) {
  const float along = std::abs(footprint.along_x * x + footprint.along_z * z);
  const float across = std::abs(footprint.along_x * z - footprint.along_z * x);
  return footprint.half_length * along + footprint.half_width * across;
}

float gapAlong(const Footprint& a, const Footprint& b, float x, float z) {
  const float between = std::abs((b.x - a.x) * x + (b.z - a.z) * z);
  return between - halfExtent(a, x, z) - halfExtent(b, x, z);
}

}  // namespace

StandingSize standingSize(const ObjectModel& model, const StablePose& pose) {
  constexpr float kFar = std::numeric_limits<float>::max();
  StandingSize size{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  const Vec3& half = model.box.half_extents;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3 in_box{(corner & 1U) != 0 ? half.x : -half.x, (corner & 2U) != 0 ? half.y : -half.y,
                      (corner & 4U) != 0 ? half.z : -half.z};
    const Vec3 p = rotate(pose.rotation, model.box.pose * in_box);
    size.min = {std::min(size.min.x, p.x), std::min(size.min.y, p.y), std::min(size.min.z, p.z)};
    size.max = {std::max(size.max.x, p.x), std::max(size.max.y, p.y), std::max(size.max.z, p.z)};
  }
  size.min.y += pose.height;
  size.max.y += pose.height;
  return size;
}

PlacedObject placeObject(const ObjectModel& model, std::uint32_t object, const StablePose& stable,
                         const Spot& spot) {
  const StandingSize size = standingSize(model, stable);
  const Quat yaw = rotationOfYaw(spot.yaw);
  const Vec3 along = rotate(yaw, {1, 0, 0});
  const Vec3 center =
      rotate(yaw, {(size.min.x + size.max.x) / 2, 0, (size.min.z + size.max.z) / 2});
  return {.model = &model,
          .object = object,
          .pose = {{spot.x, spot.surface + stable.height, spot.z}, yaw * stable.rotation},
          .footprint = {.x = spot.x + center.x,
                        .z = spot.z + center.z,
                        .half_length = (size.max.x - size.min.x) / 2,
                        .half_width = (size.max.z - size.min.z) / 2,
                        .along_x = along.x,
                        .along_z = along.z,
                        .heights = {spot.surface + size.min.y, spot.surface + size.max.y}}};
}

float gapBetween(const Footprint& a, const Footprint& b) {
  // Gaps along each side of both rectangles, and of the heights; none exceeds the distance.
  const std::array<float, 5> gaps{
      gapAlong(a, b, a.along_x, a.along_z), gapAlong(a, b, -a.along_z, a.along_x),
      gapAlong(a, b, b.along_x, b.along_z), gapAlong(a, b, -b.along_z, b.along_x),
      std::max(a.heights.lo - b.heights.hi, b.heights.lo - a.heights.hi)};
  return *std::max_element(gaps.begin(), gaps.end());
}

float distanceToBox(const PlacedObject& object, const Vec3& point) {
  const Pose world_from_box = object.pose * object.model->box.pose;
  const Vec3 p = inverse(world_from_box) * point;
  const Vec3& half = object.model->box.half_extents;
  const Vec3 outside{std::max(std::abs(p.x) - half.x, 0.0F), std::max(std::abs(p.y) - half.y, 0.0F),
                     std::max(std::abs(p.z) - half.z, 0.0F)};
  return std::sqrt(dot(outside, outside));
}

bool touches(const PlacedObject& object, std::span<const BodySphere> spheres) {
  return std::any_of(spheres.begin(), spheres.end(), [&](const BodySphere& sphere) {
    return distanceToBox(object, sphere.center) < sphere.radius;
  });
}

}  // namespace galactic::bake
