#pragma once
#include <string>
#include <vector>

struct aiScene;

namespace galactic::bake {

/// Adds a warning for each material whose texture is clamped or mirrored at its edges in the file
/// while a triangle reaches beyond these edges: renderers repeat every texture.
void warnOfWraps(const aiScene& scene, std::vector<std::string>& warnings);

}  // namespace galactic::bake
