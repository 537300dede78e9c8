#pragma once
#include <memory>

#include "galactic/pack.h"
#include "galactic/render_meshes.h"

namespace galactic::pack_tool {

/// The render meshes of a pack with the textures that it shares with others, where their packs lie
/// where galactic-bake puts them: in "textures" beside the pack's folder. What is not found there
/// has plain colors. Null where the pack has no render meshes. `pack` must outlive the result.
[[nodiscard]] std::shared_ptr<const RenderMeshes> renderMeshesWithTextures(const PackFile& pack);

}  // namespace galactic::pack_tool
