#include "simulation/state/grip_frame.h"

#include <cmath>

namespace galactic::simulation {

Pose gripPose(const GripFrame& grip) {
  // The largest of the four squares is never small, so that the divisions are safe (Shepperd 1978).
  const float xx = grip[0];
  const float yy = grip[4];
  const float zz = grip[8];
  Quat q;
  if (xx + yy + zz > 0) {
    q = {grip[5] - grip[7], grip[6] - grip[2], grip[1] - grip[3], 1 + xx + yy + zz};
  } else if (xx > yy && xx > zz) {
    q = {1 + xx - yy - zz, grip[1] + grip[3], grip[6] + grip[2], grip[5] - grip[7]};
  } else if (yy > zz) {
    q = {grip[1] + grip[3], 1 + yy - xx - zz, grip[5] + grip[7], grip[6] - grip[2]};
  } else {
    q = {grip[6] + grip[2], grip[5] + grip[7], 1 + zz - xx - yy, grip[1] - grip[3]};
  }
  const float factor = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {gripOrigin(grip), {q.x * factor, q.y * factor, q.z * factor, q.w * factor}};
}

}  // namespace galactic::simulation
