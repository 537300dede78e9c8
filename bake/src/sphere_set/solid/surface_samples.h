#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/solid/exterior_solid.h"

namespace galactic::bake::sphere_set {

/// Options for spreading points over a surface.
struct SampleOptions {
  /// Least distance between two points, meters.
  double spacing = 0;
  std::uint64_t seed = 0;
  /// Number of points tried per square of the spacing. More tries leave fewer bare places.
  double tries = 10;
};

/// Points spread evenly over the reachable surface on the near side of `support`: uniform points,
/// stratified by area, each kept if no earlier one is nearer than the spacing (Poisson disk
/// sampling by dart throwing). Deterministic for the same options.
[[nodiscard]] std::vector<Vec3d> sampleSurface(const ExteriorSolid& solid,
                                               const std::optional<HalfSpace>& support,
                                               const SampleOptions& options);

/// The points that are at least `spacing` away from all points kept before them.
[[nodiscard]] std::vector<Vec3d> thinnedOut(const std::vector<Vec3d>& points, double spacing);

/// Distance of `p` to the plane of `support`, negative beyond it; infinite without one.
[[nodiscard]] double heightAbove(const std::optional<HalfSpace>& support, const Vec3d& p);

}  // namespace galactic::bake::sphere_set
