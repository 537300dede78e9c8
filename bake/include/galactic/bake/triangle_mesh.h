#pragma once
#include <cstdint>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// An axis-aligned box, meters.
struct Bounds {
  Vec3 min;
  Vec3 max;
};

/// What cleaning a mesh dropped.
struct CleaningCounts {
  std::uint64_t read = 0;
  /// Two corners coincide, or the shortest altitude is under kDegenerateHeight.
  std::uint64_t degenerate = 0;
  /// The same three corner positions as an earlier triangle, in any order.
  std::uint64_t duplicate = 0;
};

/// A triangle lower than this is dropped: its neighbors cover it to within this distance. Meters.
inline constexpr double kDegenerateHeight = 1e-7;
/// A coordinate beyond this is refused: float positions would be coarser than 0.1 mm. Meters.
inline constexpr double kMaxCoordinate = 800.0;

/// The collision geometry of a scene: world frame, finite, no degenerate and no duplicate triangle,
/// at least one triangle.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  /// Of the vertices that triangles use.
  Bounds bounds;
};

struct CleanMesh {
  TriangleMesh mesh;
  CleaningCounts counts;
};

/// Places every instance of `asset` in the world frame (in double precision, rounded once) and
/// cleans the triangles. Fails with kInvalidInput when nothing remains, or when a coordinate is not
/// finite or beyond kMaxCoordinate (with a question about units).
[[nodiscard]] Result<CleanMesh> placeAndClean(const SourceAsset& asset);

}  // namespace galactic::bake
