#pragma once
#include <array>
#include <cstdint>

#include "galactic/pose.h"
#include "galactic/sensor_noise.h"

namespace galactic {

/// The pose of a camera in the frame that it would have without this offset: moved by meters ahead,
/// to the left and up, then turned by roll, pitch (down is positive) and yaw.
[[nodiscard]] Pose cameraOffset(const std::array<float, 3>& position,
                                const std::array<float, 3>& rpy_degrees) noexcept;

/// The random offset of the camera with this CameraMount::number in the episode of `moment`. Each
/// coordinate and angle is distributed uniformly within the jitter's limit for that episode.
[[nodiscard]] Pose drawOffset(const CameraJitter& jitter, std::uint64_t camera,
                              const EnvMoment& moment) noexcept;

/// The random offset of the camera's vertical field of view, radians, above or below 0.
[[nodiscard]] float drawFovOffset(const CameraJitter& jitter, std::uint64_t camera,
                                  const EnvMoment& moment) noexcept;

}  // namespace galactic
