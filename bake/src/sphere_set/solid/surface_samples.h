#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/solid/exterior_solid.h"

namespace galactic::bake::sphere_set {

/// How to spread points over a surface.
struct SampleOptions {
  /// No two points are nearer to each other, meters.
  double spacing = 0;
  std::uint64_t seed = 0;
  /// Points tried per square of the spacing: the more, the fewer places stay bare.
  double tries = 10;
};

/// Points spread evenly over the reachable surface on the near side of `support`: uniform points,
/// stratified by area, each kept where none of the earlier ones is nearer than the spacing
/// (Poisson disc sampling by dart throwing). The same for the same options.
[[nodiscard]] std::vector<Vec3d> sampleSurface(const ExteriorSolid& solid,
                                               const std::optional<HalfSpace>& support,
                                               const SampleOptions& options);

/// Those of `points` that are no nearer than `spacing` to one kept before.
[[nodiscard]] std::vector<Vec3d> thinnedOut(const std::vector<Vec3d>& points, double spacing);

/// Distance of `p` to the plane of `support`, negative beyond it; infinite without one.
[[nodiscard]] double heightAbove(const std::optional<HalfSpace>& support, const Vec3d& p);

}  // namespace galactic::bake::sphere_set
