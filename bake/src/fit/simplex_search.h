#pragma once
#include <functional>

#include "fit/axes.h"

namespace galactic::bake::fit {

struct SimplexOptions {
  /// Edge length of the first simplex, which has one corner at the origin.
  double size = 0.1;
  int max_steps = 120;
  /// The search ends when the simplex is smaller than this.
  double end_size = 1e-7;
};

struct SimplexResult {
  Vec3d place;
  double value = 0;
};

/// The least value of `function` that Nelder and Mead's simplex method (1965) finds around the
/// origin of a three-dimensional space. Deterministic.
[[nodiscard]] SimplexResult searchSimplex(const std::function<double(const Vec3d&)>& function,
                                          const SimplexOptions& options);

}  // namespace galactic::bake::fit
