#pragma once
#include <cstdint>
#include <vector>

#include "galactic/bake/render_baker.h"
#include "render/piece.h"

namespace galactic::bake {

/// For each material, whether the bake lights its surfaces.
[[nodiscard]] std::vector<bool> litMaterials(const RenderSource& source, Lighting lighting);

/// Multiplies the vertex colors of a part's finished pieces by the light that reaches them, where
/// their material is lit. The light depends on the normal and on occlusion by what is near. Corners
/// on an edge of a surface get one color for each side of it. Fails like ambientOcclusion.
[[nodiscard]] Result<void> lightPieces(std::vector<FinishedPiece>& pieces, const RenderPart& part,
                                       const RenderSource& source, const RenderBakeOptions& options,
                                       unsigned threads);

/// The light on an unoccluded surface with this unit normal, linear, 0 to 1. Y is up.
[[nodiscard]] double lightByNormal(const std::array<double, 3>& normal);

}  // namespace galactic::bake
