#include "sphere_set/curve/gap_gain_kernel.h"

namespace galactic::bake::sphere_set {

GapGain gapGainAvx2(const CostedPoints& points, const GapCost& cost, const Sphere& sphere) {
  return gainOf(points, cost, sphere);
}

}  // namespace galactic::bake::sphere_set
