#pragma once
#include <cstdint>

#include "galactic/bake/column_engines.h"
#include "galactic/bake/columns.h"
#include "galactic/bake/triangle_mesh.h"

namespace galactic::bake {

struct CastCheckOptions {
  /// Columns to replay, spread evenly over those that hold spans.
  std::uint32_t columns = 128;
  /// A surface whose distance differs from the radius by no more than this is a tie, meters.
  double tie_tolerance = 1e-5;
};

/// How replayed sphere casts compare with a grid; lengths in meters, summed over the sample.
struct CastCheck {
  std::uint32_t columns = 0;
  std::uint32_t columns_differing = 0;
  double compared = 0;
  /// Explained by the casting method: its contact pad and its search step.
  double method = 0;
  /// The surface lies at the radius to within the tolerance.
  double ties = 0;
  /// A double-precision distance says that the grid is wrong: must be 0.
  double errors = 0;
  /// The longest stretch of one column in which the two differ because of the method.
  double longest = 0;
};

/// Replays a sample of columns with Bullet and judges each disagreement by the distance to the
/// mesh, computed in double precision by brute force. `columns` are the free spans before the
/// choice of regions, of Coverage::kColumn.
[[nodiscard]] CastCheck checkWithCasts(const TriangleMesh& mesh, const Columns& columns,
                                       const BulletColumnCaster& caster,
                                       const CastCheckOptions& options = {});

}  // namespace galactic::bake
