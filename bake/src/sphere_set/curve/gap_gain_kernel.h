#pragma once
#include "sphere_set/curve/gap_gain.h"

namespace galactic::bake::sphere_set {
namespace {

inline bool isOutOfReach(const PointBlock& block, const Sphere& sphere) {
  const float dx = block.x - sphere.x;
  const float dy = block.y - sphere.y;
  const float dz = block.z - sphere.z;
  const float reach = block.reach + sphere.radius;
  return dx * dx + dy * dy + dz * dz > reach * reach;
}

/// A loop that compilers vectorize for the instruction set of the including file.
inline GapGain gainOf(const CostedPoints& points, const GapCost& cost, const Sphere& sphere) {
  float staying[kGainLanes] = {};
  float gone[kGainLanes] = {};
  for (std::size_t first = 0; first < points.count; first += kGainLanes) {
    if (isOutOfReach(points.blocks[first / kGainLanes], sphere)) continue;
    for (std::size_t lane = 0; lane < kGainLanes; ++lane) {
      const std::size_t at = first + lane;
      const float dx = points.x[at] - sphere.x;
      const float dy = points.y[at] - sphere.y;
      const float dz = points.z[at] - sphere.z;
      const float distance = __builtin_sqrtf(dx * dx + dy * dy + dz * dz) - sphere.radius;
      const float gap = distance > 0 ? distance : 0;
      const float squared = gap * gap;
      const float now = cost.linear * gap + squared * (1 + cost.fourth * squared);
      const float falls = points.nearest[at] - now;
      const float falls_gone = points.next[at] - now;
      staying[lane] += falls > 0 ? falls : 0;
      gone[lane] += falls_gone > 0 ? falls_gone : 0;
    }
  }
  GapGain gain;
  for (std::size_t lane = 0; lane < kGainLanes; ++lane) {
    gain.staying += staying[lane];
    gain.gone += gone[lane];
  }
  return gain;
}

}  // namespace
}  // namespace galactic::bake::sphere_set
