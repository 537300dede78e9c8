#pragma once
#include "galactic/pose.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// Origin of the grip in the world, meters.
[[nodiscard]] inline Vec3 gripOrigin(const GripFrame& grip) {
  return {grip[9], grip[10], grip[11]};
}

/// Cosine and sine of the base's yaw.
[[nodiscard]] inline float headingCosine(const GripFrame& grip) { return grip[12]; }
[[nodiscard]] inline float headingSine(const GripFrame& grip) { return grip[13]; }

/// Transforms a point from the grip's frame to the world.
[[nodiscard]] inline Vec3 gripToWorld(const GripFrame& grip, const Vec3& point) {
  return {grip[0] * point.x + grip[3] * point.y + grip[6] * point.z + grip[9],
          grip[1] * point.x + grip[4] * point.y + grip[7] * point.z + grip[10],
          grip[2] * point.x + grip[5] * point.y + grip[8] * point.z + grip[11]};
}

/// The frame as a pose: world_from_grip.
[[nodiscard]] Pose gripPose(const GripFrame& grip);

}  // namespace galactic::simulation
