#pragma once
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/shapes.h"
#include "robot_description/hand_spheres.h"

namespace galactic::bake {

/// A smaller change of a radius is rounding.
inline constexpr double kRadiusChangeWorthMentioning = 1e-6;

/// Hand-made spheres as spheres of a working set.
struct SnappedSpheres {
  /// In the order of packs: radius descending, then x, y, z ascending.
  std::vector<SetSphere> spheres;
  /// Of a radius, meters.
  double largest_change = 0;
};

/// Gives each sphere the nearest radius of the working set (meters, ascending, not empty).
[[nodiscard]] SnappedSpheres snapRadii(const std::vector<HandSphere>& by_hand,
                                       const std::vector<float>& radii);

/// Spheres as they are given, measured with the yardstick of the fitter: what it promises of its
/// own is here what was measured. Fails as measureSphereSet.
[[nodiscard]] Result<SphereSet> authoredSphereSet(const TriangleMesh& mesh,
                                                  std::vector<SetSphere> spheres,
                                                  const SphereSetOptions& options,
                                                  unsigned threads);

}  // namespace galactic::bake
