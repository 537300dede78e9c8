#pragma once
#include <cstddef>

// Included by sources compiled for wider instruction sets: has only plain data, like ball_weight.h.

namespace galactic::bake::sphere_set {

inline constexpr std::size_t kGainLanes = 8;

/// A ball around kGainLanes points, and how near a sphere must be to reduce the cost of any of
/// them.
struct PointBlock {
  float x = 0;
  float y = 0;
  float z = 0;
  /// Greatest such distance from the ball's center to the surface of the sphere, meters.
  float reach = 0;
};

/// Points, one array per coordinate, that have the same nearest sphere, and the cost of each one's
/// gap to that sphere and to the next nearest. The count is padded to a multiple of kGainLanes with
/// points whose costs are 0. Fast if neighbors in space are neighbors in the list.
struct CostedPoints {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  const float* nearest = nullptr;
  const float* next = nullptr;
  /// One for every kGainLanes points.
  const PointBlock* blocks = nullptr;
  std::size_t count = 0;
};

/// The cost of a gap: linear * gap + gap^2 + fourth * gap^4.
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

/// The amount by which one more sphere reduces the costs of points.
struct GapGain {
  /// If their nearest sphere stays, and if it is removed.
  float staying = 0;
  float gone = 0;
};

/// All versions give the same numbers, because they sum in the same fixed number of lanes.
using GapGainOf = GapGain (*)(const CostedPoints& points, const GapCost& cost,
                              const Sphere& sphere);

[[nodiscard]] GapGain gapGainPortable(const CostedPoints& points, const GapCost& cost,
                                      const Sphere& sphere);
[[nodiscard]] GapGain gapGainAvx2(const CostedPoints& points, const GapCost& cost,
                                  const Sphere& sphere);

/// The fastest version for this machine.
[[nodiscard]] GapGainOf fastestGapGain();

}  // namespace galactic::bake::sphere_set
