#pragma once
#include "bake_run.h"
#include "galactic/bake/render_textures.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Where the command shares textures between packs, writes those of `materials` that are not there
/// yet, each into a pack named by its content, and leaves their texels out of the asset's own pack.
[[nodiscard]] Result<void> shareTextures(BakedMaterials& materials, const BakeCommand& command);

}  // namespace galactic::bake
