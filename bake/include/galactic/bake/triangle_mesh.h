#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// An axis-aligned box, meters.
struct Bounds {
  Vec3 min;
  Vec3 max;

  friend bool operator==(const Bounds&, const Bounds&) = default;
};

/// What cleaning a mesh dropped.
struct CleaningCounts {
  std::uint64_t read = 0;
  /// Two corners coincide, or the shortest altitude is under kDegenerateHeight.
  std::uint64_t degenerate = 0;
  /// The same three corner positions as an earlier triangle, in any order.
  std::uint64_t duplicate = 0;
};

/// A triangle whose shortest altitude is below this is dropped: its neighbors cover it to within
/// this distance. Meters.
inline constexpr double kDegenerateHeight = 1e-7;
/// A coordinate beyond this is refused, because float positions would be coarser than 0.1 mm.
/// Meters.
inline constexpr double kMaxCoordinate = 800.0;

/// The collision geometry of a scene: world frame, finite, no degenerate and no duplicate
/// triangles, at least one triangle.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  /// Bounds of the vertices that triangles use.
  Bounds bounds;
};

[[nodiscard]] inline std::array<Vec3, 3> cornersOf(const TriangleMesh& mesh,
                                                   const Triangle& triangle) {
  return {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
}

struct CleanMesh {
  TriangleMesh mesh;
  CleaningCounts counts;
};

/// Places every instance of `asset` in the world frame (in double precision, rounded once) and
/// cleans the triangles. Fails with kInvalidInput if nothing remains, or if a coordinate is not
/// finite or beyond kMaxCoordinate (with a question about units).
[[nodiscard]] Result<CleanMesh> placeAndClean(const SourceAsset& asset);

/// What the importer read and what cleaning left of a mesh, for the pack.
struct ImportStatistics {
  /// Format of the main input, for example "glTF 2.0".
  std::string format;
  std::uint32_t meshes = 0;
  std::uint32_t instances = 0;
  CleaningCounts counts;
  /// Triangles that remain.
  std::uint64_t triangles = 0;
};

[[nodiscard]] inline ImportStatistics importStatisticsOf(const SourceAsset& asset,
                                                         const CleanMesh& cleaned) {
  return {.format = asset.format,
          .meshes = static_cast<std::uint32_t>(asset.meshes.size()),
          .instances = static_cast<std::uint32_t>(asset.instances.size()),
          .counts = cleaned.counts,
          .triangles = cleaned.mesh.triangles.size()};
}

/// A colored triangle mesh for pictures, exports and checks.
struct Surface {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  /// RGBA, sRGB, 8 bits each, R in the lowest byte: one per position, or none for a neutral gray.
  std::vector<std::uint32_t> colors;

  [[nodiscard]] bool empty() const { return triangles.empty(); }
};

/// A linear RGBA color (0 to 1) as a Surface stores it.
[[nodiscard]] std::uint32_t surfaceColor(const std::array<float, 4>& linear);

/// Every instance of `asset`, placed by `frame_from_asset`, as one surface, colored by its
/// materials and vertex colors, or by `color` (linear RGBA) if given. Textures are not read.
[[nodiscard]] Surface surfaceOf(const SourceAsset& asset, const Affine& frame_from_asset,
                                const std::array<float, 4>* color = nullptr);

/// Appends `part` to `surface`; one of them may have no colors.
void append(Surface& surface, const Surface& part);

}  // namespace galactic::bake
