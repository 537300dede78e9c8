#pragma once
#include <vector>

#include "sphere_set/solid/exterior_solid.h"
#include "sphere_set/solid/point_grid.h"

namespace galactic::bake::sphere_set {

/// Selects points of a lattice.
struct LatticeBand {
  /// Meters between neighbors along each axis.
  double spacing = 0;
  /// Only points whose signed distance to the surface is from `lowest` to `highest`.
  double lowest = 0;
  double highest = 0;
  /// Only points within `reach` of one of these; null: anywhere.
  const PointGrid* wanted = nullptr;
  double reach = 0;
};

/// A lattice point, rounded as it would be stored, and its distance to the surface.
struct LatticePoint {
  Vec3d position;
  SurfaceDistance surface;
};

/// The points in the band of a lattice through the middle of the solid. Whole cubes of lattice
/// points are skipped if the distance at their center, which is 1-Lipschitz, rules them out.
[[nodiscard]] std::vector<LatticePoint> latticeInBand(const ExteriorSolid& solid,
                                                      const LatticeBand& band, unsigned threads);

}  // namespace galactic::bake::sphere_set
