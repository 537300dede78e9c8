#pragma once
#include <cstddef>
#include <cstdint>

// Included by sources compiled for wider instruction sets: has only plain data and uses nothing of
// the standard library, so that no inline function compiled there can end up in the rest of the
// program.

namespace galactic::bake::sphere_set {

/// Points, one array per coordinate, and their weights.
struct WeightedPoints {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  const std::int32_t* weight = nullptr;
  std::size_t count = 0;
};

/// The ball in which a sphere covers points.
struct Ball {
  float x = 0;
  float y = 0;
  float z = 0;
  float squared_reach = 0;
};

/// The sum of the weights of the points in `ball`. All versions give the same number: each point is
/// tested alone, and the order of an integer sum does not matter.
using BallWeight = std::int32_t (*)(const WeightedPoints& points, const Ball& ball);

[[nodiscard]] std::int32_t ballWeightPortable(const WeightedPoints& points, const Ball& ball);
[[nodiscard]] std::int32_t ballWeightAvx2(const WeightedPoints& points, const Ball& ball);

/// The fastest version for this machine.
[[nodiscard]] BallWeight fastestBallWeight();

}  // namespace galactic::bake::sphere_set
