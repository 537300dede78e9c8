#pragma once
#include <span>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_fit {

/// Measures sphere sets of one mesh on samples that no solver has seen.
class Yardstick {
 public:
  explicit Yardstick(const FitTask& task);

  /// Of spheres whose protrusions may be wrong: they are measured. `task` has the tolerances; its
  /// solid and support are those that the yardstick was made with. All zero where no surface needs
  /// cover or without spheres.
  [[nodiscard]] SphereSetQuality measure(const FitTask& task,
                                         std::span<const Candidate> spheres) const;

 private:
  std::vector<Vec3d> samples_;
};

}  // namespace galactic::bake::sphere_fit
