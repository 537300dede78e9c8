#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/solid/exterior_solid.h"

namespace galactic::bake::sphere_set {

/// What one cover has to do, and on which solid. Lengths in meters.
struct FitTask {
  const ExteriorSolid* solid = nullptr;
  /// Ascending.
  std::vector<double> radii;
  double eps = 0;
  double tau = 0;
  std::optional<HalfSpace> support;
  unsigned threads = 1;
  /// Places where a sphere of one radius is tried, about and at most.
  double most_places = 30'000;
};

/// A sphere that may be chosen.
struct Candidate {
  /// Exactly as it would be stored.
  Vec3d center;
  std::uint32_t radius_index = 0;
  /// No point of the sphere is further outside the solid than this.
  double protrusion = 0;
};

/// How far the center of a sphere may be outside (negative: must be inside) under `tau`.
[[nodiscard]] inline double highestCenter(const FitTask& task, std::uint32_t radius_index) {
  return task.tau - task.radii[radius_index];
}

}  // namespace galactic::bake::sphere_set
