#pragma once
#include "galactic/render_mesh_builder.h"
#include "support/render_pack_builder.h"

namespace galactic::test {

/// Render meshes made in memory, as fields of a hand-made pack.
RenderMeshesFields fieldsOf(const RenderMeshStorage& meshes);

}  // namespace galactic::test
