#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "galactic/bake/render_baker.h"
#include "galactic/bake/source_asset.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// What cannot be shared by two triangles of one cluster: material and semantic.
struct SurfaceKey {
  std::uint16_t material = 0;
  std::uint16_t semantic = 0;

  friend bool operator==(const SurfaceKey&, const SurfaceKey&) = default;
};

/// A corner with all that is drawn of it. Two that are equal byte by byte are one.
struct RenderVertex {
  Vec3 position;
  /// v down from the image's top.
  std::array<float, 2> uv{};
  /// RGBA, sRGB, R lowest.
  std::uint32_t color = 0xFFFFFFFF;
  SurfaceKey surface;
};
static_assert(sizeof(RenderVertex) == 28, "compared byte by byte, so without padding");

/// Welded triangles: of a whole part, or of a connected piece of it.
struct PartMesh {
  std::vector<RenderVertex> vertices;
  std::vector<Triangle> triangles;
};

/// All meshes of a part in its frame: placed in double precision and rounded once, mirrored ones
/// turned round, equal corners welded; without triangles that have no area because two corners are
/// one, or that are there twice. Fails as bakeRenderMeshes does.
[[nodiscard]] Result<PartMesh> assemblePart(const RenderPart& part, const RenderSource& source);

/// The connected pieces of a mesh, in the order of their first triangles: triangles belong together
/// when they touch at a position, whatever else differs.
[[nodiscard]] std::vector<PartMesh> connectedPieces(const PartMesh& mesh);

}  // namespace galactic::bake
