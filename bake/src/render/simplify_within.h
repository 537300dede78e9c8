#pragma once
#include <cstdint>

#include "render/mesh_optimizer.h"
#include "render/part_mesh.h"

namespace galactic::bake {

/// A simplified piece, and the work it took to measure how far its surface moved.
struct MeasuredSimplified {
  /// Its error is measured: the largest distance of the points that were checked.
  Simplified surface;
  /// Number of source points whose distance to a simplified surface was compared with the error.
  std::uint64_t comparisons = 0;
  /// How many of these needed a search through all triangles.
  std::uint64_t searches = 0;
};

/// Simplifies a piece such that none of the checked points, the corners and centers of its
/// triangles, lies farther than `error` meters from the result. Where the quadrics let the surface
/// move farther (they bound the root mean square), or where the colors of corners are details that
/// their neighbors lack, these corners are kept and the rest is simplified again.
[[nodiscard]] MeasuredSimplified simplifyWithin(const PartMesh& piece, double error);

}  // namespace galactic::bake
