#pragma once
#include <cstdint>

#include "galactic/drawn_number.h"
#include "galactic/sensor_noise.h"
#include "support/random_stream.h"

namespace galactic {

/// The value that is drawn for `number` in the episode of `moment`. It follows from the moment
/// alone, so nothing has to store it. `salt` keeps the number's random stream apart from all
/// others.
[[nodiscard]] inline float drawnIn(const EnvMoment& moment, const DrawnNumber& number,
                                   std::uint64_t salt) {
  if (!number.isRange()) return number.least;
  RandomStream luck(moment.seed ^ salt, moment.env, moment.episode, 0);
  return number.at(luck.unit());
}

[[nodiscard]] inline std::uint32_t drawnIn(const EnvMoment& moment, const DrawnCount& count,
                                           std::uint64_t salt) {
  if (!count.isRange()) return count.least;
  RandomStream luck(moment.seed ^ salt, moment.env, moment.episode, 0);
  return count.at(luck.unit());
}

}  // namespace galactic
