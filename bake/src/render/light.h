#pragma once
#include <cstdint>
#include <vector>

#include "galactic/bake/render_baker.h"
#include "render/piece.h"

namespace galactic::bake {

/// For each material whether its surfaces are lit by the bake.
[[nodiscard]] std::vector<bool> litMaterials(const RenderSource& source, Lighting lighting);

/// Multiplies light into the vertex colors of the finished pieces of a part, where their material
/// is lit: light by normal, kept away by what is near. Corners where a surface has an edge get a
/// color for each side of it. Fails as ambientOcclusion does.
[[nodiscard]] Result<void> lightPieces(std::vector<FinishedPiece>& pieces, const RenderPart& part,
                                       const RenderSource& source, const RenderBakeOptions& options,
                                       unsigned threads);

/// How much light falls on an open surface with this unit normal, in linear light, 0 to 1. Y is up.
[[nodiscard]] double lightByNormal(const std::array<double, 3>& normal);

}  // namespace galactic::bake
