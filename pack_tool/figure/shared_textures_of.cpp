#include "pack_tool/figure/shared_textures_of.h"

#include <fmt/format.h>

#include <vector>

#include "galactic/render_library.h"

namespace galactic::pack_tool {
namespace {

/// Render meshes, and the files that they look into.
struct TexturedMeshes {
  std::vector<PackFile> texture_packs;
  RenderMeshes meshes;
};

}  // namespace

std::shared_ptr<const RenderMeshes> renderMeshesWithTextures(const PackFile& pack) {
  auto plain = renderMeshesOf(pack);
  if (!plain || !*plain) return nullptr;
  const auto held = std::make_shared<TexturedMeshes>();
  SharedTextures textures;
  for (const MissingTexture& missing : (*plain)->missing_textures) {
    auto opened = PackFile::open(texturePackBeside(pack, missing));
    // Of another kind: then it is not the texture. It stays among those that are missing.
    if (!opened || !textures.add(*opened)) continue;
    held->texture_packs.push_back(std::move(*opened));
  }
  auto textured = renderMeshesOf(pack, textures);
  held->meshes = std::move(**textured);
  return {held, &held->meshes};
}

void AbsentTextures::note(const PackFile& pack, const RenderMeshes* meshes) {
  if (meshes == nullptr) return;
  const std::lock_guard lock(mutex_);
  for (const MissingTexture& missing : meshes->missing_textures) {
    hashes_.emplace(missing.hash_high, missing.hash_low);
    folders_.insert(texturePackBeside(pack, missing).parent_path().lexically_normal());
  }
}

std::optional<std::string> AbsentTextures::warning() const {
  const std::lock_guard lock(mutex_);
  if (hashes_.empty()) return std::nullopt;
  std::vector<std::string> folders;
  for (const std::filesystem::path& folder : folders_) folders.push_back(folder.string());
  const bool is_one = hashes_.size() == 1;
  return fmt::format("{} shared texture{} drawn as flat colors: {} missing or damaged in {}",
                     hashes_.size(), is_one ? " is" : "s are",
                     is_one ? "its pack is" : "their packs are", fmt::join(folders, ", "));
}

}  // namespace galactic::pack_tool
