#pragma once
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/shapes.h"
#include "robot_description/hand_spheres.h"

namespace galactic::bake {

/// Smaller changes of a radius, in meters, are considered rounding and not reported.
inline constexpr double kRadiusChangeWorthMentioning = 1e-6;

/// Hand-made spheres with their radii snapped to a working set.
struct SnappedSpheres {
  /// In the order of packs: radius descending, then x, y, z ascending.
  std::vector<SetSphere> spheres;
  /// Largest change of a radius, meters.
  double largest_change = 0;
};

/// Changes the radius of each sphere to the nearest one of the working set (meters, ascending, not
/// empty).
[[nodiscard]] SnappedSpheres snapRadii(const std::vector<HandSphere>& by_hand,
                                       const std::vector<float>& radii);

/// The given spheres as a sphere set, measured like those of the fitter. The members that the
/// fitter guarantees for its own sets hold the measured values here. Fails like measureSphereSet.
[[nodiscard]] Result<SphereSet> authoredSphereSet(const TriangleMesh& mesh,
                                                  std::vector<SetSphere> spheres,
                                                  const SphereSetOptions& options,
                                                  unsigned threads);

}  // namespace galactic::bake
