#pragma once
#include "render/mesh_optimizer.h"
#include "render/part_mesh.h"

namespace galactic::bake {

/// Simplifies a piece such that no point of it that is looked at, its corners and the middles of
/// its triangles, lies farther than `error` metres from the result. Where the quadrics let the
/// surface move further (they hold the root mean square) or the colours of corners show more than
/// their neighbours do, the corners are kept and the rest is simplified again. The error of the
/// result is measured.
[[nodiscard]] Simplified simplifyWithin(const PartMesh& piece, double error);

}  // namespace galactic::bake
