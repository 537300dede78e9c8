#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "galactic/bake/render_baker.h"
#include "galactic/bake/source_asset.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// Material and semantic, which all triangles of a cluster share.
struct SurfaceKey {
  std::uint16_t material = 0;
  std::uint16_t semantic = 0;

  friend bool operator==(const SurfaceKey&, const SurfaceKey&) = default;
};

/// A vertex with all its attributes. Two vertices with equal bytes are the same vertex.
struct RenderVertex {
  Vec3 position;
  /// Texture coordinates; v points down from the top of the image.
  std::array<float, 2> uv{};
  /// RGBA, sRGB, R lowest.
  std::uint32_t color = 0xFFFFFFFF;
  SurfaceKey surface;
};
static_assert(sizeof(RenderVertex) == 28, "compared byte by byte, so without padding");

/// Welded triangles of a whole part or of a connected piece of it.
struct PartMesh {
  std::vector<RenderVertex> vertices;
  std::vector<Triangle> triangles;
};

/// All meshes of a part in its frame. Positions are computed in double precision and rounded once,
/// mirrored meshes get the opposite winding, and equal vertices are welded. Drops triangles with
/// two equal corners, and duplicates. Fails like bakeRenderMeshes.
[[nodiscard]] Result<PartMesh> assemblePart(const RenderPart& part, const RenderSource& source);

/// The connected pieces of a mesh, in the order of their first triangles. Triangles are connected
/// if they share a position, whatever their other attributes.
[[nodiscard]] std::vector<PartMesh> connectedPieces(const PartMesh& mesh);

}  // namespace galactic::bake
