#pragma once
#include <vector>

#include "sphere_set/solid/exterior_solid.h"
#include "sphere_set/solid/point_grid.h"

namespace galactic::bake::sphere_set {

/// Which points of a lattice are wanted.
struct LatticeBand {
  /// Meters between neighbors along each axis.
  double spacing = 0;
  /// Signed distance to the surface from `lowest` to `highest`.
  double lowest = 0;
  double highest = 0;
  /// Only points within `reach` of one of these; null: anywhere.
  const PointGrid* wanted = nullptr;
  double reach = 0;
};

/// A lattice point, as it would be stored, and where it is in the solid.
struct LatticePoint {
  Vec3d position;
  SurfaceDistance surface;
};

/// The points of the band of a lattice through the middle of the solid. Cubes of lattice points are
/// skipped whole where the distance at their middle, which changes by no more than the way gone,
/// rules them out.
[[nodiscard]] std::vector<LatticePoint> latticeInBand(const ExteriorSolid& solid,
                                                      const LatticeBand& band, unsigned threads);

}  // namespace galactic::bake::sphere_set
