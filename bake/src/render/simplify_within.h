#pragma once
#include <cstdint>

#include "render/mesh_optimizer.h"
#include "render/part_mesh.h"

namespace galactic::bake {

/// A piece simplified, and what it took to be sure how far its surface moved.
struct MeasuredSimplified {
  /// The error is measured: the largest distance of what is looked at.
  Simplified surface;
  /// Distances of points of the source to a simplified surface that were compared with the error.
  std::uint64_t comparisons = 0;
  /// Of these, how many took a search through all triangles.
  std::uint64_t searches = 0;
};

/// Simplifies a piece such that no point of it that is looked at, its corners and the middles of
/// its triangles, lies farther than `error` meters from the result. Where the quadrics let the
/// surface move further (they hold the root mean square) or the colors of corners show more than
/// their neighbors do, the corners are kept and the rest is simplified again.
[[nodiscard]] MeasuredSimplified simplifyWithin(const PartMesh& piece, double error);

}  // namespace galactic::bake
