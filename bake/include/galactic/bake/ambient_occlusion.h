#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "galactic/vec3.h"

namespace galactic::bake {

/// One placement of a mesh: what light is kept away from, and what keeps it away.
struct OccludingMesh {
  std::span<const Vec3> positions;
  /// Corners in range of `positions`.
  std::span<const Triangle> triangles;
  /// Row-major; mirroring ones turn the triangles round.
  Affine world_from_mesh{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  /// A sheet that is seen from both sides: the side that gets more light counts. Not for closed
  /// bodies, whose inside nobody sees.
  bool two_sided = false;
};

struct AmbientOcclusionOptions {
  /// For each vertex (and side), 1 to 65,536. In a cluttered room factors from 128 rays are off by
  /// 0.025 (root mean square), from 1,024 by 0.007.
  unsigned rays = 128;
  /// What is farther away keeps no light away. Metres, > 0.
  float largest_distance = 1;
  /// Threads. The result does not depend on them.
  unsigned jobs = 1;
};

/// How much of the light that comes evenly from all sides reaches each vertex: for each mesh and
/// vertex a factor in linear light, 0 (dark) to 1 (open), to be multiplied into its colour.
///
/// The factor is a mean over the triangles around the vertex, weighted with its share (barycentric
/// coordinate) in them, of the part of cosine-weighted rays that meet nothing. So in a coarse mesh
/// the colours are right on average, where values at the vertices themselves would paint the
/// corners' darkness over whole walls (after Kavan, Bargteil and Sloan, "Least Squares Vertex
/// Baking", 2011, with lumped weights). Vertices at one place whose normals differ by less than 30
/// degrees share their triangles: no seams. Details smaller than the triangles blur.
///
/// Triangles occlude from both sides and wholly, whatever their material. A vertex without a
/// triangle of some area gets 1.
///
/// Deterministic: fixed directions (the R5 sequence, Roberts 2018), and Embree's instructions
/// pinned. Fails with kInvalidInput when an option is out of range, kInternal when Embree does.
/// Thread-safe.
[[nodiscard]] Result<std::vector<std::vector<float>>> ambientOcclusion(
    std::span<const OccludingMesh> meshes, const AmbientOcclusionOptions& options);

/// `colors` (linear RGBA; none counts as white) darkened by `openness`, one per vertex.
[[nodiscard]] std::vector<std::array<float, 4>> darkened(
    std::span<const std::array<float, 4>> colors, std::span<const float> openness);

}  // namespace galactic::bake
