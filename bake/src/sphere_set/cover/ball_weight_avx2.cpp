#include "sphere_set/cover/ball_weight_kernel.h"

namespace galactic::bake::sphere_set {

std::int32_t ballWeightAvx2(const WeightedPoints& points, const Ball& ball) {
  return weightIn(points, ball);
}

}  // namespace galactic::bake::sphere_set
