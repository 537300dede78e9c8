#pragma once
#include "galactic/bake/render_baker.h"
#include "write/pack_payload.h"

namespace galactic::bake {

/// Builds the render meshes' table of a scene, object set or robot.
[[nodiscard]] Offset<schema::RenderMeshes> renderMeshesTable(FlatBufferBuilder& builder,
                                                             const BakedRenderMeshes& meshes);

}  // namespace galactic::bake
