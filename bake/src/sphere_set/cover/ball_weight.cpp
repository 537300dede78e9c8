#include "sphere_set/cover/ball_weight.h"

#include "sphere_set/cover/ball_weight_kernel.h"

namespace galactic::bake::sphere_set {

std::int32_t ballWeightPortable(const WeightedPoints& points, const Ball& ball) {
  return weightIn(points, ball);
}

BallWeight fastestBallWeight() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return ballWeightAvx2;
#endif
  return ballWeightPortable;
}

}  // namespace galactic::bake::sphere_set
