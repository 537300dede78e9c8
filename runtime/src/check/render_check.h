#pragma once
#include <cstddef>
#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct RenderMeshes;
}

namespace galactic::detail {

/// Checks every value of render meshes whose structure has been verified: meshes that pass can be
/// drawn without checking any index, and culling by their bounds omits nothing visible. `parts` is
/// the number of objects or links in the pack, 1 for a scene. `where`: for example "mugs.pack:
/// objects".
[[nodiscard]] Result<void> checkRenderMeshes(const schema::RenderMeshes& meshes, std::size_t parts,
                                             const std::string& where);

}  // namespace galactic::detail
