#include "views/camera_offset.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "support/drawn_in.h"
#include "support/random_stream.h"

namespace galactic {

Pose cameraOffset(const std::array<float, 3>& position,
                  const std::array<float, 3>& rpy_degrees) noexcept {
  const auto half = [&](std::size_t n) {
    return rpy_degrees[n] * (std::numbers::pi_v<float> / 180) / 2;
  };
  const Quat roll{.x = std::sin(half(0)), .y = 0, .z = 0, .w = std::cos(half(0))};
  const Quat pitch{.x = 0, .y = 0, .z = -std::sin(half(1)), .w = std::cos(half(1))};
  const Quat yaw{.x = 0, .y = std::sin(half(2)), .z = 0, .w = std::cos(half(2))};
  const auto& [ahead, left, up] = position;
  return {{ahead, up, -left}, yaw * pitch * roll};
}

Pose drawOffset(const CameraJitter& jitter, std::uint64_t camera,
                const EnvMoment& moment) noexcept {
  // Keep these draws independent of each other and of those of other sensors.
  constexpr std::uint64_t kJitterSalt = 0x4A69747465722D31ULL;
  constexpr std::uint64_t kPlaceDraw = 0x4A69747465724431ULL;
  constexpr std::uint64_t kTurnDraw = 0x4A69747465724432ULL;
  RandomStream random(moment.seed ^ kJitterSalt ^ camera, moment.env, moment.episode, 0);
  const auto draw = [&](float most) {
    std::array<float, 3> three;
    for (float& one : three) one = most * (2 * random.unit() - 1);
    return three;
  };
  const std::array<float, 3> position =
      draw(drawnIn(moment, jitter.camera_jitter, kPlaceDraw ^ camera));
  return cameraOffset(position,
                      draw(drawnIn(moment, jitter.camera_jitter_degrees, kTurnDraw ^ camera)));
}

float drawFovOffset(const CameraJitter& jitter, std::uint64_t camera,
                    const EnvMoment& moment) noexcept {
  constexpr std::uint64_t kFovSalt = 0x4A69747465722D32ULL;
  constexpr std::uint64_t kFovDraw = 0x4A69747465724433ULL;
  const float most = drawnIn(moment, jitter.camera_jitter_fov, kFovDraw ^ camera);
  RandomStream random(moment.seed ^ kFovSalt ^ camera, moment.env, moment.episode, 0);
  return most * (2 * random.unit() - 1) * (std::numbers::pi_v<float> / 180);
}

}  // namespace galactic
