#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// From which sides light on a mesh is wanted.
enum class LitSides : std::uint8_t {
  kNone,   ///< It only keeps light away.
  kFront,  ///< Where it is seen from the front alone.
  kBoth
};

/// A mesh in the world: what light is kept away from, and what keeps it away.
struct OccludingMesh {
  std::span<const Vec3> positions;
  /// Corners in range of `positions`.
  std::span<const Triangle> triangles;
  LitSides lit = LitSides::kFront;
};

struct AmbientOcclusionOptions {
  /// For each vertex (and side), 1 to 65,536. In a cluttered room factors from 128 rays are off by
  /// 0.025 (root mean square), from 1,024 by 0.007.
  unsigned rays = 128;
  /// Backs are measured where the front's factor is smaller, 0 to 1.
  float dim = 0.25F;
  /// What is nearer keeps no light away: surfaces that were simplified may pass through each other.
  /// Meters, 0 or more, less than `largest_distance`.
  float least_distance = 0;
  /// What is farther away keeps no light away. Meters, > 0.
  float largest_distance = 1;
};

/// Factors of light at a vertex, 0 (dark) to 1 (open).
struct Openness {
  float front = 1;
  /// Where it was measured, else 0.
  float back = 0;

  friend bool operator==(const Openness&, const Openness&) = default;
};

/// How much of the light that comes evenly from all sides reaches each vertex: for each mesh and
/// vertex factors in linear light. None for meshes that are not lit.
///
/// The factor is a mean over the triangles around the vertex, weighted with its share (barycentric
/// coordinate) in them, of the part of cosine-weighted rays that meet nothing. So in a coarse mesh
/// the colors are right on average, where values at the vertices themselves would paint the
/// corners' darkness over whole walls (after Kavan, Bargteil and Sloan, "Least Squares Vertex
/// Baking", 2011, with lumped weights). Vertices at one place whose normals differ by less than 30
/// degrees share their triangles: no seams. Details smaller than the triangles blur.
///
/// Triangles occlude from both sides and wholly, whatever their material. A vertex without a
/// triangle of some area gets 1.
///
/// Deterministic: fixed directions (Hammersley points), and Embree's instructions pinned. Fails
/// with kInvalidInput when an option is out of range, kInternal when Embree does. Thread-safe. The
/// result does not depend on `threads`.
[[nodiscard]] Result<std::vector<std::vector<Openness>>> ambientOcclusion(
    std::span<const OccludingMesh> meshes, const AmbientOcclusionOptions& options,
    unsigned threads = 1);

}  // namespace galactic::bake
