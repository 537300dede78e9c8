#pragma once
#include <cstdint>

#include "galactic/drawn_number.h"
#include "galactic/sensor_noise.h"
#include "support/random_stream.h"

namespace galactic {

/// What the episode of a moment has drawn of a number. It follows from the moment alone, so nothing
/// has to keep it. `salt`: of the number, apart from those of all other random numbers.
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
