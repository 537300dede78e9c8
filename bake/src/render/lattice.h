#pragma once
#include <span>

#include "layout/render_pools.h"
#include "render/part_mesh.h"
#include "render/piece.h"

namespace galactic::bake {

/// Puts finished pieces on the finest lattice, but not finer than kFinestStep, on which every
/// triangle spans at most 65,535 steps, and cuts them into clusters that span no more. Corners at
/// one position come to one lattice point; triangles that lose their area there are dropped.
[[nodiscard]] LatticeModel cutModel(std::span<const FinishedPiece> pieces,
                                    const RenderSource& source, unsigned threads);

}  // namespace galactic::bake
