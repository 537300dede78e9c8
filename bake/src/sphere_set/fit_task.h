#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/solid/exterior_solid.h"

namespace galactic::bake::sphere_set {

/// The solid to cover and the requirements for the cover. Lengths in meters.
struct FitTask {
  const ExteriorSolid* solid = nullptr;
  /// Ascending.
  std::vector<double> radii;
  double eps = 0;
  double tau = 0;
  std::optional<HalfSpace> support;
  unsigned threads = 1;
  /// Approximate maximum number of positions at which a sphere of one radius is tried.
  double most_places = 30'000;
};

/// A sphere that may be chosen for a cover.
struct Candidate {
  /// Rounded exactly as it would be stored.
  Vec3d center;
  std::uint32_t radius_index = 0;
  /// No point of the sphere is farther outside the solid than this.
  double protrusion = 0;
};

/// How far outside the solid a sphere's center may be if the sphere protrudes by at most `tau`; if
/// negative, it must be that far inside.
[[nodiscard]] inline double highestCenter(const FitTask& task, std::uint32_t radius_index) {
  return task.tau - task.radii[radius_index];
}

}  // namespace galactic::bake::sphere_set
