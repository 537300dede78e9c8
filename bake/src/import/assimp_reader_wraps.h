#pragma once
#include <string>
#include <vector>

struct aiScene;

namespace galactic::bake {

/// Adds a warning for each material whose texture does not repeat in the file, but is clamped or
/// mirrored at its edges, where a triangle reaches beyond them: renderers repeat every texture.
void warnOfWraps(const aiScene& scene, std::vector<std::string>& warnings);

}  // namespace galactic::bake
