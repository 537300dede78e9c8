#include "galactic/render_library.h"

#include <utility>

namespace galactic {

std::uint32_t RenderLibrary::add(RenderMeshes meshes, const std::string& prefix) {
  const auto first = static_cast<std::uint32_t>(entries_.size());
  const auto pack = static_cast<std::uint32_t>(packs_.size());
  for (std::uint32_t model = 0; model < meshes.models.size(); ++model) {
    entries_.push_back({pack, model});
  }
  first_semantics_.push_back(static_cast<std::uint32_t>(semantic_names_.size()));
  for (const std::string_view name : meshes.semantics) {
    semantic_names_.push_back(prefix + std::string(name));
  }
  packs_.push_back(std::move(meshes));
  return first;
}

}  // namespace galactic
