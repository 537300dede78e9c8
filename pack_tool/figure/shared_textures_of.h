#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "galactic/pack.h"
#include "galactic/render_meshes.h"

namespace galactic::pack_tool {

/// The render meshes of a pack with the textures that it shares with others, where their packs lie
/// where galactic-bake puts them: in "textures" beside the pack's folder. What is not found there
/// has plain colors, and stays among their missing textures. Null where the pack has no render
/// meshes. `pack` must outlive the result.
[[nodiscard]] std::shared_ptr<const RenderMeshes> renderMeshesWithTextures(const PackFile& pack);

/// The shared textures that some packs show and that were not found. Any thread may note some.
class AbsentTextures {
 public:
  /// Those that `meshes` of `pack` lack; nullptr lacks none.
  void note(const PackFile& pack, const RenderMeshes* meshes);

  /// How many there are, and where they were looked for; nothing where none is missing.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  mutable std::mutex mutex_;
  std::set<std::pair<std::uint64_t, std::uint64_t>> hashes_;
  std::set<std::filesystem::path> folders_;
};

}  // namespace galactic::pack_tool
