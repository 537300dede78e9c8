#include <algorithm>
#include <memory>
#include <utility>

#include "galactic/bake/render_source.h"
#include "render/part_mesh.h"
#include "render/piece.h"

namespace galactic::bake {
namespace {

/// Whether nobody sees the inside of the mesh: its pieces are closed and face outwards.
Result<bool> isSolid(const PlacedMesh& placed, const RenderSource& source) {
  const auto mesh = assemblePart({.part = 0, .meshes = {placed}}, source);
  if (!mesh) return tl::unexpected(mesh.error());
  const std::vector<PartMesh> pieces = connectedPieces(*mesh);
  return std::all_of(pieces.begin(), pieces.end(), [](const PartMesh& piece) {
    const PieceShape shape = measurePiece(piece);
    return shape.closed && shape.volume > 0;
  });
}

}  // namespace

Result<void> addAmbientOcclusion(RenderSource& source, const AmbientOcclusionOptions& options) {
  for (RenderPart& part : source.parts) {
    std::vector<OccludingMesh> meshes;
    meshes.reserve(part.meshes.size());
    for (const PlacedMesh& placed : part.meshes) {
      const auto solid = isSolid(placed, source);
      if (!solid) return tl::unexpected(solid.error());
      meshes.push_back({.positions = placed.mesh->positions,
                        .triangles = placed.mesh->triangles,
                        .world_from_mesh = placed.part_from_mesh,
                        .two_sided = source.materials[placed.material].two_sided && !*solid});
    }
    const auto openness = ambientOcclusion(meshes, options);
    if (!openness) return tl::unexpected(openness.error());
    for (std::size_t n = 0; n < part.meshes.size(); ++n) {
      auto copy = std::make_unique<SourceMesh>(*part.meshes[n].mesh);
      copy->colors = darkened(copy->colors, (*openness)[n]);
      part.meshes[n].mesh = copy.get();
      source.own_meshes.push_back(std::move(copy));
    }
  }
  return {};
}

}  // namespace galactic::bake
