#pragma once
#include "sphere_set/cover/ball_weight.h"

namespace galactic::bake::sphere_set {
namespace {

/// A loop that compilers vectorize for the instruction set of the including file.
inline std::int32_t weightIn(const WeightedPoints& points, const Ball& ball) {
  const float* const x = points.x;
  const float* const y = points.y;
  const float* const z = points.z;
  const std::int32_t* const weight = points.weight;
  const std::size_t count = points.count;
  std::int32_t sum = 0;
  for (std::size_t at = 0; at < count; ++at) {
    const float dx = x[at] - ball.x;
    const float dy = y[at] - ball.y;
    const float dz = z[at] - ball.z;
    const float squared = dx * dx + dy * dy + dz * dz;
    sum += squared <= ball.squared_reach ? weight[at] : 0;
  }
  return sum;
}

}  // namespace
}  // namespace galactic::bake::sphere_set
