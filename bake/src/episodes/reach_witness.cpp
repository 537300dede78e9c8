#include "episodes/reach_witness.h"

#include <cmath>
#include <numbers>

namespace galactic::bake {
namespace {

constexpr std::size_t kTries = 400;
/// Half the range of heights from which arm samples are taken for one aim, meters.
constexpr float kHeightRange = 0.015F;
/// Floors may differ from the given height by this much, meters: there are rugs and thresholds.
constexpr float kFloorRange = 0.05F;

float between(float low, float high, Random& random) {
  return low + static_cast<float>(random.unit()) * (high - low);
}

/// Draws a point for the grasp point to aim at: above or beside the box, seldom far inside.
Vec3 drawAim(const Footprint& box, float margin, Random& random) {
  const float length = between(-box.half_length - margin, box.half_length + margin, random);
  const float width = between(-box.half_width - margin, box.half_width + margin, random);
  const float middle = (box.heights.lo + box.heights.hi) / 2;
  return {box.x + box.along_x * length - box.along_z * width,
          between(middle, box.heights.hi + margin, random),
          box.z + box.along_z * length + box.along_x * width};
}

/// The place under the base that is on the right floor and that the robot can leave in this
/// heading.
const FloorPlace* standingPlace(const FloorMap& map, const Vec3& ground, float yaw,
                                std::uint32_t part) {
  const std::uint32_t heading = nearestHeading(yaw);
  for (const FloorPlace& place : map.placesAt(ground.x, ground.z)) {
    if (place.part != part || std::abs(place.height - ground.y) > kFloorRange) continue;
    if (((place.headings >> heading) & 1U) != 0) return &place;
  }
  return nullptr;
}

}  // namespace

std::optional<std::vector<BodySphere>> findReach(const DraftHome& home, const PlacedObject& object,
                                                 const SupportPlace& from, Random& random) {
  const float grasp = kGraspShare * home.robot.endEffector()->grasp_radius;
  for (std::size_t n = 0; n < kTries; ++n) {
    const Vec3 aim = drawAim(object.footprint, grasp, random);
    const float yaw = between(0, 2 * std::numbers::pi_v<float>, random);
    const float height = aim.y - from.floor;
    const auto samples = home.reach.between(height - kHeightRange, height + kHeightRange);
    if (samples.empty() || distanceToBox(object, aim) >= grasp) continue;
    const ArmSample& sample = samples[random.below(static_cast<std::uint32_t>(samples.size()))];
    const Vec3 offset = rotate(rotationOfYaw(yaw), sample.grasp_point);
    Vec3 ground{aim.x - offset.x, from.floor, aim.z - offset.z};
    const FloorPlace* place = standingPlace(home.floor, ground, yaw, from.part);
    if (place == nullptr) continue;
    const auto base_height = home.floor.heightAt(ground.x, ground.z, place->height);
    if (!base_height) continue;
    ground.y = *base_height;
    RobotBody body = robotBody(home.robot, groundPose(ground, yaw), home.reach.positions(sample));
    if (distanceToBox(object, body.grasp_point) >= grasp) continue;
    if (!touches(object, body.spheres) && isFree(home.scene, body.spheres)) return body.spheres;
  }
  return std::nullopt;
}

}  // namespace galactic::bake
