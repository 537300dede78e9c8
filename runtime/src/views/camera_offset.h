#pragma once
#include <array>
#include <cstdint>

#include "galactic/pose.h"
#include "galactic/sensor_noise.h"

namespace galactic {

/// Where a camera is in the frame that it would have otherwise: meters ahead, to the left and up,
/// then turned by roll, pitch (down is positive) and yaw.
[[nodiscard]] Pose cameraOffset(const std::array<float, 3>& position,
                                const std::array<float, 3>& rpy_degrees) noexcept;

/// The offset of the camera with this CameraMount::number in the episode of `moment`, each part of
/// it as likely as any other within the jitter's limits.
[[nodiscard]] Pose drawOffset(const CameraJitter& jitter, std::uint64_t camera,
                              const EnvMoment& moment) noexcept;

/// The same of its vertical field of view: radians, more or less than it should be.
[[nodiscard]] float drawFovOffset(const CameraJitter& jitter, std::uint64_t camera,
                                  const EnvMoment& moment) noexcept;

}  // namespace galactic
