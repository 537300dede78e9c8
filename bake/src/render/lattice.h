#pragma once
#include <span>

#include "layout/render_pools.h"
#include "render/part_mesh.h"
#include "render/piece.h"

namespace galactic::bake {

/// Snaps finished pieces to a lattice and cuts them into clusters. The lattice is the finest one
/// (but not finer than kFinestStep) on which every triangle spans at most 65,535 steps; clusters do
/// not span more either. Corners at the same position get the same lattice point. Triangles that
/// lose their area are dropped.
[[nodiscard]] LatticeModel cutModel(std::span<const FinishedPiece> pieces,
                                    const RenderSource& source, unsigned threads);

}  // namespace galactic::bake
