#pragma once
#include <cstdint>

#include "galactic/batch_simulator.h"
#include "simulation/state/model.h"
#include "support/drawn_in.h"

namespace galactic::simulation {

// Salts of the random numbers that episodes draw for options that are ranges.
inline constexpr std::uint64_t kMotionDraw = 0x4D6F74696F6E4431ULL;
inline constexpr std::uint64_t kBiasDraw = 0x426961732D2D4431ULL;
inline constexpr std::uint64_t kLocalizationDraw = 0x506C6163652D4431ULL;
inline constexpr std::uint64_t kDelayDraw = 0x44656C61792D4431ULL;
inline constexpr std::uint64_t kLaserDraw = 0x4C617365722D4431ULL;

/// The noise drawn for the episode of a moment.
[[nodiscard]] inline EpisodeNoise episodeNoiseIn(const Model& model, const EnvMoment& moment) {
  const RobotNoise& noise = model.options.noise;
  return {.motion = drawnIn(moment, noise.motion, kMotionDraw),
          .motion_bias = drawnIn(moment, noise.motion_bias, kBiasDraw),
          .localization = drawnIn(moment, noise.localization, kLocalizationDraw),
          .action_delay = drawnIn(moment, noise.action_delay, kDelayDraw),
          .laser = drawnIn(moment, model.laser.noise(), kLaserDraw)};
}

}  // namespace galactic::simulation
