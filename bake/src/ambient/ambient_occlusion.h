#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// On which sides of a mesh to compute the light.
enum class LitSides : std::uint8_t {
  kNone,   ///< None: the mesh only occludes.
  kFront,  ///< Only the front is seen.
  kBoth
};

/// A mesh in the world frame that occludes and may be lit.
struct OccludingMesh {
  std::span<const Vec3> positions;
  /// Indices into `positions`.
  std::span<const Triangle> triangles;
  LitSides lit = LitSides::kFront;
};

struct AmbientOcclusionOptions {
  /// Rays per vertex (and side), 1 to 65,536. In a cluttered room, the root mean square error of
  /// the factors is 0.025 with 128 rays and 0.007 with 1,024.
  unsigned rays = 128;
  /// The back is measured where the front's factor is below this, 0 to 1.
  float dim = 0.25F;
  /// Nearer surfaces do not occlude, because simplified surfaces may intersect each other. Meters,
  /// 0 or more, less than `largest_distance`.
  float least_distance = 0;
  /// Farther surfaces do not occlude. Meters, > 0.
  float largest_distance = 1;
};

/// Light factors at a vertex, 0 (dark) to 1 (open).
struct Openness {
  float front = 1;
  /// 0 where it was not measured.
  float back = 0;

  friend bool operator==(const Openness&, const Openness&) = default;
};

/// How much of a uniform light from all sides reaches each vertex: factors in linear light for each
/// vertex of each mesh; none for meshes that are not lit.
///
/// The factor is the share of cosine-weighted rays that hit nothing, averaged over the triangles
/// around the vertex and weighted by its barycentric coordinate. In a coarse mesh the colors are
/// thus right on average, whereas values at the vertices themselves would spread the darkness of
/// corners over whole walls (after Kavan, Bargteil and Sloan, "Least Squares Vertex Baking", 2011,
/// with lumped weights). A vertex also counts the triangles of other vertices at its position if
/// their normals are less than 30 degrees from its own, which avoids seams. Details smaller than
/// the triangles blur.
///
/// Triangles occlude fully and from both sides, whatever their material. A vertex gets 1 if its
/// triangles have no area.
///
/// Deterministic: the directions (Hammersley points) and Embree's instruction set are fixed. Fails
/// with kInvalidInput if an option is out of range, and with kUnsupported if memory runs out.
/// Thread-safe. The result does not depend on `threads`.
[[nodiscard]] Result<std::vector<std::vector<Openness>>> ambientOcclusion(
    std::span<const OccludingMesh> meshes, const AmbientOcclusionOptions& options,
    unsigned threads = 1);

}  // namespace galactic::bake
