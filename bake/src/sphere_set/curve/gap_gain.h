#pragma once
#include <cstddef>

// Included by sources compiled for wider instruction sets: plain data only, as ball_weight.h.

namespace galactic::bake::sphere_set {

inline constexpr std::size_t kGainLanes = 8;

/// A ball around kGainLanes points, and how near a sphere has to come to lessen what any of them
/// costs.
struct PointBlock {
  float x = 0;
  float y = 0;
  float z = 0;
  /// From the ball's center to the surface of the sphere, meters.
  float reach = 0;
};

/// Points side by side whose nearest sphere is the same one, and what the gap of each costs with
/// that sphere and with the next nearest. The count is a multiple of kGainLanes: points whose
/// costs are 0 fill it up. Fast where neighbors in space are neighbors in the list.
struct CostedPoints {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  const float* nearest = nullptr;
  const float* next = nullptr;
  /// Of each kGainLanes points.
  const PointBlock* blocks = nullptr;
  std::size_t count = 0;
};

/// What a gap costs: linear * gap + gap^2 + fourth * gap^4.
struct GapCost {
  float linear = 0;
  float fourth = 0;
};

struct Sphere {
  float x = 0;
  float y = 0;
  float z = 0;
  float radius = 0;
};

/// How far the costs of some points fall with one more sphere.
struct GapGain {
  /// While their nearest sphere stays, and once it is gone.
  float staying = 0;
  float gone = 0;
};

/// All versions give the same numbers: sums are kept in lanes of a fixed number.
using GapGainOf = GapGain (*)(const CostedPoints& points, const GapCost& cost,
                              const Sphere& sphere);

[[nodiscard]] GapGain gapGainPortable(const CostedPoints& points, const GapCost& cost,
                                      const Sphere& sphere);
[[nodiscard]] GapGain gapGainAvx2(const CostedPoints& points, const GapCost& cost,
                                  const Sphere& sphere);

/// The fastest that this machine runs.
[[nodiscard]] GapGainOf fastestGapGain();

}  // namespace galactic::bake::sphere_set
