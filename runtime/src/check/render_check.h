#pragma once
#include <cstddef>
#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct RenderMeshes;
}

namespace galactic::detail {

/// Checks every value of render meshes whose structure has been verified: what passes can be drawn
/// without a look at an index, and culling by its bounds leaves nothing out. `parts`: how many
/// objects or links the pack has; 1 for a scene. `where`: for example "mugs.pack: objects".
[[nodiscard]] Result<void> checkRenderMeshes(const schema::RenderMeshes& meshes, std::size_t parts,
                                             const std::string& where);

}  // namespace galactic::detail
