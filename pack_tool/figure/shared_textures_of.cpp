#include "pack_tool/figure/shared_textures_of.h"

#include <utility>
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
    // Of another kind: then it is not the texture.
    if (!opened || !textures.add(*opened)) continue;
    held->texture_packs.push_back(std::move(*opened));
  }
  auto textured = renderMeshesOf(pack, textures);
  held->meshes = std::move(**textured);
  return {held, &held->meshes};
}

}  // namespace galactic::pack_tool
