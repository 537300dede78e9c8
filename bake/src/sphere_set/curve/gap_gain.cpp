#include "sphere_set/curve/gap_gain.h"

#include "sphere_set/curve/gap_gain_kernel.h"

namespace galactic::bake::sphere_set {

GapGain gapGainPortable(const CostedPoints& points, const GapCost& cost, const Sphere& sphere) {
  return gainOf(points, cost, sphere);
}

GapGainOf fastestGapGain() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return gapGainAvx2;
#endif
  return gapGainPortable;
}

}  // namespace galactic::bake::sphere_set
