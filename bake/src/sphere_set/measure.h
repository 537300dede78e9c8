#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_set {

/// Measures sphere sets of one mesh on samples that no solver has seen.
class Yardstick {
 public:
  /// Keeps a copy of the task, whose solid must outlive it.
  explicit Yardstick(const FitTask& task);

  /// Of spheres whose protrusions may be wrong: they are measured. Gap and protrusion, and how many
  /// samples of what area; zero where no surface needs cover or without spheres.
  [[nodiscard]] SphereSetQuality measureLengths(std::span<const Candidate> spheres) const;

  /// The rest of a quality: volume and thin points.
  void complete(std::span<const Candidate> spheres, SphereSetQuality& quality) const;

 private:
  /// Number of samples that no sphere within tau can cover, the same for all `spheres`: those near
  /// them only save a search where they are within tau themselves.
  [[nodiscard]] std::uint64_t countThin(std::span<const Candidate> spheres) const;

  FitTask task_;
  std::vector<Vec3d> samples_;
};

}  // namespace galactic::bake::sphere_set
