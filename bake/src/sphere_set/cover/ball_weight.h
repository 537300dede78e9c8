#pragma once
#include <cstddef>
#include <cstdint>

// Included by sources compiled for wider instruction sets: plain data only, nothing of the standard
// library, so that no inline function compiled there can end up in the rest of the program.

namespace galactic::bake::sphere_set {

/// Points side by side, and what each weighs.
struct WeightedPoints {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  const std::int32_t* weight = nullptr;
  std::size_t count = 0;
};

/// The points that a sphere covers are in this ball.
struct Ball {
  float x = 0;
  float y = 0;
  float z = 0;
  float squared_reach = 0;
};

/// The weight of the points in `ball`. All versions give the same number: each point is judged
/// alone, and whole numbers add up the same in any order.
using BallWeight = std::int32_t (*)(const WeightedPoints& points, const Ball& ball);

[[nodiscard]] std::int32_t ballWeightPortable(const WeightedPoints& points, const Ball& ball);
[[nodiscard]] std::int32_t ballWeightAvx2(const WeightedPoints& points, const Ball& ball);

/// The fastest that this machine runs.
[[nodiscard]] BallWeight fastestBallWeight();

}  // namespace galactic::bake::sphere_set
