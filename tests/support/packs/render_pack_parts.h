#pragma once
#include "layout/render_mesh_builder.h"
#include "support/packs/render_pack_builder.h"

namespace galactic::test {

/// Render meshes made in memory, as fields of a hand-made pack.
RenderMeshesFields fieldsOf(const RenderMeshStorage& meshes);

}  // namespace galactic::test
