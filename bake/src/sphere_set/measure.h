#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_set {

/// Measures sphere sets of one mesh on samples that no solver uses.
class Yardstick {
 public:
  /// Keeps a copy of the task, whose solid must outlive it.
  explicit Yardstick(const FitTask& task);

  /// Gap and protrusion, the number of samples and their area; zero without spheres or if no
  /// surface needs cover. The spheres' own `protrusion` may be wrong, as it is measured anew.
  [[nodiscard]] SphereSetQuality measureLengths(std::span<const Candidate> spheres) const;

  /// Adds the rest of the quality: volume and thin points.
  void complete(std::span<const Candidate> spheres, SphereSetQuality& quality) const;

 private:
  /// Number of samples that no sphere that protrudes by at most tau can cover. It does not depend
  /// on `spheres`: nearby ones that are within tau themselves only save a search.
  [[nodiscard]] std::uint64_t countThin(std::span<const Candidate> spheres) const;

  FitTask task_;
  std::vector<Vec3d> samples_;
};

}  // namespace galactic::bake::sphere_set
